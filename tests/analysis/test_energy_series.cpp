// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "solver/analysis/energy_series.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_energy_series {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

/// f at 0, tau, .., steps tau.
template <class Function>
Series sampled(double tau, int steps, Function f) {
  Series series;
  for (int n = 0; n <= steps; ++n) {
    series["t"].push_back(n * tau);
    series["f"].push_back(f(n * tau));
  }
  return series;
}

TEST(EnergySeries, OfTheConstantOne) {
  const Mesh mesh = icosphere(2, 2);
  const SurfaceSpace space(mesh);
  const Field one = Field::Ones(mesh.nodes.rows(), 1);
  Series series;
  record_energy(space, cahn_hilliard_state(space, 0.5, mesh.nodes, one, one), 0.1, series);
  record_energy(space, cahn_hilliard_state(space, 1, mesh.nodes, 0 * one, one), 0.1, series);
  const double area = space.area(mesh.nodes);
  EXPECT_THAT(series.at("t"), ElementsAre(0.5, 1));
  EXPECT_NEAR(series.at("energy")[0], 0, 1e-12) << "no gradient, and in a well";
  EXPECT_NEAR(series.at("energy")[1], area / (4 * 0.1), 1e-10) << "on top of the hill";
  EXPECT_NEAR(series.at("mass")[0], area, 1e-11);
  EXPECT_EQ(series.at("min_u")[0], 1);
  EXPECT_EQ(series.at("max_u")[1], 0);
}

TEST(EnergySeries, ThinnedKeepsFirstAndLast) {
  const Series series = sampled(1, 10, [](double t) { return t; });
  EXPECT_EQ(thinned(series, 11), series);
  EXPECT_THAT(thinned(series, 4).at("f"), ElementsAre(0, 3, 6, 9, 10));
  EXPECT_THAT(thinned(series, 5).at("t"), ElementsAre(0, 3, 6, 9, 10));
  EXPECT_THAT(thinned(series, 6).at("t"), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(thinned(series, 1).at("t"), ElementsAre(0, 10));
}

TEST(EnergySeries, ExtremaAreThoseOfTheTimesAsked) {
  const Series series = sampled(0.01, 100, [](double t) { return std::sin(2 * pi * t); });
  EXPECT_EQ(nearest(series, 0.254), 25u);
  EXPECT_EQ(nearest(series, 7), 100u);
  EXPECT_EQ(largest_in(series, "f", 0, 1), 25u);
  EXPECT_EQ(largest_in(series, "f", 0, 0.105), 10u);
  EXPECT_EQ(smallest_in(series, "f", 0.1, 1), 75u);
  EXPECT_THROW(largest_in(series, "f", 1.5, 2), InputError);
  EXPECT_THROW(nearest({{"t", {}}}, 0), InputError);
}

/// A quantity with overtones whose second half of a period resembles the first one.
double wave(double t) {
  return std::cos(2 * pi * t / 0.2) + 3 * std::cos(4 * pi * t / 0.2 + 1);
}

TEST(EnergySeries, FindThePeriodBetweenTwoSteps) {
  const auto measured = [](double length) {
    const Series series = sampled(1e-3, 1000, [=](double t) { return wave(t * 0.2 / length); });
    return period(series, "f", 0.4, 0.11, 0.29);
  };
  EXPECT_NEAR(measured(0.2), 0.2, 1e-5);
  EXPECT_NEAR(measured(0.2003), 0.2003, 1e-5);
  EXPECT_NEAR(measured(0.187), 0.187, 1e-5);
  const Series series = sampled(1e-3, 600, wave);
  EXPECT_THROW(period(series, "f", 0.4, 0.1, 0.3), InputError) << "nothing is left to compare";
}

TEST(EnergySeries, SayHowPeriodicAQuantityIs) {
  const auto drifting = [](double drift) {
    return sampled(1e-3, 1000, [=](double t) { return std::cos(2 * pi * t / 0.2) + drift * t; });
  };
  EXPECT_LT(aperiodicity(drifting(0), "f", 0.2), 1e-12);
  EXPECT_NEAR(aperiodicity(drifting(0.1), "f", 0.2), 0.2 * 0.1 / 2, 1e-4);
  EXPECT_GT(aperiodicity(drifting(0), "f", 0.19), 0.1);
  EXPECT_THROW(aperiodicity(drifting(0), "f", 0.6), InputError);
}

struct Stopped : std::exception {};

/// The energy on a moving ellipsoid, stopped after step `stop` and taken up again.
struct ResumedEnergy : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_energy_" + std::to_string(getpid()));
  Mesh mesh = icosphere(1, 2);
  SurfaceSpace space{mesh};

  ~ResumedEnergy() override { fs::remove_all(folder); }

  struct Outcome {
    Series series;
    int observed = 0;
  };

  Outcome run(int stop) const {
    const double tau = 1e-3, epsilon = 0.1;
    const EvolvingEllipsoid moving{0.25, 0.2, 1};
    MovingNodes nodes(moving.velocity(), mesh.nodes, tau);
    const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
    CahnHilliard flow(space, DoubleWell(), motion, epsilon);
    const Field u = 0.1 * (6 * mesh.nodes.array()).cos().rowwise().prod().matrix();
    const CahnHilliardState start = cahn_hilliard_state(space, 0, mesh.nodes, u, 0 * u);
    Outcome outcome;
    Checkpoint checkpoint((folder / "checkpoint").string(), {{"run", "of a test"}}, 0);
    attach(checkpoint, outcome.series);
    const auto observe = [&](int n, const CahnHilliardState& state) {
      record_energy(space, state, epsilon, outcome.series);
      ++outcome.observed;
      if (n == stop) throw Stopped();
    };
    try {
      integrate(flow, {2, tau, 30, {Start::cascade, 1}}, start, &checkpoint, observe);
    } catch (const Stopped&) {
    }
    return outcome;
  }
};

TEST_F(ResumedEnergy, EqualsThatOfARunThatWasNotStopped) {
  const Outcome whole = run(-1);
  EXPECT_EQ(whole.observed, 31);
  fs::remove(folder / "checkpoint");
  run(17);
  EXPECT_EQ(run(24).observed, 8) << "it continues after step 16, the last one that was saved";
  const Outcome resumed = run(-1);
  EXPECT_EQ(resumed.observed, 7);
  EXPECT_EQ(resumed.series, whole.series) << "to the last bit";
}

}  // namespace
}  // namespace esfem::test_energy_series
