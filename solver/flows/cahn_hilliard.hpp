// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "solver/assembly/surface_space.hpp"
#include "solver/geometry/prescribed_motion.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/linalg/block_solver.hpp"
#include "solver/linalg/symmetric_block_solver.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/checkpoint.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// What a step starts from and computes.
struct CahnHilliardState {
  double t = 0;  ///< time of the nodal values
  Field x;       ///< N x 3
  Field u;       ///< N x 1
  Field w;       ///< N x 1
  Field Mu;      ///< N x 1: M(x) u, so that no old matrix is needed

  /// Names of the fields, for checkpoints and messages (History).
  static constexpr NamedField<CahnHilliardState> fields[] = {{"x", &CahnHilliardState::x},
                                                             {"u", &CahnHilliardState::u},
                                                             {"w", &CahnHilliardState::w},
                                                             {"Mu", &CahnHilliardState::Mu}};
};

/// The mobility m of d•u + u div v - div(m grad w) = f + b; 1 when there is none of the functions.
struct Mobility {
  /// m(t) > 0, the same on the whole surface.
  std::function<double(double t)> in_time = {};
  /// m >= 0 in quadrature points; u is extrapolated.
  std::function<void(double t, const PointData<1>& p, Pack& m)> at_points = {};
};

/// A step of bk22 (8.3) with its loads given: what does not depend on f, g and b. As printed (8.3) lacks tau
/// before f, and the theta of (3.13); with epsilon it is
///   delta_0 M(t_n) u + tau A(t_n) w = tau (f + M(t_n) b) - sum_{j>=1} delta_j M(t_{n-j}) u^{n-j},
///   -epsilon A(t_n) u + M(t_n) w = g/epsilon + theta.
///
/// Nodes may move with another velocity than the material, v + W with a tangential W (bk22 §1: ALE). Then
/// d•u + u div v = d°u + u div(v + W) - div(u W), where d° is the derivative along the nodes, and f gets the
/// load - int u~ W . grad phi_j.
///
/// With a mobility A(t_n) w becomes A_m w, (A_m)_ij = int m(u~) grad phi_i . grad phi_j, which keeps the
/// order of BDF and conserves int u. For m(t) the system has the complex form of BlockSolver still. Else it
/// has not, since A_m is no multiple of A; but a/c times the second line and U = c u, a = delta_0/tau, make
/// it symmetric,
///   -(a epsilon/c²) A U + (a/c) M w = (a/c) (g/epsilon + theta),
///    (a/c) M U          +     A_m w = f + ..,
/// with two unknowns a node (SymmetricBlockSolver). c² = a epsilon/mean of m makes the diagonal blocks of one
/// size. The system is regular for every m >= 0, and A gives a good pivot even where m = 0, as U comes first.
class CahnHilliardScheme {
 public:
  /// The type of the states.
  using State = CahnHilliardState;

  /// theta (N x 1), see cahn_hilliard_theta; none when it is empty. tangential: W in the nodes; none: they
  /// are material points. limits: of |u|. Throws InputError unless epsilon > 0.
  CahnHilliardScheme(const SurfaceSpace& space, NodalMotion motion, double epsilon, Field theta,
                     Velocity tangential, Mobility mobility, const RegularityLimits& limits);

  /// next.x at next.t, M and A there, and the extrapolated u~. Throws SingularityError where elements are
  /// degenerate.
  void prepare(const BdfStep<State>& step, State& next);
  /// Of the last prepare, N x 1.
  const Field& u_tilde() const { return u_tilde_; }
  /// N x 1, or empty: none.
  const Field& theta() const { return theta_; }
  /// For a run that resumes.
  void set_theta(Field theta) { theta_ = std::move(theta); }

  /// After prepare: solves for u and w. loads: N x 2, f(u~) and g(u~); b: nodal values at next.t, N x 1
  /// (none: empty). Throws SingularityError where |u| is beyond its limit.
  void advance(const BdfStep<State>& step, const Field& loads, const Field& b, State& next);

 private:
  /// What the solvers of systems with A_m keep.
  struct VariableMobility {
    explicit VariableMobility(const SurfaceSpace& space);
    SymmetricMatrix A_m, P, Q;
    SymmetricBlockSolver block;
  };

  void add_advection(const State& at, Field& load_of_u);
  void solve(double a, State& next);
  void solve_with_variable_mobility(double a, State& next);

  const SurfaceSpace& space_;
  NodalMotion motion_;
  double epsilon_;
  Field theta_;
  Velocity tangential_;
  Mobility mobility_;
  RegularityLimits limits_;
  SymmetricMatrix M_, A_;
  std::optional<BlockSolver> block_;  ///< one of these
  std::optional<VariableMobility> variable_;
  Field u_tilde_, Mu_sum_, Mb_, W_, u_and_W_, advection_;
};

/// Cahn-Hilliard equation on a surface that moves with a given velocity, bk22 (9.1) with a general f:
///   d•u + u div v - div(m grad w) = f(u, grad u) + b,   w + epsilon Lap u = g(u, grad u)/epsilon,
/// linear in each step: f, g and the mobility m are evaluated with u~.
///
/// A Problem says what f, g and b are:
///   struct Problem {
///     Pack f(double t, const PointData<1>& p) const;
///     Pack g(double t, const PointData<1>& p) const;
///     void b(double t, const Field& x, Field& nodal) const;   // N x 1, or empty: none
///   };
template <class Problem>
class CahnHilliard {
 public:
  /// The type of the states.
  using State = CahnHilliardState;

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  CahnHilliard(const SurfaceSpace& space, Problem problem, NodalMotion motion, double epsilon,
               Field theta = {}, Velocity tangential = {}, Mobility mobility = {},
               const RegularityLimits& limits = {})
      : space_(space),
        problem_(std::move(problem)),
        scheme_(space, std::move(motion), epsilon, std::move(theta), std::move(tangential),
                std::move(mobility), limits) {}

  /// One step with BDF of order q: fills all fields of next. Throws SingularityError where elements have
  /// degenerated, or u has blown up.
  void step(const BdfStep<State>& step, State& next) {
    scheme_.prepare(step, next);
    const auto f_and_g = [&](const PointData<1>& p, Integrand<2, 0>& load) {
      load.value[0] = problem_.f(next.t, p);
      load.value[1] = problem_.g(next.t, p);
    };
    space_.assemble_load<1, 2, 0>(next.x, scheme_.u_tilde(), f_and_g, loads_);
    problem_.b(next.t, next.x, b_);
    scheme_.advance(step, loads_, b_, next);
  }

  /// For checkpoints: theta, which is that of the start.
  nlohmann::json progress() const {
    return scheme_.theta().size() > 0 ? packed(scheme_.theta()) : nlohmann::json();
  }
  /// Restores what progress() of an earlier run has returned.
  void resume(const nlohmann::json& saved) {
    if (!saved.is_null()) scheme_.set_theta(unpacked(saved));
  }

 private:
  const SurfaceSpace& space_;
  Problem problem_;
  CahnHilliardScheme scheme_;
  Field loads_, b_;
};

/// The state with given nodal values, and Mu = M(x) u.
CahnHilliardState cahn_hilliard_state(const SurfaceSpace& space, double t, Field x, Field u, Field w);

/// The load of a Problem's g for given nodes and u, N x 1: what the starting values below need.
template <class Problem>
Field load_of_g(const SurfaceSpace& space, const Problem& problem, double t, const Field& x, const Field& u) {
  const auto g = [&](const PointData<1>& p, Integrand<1, 0>& load) { load.value[0] = problem.g(t, p); };
  Field load;
  space.assemble_load<1, 1, 0>(x, u, g, load);
  return load;
}

/// theta = M w - epsilon A u - g/epsilon: what the second equation lacks for given u and w at the start (bk22
/// (3.13)).
Field cahn_hilliard_theta(const SurfaceSpace& space, const Field& x, const Field& u, const Field& w,
                          double epsilon, const Field& load_of_g);

/// The same for a start and the g of a Problem.
template <class Problem>
Field cahn_hilliard_theta(const SurfaceSpace& space, const Problem& problem, double epsilon,
                          const CahnHilliardState& start) {
  return cahn_hilliard_theta(space, start.x, start.u, start.w, epsilon,
                             load_of_g(space, problem, start.t, start.x, start.u));
}

/// w from the second equation for given u, without theta.
Field cahn_hilliard_w(const SurfaceSpace& space, const Field& x, const Field& u, double epsilon,
                      const Field& load_of_g);

/// The state with given u, and w from the second equation with a Problem's g, without theta.
template <class Problem>
CahnHilliardState cahn_hilliard_start(const SurfaceSpace& space, const Problem& problem, double epsilon,
                                      double t, const Field& x, const Field& u) {
  return cahn_hilliard_state(space, t, x, u,
                             cahn_hilliard_w(space, x, u, epsilon, load_of_g(space, problem, t, x, u)));
}

/// The double-well potential without f and b: g = F'(u) = u³ - u, F = (u² - 1)²/4.
struct DoubleWell {
  /// The functions of a Problem: f = 0, g, its derivative with respect to u, and no b.
  /// @{
  Pack f(double, const PointData<1>&) const { return Pack{}; }
  Pack g(double, const PointData<1>& p) const { return p.u[0] * (p.u[0] * p.u[0] - 1.0); }
  Pack dg(double, const PointData<1>& p) const { return 3.0 * p.u[0] * p.u[0] - 1.0; }
  void b(double, const Field&, Field&) const {}
  /// @}
};

/// Ginzburg-Landau energy, integral of epsilon/2 |grad u|² + F(u)/epsilon over Gamma_h[x] (bk22 (2.3) with
/// epsilon).
double ginzburg_landau_energy(const SurfaceSpace& space, const Field& x, const Field& u, double epsilon);

/// The flow's own nodal fields beside x: u, w.
NodalFields nodal_fields(const CahnHilliardState& state);

}  // namespace esfem
