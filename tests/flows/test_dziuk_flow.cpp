// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/problems/exact_states.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_dziuk_flow {
namespace {

using State = DziukFlow::State;

State run_sphere(const Mesh& mesh, const Quadrature& rule, const UniformSteps& grid) {
  const ExactEvolution exact = shrinking_sphere(2);
  const std::function<State(double)> state = [&](double t) {
    return exact_dziuk_state(exact, mesh.nodes, t);
  };
  const SurfaceSpace space(mesh, rule);
  DziukFlow flow(space);
  return last_state(flow, grid, {state(0), state});
}

double largest(const Field& field) {
  return field.cwiseAbs().maxCoeff();
}

TEST(DziukFlow, AgreesWithTheIndependentImplementation) {
  const ReferenceCase reference("mcf_dziuk_bdf2");
  const State end = run_sphere(reference.mesh, conical_quadrature(12), reference.grid);
  EXPECT_LT(largest(end.x - reference.nodal("x")), 1e-12);
  EXPECT_LT(largest(end.v - reference.nodal("v")), 1e-11);
  // A rule that is too weak, another order and another start are seen.
  const auto deviation = [&](const Quadrature& rule, const UniformSteps& grid) {
    return reference.deviation(run_sphere(reference.mesh, rule, grid));
  };
  EXPECT_GT(deviation(conical_quadrature(4), reference.grid), 1e-5);
  UniformSteps other = reference.grid;
  other.order = 3;
  EXPECT_GT(deviation(conical_quadrature(12), other), 1e-4);
  other = reference.grid;
  other.start = parse_start("cascade");
  EXPECT_GT(deviation(conical_quadrature(12), other), 1e-4);
}

TEST(DziukFlow, StatesHaveTheVelocityOfMeanCurvatureFlow) {
  const Mesh mesh = sphere_mesh(2, 2, 3);
  const SurfaceSpace space(mesh);
  const State discrete = dziuk_state_on(space, mesh.nodes);
  const State exact = exact_dziuk_state(shrinking_sphere(2), mesh.nodes, 0);
  EXPECT_EQ(discrete.x, mesh.nodes);
  EXPECT_LT(largest(exact.x - mesh.nodes), 1e-15);
  EXPECT_LT(largest(exact.v + mesh.nodes / 2), 1e-14);  // v = -2/R nu
  EXPECT_LT(largest(discrete.v - exact.v), 0.02);
  const State later = exact_dziuk_state(shrinking_sphere(2), mesh.nodes, 0.75);
  EXPECT_EQ(later.t, 0.75);
  EXPECT_LT(largest(later.x - mesh.nodes / 2), 1e-15);
  EXPECT_LT(largest(later.v + mesh.nodes), 1e-14);
}

/// On a sphere of radius R~, A acts on the coordinates like 2/R~² M: the radii R^1, R^2, .. that the scheme
/// has without error in space, from exact starting values, at time 0.4.
double radius_of_the_scheme(int q, int steps) {
  const std::vector<double> delta = bdf_delta(q), gamma = bdf_gamma(q);
  const double tau = 0.4 / steps;
  std::vector<double> R;
  for (int n = 0; n < q; ++n) R.push_back(std::sqrt(4 - 4 * n * tau));
  for (int n = q; n <= steps; ++n) {
    double extrapolated = 0, sum = 0;
    for (int j = 0; j < q; ++j) extrapolated += gamma[j] * R[n - 1 - j];
    for (int j = 1; j <= q; ++j) sum += delta[j] * R[n - j];
    R.push_back(-sum / (delta[0] + 2 * tau / (extrapolated * extrapolated)));
  }
  return R.back();
}

TEST(DziukFlow, SphereHasTheRadiusOfTheSchemeInTime) {
  const double exact = std::sqrt(4 - 4 * 0.4), tolerance = 0.3;
  const int steps = 16;
  for (int q : {1, 2, 3}) {
    const auto error = [&](int subdivisions) {
      const Mesh mesh = sphere_mesh(2, 2, subdivisions);
      const State end = run_sphere(mesh, default_quadrature(2), {q, 0.4 / steps, steps, {}});
      return (end.x.rowwise().norm().array() - radius_of_the_scheme(q, steps)).abs().maxCoeff();
    };
    EXPECT_LT(error(3), 1e-4) << "BDF" << q;
    EXPECT_GE(order(error(2), error(3)), 4 - tolerance) << "BDF" << q;  // P2 superconverges on spheres

    const auto error_in_time = [&](int steps) { return radius_of_the_scheme(q, steps) - exact; };
    EXPECT_GE(order(error_in_time(128), error_in_time(256)), q - 0.1) << "BDF" << q;
    EXPECT_GT(std::abs(radius_of_the_scheme(q, steps) - radius_of_the_scheme(q == 1 ? 2 : 1, steps)), 1e-2)
        << "another order is another radius";
  }
}

/// By how much a small tangential displacement of the nodes of a sphere grows per step, in the last 10 steps.
double growth_of_tangential_motion(const Mesh& mesh, int q, double tau, int steps) {
  const ExactEvolution exact = shrinking_sphere(2);
  const Field along = (29 * mesh.nodes).array().sin();
  const Field displacement =
      1e-9 * (along - (along.cwiseProduct(mesh.nodes) / 4).rowwise().sum().asDiagonal() * mesh.nodes);
  const SurfaceSpace space(mesh);
  DziukFlow flow(space);
  std::vector<Field> x[2];
  for (int displaced : {0, 1}) {
    const Field x0 = mesh.nodes + displaced * displacement;
    const std::function<State(double)> state = [&](double t) { return exact_dziuk_state(exact, x0, t); };
    integrate(flow, {q, tau, steps, {}}, {state(0), state},
              [&](int, const State& now) { x[displaced].push_back(now.x); });
  }
  const auto difference = [&](int n) { return largest(x[1][n] - x[0][n]); };
  return std::pow(difference(steps) / difference(steps - 10), 0.1);
}

// kll19 Remark 7.1: d/dt of M(x)v + A(x)x = 0 has the form int |grad v|² + grad x : (D v) grad v, the second
// term of which is nowhere positive, and which is not positive where grad v has nu in its null-space and
// eigenvalues of different sign. For v = phi nu these are -phi² (kappa_1 - kappa_2)² and, in all, |grad phi|²
// + 2 K phi²: with phi large where K < 0, on the inside of a torus, the form is negative.
TEST(DziukFlow, ItsDifferentiatedFormIsNotElliptic) {
  const double major = 2, minor = 1, c = 0.5, epsilon = 1e-4;
  const Mesh mesh = torus_mesh(major, minor, 2, 60, 30);
  const SurfaceSpace space(mesh);
  Field v(mesh.nodes.rows(), 3);
  for (Eigen::Index j = 0; j < v.rows(); ++j) {
    const Vec3 x = mesh.nodes.row(j), nu = torus(major, minor).normal(x);
    v.row(j) = (1 - c * (x.head<2>().norm() - major) / minor) * nu;
  }
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  const auto stiffness_of = [&](const Field& on, const Field& u) {
    space.assemble(on, M, A);
    Field product(u.rows(), 3);
    A.multiply(u, product);
    return product.cwiseProduct(v).sum();
  };
  const double second = (stiffness_of(mesh.nodes + epsilon * v, mesh.nodes) -
                         stiffness_of(mesh.nodes - epsilon * v, mesh.nodes)) /
                        (2 * epsilon);
  const double all = stiffness_of(mesh.nodes, v) + second;
  EXPECT_LT(second, 0);
  EXPECT_NEAR(all, 2 * pi * pi * (c * c * major / minor - 4 * c), 0.1);
}

// Tangential motion does not change the surface, so that A(x) e + A'(x)[e] x is about 0 for a tangential
// displacement e, and the step with the extrapolated x~ acts on a mode with eigenvalue lambda of M^-1 A like
//   1/tau delta(zeta) e + lambda (1 - zeta)^q e = 0.
// All roots but zeta = 1 are outside the unit circle for q <= 3. For q = 4 there is one inside for tau lambda
// > 2.5, which grows by up to 1.11 a step (at 20), for q = 5 for tau lambda > 0.64, by up to 1.31 (at 11).
TEST(DziukFlow, TangentialMotionGrowsWithBdf4And5) {
  const Mesh mesh = sphere_mesh(2, 2, 2);
  for (int q : {1, 2, 3}) EXPECT_LT(growth_of_tangential_motion(mesh, q, 0.02, 35), 1) << "BDF" << q;
  // While the sphere shrinks, tau lambda grows, and with it the motion a little faster than above.
  EXPECT_NEAR(growth_of_tangential_motion(mesh, 4, 0.02, 40), 1.11, 0.06);
  EXPECT_NEAR(growth_of_tangential_motion(mesh, 5, 0.02, 35), 1.31, 0.08);
  for (int q : {4, 5}) EXPECT_LT(growth_of_tangential_motion(mesh, q, 0.001, 40), 1) << "BDF" << q;
}

TEST(DziukFlow, ARunEndsWhereItsMeshFolds) {
  const ReferenceCase dumbbell("mcf_dumbbell_kll_bdf2");
  const SurfaceSpace space(dumbbell.mesh);
  DziukFlow flow(space);
  const auto run = [&](int steps) {
    return last_state(flow, {2, 0.003, steps, parse_start("cascade")},
                      dziuk_state_on(space, dumbbell.mesh.nodes));
  };
  EXPECT_NEAR(run(25).t, 0.075, 1e-15);
  EXPECT_THROW(run(40), SingularityError);
  // The unstable BDF5 folds the sphere's mesh long before the sphere vanishes at t = 1.
  const Mesh mesh = sphere_mesh(2, 2, 2);
  EXPECT_THROW(run_sphere(mesh, default_quadrature(2), {5, 0.02, 45, {}}), SingularityError);
  EXPECT_EQ(run_sphere(mesh, default_quadrature(2), {3, 0.02, 45, {}}).t, 0.9);
}

}  // namespace
}  // namespace esfem::test_dziuk_flow
