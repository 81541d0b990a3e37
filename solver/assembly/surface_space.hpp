// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/pack.hpp"
#include "solver/assembly/symmetric_matrix.hpp"
#include "solver/fe/quadrature.hpp"
#include "solver/mesh/mesh.hpp"

namespace esfem {

/// What an integrand sees at one quadrature point of eight elements at once.
template <int inputs>
struct PointData {
  Pack x[3];             ///< position on Gamma_h[x]
  Pack normal[3];        ///< unit normal of Gamma_h[x], outward
  Pack u[inputs];        ///< values of the input components
  Pack grad[inputs][3];  ///< their tangential gradients
};

/// What an integrand returns: the load of output component l is the integral of value[l] phi_j, plus
/// flux[l] . grad phi_j for the first `fluxes` components.
template <int outputs, int fluxes>
struct Integrand {
  Pack value[outputs];
  Pack flux[fluxes > 0 ? fluxes : 1][3];
};

/// S_h[x] of kll19 §3.1: isoparametric P_k functions on the surface Gamma_h[x] that the nodal vector x
/// determines. Topology, sparsity and scatter map are fixed at construction; matrices and loads are filled
/// for any x. Every function of x throws NumericsError with the element's number when an element is
/// degenerate (Jacobian not positive relative to the element's size, or not finite).
class SurfaceSpace {
 public:
  SurfaceSpace(const Mesh& mesh, const Quadrature& rule);
  /// With default_quadrature(mesh.degree).
  explicit SurfaceSpace(const Mesh& mesh);

  int degree() const;
  int dofs() const;
  int element_count() const;
  const Connectivity& elements() const;
  const Quadrature& quadrature() const;
  std::shared_ptr<const SparsityPattern> pattern() const;
  /// A zero matrix on the pattern.
  SymmetricMatrix matrix() const;

  /// M(x) and A(x) of kll19 §3.3, both in one pass.
  void assemble(const Field& x, SymmetricMatrix& M, SymmetricMatrix& A) const;

  /// Integral of weight phi_i phi_j; weight(const PointData<inputs>&) -> Pack, u: N x inputs.
  template <int inputs, class Weight>
  void assemble_weighted_mass(const Field& x, const Field& u, const Weight& weight,
                              SymmetricMatrix& out) const;

  /// Load functionals: out (N x outputs) = integral of value phi_j + flux . grad phi_j over Gamma_h[x], where
  /// integrand(const PointData<inputs>&, Integrand<outputs, fluxes>&) fills value and flux from u (N x
  /// inputs).
  template <int inputs, int outputs, int fluxes, class Function>
  void assemble_load(const Field& x, const Field& u, const Function& integrand, Field& out) const;

  /// Surface area, integral of 1.
  double area(const Field& x) const;
  /// Enclosed volume, one third of the integral of x . nu.
  double volume(const Field& x) const;
};

}  // namespace esfem
