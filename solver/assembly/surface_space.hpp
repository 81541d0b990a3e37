// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "solver/assembly/element_batches.hpp"
#include "solver/assembly/symmetric_matrix.hpp"
#include "solver/fe/quadrature.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/pack.hpp"

namespace esfem {

/// What an integrand sees at one quadrature point of pack_size elements at once.
template <int inputs>
struct PointData {
  Pack x[3];                              ///< position on Gamma_h[x]
  Pack normal[3];                         ///< unit normal of Gamma_h[x], outward
  Pack u[inputs > 0 ? inputs : 1];        ///< values of the input components
  Pack grad[inputs > 0 ? inputs : 1][3];  ///< their tangential gradients
};

/// What an integrand returns: the load of output component l is the integral of value[l] phi_j, plus
/// flux[l] . grad phi_j for the first `fluxes` components.
template <int outputs, int fluxes>
struct Integrand {
  Pack value[outputs];                    ///< tested with phi_j
  Pack flux[fluxes > 0 ? fluxes : 1][3];  ///< tested with grad phi_j; only its tangential part counts
};

/// S_h[x] of kll19 §3.1: isoparametric P_k functions on the surface Gamma_h[x] that the nodal vector x
/// determines. Topology, sparsity and scatter map are fixed at construction; matrices and loads are filled
/// for any x, without allocation. The work space is a member: one object is used by one thread at a time.
/// Every function of x throws NumericsError with the element's number when an element is degenerate (Jacobian
/// not positive relative to the element's size, or not finite), and InputError when a field has not one row a
/// node.
class SurfaceSpace {
 public:
  /// The degree and the elements of the mesh, which are copied; all sums are by this rule.
  SurfaceSpace(const Mesh& mesh, const Quadrature& rule);
  /// With default_quadrature(mesh.degree).
  explicit SurfaceSpace(const Mesh& mesh);

  /// k of P_k.
  int degree() const { return degree_; }
  /// N, the number of nodes.
  int dofs() const { return pattern_->size; }
  /// E, the number of elements.
  int element_count() const { return static_cast<int>(elements_.rows()); }
  /// E x (k+1)(k+2)/2, as in the mesh.
  const Connectivity& elements() const { return elements_; }
  /// The rule of all sums.
  const Quadrature& quadrature() const { return rule_; }
  /// The elements with the rule's shape functions, for sums over quadrature points outside this class.
  const ElementBatches& batches() const { return batches_; }
  /// That of all matrices of the space, for solvers.
  std::shared_ptr<const SparsityPattern> pattern() const { return pattern_; }
  /// The characteristic_length of the mesh that the space was made for; exactly 1 for surfaces of size one.
  double length() const { return length_; }
  /// A zero matrix on the pattern.
  SymmetricMatrix matrix() const;

  /// M(x) and A(x) of kll19 §3.3, both in one pass. Both are matrices of this space.
  void assemble(const Field& x, SymmetricMatrix& M, SymmetricMatrix& A) const;

  /// Integral of weight phi_i phi_j; weight(const PointData<inputs>&) -> Pack, u: N x inputs.
  template <int inputs, class Weight>
  void assemble_weighted_mass(const Field& x, const Field& u, const Weight& weight,
                              SymmetricMatrix& out) const;

  /// Several of them in one pass: out[l] with weight[l] of weights(const PointData<inputs>&, Pack* weight).
  template <int inputs, int outputs, class Weights>
  void assemble_weighted_masses(const Field& x, const Field& u, const Weights& weights,
                                SymmetricMatrix (&out)[outputs]) const;

  /// Integral of weight grad phi_i . grad phi_j, otherwise as the one above.
  template <int inputs, class Weight>
  void assemble_weighted_stiffness(const Field& x, const Field& u, const Weight& weight,
                                   SymmetricMatrix& out) const;

  /// Load functionals: out (N x outputs) = integral of value phi_j + flux . grad phi_j over Gamma_h[x], where
  /// integrand(const PointData<inputs>&, Integrand<outputs, fluxes>&) fills value and flux from u (N x
  /// inputs).
  template <int inputs, int outputs, int fluxes, class Function>
  void assemble_load(const Field& x, const Field& u, const Function& integrand, Field& out) const;

  /// Surface area, integral of 1.
  double area(const Field& x) const;
  /// Enclosed volume, one third of the integral of (x - centre) . nu, about the far_centre of x.
  double volume(const Field& x) const;

 private:
  void require_rows(const Field& field, int columns) const;
  void require_matrix(const SymmetricMatrix& matrix) const;
  template <int inputs>
  PointData<inputs> point_data(const Batch& batch, int q, const BatchPoint& geometry,
                               const DualTangents& dual, const Pack (*u)[inputs + 1]) const;
  /// Integral of function(batch, shapes, point) against dxi deta.
  template <class Function>
  double integrate(const Field& x, const Function& function) const;
  /// keep(q, rule's weight, point data, geometry) at the points of each batch, and then add(batch).
  template <int inputs, class Keep, class Add>
  void assemble_weighted(const Field& x, const Field& u, const Keep& keep, const Add& add) const;
  /// Element mass matrices of a batch from the weights of its points, added to M.
  void add_mass(const Batch& batch, const Pack* weights, SymmetricMatrix& M) const;
  /// The metric terms of a quadrature point, for gradients that are weighted with the weight of the point.
  void set_stiffness_point(int q, const Pack& weight, const BatchPoint& point) const {
    const Pack scale = weight * point.inverse_jacobian;
    stiffness_point_[3 * q] = scale * dot(point.tangent_eta, point.tangent_eta);
    stiffness_point_[3 * q + 1] = -scale * dot(point.tangent_xi, point.tangent_eta);
    stiffness_point_[3 * q + 2] = scale * dot(point.tangent_xi, point.tangent_xi);
  }
  /// stiffness_entry_ from stiffness_point_: rows sum to zero.
  void sum_stiffness() const;
  void add_stiffness(const Batch& batch, SymmetricMatrix& A) const;
  void add_entries(const Batch& batch, const std::vector<Pack>& entry, SymmetricMatrix& out) const;

  int degree_;
  Connectivity elements_;
  Quadrature rule_;
  double length_;
  std::shared_ptr<const SparsityPattern> pattern_;
  ElementBatches batches_;
  int off_diagonals_, entries_;             ///< number in the lower triangle of an element matrix
  std::vector<std::pair<int, int>> pairs_;  ///< local nodes of these entries
  std::vector<int> position_;               ///< batches x entries x lanes: where it goes in M.values
  std::vector<double> mass_table_;          ///< see pair_table in the .cpp
  std::vector<double> stiffness_table_;
  mutable std::vector<Pack> mass_point_;       ///< work space: one integration weight a point and matrix
  mutable std::vector<Pack> stiffness_point_;  ///< work space: three metric terms a point
  mutable std::vector<Pack> mass_entry_, stiffness_entry_;
};

}  // namespace esfem

#include "solver/assembly/surface_space_templates.hpp"
