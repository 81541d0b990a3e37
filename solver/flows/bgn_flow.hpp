// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/bgn_system.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Mean curvature flow by the scheme of Barrett, Garcke and Nürnberg (J. Comput. Phys. 227, 2008), which
/// moves nodes tangentially so that the mesh stays good: find x^n and H^n with
///   (1/tau) ((x^n - x^{n-1}) . nu, chi) + (H^n, chi) = 0        for all chi in S_h,
///   (H^n nu, eta) - (grad x^n, grad eta) = 0                    for all eta in S_h^3
/// on Gamma_h[x^{n-1}], nu its own normal, with H = div nu (2/R on a sphere: their kappa is -H).
///
/// For the lumped scheme of the paper (P1) give the space the rule of the vertices, vertex_quadrature().
class BgnFlow {
 public:
  /// What a step starts from and computes.
  struct State {
    double t = 0;  ///< time of the nodal values
    Field x;       ///< N x 3
    Field v;       ///< N x 3: (x^n - x^{n-1})/tau, with its tangential part
    Field H;       ///< N x 1

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"H", &State::H}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  explicit BgnFlow(const SurfaceSpace& space, const RegularityLimits& limits = {});

  /// One step; q must be 1 (InputError), the scheme is of first order. Throws SingularityError where the
  /// surface is singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

 private:
  const SurfaceSpace& space_;
  RegularityLimits limits_;
  BgnSystem system_;
  SymmetricMatrix tau_M_;
  Field zero_;
};

/// The state on nodes x at time 0, with v = -M(x)^-1 A(x) x and H the projection of -v onto the discrete
/// normal.
BgnFlow::State bgn_state_on(const SurfaceSpace& space, const Field& x);

/// The flow's own nodal fields beside x: v, H.
NodalFields nodal_fields(const BgnFlow::State& state);

}  // namespace esfem
