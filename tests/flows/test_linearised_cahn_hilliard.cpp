// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/error.hpp"
#include "solver/flows/linearised_cahn_hilliard.hpp"
#include "solver/time/integrate.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_linearised_cahn_hilliard {
namespace {

using State = CahnHilliardState;

const double epsilon = 0.2, once = std::numeric_limits<double>::infinity();

/// g = u³ - u with g', which a factor other than 1 falsifies.
struct Well : DoubleWell {
  double factor = 1;
  Pack dg(double, const PointData<1>& p) const { return factor * (3.0 * p.u[0] * p.u[0] - 1.0); }
};

Well well(double factor) {
  Well well;
  well.factor = factor;
  return well;
}

/// A sphere at rest, or one that shrinks and grows, with waves on it.
struct Waves {
  Mesh mesh = sphere_mesh(1, 1, 2);
  SurfaceSpace space{mesh};
  Field x;
  bool moving = false;
  State start;

  explicit Waves(double amplitude = 0.5) {
    const Field u =
        amplitude * ((4 * mesh.nodes.col(0)).array().cos() * (3 * mesh.nodes.col(2)).array().sin());
    start = cahn_hilliard_start(space, DoubleWell(), epsilon, 0, mesh.nodes, u);
  }

  NodalMotion motion() {
    return [this](double t) -> const Field& {
      x = (moving ? 1 + 0.2 * std::sin(2 * t) : 1.0) * mesh.nodes;
      return x;
    };
  }

  LinearisedCahnHilliard<Well> linearised(double factor = 1, double newton_tolerance = once) {
    return {space, well(factor), motion(), epsilon, newton_tolerance};
  }
  CahnHilliard<DoubleWell> extrapolated() { return {space, DoubleWell(), motion(), epsilon}; }

  /// u after a run to t = 0.1; 8 substeps replace each starting step.
  template <class Flow>
  Field end(Flow flow, int q, int steps) {
    return last_state(flow, {q, 0.1 / steps, steps, parse_start("substeps:8")}, start).u;
  }

  template <class Flow>
  double order_in_time(const Flow& make, int q, const Field& fine) {
    return order((end(make(), q, 64) - fine).norm(), (end(make(), q, 128) - fine).norm());
  }
};

TEST(LinearisedCahnHilliard, HasTheOrderOfTheBdf) {
  Waves waves;
  const auto make = [&] { return waves.linearised(); };
  const Field fine = waves.end(make(), 3, 1024);
  EXPECT_NEAR(waves.order_in_time(make, 1, fine), 1, 0.15);
  EXPECT_NEAR(waves.order_in_time(make, 2, fine), 2, 0.25);
}

TEST(LinearisedCahnHilliard, TendsToTheSolutionOfTheSchemeWithExtrapolation) {
  for (const bool moving : {false, true}) {
    Waves waves;
    waves.moving = moving;
    const auto distance = [&](int steps) {
      return (waves.end(waves.linearised(), 2, steps) - waves.end(waves.extrapolated(), 2, steps)).norm() /
             waves.start.u.norm();
    };
    const double coarse = distance(128), fine = distance(256);
    EXPECT_LT(fine, 2e-3);
    EXPECT_GT(order(coarse, fine), 1.7);
  }
}

TEST(LinearisedCahnHilliard, WithoutTheDerivativeItIsTheSchemeWithExtrapolation) {
  Waves waves;
  waves.moving = true;
  const Field expected = waves.end(waves.extrapolated(), 2, 64);
  EXPECT_LT((waves.end(waves.linearised(0), 2, 64) - expected).norm(), 1e-11 * expected.norm());
  EXPECT_GT((waves.end(waves.linearised(), 2, 64) - expected).norm(), 1e-4 * expected.norm());
}

// With backward Euler one linearisation leaves O(tau²) of g; with a wrong derivative O(tau).
TEST(LinearisedCahnHilliard, IsNearerToTheImplicitSchemeByItsDerivative) {
  Waves waves;
  const auto order_of_distance = [&](double factor) {
    const auto distance = [&](int steps) {
      return (waves.end(waves.linearised(factor), 1, steps) - waves.end(waves.linearised(1, 1e-12), 1, steps))
          .norm();
    };
    return order(distance(64), distance(128));
  };
  EXPECT_GT(order_of_distance(1), 1.7);
  EXPECT_LT(order_of_distance(0.5), 1.3);
}

TEST(LinearisedCahnHilliard, TakesStepsThatExtrapolationDoesNot) {
  Waves waves;
  const UniformSteps grid{2, 0.05, 100, parse_start("substeps:64")};
  LinearisedCahnHilliard linearised = waves.linearised();
  const State end = last_state(linearised, grid, waves.start);
  EXPECT_LT(end.u.cwiseAbs().maxCoeff(), 1.1);
  EXPECT_NEAR(end.Mu.sum(), waves.start.Mu.sum(), 1e-11);
  EXPECT_LT(ginzburg_landau_energy(waves.space, end.x, end.u, epsilon),
            0.7 * ginzburg_landau_energy(waves.space, waves.start.x, waves.start.u, epsilon));
  // 16/9 epsilon³/g'² = 0.0036 for g' = 2.
  double largest = 0;
  CahnHilliard extrapolated = waves.extrapolated();
  try {
    integrate(extrapolated, grid, waves.start,
              [&](int, const State& state) { largest = std::max(largest, state.u.cwiseAbs().maxCoeff()); });
  } catch (const NumericsError&) {
    largest = once;
  }
  EXPECT_GT(largest, 10);
}

TEST(LinearisedCahnHilliard, LosesEnergyWithAdaptiveSteps) {
  Waves waves;
  const auto largest_rise = [&](double factor) {
    double before = once, rise = -once;
    std::vector<double> mass;
    LinearisedCahnHilliard flow = waves.linearised(factor);
    const StepCount run =
        integrate(flow, AdaptiveSteps{"u", 2, 5, 1e-3, 1e-4, 0}, waves.start, [&](int, const State& state) {
          const double energy = ginzburg_landau_energy(waves.space, state.x, state.u, epsilon);
          rise = std::max(rise, energy - before);
          before = energy;
          mass.push_back(state.Mu.sum());
        });
    EXPECT_NEAR(mass.back(), mass.front(), 1e-11);
    return std::pair(rise, run.steps);
  };
  const auto [rise, steps] = largest_rise(1);
  EXPECT_LT(rise, 1e-5);
  const auto [broken_rise, broken_steps] = largest_rise(0);
  EXPECT_GT(broken_steps, 2 * steps) << "without g' the control finds small steps only";
}

TEST(LinearisedCahnHilliard, SaysWhatItDoesNotTake) {
  Waves waves;
  const auto make = [&](double eps, double tolerance) {
    return LinearisedCahnHilliard<Well>(waves.space, Well(), waves.motion(), eps, tolerance);
  };
  EXPECT_THAT([&] { make(0, once); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("epsilon: found 0")));
  EXPECT_THAT([&] { make(1, 0); }, testing::ThrowsMessage<InputError>(
                                       testing::HasSubstr("tolerance of Newton's method: found 0")));
  EXPECT_THAT([&] { waves.end(waves.linearised(0, 1e-9), 1, 1); },
              testing::ThrowsMessage<NumericsError>(testing::HasSubstr("has not converged in 20")));
}

}  // namespace
}  // namespace esfem::test_linearised_cahn_hilliard
