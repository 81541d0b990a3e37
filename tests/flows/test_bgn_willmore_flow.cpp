// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "solver/constants.hpp"
#include "solver/flows/bgn_willmore_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/surfaces/surface.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/bgn_schemes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_bgn_willmore_flow {
namespace {

using testing::HasSubstr;
using State = BgnWillmoreFlow::State;

State run(const Mesh& mesh, const Quadrature& rule, double tau, int steps) {
  const SurfaceSpace space(mesh, rule);
  BgnWillmoreFlow flow(space);
  return last_state(flow, {1, tau, steps, {}}, bgn_willmore_state_on(space, mesh.nodes));
}

double largest(const Field& field) {
  return field.cwiseAbs().maxCoeff();
}

SymmetricMatrix mass_matrix(const SurfaceSpace& space, const Field& x) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  return M;
}

/// 1/2 int |kappa|² with the consistent mass matrix, whatever the flow's own is.
double energy(const Mesh& mesh, const Field& x) {
  const SurfaceSpace space(mesh);
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  return mass_matrix(space, x).energy(curvature.kappa()) / 2;
}

double radius_error(const Field& x) {
  return (x.rowwise().norm().array() - 1).abs().maxCoeff();
}

/// L2 error of A_h, from the exact H or from H = 0, on an ellipsoid.
double weingarten_error(int subdivisions, bool with_H) {
  const Surface surface = ellipsoid(1, 0.8, 0.6);
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, subdivisions);
  const SurfaceSpace space(mesh);
  Field exact(mesh.nodes.rows(), 6), H = Field::Zero(mesh.nodes.rows(), 1);
  for (int j = 0; j < exact.rows(); ++j) {
    const Mat3 A = surface.weingarten(mesh.nodes.row(j));
    exact.row(j) << A(0, 0), A(0, 1), A(0, 2), A(1, 1), A(1, 2), A(2, 2);
    if (with_H) H(j, 0) = A.trace();
  }
  const SymmetricMatrix M = mass_matrix(space, mesh.nodes);
  WeakWeingarten weingarten(space);
  weingarten.compute(mesh.nodes, H, M);
  return std::sqrt(M.energy(weingarten.A() - exact));
}

TEST(WeakWeingarten, ConvergesToTheWeingartenMap) {
  const double coarse = weingarten_error(2, true), fine = weingarten_error(3, true);
  EXPECT_GE(order(coarse, fine), 0.9);
  EXPECT_LT(fine, 0.2);
  EXPECT_GT(weingarten_error(3, false), 2) << "it needs the term with H";
}

class BgnWillmoreSchemes : public testing::TestWithParam<BgnScheme> {
 protected:
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, GetParam().degree, GetParam().degree == 1 ? 2 : 1);
  const SurfaceSpace space{mesh, GetParam().rule};
};

TEST_P(BgnWillmoreSchemes, TraceOfTheWeingartenMapIsTheMeanCurvature) {
  const Field H = 3 + mesh.nodes.col(0).array().sin();
  WeakWeingarten weingarten(space);
  weingarten.compute(mesh.nodes, H, mass_matrix(space, mesh.nodes));
  const Field& A = weingarten.A();
  EXPECT_LT(largest(A.col(0) + A.col(3) + A.col(5) - H), 1e-11);
}

TEST_P(BgnWillmoreSchemes, AStepSolvesBothEquations) {
  const double tau = 1e-3;
  const State initial = bgn_willmore_state_on(space, mesh.nodes);
  State end = run(mesh, GetParam().rule, tau, 1);
  SymmetricMatrix M = space.matrix(), A = space.matrix(), N = space.matrix();
  space.assemble(mesh.nodes, M, A);
  WeakWeingarten weingarten(space);
  weingarten.compute(mesh.nodes, initial.H, M);
  Field Q;
  weingarten.assemble_Q(mesh.nodes, initial.H, Q);
  const Field Ax = A * end.x;
  Field velocity = A * end.H - Q, curvature = -Ax;
  for (int a = 0; a < 3; ++a) {
    const auto normal = [a](const PointData<0>& p) { return p.normal[a]; };
    space.assemble_weighted_mass<0>(mesh.nodes, mesh.nodes, normal, N);
    velocity += N * end.v.col(a);
    curvature.col(a) += N * end.H;
  }
  EXPECT_LT(velocity.norm(), 1e-9 * Q.norm());
  EXPECT_LT(curvature.norm(), 1e-11 * Ax.norm());
  EXPECT_GT(Q.norm(), 0.01 * Field(A * end.H).norm()) << "Q counts";
  EXPECT_LT(largest(end.x - mesh.nodes - tau * end.v), 1e-14);
}

// Q = (kappa_1 - kappa_2)²/2 H for the eigenvalues kappa_1, kappa_2, 0 of A_h.
TEST_P(BgnWillmoreSchemes, QIsThatOfTheWeingartenMap) {
  const Surface surface = ellipsoid(1, 0.8, 0.6);
  const Mesh fine = ellipsoid_mesh({1, 0.8, 0.6}, GetParam().degree, GetParam().degree == 1 ? 4 : 3);
  const SurfaceSpace fine_space(fine, GetParam().rule);
  Field H(fine.nodes.rows(), 1), exact(fine.nodes.rows(), 1);
  for (int j = 0; j < H.rows(); ++j) {
    const Mat3 A = surface.weingarten(fine.nodes.row(j));
    H(j, 0) = A.trace();
    exact(j, 0) = (A.squaredNorm() - H(j, 0) * H(j, 0) / 2) * H(j, 0);
  }
  const SymmetricMatrix M = mass_matrix(fine_space, fine.nodes);
  WeakWeingarten weingarten(fine_space);
  weingarten.compute(fine.nodes, H, M);
  Field Q;
  weingarten.assemble_Q(fine.nodes, H, Q);
  const double total = (M * exact).sum();
  EXPECT_NEAR(Q.sum(), total, 0.1 * total);
}

TEST_P(BgnWillmoreSchemes, OrientationDoesNotMatter) {
  Mesh turned = mesh;
  turned.elements.col(1).swap(turned.elements.col(2));
  if (mesh.degree == 2) turned.elements.col(3).swap(turned.elements.col(5));
  const State some = run(mesh, GetParam().rule, 1e-3, 5), other = run(turned, GetParam().rule, 1e-3, 5);
  EXPECT_LT(largest(some.x - other.x), 1e-11);
  EXPECT_LT(largest(some.H + other.H), 1e-9);
}

TEST_P(BgnWillmoreSchemes, EnergyOfAnEllipsoidDecreasesAndTheMeshStaysGood) {
  const Mesh flat = ellipsoid_mesh({1, 1, 0.6}, GetParam().degree, GetParam().degree == 1 ? 2 : 1);
  const SurfaceSpace flat_space(flat, GetParam().rule);
  BgnWillmoreFlow flow(flat_space);
  double old_energy = energy(flat, flat.nodes);
  EXPECT_GT(old_energy, 1.15 * 8 * pi);
  integrate(flow, {1, 0.01, 20, {}}, bgn_willmore_state_on(flat_space, flat.nodes),
            [&](int n, const State& now) {
              const double new_energy = energy(flat, now.x);
              EXPECT_LE(new_energy, old_energy + 1e-10) << "step " << n;
              EXPECT_GT(mesh_quality(flat.elements, now.x).min_angle, 25) << "step " << n;
              old_energy = new_energy;
            });
  EXPECT_NEAR(old_energy, 8 * pi, 0.15);
}

INSTANTIATE_TEST_SUITE_P(Schemes, BgnWillmoreSchemes, testing::Values(lumped, consistent, quadratic),
                         [](const auto& info) { return info.param.name; });

TEST(BgnWillmoreFlow, InitialStateIsThatOfTheDiscreteSurface) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, 1);
  const SurfaceSpace space(mesh);
  const State state = bgn_willmore_state_on(space, mesh.nodes);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  EXPECT_EQ(state.x, mesh.nodes);
  EXPECT_EQ(state.H, curvature.H());
  const Field V = state.v.cwiseProduct(curvature.nu()).rowwise().sum();
  EXPECT_LT(largest(state.v - V.col(0).asDiagonal() * curvature.nu()), 1e-12 * largest(V));
}

// The velocity of the discrete surface is rough: it converges weakly, here tested by nu_l x_l.
TEST(BgnWillmoreFlow, VelocityIsThatOfWillmoreFlowOnTheEllipsoid) {
  const std::string folder = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/";
  const nlohmann::json reference = read_json(folder + "willmore_assembly.json");
  const Mesh mesh = read_mesh(folder + reference["mesh"].get<std::string>()).mesh;
  const SurfaceSpace space(mesh);
  const State state = bgn_willmore_state_on(space, mesh.nodes);
  Field exact_V(mesh.nodes.rows(), 1), V(mesh.nodes.rows(), 1), nu(mesh.nodes.rows(), 3);
  for (int j = 0; j < V.rows(); ++j) {
    exact_V(j, 0) = reference["exact_w_willmore"][j][0].get<double>();
    for (int l = 0; l < 3; ++l) nu(j, l) = reference["exact_u"][j][1 + l].get<double>();
    V(j, 0) = state.v.row(j).dot(nu.row(j));
  }
  const SymmetricMatrix M = mass_matrix(space, mesh.nodes);
  for (int l = 0; l < 3; ++l) {
    const Field test = nu.col(l).cwiseProduct(mesh.nodes.col(l));
    const double exact = (M * exact_V).cwiseProduct(test).sum(), actual = (M * V).cwiseProduct(test).sum();
    EXPECT_NEAR(actual, exact, 0.1 * std::abs(exact)) << "x" << l + 1;
  }
}

TEST(BgnWillmoreFlow, OnlyTheFirstOrderIsThere) {
  const Mesh mesh = sphere_mesh(1, 1, 1);
  const SurfaceSpace space(mesh);
  BgnWillmoreFlow flow(space);
  try {
    last_state(flow, {2, 0.01, 2, parse_start("cascade")}, bgn_willmore_state_on(space, mesh.nodes));
    FAIL() << "BDF2 was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("BDF order 2: expected 1"));
  }
}

TEST(BgnWillmoreFlow, SphereStaysUpToTheErrorInSpace) {
  const auto error = [](const BgnScheme& scheme, int subdivisions) {
    return radius_error(run(sphere_mesh(1, scheme.degree, subdivisions), scheme.rule, 0.01, 10).x);
  };
  EXPECT_LT(error(lumped, 2), 4e-3);
  EXPECT_GE(order(error(lumped, 1), error(lumped, 2)), 1);
  EXPECT_LT(error(quadratic, 1), 2e-3);
  EXPECT_GE(order(error(quadratic, 0), error(quadratic, 1)), 3);
}

TEST(BgnWillmoreFlow, CliffordTorusStaysUpToTheErrorInSpace) {
  const auto change = [](double minor) {
    const Mesh mesh = torus_mesh(1, minor, 2, 14, 10);
    const SurfaceSpace space(mesh);
    const State end = run(mesh, quadratic.rule, 1e-3, 20);
    return std::pair(space.volume(end.x) - space.volume(mesh.nodes), energy(mesh, end.x));
  };
  const auto [volume_change, final_energy] = change(std::sqrt(0.5));
  EXPECT_LT(std::abs(volume_change), 0.02);
  EXPECT_NEAR(final_energy, 4 * pi * pi, 0.1);
  EXPECT_GT(std::abs(change(0.6).first), 0.06) << "another torus does not stay";
}

}  // namespace
}  // namespace esfem::test_bgn_willmore_flow
