// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/area_and_volume.hpp"
#include "solver/flows/lagged_block_solver.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_law.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/geometry/reinitialisation.hpp"
#include "solver/nodal_field.hpp"
#include "solver/surfaces/surface.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Willmore flow and surface diffusion by evolution equations for mean curvature and normal: kll21
/// (3.4)-(3.5), linearly implicit BDF.
///
/// Unknown nodal vectors: positions x, velocity v = V nu, u = (H, nu) and w = (V, z), where V is the normal
/// velocity, Delta H + Q, and z = Delta nu + |A|² nu, which is grad H on a smooth surface.
///
/// Where area or volume are prescribed Q has the part -lambda_A H - lambda_V. It is linear in the multipliers
/// lambda, and so are u and w of a step: lambda = lambda~ + mu, lambda~ extrapolated, and u = u_0 + sum mu_i
/// u_i, with the right-hand sides of u_0 and of each u_i solved together. Then the positions depend on mu
/// alone, and Newton's method finds the mu with which area and volume are the prescribed ones.
class WillmoreFlow {
 public:
  /// What of the flow is a choice; the default is Willmore flow without constraints.
  struct Variant {
    WillmoreLaw law = willmore_law();  ///< Q without the multipliers' part
    AreaAndVolume prescribed = {};     ///< empty: neither

    /// How F(x, u) w of (3.5a) is taken: extrapolated, F(x~, u~) w~; implicit, F(x~, u~) w^n, which on the
    /// Clifford torus is unstable for step sizes from 0.02 to 0.1.
    enum Coupling { extrapolated, implicit } F = extrapolated;  ///< how F w is taken

    /// nu_h to unit length and z_h to the plane normal to it, in the nodes. after_steps is the paper's way
    /// (§7.1), which loses the order in time: the implicit terms are those of the nu_h that was solved for,
    /// and the larger part of what the projection takes away comes back in each step, whatever its size. With
    /// in_coefficients only nu~ and z~ are projected, of which f, g and F are made; nu_h and z_h stay what
    /// the scheme gives, and all orders are kept. On a sphere of radius R, |nu_h| - 1 grows like exp(8t/R⁴)
    /// with none, and decays like exp(-4t/R⁴) with in_coefficients.
    enum Projection { none, in_coefficients, after_steps } projection = after_steps;  ///< of nu and z

    /// lambda >= 0: adds lambda int (n - nu_h) . phi to the equation of nu, n the normal of Gamma_h, and
    /// lambda int (div nu_h - H_h) phi + nu_h . grad phi to that of H. Not in the paper; zero for the exact
    /// solution. It prevents nu_h and H_h from drifting away from the surface. Unit 1/time. Explicit: lambda
    /// tau <= 0.5 is stable on surfaces that tend to a sphere of radius one, 0.2 on tori of that size.
    double relaxation = 0;
    /// Tolerance of nu and H, see Reinitialisation; 0: they are never taken from the surface.
    double reinitialise = 0;
    /// minimal_deformation: v is the velocity of MinimalDeformation with the normal speed V~, and the
    /// equation of u has a convective term: normal motion has M d°u = A w + .., and along v the derivative is
    /// d•u = d°u + (v . grad) u. (3.5b) has no time derivative: V and z are those of the surface and u at
    /// each time, however the nodes move.
    MeanCurvatureFlow::Variant::Tangential tangential = MeanCurvatureFlow::Variant::none;
  };

  /// What a step starts from and computes.
  struct State {
    double t = 0;                      ///< time of the nodal values
    Field x;                           ///< N x 3
    Field v;                           ///< N x 3
    Field u;                           ///< N x 4: H, nu_1, nu_2, nu_3
    Field w;                           ///< N x 4: V, z_1, z_2, z_3
    Field lambda = Field::Zero(1, 2);  ///< multipliers of area and volume; 0 for what is not prescribed

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {
        {"x", &State::x}, {"v", &State::v}, {"u", &State::u}, {"w", &State::w}, {"lambda", &State::lambda}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow. theta (N x 4): the correction
  /// of (3.7), see willmore_theta; none when it is empty.
  WillmoreFlow(const SurfaceSpace& space, Variant variant, Field theta = {},
               const RegularityLimits& limits = {});
  ~WillmoreFlow();

  /// One step of (3.4)-(3.5) with BDF of order q: fills next.x, next.v, next.u and next.w. Throws
  /// SingularityError where the surface is singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

  /// Takes nu, H, V and z from the surface when nu and H differ from it by more than the variant's tolerance.
  void reinitialise(State& state) { reinitialisation_.apply(state); }
  /// The same for a new state and, then, those of its history; the time loop calls it after each step.
  void settle(History<State>& past, State& next) { reinitialisation_.apply(past, next); }

  /// The number of factorisations so far: with extrapolated F it is smaller than that of the steps, because
  /// one serves several of them (LaggedBlockSolver).
  int factorisations() const { return lagged_.factorisations(); }

  /// What the flow keeps from step to step, for checkpoints: resume(progress()) makes another flow continue
  /// with the same bits.
  nlohmann::json progress() const;
  /// Restores what progress() of an earlier run has returned.
  void resume(const nlohmann::json& saved);

 private:
  struct ImplicitCoupling;
  void move_along_surface(Field& v);
  void extrapolate(const BdfStep<State>& step);
  void assemble_loads(const BdfStep<State>& step);
  void solve_systems(const BdfStep<State>& step);
  void advance(const BdfStep<State>& step, State& next) const;
  void rates_of_x(const BdfStep<State>& step, const State& next);

  /// How Reinitialisation sees u; w comes from (3.5b).
  struct Fields {
    const SurfaceSpace& space;
    const Multipliers& multipliers;
    WillmoreLaw law;
    static auto nu(State& state) { return state.u.rightCols(3); }
    static auto H(State& state) { return state.u.col(0); }
    void complete(State& state) const;
  };

  const SurfaceSpace& space_;
  Variant variant_;
  RegularityLimits limits_;
  Field theta_;
  SymmetricMatrix M_, A_;
  LaggedBlockSolver lagged_;
  std::unique_ptr<ImplicitCoupling> implicit_;
  Multipliers multipliers_;
  Reinitialisation<State, Fields> reinitialisation_;
  LaggedBlockSolver::Guess tilde_;  ///< u~ and w~, and 0 for u_i and w_i
  Field x_tilde_, u_tilde_, w_tilde_, lambda_tilde_, u_w_tilde_, loads_, x_sum_, u_sum_, M_sum_;
  Field u_, w_;  ///< u_0, u_1, .. and w_0, w_1, .., side by side
  std::array<Field, 2> x_rates_;
  std::unique_ptr<MinimalDeformation> deformation_;  ///< none without tangential motion
  Field nu_V_, u_v_, convection_;
};

/// Start of a run. V has the multipliers with which it leaves the prescribed ones of area and volume as they
/// are; they must be at rest at t = 0.
struct WillmoreStart {
  WillmoreFlow::State state;  ///< t = 0
  Field theta;                ///< N x 4: what WillmoreFlow takes; empty without the correction
};

/// Starting values of a surface that its nodes x lie on: H, nu and, with_theta, V and z of the surface
/// (derivatives by autodiff) with the theta (3.6) that belongs to them; otherwise V and z from (3.5b).
WillmoreStart willmore_start_on(const SurfaceSpace& space, const Surface& surface, const Field& x,
                                const WillmoreLaw& law, bool with_theta,
                                const AreaAndVolume& prescribed = {});

/// Starting values with given nodes x, u = (H, nu) and w = (V, z); without w (no rows) it is that of (3.5b).
/// theta is empty.
WillmoreStart willmore_start_from(const SurfaceSpace& space, const Field& x, Field u, Field w,
                                  const WillmoreLaw& law, const AreaAndVolume& prescribed = {});

/// Starting values of a surface of which only the nodes x are known: nu and H as those of mean curvature flow
/// (discrete_mean_curvature_state), V and z from (3.5b).
WillmoreStart discrete_willmore_start(const SurfaceSpace& space, const Field& x, const WillmoreLaw& law,
                                      const AreaAndVolume& prescribed = {});

/// The flow's own nodal fields beside x: v, nu, H, V, z.
NodalFields nodal_fields(const WillmoreFlow::State& state);

}  // namespace esfem
