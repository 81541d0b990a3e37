// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/mean_curvature_flow.hpp"

namespace esfem {

/// V(H) = H^k for k > 0, -H^k for k < 0, on surfaces with H > 0: increasing, so that the flow is parabolic.
/// k = 1 is mean curvature flow, k = -1 the inverse flow, V = -1/H.
class PowerLaw {
 public:
  /// Throws InputError unless k is finite and not 0.
  explicit PowerLaw(double power);

  /// k.
  double power() const { return power_; }
  /// V(H) for H > 0; for k = 1 for every H.
  double V(double H) const;
  /// The H with this V(H); of no meaning where `has` is false.
  double H(double V) const;
  /// Whether V is the value of some H > 0.
  bool has(double V) const { return power_ == 1 || (power_ > 0 ? V > 0 : V < 0); }
  /// 1/V'(H) as a function of V; of no meaning where `has` is false.
  double weight(double V) const;

 private:
  double power_;
};

/// Generalised mean curvature flow v = -V(H) nu (Binz, Kovács, IMA J. Numer. Anal. 42, 2022) by evolution
/// equations for nu and V, linearly implicit BDF, in the manner of kll19 (5.1).
///
/// d•nu = grad V = V'(H) grad H and grad H = Lap nu + |A|² nu; d•H = Lap V + |A|² V and d•V = V'(H) d•H. So
///   w d•nu = Lap nu + |A|² nu,   w d•V = Lap V + |A|² V,   w = 1/V'(H),
/// and w is a function of V. A step has the weighted mass matrix D(x~)_ij = int w(V~_h) phi_i phi_j in the
/// place of M(x~), which for V = H gives (5.1). With the velocity of minimal deformation rate the right-hand
/// sides are + w (v . grad) nu and + w v . grad V (MovingCurvatureLoad).
///
/// Unknown nodal vectors: positions x, velocity v = -V nu, and u = (nu, V).
class GeneralisedMeanCurvatureFlow {
 public:
  /// How v is taken from V nu.
  using Velocity = MeanCurvatureFlow::Variant::Velocity;
  /// Tangential motion of the nodes.
  using Tangential = MeanCurvatureFlow::Variant::Tangential;

  /// What a step starts from and computes.
  struct State {
    double t = 0;  ///< time of the nodal values
    Field x;       ///< N x 3
    Field v;       ///< N x 3
    Field u;       ///< N x 4: nu_1, nu_2, nu_3, V

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"u", &State::u}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  GeneralisedMeanCurvatureFlow(const SurfaceSpace& space, PowerLaw law,
                               Velocity velocity = MeanCurvatureFlow::Variant::ritz,
                               const RegularityLimits& limits = {},
                               Tangential tangential = MeanCurvatureFlow::Variant::none);

  /// One step of BDF: fills next.x, next.v and next.u. Throws SingularityError where V has left the range of
  /// the law, and where the surface is singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

  /// What tangential motion keeps from step to step, for checkpoints; null without.
  nlohmann::json progress() const { return deformation_ ? deformation_->progress() : nullptr; }
  /// Restores what progress() of an earlier run has returned.
  void resume(const nlohmann::json& saved) {
    if (deformation_) deformation_->resume(saved);
  }

 private:
  void assemble_weighted_mass();
  void velocity_and_load(Field& v);

  const SurfaceSpace& space_;
  PowerLaw law_;
  Velocity velocity_;
  RegularityLimits limits_;
  double mass_factor_;  ///< 1/L²
  SymmetricMatrix M_, A_, D_;
  SpdSolver spd_;
  std::unique_ptr<MinimalDeformation> deformation_;  ///< none without tangential motion
  Field x_tilde_, u_tilde_, loads_, u_v_, f_, sum_, D_sum_, H_;
};

/// The state with given positions, normals (N x 3) and mean curvatures (N x 1), v = -V nu in the nodes;
/// t = 0. Throws InputError with the node (from 1) where H is not positive, unless V = H.
GeneralisedMeanCurvatureFlow::State generalised_mean_curvature_state(const PowerLaw& law, Field x,
                                                                     const Field& nu, const Field& H);

/// The flow's own nodal fields beside x: v, nu, V.
NodalFields nodal_fields(const GeneralisedMeanCurvatureFlow::State& state);

}  // namespace esfem
