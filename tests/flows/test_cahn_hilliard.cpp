// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/analysis/table.hpp"
#include "solver/error.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/evolving_ellipsoid.hpp"
#include "solver/flows/ritz_map.hpp"
#include "solver/mesh/read.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem {
namespace {

using State = CahnHilliardState;

const EvolvingEllipsoid moving;
const double epsilon = 0.5;

Vec3 upper_point(double x1, double x2, double t) {
  return {x1, x2, std::sqrt(1 - x1 * x1 / moving.a(t) - x2 * x2)};
}

// The numbers come from an independent implementation.
TEST(ManufacturedCahnHilliard, ExactDataAgreeWithIndependentValues) {
  const ManufacturedCahnHilliard exact(moving, epsilon);
  EXPECT_NEAR(exact.w(upper_point(0.3, 0.5, 0), 0), 0.15675, 1e-14);
  EXPECT_NEAR(exact.b(upper_point(0.3, 0.5, 0), 0), -0.28608849917653556, 1e-12);
  EXPECT_NEAR(exact.b(upper_point(-0.6, 0.2, 0), 0), 0.29513119736491966, 1e-12);
  EXPECT_NEAR(exact.w(upper_point(0.3, 0.5, 0.1), 0.1), 0.055354805659806466, 1e-13);
  EXPECT_NEAR(exact.b(upper_point(0.3, 0.5, 0.1), 0.1), -0.4158394612983972, 1e-12);
}

TEST(ManufacturedCahnHilliard, GradientsAreThoseOfDifferences) {
  const ManufacturedCahnHilliard exact(moving, epsilon);
  const double t = 0.3, step = 1e-5;
  const Vec3 x = upper_point(0.4, -0.3, t), nu = moving.surface(t).normal(x);
  const Vec3 along = nu.cross(Vec3(1, 2, 0.5)).normalized();
  const Surface surface = moving.surface(t);
  const Vec3 forth = surface.closest_point(x + step * along), back = surface.closest_point(x - step * along);
  EXPECT_NEAR((exact.u(forth, t) - exact.u(back, t)) / (2 * step), exact.gradient_of_u(x, t).dot(along),
              1e-8);
  EXPECT_NEAR((exact.w(forth, t) - exact.w(back, t)) / (2 * step), exact.gradient_of_w(x, t).dot(along),
              1e-8);
  EXPECT_NEAR(exact.gradient_of_w(x, t).dot(nu), 0, 1e-13);
}

TEST(MovingNodes, StayOnTheSurfaceWithFourthOrder) {
  const Mesh mesh = sphere_mesh(1, 1, 1);
  const auto distance = [&](double tau) {
    MovingNodes nodes(moving.velocity(), mesh.nodes, tau);
    const Field& x = nodes.at(0.4);
    double largest = 0;
    for (int j = 0; j < x.rows(); ++j)
      largest = std::max(largest, std::abs(moving.surface(0.4).level(x.row(j))));
    return largest;
  };
  EXPECT_LT(distance(0.05), 1e-4);
  EXPECT_GT(order(distance(0.05), distance(0.025)), 3.7);
}

TEST(MovingNodes, GoBackInTimeAndRefuseOtherTimes) {
  const Mesh mesh = sphere_mesh(1, 1, 1);
  MovingNodes nodes(moving.velocity(), mesh.nodes, 0.01);
  const Field early = nodes.at(0.02);
  nodes.at(0.5);
  EXPECT_EQ(nodes.at(0.02), early);
  EXPECT_THAT([&] { nodes.at(0.015); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("multiple of 0.01")));
}

/// A run of the independent implementation (bk22 (8.3) as corrected).
struct CahnHilliardCase {
  nlohmann::json json;
  Mesh mesh = read_mesh(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/sphere_p1_362.msh").mesh;
  SurfaceSpace space{mesh, conical_quadrature(4)};
  ManufacturedCahnHilliard exact{moving, epsilon};
  bool ritz;

  explicit CahnHilliardCase(const std::string& name)
      : json(read_json(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/" + name + ".json")),
        ritz(json["ritz_and_theta"].get<bool>()) {}

  State exact_state(const Field& x, double t) const {
    return exact_cahn_hilliard_state(space, exact, x, t,
                                     ritz ? StartValues::ritz : StartValues::interpolation);
  }

  State end(bool with_theta) const {
    const double tau = json["tau"];
    MovingNodes nodes(moving.velocity(), mesh.nodes, tau);
    const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
    const std::function<State(double)> starts = [&](double t) { return exact_state(nodes.at(t), t); };
    const State start = starts(0);
    Field theta;
    if (with_theta) {
      theta = cahn_hilliard_theta(space, start.x, start.u, start.w, epsilon,
                                  load_of_g(space, DoubleWell(), 0, start.x, start.u));
    }
    CahnHilliard flow(space, exact.problem(), motion, epsilon, theta);
    return last_state(flow, {json["q"], tau, json["steps"], {}}, start, starts);
  }

  double deviation(const State& state) const {
    double largest = 0;
    for (int j = 0; j < state.u.rows(); ++j)
      largest = std::max({largest, std::abs(state.u(j, 0) - json["u"][j].get<double>()),
                          std::abs(state.w(j, 0) - json["w"][j].get<double>())});
    return largest;
  }
};

TEST(CahnHilliard, Bdf1AgreesWithTheIndependentImplementation) {
  const CahnHilliardCase run("cahn_hilliard_p1_bdf1");
  EXPECT_LT(run.deviation(run.end(false)), 1e-9);
}

TEST(CahnHilliard, Bdf3WithRitzMapAndThetaAgreesWithTheIndependentImplementation) {
  const CahnHilliardCase run("cahn_hilliard_p1_bdf3_ritz_theta");
  EXPECT_LT(run.deviation(run.end(true)), 1e-9);
  EXPECT_GT(run.deviation(run.end(false)), 1e-5) << "without theta";
}

TEST(CahnHilliard, TheRitzMapOfTheIndependentImplementation) {
  const CahnHilliardCase run("cahn_hilliard_p1_bdf3_ritz_theta");
  const Field u = run.exact_state(run.mesh.nodes, 0).u;
  double largest = 0;
  for (int j = 0; j < u.rows(); ++j)
    largest = std::max(largest, std::abs(u(j, 0) - run.json["u0"][j].get<double>()));
  EXPECT_LT(largest, 1e-11);
}

TEST(CahnHilliard, KeepsTheMassAndLosesEnergyOnAStationarySurface) {
  const Mesh mesh = sphere_mesh(1, 1, 3);
  const SurfaceSpace space(mesh);
  Field u = 0.2 * (4 * mesh.nodes.col(0)).array().cos() + 0.1 * (3 * mesh.nodes.col(2)).array().sin();
  const double eps = 0.2;
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  CahnHilliard flow(space, DoubleWell(), at_rest, eps);
  const State start = cahn_hilliard_state(
      space, 0, mesh.nodes, u,
      cahn_hilliard_w(space, mesh.nodes, u, eps, load_of_g(space, DoubleWell(), 0, mesh.nodes, u)));
  std::vector<double> mass, energy;
  integrate(flow, {1, 1e-3, 40, {}}, start, {}, [&](int, const State& state) {
    mass.push_back(state.Mu.sum());
    energy.push_back(ginzburg_landau_energy(space, state.x, state.u, eps));
  });
  EXPECT_NEAR(mass.back(), mass.front(), 1e-11);
  for (size_t n = 1; n < energy.size(); ++n) EXPECT_LT(energy[n], energy[n - 1]);
  EXPECT_LT(energy.back(), 0.95 * energy.front());
}

TEST(CahnHilliard, SaysWhatItDoesNotTake) {
  const Mesh mesh = sphere_mesh(1, 1, 1);
  const SurfaceSpace space(mesh);
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  EXPECT_THAT([&] { CahnHilliard(space, DoubleWell(), at_rest, 0); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("epsilon: found 0")));
}

}  // namespace
}  // namespace esfem
