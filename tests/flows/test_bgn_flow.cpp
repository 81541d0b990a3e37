// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/mesh/generate.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/bgn_schemes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_bgn_flow {
namespace {

using testing::HasSubstr;
using State = BgnFlow::State;

State run(const Mesh& mesh, const Quadrature& rule, double tau, int steps) {
  const SurfaceSpace space(mesh, rule);
  BgnFlow flow(space);
  return last_state(flow, {1, tau, steps, {}}, bgn_state_on(space, mesh.nodes));
}

double largest(const Field& field) {
  return field.cwiseAbs().maxCoeff();
}

class BgnSchemes : public testing::TestWithParam<BgnScheme> {
 protected:
  const Mesh mesh = ellipsoid_mesh({2, 1.5, 1.2}, GetParam().degree, GetParam().degree == 1 ? 2 : 1);
  const SurfaceSpace space{mesh, GetParam().rule};
};

/// Residuals of the two equations after one step, relative to their terms.
struct Residuals {
  double velocity, curvature;
};
Residuals residuals(const SurfaceSpace& space, const Field& old_x, const State& state) {
  SymmetricMatrix M = space.matrix(), A = space.matrix(), N = space.matrix();
  space.assemble(old_x, M, A);
  const Field MH = M * state.H, Ax = A * state.x;
  Field velocity = MH, curvature = -Ax;
  for (int a = 0; a < 3; ++a) {
    const auto normal = [a](const PointData<3>& p) { return p.normal[a]; };
    space.assemble_weighted_mass<3>(old_x, old_x, normal, N);
    velocity += N * state.v.col(a);
    curvature.col(a) += N * state.H;
  }
  return {velocity.norm() / MH.norm(), curvature.norm() / Ax.norm()};
}

TEST_P(BgnSchemes, AStepSolvesBothEquations) {
  State end = run(mesh, GetParam().rule, 0.02, 1);
  EXPECT_LT(residuals(space, mesh.nodes, end).velocity, 1e-12);
  EXPECT_LT(residuals(space, mesh.nodes, end).curvature, 1e-12);
  EXPECT_LT(largest(end.x - mesh.nodes - 0.02 * end.v), 1e-15);
  EXPECT_GT(end.H.minCoeff(), 0);
  end.H = -end.H;
  EXPECT_GT(residuals(space, mesh.nodes, end).velocity, 1);
  EXPECT_GT(residuals(space, mesh.nodes, end).curvature, 1);
}

// Since int_Gamma grad X : grad (X - id) >= |X(Gamma)| - |Gamma| for every map X, the scheme is stable for
// every tau: |Gamma^n| + tau (H^n, H^n) <= |Gamma^{n-1}|.
TEST_P(BgnSchemes, AreaDecreasesWhateverTheStepSize) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  for (const auto& [tau, steps] :
       {std::pair{1e-3, 5}, std::pair{0.02, 5}, std::pair{1.0, 3}, std::pair{100.0, 1}}) {
    BgnFlow flow(space);
    Field old_x;
    integrate(flow, {1, tau, steps, {}}, bgn_state_on(space, mesh.nodes),
              [&, tau = tau](int n, const State& now) {
                if (n > 0) {
                  space.assemble(old_x, M, A);
                  const double old_area = space.area(old_x), dissipation = tau * M.energy(now.H);
                  EXPECT_LE(space.area(now.x) + dissipation, old_area) << "tau = " << tau;
                  if (tau == 1e-3) {
                    EXPECT_GT(space.area(now.x) + 1.1 * dissipation, old_area)
                        << "the bound is sharp for small steps";
                  }
                }
                old_x = now.x;
              });
  }
}

TEST_P(BgnSchemes, OrientationDoesNotMatter) {
  Mesh turned = mesh;
  turned.elements.col(1).swap(turned.elements.col(2));
  if (mesh.degree == 2) turned.elements.col(3).swap(turned.elements.col(5));
  const State some = run(mesh, GetParam().rule, 0.02, 5), other = run(turned, GetParam().rule, 0.02, 5);
  EXPECT_LT(largest(some.x - other.x), 1e-12);
  EXPECT_LT(largest(some.H + other.H), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Schemes, BgnSchemes, testing::Values(lumped, consistent, quadratic),
                         [](const auto& info) { return info.param.name; });

TEST(BgnFlow, LumpingIsAnotherScheme) {
  const Mesh mesh = ellipsoid_mesh({2, 1.5, 1.2}, 1, 2);
  const State some = run(mesh, lumped.rule, 0.02, 5), other = run(mesh, consistent.rule, 0.02, 5);
  EXPECT_GT(largest(some.x - other.x), 1e-3);
  EXPECT_LT(largest(some.x - other.x), 0.05);
}

TEST(BgnFlow, InitialStateIsThatOfTheDiscreteSurface) {
  const Mesh mesh = ellipsoid_mesh({2, 1.5, 1.2}, 2, 2);
  const SurfaceSpace space(mesh);
  const State state = bgn_state_on(space, mesh.nodes);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  EXPECT_EQ(state.x, mesh.nodes);
  EXPECT_EQ(state.v, -curvature.kappa());
  EXPECT_EQ(state.H, curvature.H());
}

TEST(BgnFlow, OnlyTheFirstOrderIsThere) {
  const Mesh mesh = sphere_mesh(2, 1, 1);
  const SurfaceSpace space(mesh);
  BgnFlow flow(space);
  try {
    last_state(flow, {2, 0.01, 2, parse_start("cascade")}, bgn_state_on(space, mesh.nodes));
    FAIL() << "BDF2 was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("BDF order 2: expected 1"));
  }
}

/// The radii that the scheme has without error in space: (R^n - R^{n-1})/tau = -2 R^n/(R^{n-1})².
double radius_of_the_scheme(double tau, int steps) {
  double R = 2;
  for (int n = 0; n < steps; ++n) R /= 1 + 2 * tau / (R * R);
  return R;
}

/// The mean distance of the nodes from the centre, less the radius expected.
double radius_error(const State& state, double expected) {
  return state.x.rowwise().norm().mean() - expected;
}

TEST(BgnFlow, SphereShrinksWithFirstOrderInTime) {
  const Mesh mesh = sphere_mesh(2, 2, 2);
  const double radius = std::sqrt(4 - 4 * 0.4), tolerance = 0.1;
  const auto error = [&](int steps) {
    return radius_error(run(mesh, quadratic.rule, 0.4 / steps, steps), radius);
  };
  const double coarse = error(8), fine = error(16);
  EXPECT_GE(order(coarse, fine), 1 - tolerance);
  EXPECT_LT(order(coarse, fine), 1 + tolerance);
  EXPECT_LT(fine, 0.02);
}

// The orders seen are 2.0, 2.0 and 3.9.
TEST(BgnFlow, QuadraticElementsAreBetterInSpace) {
  const double tau = 0.05, tolerance = 0.2;
  const int steps = 8;
  const auto error = [&](const BgnScheme& scheme, int subdivisions) {
    return radius_error(run(sphere_mesh(2, scheme.degree, subdivisions), scheme.rule, tau, steps),
                        radius_of_the_scheme(tau, steps));
  };
  for (const BgnScheme& scheme : {lumped, consistent}) {
    EXPECT_GE(order(error(scheme, 2), error(scheme, 3)), 2 - tolerance) << scheme;
  }
  EXPECT_GE(order(error(quadratic, 1), error(quadratic, 2)), 4 - tolerance);
  EXPECT_LT(std::abs(error(quadratic, 2)), std::abs(error(lumped, 3)) / 20) << "with as many nodes";
}

// At t = 0.06, with tau = 0.003, the worst angle is 30 degrees (initially 38); Dziuk's scheme has 21 with
// BDF1 and 9 with BDF2.
TEST(BgnFlow, KeepsTheMeshOfTheDumbbellGood) {
  const Mesh mesh = generate_mesh(dumbbell(), 0.1);
  const auto worst_angle = [&](const Field& x) { return mesh_quality(mesh.elements, x).min_angle; };
  const double initial = worst_angle(mesh.nodes);
  EXPECT_GT(worst_angle(run(mesh, lumped.rule, 0.003, 20).x), 0.75 * initial);

  const SurfaceSpace space(mesh);
  DziukFlow dziuk(space);
  const auto dziuk_nodes = [&](int q) {
    return last_state(dziuk, {q, 0.003, 20, parse_start("cascade")}, dziuk_state_on(space, mesh.nodes)).x;
  };
  EXPECT_LT(worst_angle(dziuk_nodes(1)), 0.6 * initial);
  EXPECT_LT(worst_angle(dziuk_nodes(2)), 0.3 * initial);
}

TEST(BgnFlow, ARunEndsAtThePinch) {
  const ReferenceCase reference("mcf_dumbbell_kll_bdf2");
  const Mesh mesh = corner_mesh(reference.mesh);
  EXPECT_NEAR(run(mesh, lumped.rule, 0.003, 24).t, 0.072, 1e-15);
  try {
    run(mesh, lumped.rule, 0.003, 40);
    FAIL() << "went through the pinch";
  } catch (const SingularityError& error) {
    EXPECT_THAT(error.what(), HasSubstr("singular at t = 0.07"));
    EXPECT_THAT(error.what(), HasSubstr("has radius ratio"));
  }
}

}  // namespace
}  // namespace esfem::test_bgn_flow
