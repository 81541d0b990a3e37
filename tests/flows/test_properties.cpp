// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every smooth closed surface: random ones, of all sizes, positions and rotations.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/coupled_diffusion.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/phase_separation.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/problems/disturbed_mixture.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_properties {
namespace {

double between(std::mt19937& engine, double low, double high) {
  return low + (high - low) * engine() / static_cast<double>(std::mt19937::max());
}

Mat3 random_rotation(std::mt19937& engine) {
  Eigen::Quaterniond q;
  for (double& coefficient : q.coeffs()) coefficient = between(engine, -1, 1);
  return q.normalized().toRotationMatrix();
}

/// A sphere with a random harmonic of each of the degrees 1, 2 and 3 on it: radius 0.7 to 1.3.
Mesh deformed_sphere(std::mt19937& engine, int degree) {
  const Vec3 first = 0.1 * random_rotation(engine).col(0);
  const Mat3 axes = random_rotation(engine);
  const double second = between(engine, -0.15, 0.15), third = between(engine, -0.15, 0.15);
  Mesh mesh = sphere_mesh(1, degree, 2);
  for (int j = 0; j < mesh.nodes.rows(); ++j) {
    const Vec3 direction = mesh.nodes.row(j), y = axes * direction;
    const double radius =
        1 + first.dot(direction) + second * (y[0] * y[0] - y[1] * y[1]) + third * 5 * y[0] * y[1] * y[2];
    mesh.nodes.row(j) *= radius;
  }
  return mesh;
}

/// A smooth closed surface in general position: `size` is that of the sphere or torus that it is made from.
struct RandomSurface {
  Mesh mesh;
  double size;

  explicit RandomSurface(unsigned seed, int degree = 2) {
    std::mt19937 engine(seed);
    const bool is_torus = seed % 4 == 3;
    mesh =
        is_torus ? torus_mesh(1, between(engine, 0.4, 0.6), degree, 16, 10) : deformed_sphere(engine, degree);
    size = std::pow(10, between(engine, -4, 4));
    Vec3 shift;
    for (double& coordinate : shift) coordinate = between(engine, -3, 3);
    mesh.nodes = size * (mesh.nodes * random_rotation(engine).transpose());
    mesh.nodes.rowwise() += size * shift.transpose();
  }

  double time(int power) const { return std::pow(size, power); }
};

class Surfaces : public testing::TestWithParam<unsigned> {
 protected:
  const RandomSurface surface{GetParam()};
  const SurfaceSpace space{surface.mesh};
  const Field& x = surface.mesh.nodes;

  UniformSteps grid(int order, double tau, int power, int steps = 4) const {
    return {order, tau * surface.time(power), steps, parse_start("cascade")};
  }

  /// A function of space with values of order 1.
  Field waves() const {
    const Field y = (x.rowwise() - x.colwise().mean()) / surface.size;
    return (2 * y.col(0)).array().cos() * (3 * y.col(1) + y.col(2)).array().sin();
  }

  /// Values of a quantity of the states of a run.
  template <class Flow, class Quantity>
  std::vector<double> series(Flow&& flow, const UniformSteps& grid,
                             const typename std::decay_t<Flow>::State& initial,
                             const Quantity& quantity) const {
    std::vector<double> values;
    integrate(flow, grid, initial, [&](int, const auto& state) { values.push_back(quantity(state)); });
    return values;
  }

  template <class Flow>
  void expect_area_falls(Flow&& flow, int order, const typename std::decay_t<Flow>::State& initial,
                         const char* name) const {
    const std::vector<double> area =
        series(flow, grid(order, 2e-3, 2), initial, [&](const auto& state) { return space.area(state.x); });
    for (std::size_t n = 1; n < area.size(); ++n) EXPECT_LT(area[n], (1 - 1e-3) * area[n - 1]) << name;
  }
};

INSTANTIATE_TEST_SUITE_P(Random, Surfaces, testing::Range(0u, 6u));

TEST_P(Surfaces, AreaFallsUnderMeanCurvatureFlow) {
  const MeanCurvatureFlow::State start = discrete_mean_curvature_state(space, x);
  MeanCurvatureFlow::Variant interpolation;
  interpolation.velocity = MeanCurvatureFlow::Variant::interpolation;
  expect_area_falls(MeanCurvatureFlow(space, {}), 2, start, "ritz");
  expect_area_falls(MeanCurvatureFlow(space, interpolation), 2, start, "interpolation");
  expect_area_falls(DziukFlow(space), 2, dziuk_state_on(space, x), "dziuk");
  expect_area_falls(BgnFlow(space), 1, bgn_state_on(space, x), "bgn");
}

TEST_P(Surfaces, SurfaceDiffusionKeepsTheVolumeAndLosesArea) {
  using Variant = WillmoreFlow::Variant;
  const auto relative_changes = [&](const WillmoreLaw& law) {
    Variant variant;
    variant.law = law;
    WillmoreFlow flow(space, variant);
    const Field end = last_state(flow, grid(2, 2e-4, 4), discrete_willmore_start(space, x, law).state).x;
    return std::pair(space.volume(end) / space.volume(x) - 1, space.area(end) / space.area(x) - 1);
  };
  const auto [volume, area] = relative_changes(surface_diffusion_law());
  EXPECT_LT(area, -1e-4);
  EXPECT_LT(std::abs(volume), -6e-3 * area);
  EXPECT_GT(std::abs(relative_changes(willmore_law()).first), -6e-3 * area)
      << "Willmore flow does not keep it";
}

/// Willmore energy of the flow's own H, and of the surface itself, which a coarse mesh finds higher after the
/// first step than of the interpolated surface.
TEST_P(Surfaces, WillmoreEnergyFalls) {
  DiscreteCurvature curvature(space);
  const auto square = [](const PointData<1>& p, Integrand<1, 0>& load) { load.value[0] = p.u[0] * p.u[0]; };
  Field load;
  std::vector<double> of_flow, of_surface;
  WillmoreFlow flow(space, {});
  integrate(flow, grid(2, 1e-4, 4), discrete_willmore_start(space, x, willmore_law()).state,
            [&](int, const WillmoreFlow::State& state) {
              space.assemble_load<1, 1, 0>(state.x, state.u.col(0), square, load);
              of_flow.push_back(load.sum() / 2);
              curvature.compute(state.x);
              of_surface.push_back(curvature.willmore_energy());
            });
  for (std::size_t n = 1; n < of_flow.size(); ++n) EXPECT_LT(of_flow[n], of_flow[n - 1]);
  for (std::size_t n = 2; n < of_surface.size(); ++n) EXPECT_LT(of_surface[n], of_surface[n - 1]);
}

TEST_P(Surfaces, SeparationOfPhasesKeepsTheMassAndLosesEnergy) {
  const double epsilon = 0.3 * surface.size;
  const CahnHilliardState start = disturbed_mixture(space, x, epsilon, 0.2, 0.5, GetParam());
  EXPECT_NEAR(start.Mu.sum() / space.area(x), 0.2, 1e-13);
  for (const double tau : {1e-3, 10.0}) {
    PhaseSeparation flow(space, x, epsilon);
    double before = INFINITY;
    integrate(flow, grid(2, tau, 3, 3), start, [&](int, const CahnHilliardState& state) {
      EXPECT_NEAR(state.Mu.sum(), start.Mu.sum(), 1e-10 * std::abs(start.Mu.sum()));
      const double energy = ginzburg_landau_energy(space, x, state.u, epsilon);
      EXPECT_LE(energy, (1 + 1e-6) * before) << tau;
      before = energy;
    });
  }
}

/// One species without reactions on a surface that it makes grow.
struct Growth {
  static constexpr int species = 1;
  double speed;
  void f(double, const PointData<1>&, Pack (&out)[1]) const { out[0] = Pack{}; }
  Pack g(double, const PointData<1>& p) const { return speed * p.u[0]; }
};

TEST_P(Surfaces, DiffusionWithoutReactionsKeepsTheMassOnAMovingSurface) {
  CoupledDiffusionParameters parameters;
  parameters.alpha = surface.time(2);
  const CoupledDiffusionState start =
      coupled_diffusion_state(space, 0, x, Field::Zero(x.rows(), 3), 1 + 0.5 * waves().array());
  const std::vector<double> mass =
      series(CoupledDiffusion(space, Growth{1 / surface.size}, parameters, {}), grid(2, 1e-2, 2), start,
             [&](const auto& state) { return state.Mu.sum(); });
  for (const double value : mass) EXPECT_NEAR(value / mass.front(), 1, 1e-12);
}

/// Largest difference of two fields, relative to the size of the first.
double difference(const Field& a, const Field& b) {
  return (a - b).cwiseAbs().maxCoeff() / a.cwiseAbs().maxCoeff();
}

TEST_P(Surfaces, RotatedNodesGiveTheRotatedResult) {
  std::mt19937 engine(GetParam());
  const Mat3 rotation = random_rotation(engine);
  const Field rotated = x * rotation.transpose();
  const auto expect_equal = [&](auto&& flow, int order, double tau, int power, const auto& start_on) {
    const UniformSteps times = grid(order, tau, power, 2);
    const Field plain = last_state(flow, times, start_on(x)).x,
                end = last_state(flow, times, start_on(rotated)).x;
    EXPECT_LT(difference(plain, end * rotation), 1e-10);
  };
  expect_equal(MeanCurvatureFlow(space, {}), 2, 2e-3, 2,
               [&](const Field& x) { return discrete_mean_curvature_state(space, x); });
  expect_equal(DziukFlow(space), 2, 2e-3, 2, [&](const Field& x) { return dziuk_state_on(space, x); });
  expect_equal(BgnFlow(space), 1, 2e-3, 2, [&](const Field& x) { return bgn_state_on(space, x); });
  expect_equal(WillmoreFlow(space, {}), 2, 1e-4, 4,
               [&](const Field& x) { return discrete_willmore_start(space, x, willmore_law()).state; });
}

TEST_P(Surfaces, RenumberedNodesGiveTheRenumberedResult) {
  Eigen::PermutationMatrix<Eigen::Dynamic> permutation(x.rows());
  permutation.setIdentity();
  std::shuffle(permutation.indices().data(), permutation.indices().data() + x.rows(),
               std::mt19937(GetParam()));
  Mesh mesh = surface.mesh;
  mesh.nodes = permutation * x;
  mesh.elements = surface.mesh.elements.unaryExpr([&](int j) { return permutation.indices()[j]; });
  mesh.elements = mesh.elements.colwise().reverse().eval();
  const SurfaceSpace other(mesh);
  const auto expect_equal = [&](int order, double tau, int power, const auto& run) {
    const UniformSteps times = grid(order, tau, power, 2);
    const Field expected = permutation * run(space, x, times);
    EXPECT_LT(difference(expected, run(other, mesh.nodes, times)), 1e-10);
  };
  expect_equal(2, 2e-3, 2, [](const SurfaceSpace& space, const Field& x, const UniformSteps& times) {
    MeanCurvatureFlow flow(space, {});
    return last_state(flow, times, discrete_mean_curvature_state(space, x)).x;
  });
  expect_equal(1, 2e-3, 2, [](const SurfaceSpace& space, const Field& x, const UniformSteps& times) {
    BgnFlow flow(space);
    return last_state(flow, times, bgn_state_on(space, x)).x;
  });
  expect_equal(2, 1e-4, 4, [](const SurfaceSpace& space, const Field& x, const UniformSteps& times) {
    WillmoreFlow flow(space, {});
    return last_state(flow, times, discrete_willmore_start(space, x, willmore_law()).state).x;
  });
  expect_equal(2, 1e-2, 3, [&](const SurfaceSpace& space, const Field& x, const UniformSteps& times) {
    const double epsilon = 0.3 * surface.size;
    PhaseSeparation flow(space, x, epsilon);
    return last_state(flow, times, disturbed_mixture(space, x, epsilon, 0.2, 0.5, 1)).u;
  });
}

}  // namespace
}  // namespace esfem::test_properties
