// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/error.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/geometry/ritz_map.hpp"
#include "solver/mesh/read.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "solver/tables/table.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_cahn_hilliard {
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

/// A function on the surface, extended constantly along the normals: its Laplacian and divergence in space
/// are those of the surface. By differences of order 4.
template <class Function>
struct ExtendedFromTheSurface {
  Surface surface;
  Function function;
  double step = 5e-3;

  auto operator()(const Vec3& x) const { return function(surface.closest_point(x)); }

  double laplacian(const Vec3& x) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 h = step * Vec3::Unit(i);
      sum +=
          16 * ((*this)(x + h) + (*this)(x - h)) - (*this)(x + 2 * h) - (*this)(x - 2 * h) - 30 * (*this)(x);
    }
    return sum / (12 * step * step);
  }

  double divergence(const Vec3& x) const {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 h = step * Vec3::Unit(i);
      sum += 8 * ((*this)(x + h)[i] - (*this)(x - h)[i]) - ((*this)(x + 2 * h)[i] - (*this)(x - 2 * h)[i]);
    }
    return sum / (12 * step);
  }
};

template <class Function>
ExtendedFromTheSurface<Function> extended(Surface surface, Function function) {
  return {std::move(surface), std::move(function)};
}

Vec3 velocity_at(const Velocity& velocity, double t, const Vec3& x) {
  Field v;
  velocity(t, Field(x.transpose()), v);
  return v.row(0);
}

TEST(ManufacturedCahnHilliard, SatisfiesBothEquations) {
  const ManufacturedCahnHilliard exact(moving, epsilon);
  const Velocity velocity = moving.velocity();
  for (const double t : {0.1, 0.7}) {
    const Surface surface = moving.surface(t);
    for (const Vec3& x : {upper_point(0.3, 0.5, t), upper_point(-0.6, 0.2, t)}) {
      const auto u = extended(surface, [&](const Vec3& y) { return exact.u(y, t); });
      const auto w = extended(surface, [&](const Vec3& y) { return exact.w(y, t); });
      const auto v = extended(surface, [&](const Vec3& y) { return velocity_at(velocity, t, y); });
      EXPECT_NEAR(w(x) + epsilon * u.laplacian(x), (std::pow(u(x), 3) - u(x)) / epsilon, 1e-6);

      const double dt = 1e-4;
      const Vec3 step = dt * v(x);  // to first order; the material derivative is of second order then
      const double material_derivative = (exact.u(x + step, t + dt) - exact.u(x - step, t - dt)) / (2 * dt);
      EXPECT_NEAR(material_derivative + u(x) * v.divergence(x) - w.laplacian(x), exact.b(x, t), 1e-5);
    }
  }
}

TEST(ManufacturedCahnHilliard, MovesWithTheNormalVelocityOfItsLevelSet) {
  const Velocity of_level_set = normal_velocity([](const Vec3& x, double t, double& d_t, Vec3& gradient) {
    const double a = moving.a(t);
    d_t = -moving.a_t(t) * x[0] * x[0] / (a * a);
    gradient = 2 * Vec3(x[0] / a, x[1], x[2]);
  });
  for (const double t : {0.0, 0.3}) {
    const Vec3 x = upper_point(0.4, -0.3, t), v = velocity_at(moving.velocity(), t, x);
    EXPECT_LT((v - velocity_at(of_level_set, t, x)).norm(), 1e-15);
    const Vec3 stretching = velocity_at(moving.stretching_velocity(), t, x);
    EXPECT_NEAR((stretching - v).dot(moving.surface(t).normal(x)), 0, 1e-15) << "the same normal part";
    EXPECT_GT((stretching - v).norm(), 0.01);
  }
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
  MovingNodes nodes(moving.velocity(), mesh.nodes, 0.01),
      all_kept(moving.velocity(), mesh.nodes, 0.01, MovingNodes::all);
  const Field early = nodes.at(0.02);
  EXPECT_EQ(all_kept.at(0.5), nodes.at(0.5));
  EXPECT_EQ(nodes.at(0.02), early);
  EXPECT_EQ(all_kept.at(0.02), early);
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
      theta = cahn_hilliard_theta(space, DoubleWell(), epsilon, start);
    }
    CahnHilliard flow(space, exact.problem(), motion, epsilon, theta);
    return last_state(flow, {json["q"], tau, json["steps"], {}}, {start, starts});
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
  const State start = cahn_hilliard_start(space, DoubleWell(), eps, 0, mesh.nodes, u);
  std::vector<double> mass, energy;
  integrate(flow, {1, 1e-3, 40, {}}, start, [&](int, const State& state) {
    mass.push_back(state.Mu.sum());
    energy.push_back(ginzburg_landau_energy(space, state.x, state.u, eps));
  });
  EXPECT_NEAR(mass.back(), mass.front(), 1e-11);
  for (size_t n = 1; n < energy.size(); ++n) EXPECT_LT(energy[n], energy[n - 1]);
  EXPECT_LT(energy.back(), 0.95 * energy.front());
}

/// The manufactured solution with an f(u, grad u) that b takes back.
struct WithReaction : ManufacturedCahnHilliard::Problem {
  explicit WithReaction(const ManufacturedCahnHilliard& solution)
      : ManufacturedCahnHilliard::Problem(solution.problem()) {}

  Pack f(double, const PointData<1>& p) const { return 20.0 * (p.u[0] + dot(p.grad[0], p.grad[0])); }
  void b(double t, const Field& x, Field& nodal) const {
    Problem::b(t, x, nodal);
    for (int j = 0; j < x.rows(); ++j) {
      const Vec3 y = x.row(j);
      nodal(j, 0) -= 20 * (exact->u(y, t) + exact->gradient_of_u(y, t).squaredNorm());
    }
  }
};

/// The largest nodal error of u at t = 0.1, from interpolated starting values.
template <class Problem>
double manufactured_error(const Mesh& mesh, const ManufacturedCahnHilliard& exact, const Problem& problem,
                          int q) {
  const double tau = 0.0025;
  const SurfaceSpace space(mesh);
  MovingNodes nodes(moving.velocity(), mesh.nodes, tau);
  const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
  CahnHilliard flow(space, problem, motion, epsilon);
  const std::function<State(double)> starts = [&](double t) {
    return exact_cahn_hilliard_state(space, exact, nodes.at(t), t, StartValues::interpolation);
  };
  const State end = last_state(flow, {q, tau, 40, {}}, {starts(0), starts});
  return (end.u - starts(end.t).u).cwiseAbs().maxCoeff();
}

TEST(CahnHilliard, TakesAnFOfUAndItsGradient) {
  const ManufacturedCahnHilliard exact(moving, epsilon);
  const WithReaction problem(exact);
  const double coarse = manufactured_error(sphere_mesh(1, 1, 2), exact, problem, 2),
               fine = manufactured_error(sphere_mesh(1, 1, 3), exact, problem, 2);
  EXPECT_GT(order(coarse, fine), 1.8);
  struct WithoutF : WithReaction {
    using WithReaction::WithReaction;
    Pack f(double, const PointData<1>&) const { return Pack{}; }
  };
  EXPECT_GT(manufactured_error(sphere_mesh(1, 1, 3), exact, WithoutF(exact), 2), 10 * fine);
}

TEST(CahnHilliard, IsTheMoreAccurateTheHigherTheDegree) {
  const ManufacturedCahnHilliard exact(moving, epsilon);
  double previous = 1;
  for (const int degree : {1, 2, 3, 4}) {
    const double error = manufactured_error(sphere_mesh(1, degree, 1), exact, exact.problem(), 4);
    EXPECT_LT(error, previous / 3) << "degree " << degree;
    previous = error;
  }
}

/// The manufactured solution on nodes that are not material points: a linear image of the sphere's. The
/// ellipsoid moves so far that the difference shows.
struct StretchedNodes {
  EvolvingEllipsoid moving{0.8};
  Mesh mesh;
  SurfaceSpace space;
  ManufacturedCahnHilliard exact{moving, epsilon};
  double tau = 0.01;
  MovingNodes nodes{moving.stretching_velocity(), mesh.nodes, tau};
  NodalMotion motion = [this](double t) -> const Field& { return nodes.at(t); };

  explicit StretchedNodes(int subdivisions) : mesh(sphere_mesh(1, 1, subdivisions)), space(mesh) {}

  Velocity tangential = [this](double t, const Field& x, Field& W) {
    Field material;
    moving.stretching_velocity()(t, x, W);
    moving.velocity()(t, x, material);
    W -= material;
  };

  State exact_state(double t) {
    return exact_cahn_hilliard_state(space, exact, nodes.at(t), t, StartValues::interpolation);
  }

  /// The largest nodal error of u at t = 0.2, when the surface is longest.
  double error(const Velocity& tangential) {
    CahnHilliard flow(space, exact.problem(), motion, epsilon, {}, tangential);
    const std::function<State(double)> starts = [&](double t) { return exact_state(t); };
    const State end = last_state(flow, {3, tau, 20, {}}, {exact_state(0), starts});
    return (end.u - exact_state(0.2).u).cwiseAbs().maxCoeff();
  }
};

TEST(CahnHilliard, OnNodesThatAreNotMaterialPointsNeedsTheAdvection) {
  StretchedNodes coarse(3), fine(4);
  const double fine_error = fine.error(fine.tangential), without = fine.error({});
  EXPECT_GT(order(coarse.error(coarse.tangential), fine_error), 1.8);
  EXPECT_GT(without, 2 * fine_error);
  EXPECT_LT(order(coarse.error({}), without), 1);
}

TEST(CahnHilliard, KeepsTheMassOnNodesThatAreNotMaterialPoints) {
  StretchedNodes run(2);
  CahnHilliard flow(run.space, DoubleWell(), run.motion, epsilon, {}, run.tangential);
  const State start = run.exact_state(0), end = last_state(flow, {1, run.tau, 20, {}}, start);
  EXPECT_NEAR(end.Mu.sum(), start.Mu.sum(), 1e-12);
}

TEST(CahnHilliard, SaysWhatItDoesNotTake) {
  const Mesh mesh = sphere_mesh(1, 1, 1);
  const SurfaceSpace space(mesh);
  const NodalMotion at_rest = [&](double) -> const Field& { return mesh.nodes; };
  EXPECT_THAT([&] { CahnHilliard(space, DoubleWell(), at_rest, 0); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("epsilon: found 0")));
}

}  // namespace
}  // namespace esfem::test_cahn_hilliard
