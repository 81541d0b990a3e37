// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "solver/analysis/quantities.hpp"
#include "solver/assembly/surface_space.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// Squared L2 norm and H1 seminorm of each component.
struct SquaredNorms {
  Eigen::VectorXd L2;       ///< one a component
  Eigen::VectorXd H1_semi;  ///< one a component
};

/// Nodal norms (kll19 (7.1)-(7.2)): eᵀM(x*)e and eᵀA(x*)e per column of e; the matrices are assembled at x*.
SquaredNorms nodal_norms(const SymmetricMatrix& M, const SymmetricMatrix& A, const Field& e);

/// True errors on the exact surface, by quadrature with the space's rule: the functions with nodal values w
/// (N x c) on the interpolated surface Gamma_h[x_star] are lifted to the surface by its closest point (kll19
/// §3.4) and compared with the exact components at time t.
///
/// With x = y + s nu(y) the tangents of the lifted element are dy = (I + s A(y))^{-1} P dx.
SquaredNorms lifted_errors(const SurfaceSpace& space, const Field& x_star, const ExactEvolution& exact,
                           double t, const Field& w);

/// The same on Gamma_h[x] itself, without a lift: the functions with nodal values w are compared with the
/// exact components, which must be defined near the surface, in its quadrature points, and gradients with the
/// part of theirs that is tangential to Gamma_h[x]. For nodes that are O(h^(k+1)) from the exact surface this
/// differs from lifted_errors by O(h^(k+1)) in L2 and O(h^k) in H1: at orders of convergence it is as good,
/// where the exact surface is not known.
SquaredNorms unlifted_errors(const SurfaceSpace& space, const Field& x, const ExactEvolution& exact, double t,
                             const Field& w);

/// Raises the maxima of nodal_L2, nodal_H1 and nodal_H1_semi (kind "nodal"; or "lifted") of each quantity to
/// these norms, and calls each(quantity, norm, value).
void raise_maxima(const Quantities& quantities, const std::string& kind, const SquaredNorms& norms,
                  Errors& maxima,
                  const std::function<void(const std::string&, const std::string&, double)>& each = {});

/// Collects the errors of a run: per step as series "x_nodal_L2", .., and their maxima over time (the norms
/// L^infinity(L2), L^infinity(H1)). H1 is the full norm sqrt(L2² + seminorm²), per time. An observer of
/// integrate.
class ErrorRecorder {
 public:
  /// x0: the exact initial nodes. Space and exact solution must outlive the recorder.
  ErrorRecorder(const SurfaceSpace& space, const ExactEvolution& exact, Field x0);

  /// The errors of a state whose nodal fields have the names of the exact solution's quantities (Quantities).
  template <class State>
  void record(const State& state) {
    record(state.t, quantities_.of(state));
  }
  /// The same, as an observer.
  template <class State>
  void operator()(int, const State& state) {
    record(state);
  }
  /// w: the numerical components at time t, N x exact.components(), in the order of exact.quantities.
  void record(double t, const Field& w);

  /// Over the steps recorded so far.
  const Errors& maxima() const { return maxima_; }
  /// "t", and the error of each quantity and norm, one value a step.
  const std::map<std::string, std::vector<double>>& series() const { return series_; }

 private:
  const SurfaceSpace& space_;
  const ExactEvolution& exact_;
  Field x0_;
  Quantities quantities_;
  SymmetricMatrix M_, A_;
  Errors maxima_;
  std::map<std::string, std::vector<double>> series_;
};

/// The largest nodal norms, over the steps of a run, of differences of two states.
class LargestDifferences {
 public:
  /// The space must outlive this.
  LargestDifferences(const SurfaceSpace& space, std::vector<ExactEvolution::Quantity> quantities);

  /// Norms on Gamma_h[x] of a - b.
  template <class State>
  void add(const Field& x, const State& a, const State& b) {
    add(x, quantities_.of(a) - quantities_.of(b));
  }
  /// difference: N x all components.
  void add(const Field& x, const Field& difference);

  /// nodal_L2, nodal_H1 and nodal_H1_semi of each quantity.
  const Errors& errors() const { return errors_; }

 private:
  const SurfaceSpace& space_;
  Quantities quantities_;
  SymmetricMatrix M_, A_;
  Errors errors_;
};

}  // namespace esfem
