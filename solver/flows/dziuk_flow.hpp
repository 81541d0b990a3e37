// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/exact_evolution.hpp"
#include "solver/linalg/sparse_cholesky.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Mean curvature flow by Dziuk's scheme (Numer. Math. 58, 1990; kll19 (3.6)), linearly implicit BDF:
///   M(x~) 1/tau sum_{j>=0} delta_j x^{n-j} + A(x~) x^n = 0.
/// Unstable with BDF 4 and 5 (a run with them is allowed: it shows it).
///
/// Unknown nodal vector: positions x. The velocity v = 1/tau sum_{j>=0} delta_j x^{n-j} is kept beside it.
class DziukFlow {
 public:
  struct State {
    double t = 0;
    Field x;  ///< N x 3
    Field v;  ///< N x 3
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  explicit DziukFlow(const SurfaceSpace& space);

  /// One step with BDF of order q: fills next.x and next.v. Throws SingularityError where the surface is
  /// singular or no longer resolved (regularity.hpp).
  void step(const History<State>& history, int q, double tau, State& next);

 private:
  const SurfaceSpace& space_;
  SymmetricMatrix M_, A_;
  SparseCholesky cholesky_;
  Field x_tilde_, sum_;
};

/// The state on nodes x at time 0, with v = -M(x)^-1 A(x) x.
DziukFlow::State dziuk_state_on(const SurfaceSpace& space, const Field& x);

/// The state whose nodal values are an exact solution's, in the nodes that start at x0.
DziukFlow::State exact_dziuk_state(const ExactEvolution& exact, const Field& x0, double t);

}  // namespace esfem
