// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/flows/coupled_diffusion.hpp"
#include "solver/geometry/prescribed_motion.hpp"
#include "solver/geometry/regularity.hpp"

namespace esfem {

/// What a step starts from and computes.
struct ReactionDiffusionState {
  double t = 0;  ///< time of the nodal values
  Field x;       ///< N x 3
  Field v;       ///< N x 3: velocity of the nodes
  Field u;       ///< N x m
  Field Mu;      ///< N x m: M(x) u, so that no old matrix is needed

  /// Names of the fields, for checkpoints and messages (History).
  static constexpr NamedField<ReactionDiffusionState> fields[] = {{"x", &ReactionDiffusionState::x},
                                                                  {"v", &ReactionDiffusionState::v},
                                                                  {"u", &ReactionDiffusionState::u},
                                                                  {"Mu", &ReactionDiffusionState::Mu}};
};

/// Species u_1, .., u_m on a surface at rest or with a given motion v of its material points, which are the
/// nodes (Dziuk & Elliott, IMA J. Numer. Anal. 27, 2007, with f linearly implicit):
///   d•u_l + u_l div v - D_l Lap u_l = f_l(u, x, t),
///   (delta_0/tau M(t_n) + D_l A(t_n)) u_l^n = f_l(u~) - 1/tau sum_{j>=1} delta_j M(t_{n-j}) u_l^{n-j}.
class ReactionDiffusion {
 public:
  /// The type of the states.
  using State = ReactionDiffusionState;

  /// x: positions of the nodes at a time; v: their velocities, none: at rest. The space must outlive the
  /// flow. Throws InputError when one of the diffusion coefficients, one for each species, is negative.
  ReactionDiffusion(const SurfaceSpace& space, PointwiseKinetics kinetics,
                    const std::vector<double>& diffusion, NodalMotion x, Velocity v,
                    const RegularityLimits& limits = {});

  /// One step with BDF of order q: fills all fields of next. Throws SingularityError where elements have
  /// degenerated, or u is beyond limits.field_size or not finite.
  void step(const BdfStep<State>& step, State& next);

  /// The state with given u at a time, whose nodes and velocities are those of the motion.
  State state(double t, Field u);

 private:
  void move(double t, State& state);

  const SurfaceSpace& space_;
  PointwiseKinetics kinetics_;
  SpeciesDiffusion diffusion_;
  NodalMotion x_;
  Velocity v_;
  RegularityLimits limits_;
  SymmetricMatrix M_, A_;
  SpdSolver spd_;
  Field u_tilde_, Mu_sum_, loads_;
};

/// The flow's own nodal fields beside x: v, and u or, for several species, u1, u2, ...
NodalFields nodal_fields(const ReactionDiffusionState& state);

}  // namespace esfem
