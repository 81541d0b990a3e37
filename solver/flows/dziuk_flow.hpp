// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "solver/assembly/surface_space.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Mean curvature flow by Dziuk's scheme (Numer. Math. 58, 1990; kll19 (3.6)), linearly implicit BDF:
///   M(x~) 1/tau sum_{j>=0} delta_j x^{n-j} + A(x~) x^n = 0.
///
/// Tangential motion of the nodes: A(x) x is normal to the surface, so a tangential displacement d does not
/// change it to first order, and its contribution to A(x~) x^n is A (d^n - d~^n), d~ extrapolated. For a mode
/// with A d = lambda M d this is
///   delta(zeta) + tau lambda (1 - zeta)^q = 0,
/// which has its roots outside the unit disk for q <= 3, but not for q = 4 beyond tau lambda = 2.5 and q = 5
/// beyond 0.64: these are unstable (runs with them are allowed, to show this). With q = 2 the tangential
/// velocity is damped only by (tau lambda + 1/2)/(tau lambda + 3/2) per step, hardly at all for rough modes:
/// their drift continues until the mesh degenerates. With q = 1 it stops immediately.
///
/// Unknown nodal vector: positions x. The velocity v = 1/tau sum_{j>=0} delta_j x^{n-j} is kept beside it.
class DziukFlow {
 public:
  /// What a step starts from and computes.
  struct State {
    double t = 0;  ///< time of the nodal values
    Field x;       ///< N x 3
    Field v;       ///< N x 3

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  explicit DziukFlow(const SurfaceSpace& space, const RegularityLimits& limits = {});

  /// One step with BDF of order q: fills next.x and next.v. Throws SingularityError where the surface is
  /// singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

 private:
  const SurfaceSpace& space_;
  RegularityLimits limits_;
  SymmetricMatrix M_, A_;
  SpdSolver spd_;
  Field x_tilde_, sum_;
};

/// The warning for BDF of order q: orders 4 and 5 are unstable; "" for the others.
std::string dziuk_warning(int q);

/// The state on nodes x at time 0, with v = -M(x)^-1 A(x) x.
DziukFlow::State dziuk_state_on(const SurfaceSpace& space, const Field& x);

/// The flow's own nodal fields beside x: v.
NodalFields nodal_fields(const DziukFlow::State& state);

}  // namespace esfem
