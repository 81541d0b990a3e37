// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <utility>

#include "solver/flows/cahn_hilliard.hpp"
#include "solver/linalg/symmetric_block_solver.hpp"

namespace esfem {

/// A step of LinearisedCahnHilliard with its loads given: what does not depend on g.
class LinearisedCahnHilliardScheme {
 public:
  /// The type of the states.
  using State = CahnHilliardState;

  /// Throws InputError unless epsilon > 0, NumericsError when the symbolic analysis fails.
  LinearisedCahnHilliardScheme(const SurfaceSpace& space, NodalMotion motion, double epsilon);

  /// next.x at next.t, M and A there, and next.u = u~, extrapolated: where g is linearised first. Throws
  /// SingularityError where elements are degenerate.
  void prepare(const BdfStep<State>& step, State& next);

  /// After prepare: replaces next.u, where g is linearised, by the solution of the linear system, and finds
  /// next.w and next.Mu. load: N x 1, that of g(next.u); W: mass matrix weighted by g'(next.u).
  void advance(const BdfStep<State>& step, const Field& load, const SymmetricMatrix& W, State& next);

 private:
  const SurfaceSpace& space_;
  NodalMotion motion_;
  double epsilon_;
  SymmetricMatrix M_, A_;
  SymmetricMatrix kappa_M_, B_;  ///< kappa² = delta_0/(tau epsilon), B = -(A + W/epsilon²)
  SymmetricBlockSolver block_;
  Field Mu_sum_, Wu_;
};

/// Cahn-Hilliard equation on a surface that moves with a given velocity, without sources, for steps of any
/// size:
///   d•u + u div v - Lap w = 0,   w + epsilon Lap u = g(u)/epsilon.
/// CahnHilliard evaluates g(u~), which limits its step size. Around a constant state backward Euler
/// multiplies a mode with -Lap phi = lambda phi by
///   (1 - tau lambda g'/epsilon) / (1 + tau epsilon lambda²),
/// which for g' > 0 is below -1 for some lambda when tau > 8 epsilon³/g'²; BDF2, whose u~ triples the
/// numerator at the root -1, bounds it by 16/9 epsilon³/g'². Here g is linearised around u~,
///   g(u~) + g'(u~) (u - u~):
/// this differs from g(u) by O((u - u~)²) = O(tau^(2q)), and damps every mode with epsilon² lambda + g' > 0,
/// whatever the step size. The system of a step,
///   delta_0/tau M u + A w = - 1/tau sum_{j>=1} delta_j M(t_{n-j}) u^{n-j},
///   -(epsilon A + W/epsilon) u + M w = (load of g(u~) - W u~)/epsilon,    W = int g'(u~) phi_i phi_j,
/// is symmetric for the unknowns kappa epsilon u and w, kappa² = delta_0/(tau epsilon), when the second line
/// is multiplied by kappa, but W keeps it from having the complex form of bk22 (8.3).
///
/// A Problem says what g is:
///   struct Problem {
///     Pack g(double t, const PointData<1>& p) const;
///     Pack dg(double t, const PointData<1>& p) const;   // its derivative with respect to u
///   };
template <class Problem>
class LinearisedCahnHilliard {
 public:
  /// The type of the states.
  using State = CahnHilliardState;

  /// The space gives elements, degree and quadrature; it must outlive the flow. newton_tolerance: g is
  /// linearised again around the u just computed until no node's u changes by more than this, which makes the
  /// step fully implicit; infinite: once. Throws InputError unless it and epsilon are positive.
  LinearisedCahnHilliard(const SurfaceSpace& space, Problem problem, NodalMotion motion, double epsilon,
                         double newton_tolerance = std::numeric_limits<double>::infinity())
      : space_(space),
        problem_(std::move(problem)),
        scheme_(space, std::move(motion), epsilon),
        newton_tolerance_(newton_tolerance),
        W_(space.matrix()) {
    if (!(newton_tolerance > 0))
      throw InputError(
          format("tolerance of Newton's method: found %g, expected a positive number", newton_tolerance));
  }

  /// One step with BDF of order q: fills all fields of next. Throws SingularityError where elements have
  /// degenerated, NumericsError when Newton's method does not converge.
  void step(const BdfStep<State>& step, State& next) {
    scheme_.prepare(step, next);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      before_ = next.u;
      linearise(next);
      scheme_.advance(step, load_, W_, next);
      if (!((next.u - before_).cwiseAbs().maxCoeff() > newton_tolerance_)) return;
    }
    throw NumericsError(format("Newton's method has not converged in %d iterations", most_iterations));
  }

 private:
  static constexpr int most_iterations = 20;

  void linearise(const State& at) {
    space_.assemble_load<1, 1, 0>(
        at.x, at.u,
        [&](const PointData<1>& p, Integrand<1, 0>& load) { load.value[0] = problem_.g(at.t, p); }, load_);
    space_.assemble_weighted_mass<1>(
        at.x, at.u, [&](const PointData<1>& p) { return problem_.dg(at.t, p); }, W_);
  }

  const SurfaceSpace& space_;
  Problem problem_;
  LinearisedCahnHilliardScheme scheme_;
  double newton_tolerance_;
  SymmetricMatrix W_;
  Field load_, before_;
};

}  // namespace esfem
