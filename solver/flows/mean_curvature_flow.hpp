// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/minimal_deformation.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/geometry/reinitialisation.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Mean curvature flow by evolution equations for normal and mean curvature: kll19 (5.1), linearly implicit
/// BDF.
///
/// Unknown nodal vectors: positions x, velocity v = -H nu, and u = (nu, H).
class MeanCurvatureFlow {
 public:
  /// What of the scheme is a choice; the default is that of kll19.
  struct Variant {
    /// ritz: v_h is the Ritz projection (3.1a) of -H_h nu_h, with K = M/L² + A, L the length of the space, so
    /// that it does not depend on units (the papers have L = 1); interpolation: its nodal interpolation
    /// (kll21 Remark 3.1).
    enum Velocity { ritz, interpolation } velocity = ritz;  ///< how v_h is found, without tangential motion
    bool normalise = false;  ///< rescale nu_h to unit length at every node after each step (§13.2)
    double stabilise = 0;    ///< alpha >= 0 of the term -alpha int (nu_h - nu_Gamma_h) . phi of §14; 1/time

    /// Tolerance of nu and H, see Reinitialisation; 0: they are never taken from the surface. Otherwise v
    /// belongs to the new u, not to the extrapolated one.
    double reinitialise = 0;
    /// minimal_deformation: v_h is the velocity of MinimalDeformation, of normal speed -H_h, instead of that
    /// of `velocity`; the derivatives of nu and H along it have a convective term (MovingCurvatureLoad).
    enum Tangential { none, minimal_deformation } tangential = none;  ///< none: nodes move along normals
  };

  /// What a step starts from and computes.
  struct State {
    double t = 0;  ///< time of the nodal values
    Field x;       ///< N x 3
    Field v;       ///< N x 3
    Field u;       ///< N x 4: nu_1, nu_2, nu_3, H

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"u", &State::u}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  MeanCurvatureFlow(const SurfaceSpace& space, Variant variant, const RegularityLimits& limits = {});

  /// One step of (5.1) with BDF of order q: fills next.x, next.v and next.u. Throws SingularityError where
  /// the surface is singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

  /// Takes nu and H from the surface when they differ from it by more than the variant's tolerance.
  void reinitialise(State& state) { reinitialisation_.apply(state); }
  /// The same for a new state and, then, those of its history; the time loop calls it after each step.
  void settle(History<State>& past, State& next) { reinitialisation_.apply(past, next); }

  /// What tangential motion keeps from step to step, for checkpoints; null without.
  nlohmann::json progress() const { return deformation_ ? deformation_->progress() : nullptr; }
  /// Restores what progress() of an earlier run has returned.
  void resume(const nlohmann::json& saved) {
    if (deformation_) deformation_->resume(saved);
  }

 private:
  /// How Reinitialisation sees u.
  struct Fields {
    static auto nu(State& state) { return state.u.leftCols(3); }
    static auto H(State& state) { return state.u.col(3); }
    void complete(State& state) const;
  };

  void assemble_loads(const Field& u);
  void assemble_load_along(const Field& v);
  void velocity(const Field& u, Field& v);

  const SurfaceSpace& space_;
  Variant variant_;
  RegularityLimits limits_;
  double mass_factor_;  ///< 1/L²
  SymmetricMatrix M_, A_;
  SpdSolver spd_;
  std::unique_ptr<MinimalDeformation> deformation_;  ///< none without tangential motion
  Reinitialisation<State, Fields> reinitialisation_;
  Field x_tilde_, u_tilde_, loads_, u_v_, f_, sum_, M_sum_;
};

/// The state with given positions, normals (N x 3) and mean curvatures (N x 1), and v = -H nu in the nodes.
MeanCurvatureFlow::State mean_curvature_state(double t, Field x, const Field& nu, const Field& H);

/// The state whose nodal values are the normals and mean curvatures of a surface that its nodes x lie on;
/// t = 0.
MeanCurvatureFlow::State mean_curvature_state_on(const Surface& surface, const Field& x);

/// A state for a surface of which only the nodes x are known; t = 0. nu is the L2 projection of the normals
/// of Gamma_h[x], rescaled to unit length in the nodes, and H the L2 projection of the divergence of this nu.
MeanCurvatureFlow::State discrete_mean_curvature_state(const SurfaceSpace& space, const Field& x);

/// The flow's own nodal fields beside x: v, nu, H.
NodalFields nodal_fields(const MeanCurvatureFlow::State& state);

}  // namespace esfem
