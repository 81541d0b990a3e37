// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_discrete_curvature {
namespace {

/// L2 norms on the discrete surface of the differences to the exact surface's nodal values.
struct CurvatureErrors {
  double kappa, nu, H;
};

CurvatureErrors curvature_errors(const Surface& surface, const Mesh& mesh) {
  const SurfaceSpace space(mesh);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  const Field u = mean_curvature_state_on(surface, mesh.nodes).u;
  const Field nu = u.leftCols(3), H = u.col(3);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  const auto norm = [&](const Field& e) { return std::sqrt(M.energy(e)); };
  return {norm(curvature.kappa() - nu.cwiseProduct(H.replicate(1, 3))), norm(curvature.nu() - nu),
          norm(curvature.H() - H)};
}

/// Orders in h, where the second mesh halves the edges of the first.
CurvatureErrors orders(const Surface& surface, const Mesh& coarse, const Mesh& fine) {
  const CurvatureErrors some = curvature_errors(surface, coarse), others = curvature_errors(surface, fine);
  return {order(some.kappa, others.kappa), order(some.nu, others.nu), order(some.H, others.H)};
}

// On the torus P1, P2, P3 show -0.02, 1.5, 2.0 for kappa and H, 2.0, 2.0, 3.0 for nu: the orders k - 1 and k
// (P1 has one more for nu on this regular mesh).
TEST(DiscreteCurvature, HasOrderDegreeMinusOneOnATorus) {
  const Surface surface = torus(2, 0.8);
  const double tolerance = 0.1;
  for (int degree : {1, 2, 3}) {
    const CurvatureErrors found =
        orders(surface, torus_mesh(2, 0.8, degree, 48, 24), torus_mesh(2, 0.8, degree, 96, 48));
    EXPECT_GE(found.nu, degree - tolerance) << "P" << degree;
    EXPECT_GE(found.kappa, degree - 1 - tolerance) << "P" << degree;
    EXPECT_GE(found.H, degree - 1 - tolerance) << "P" << degree;
    if (degree == 1) {
      EXPECT_LT(found.H, 0.5) << "the curvature of P1 surfaces does not converge";
    }
  }
}

// On icospheres kappa and H have orders 1, 2, 2 for P1, P2, P3, nu has 1.4, 3.5, 3.0.
TEST(DiscreteCurvature, HasHigherOrdersOnASphere) {
  const double expected_H[] = {1, 2, 2}, expected_nu[] = {1, 3, 3}, tolerance = 0.1;
  for (int degree : {1, 2, 3}) {
    const CurvatureErrors found = orders(sphere(2), sphere_mesh(2, degree, 2), sphere_mesh(2, degree, 3));
    EXPECT_GE(found.nu, expected_nu[degree - 1] - tolerance) << "P" << degree;
    EXPECT_GE(found.kappa, expected_H[degree - 1] - tolerance) << "P" << degree;
    EXPECT_GE(found.H, expected_H[degree - 1] - tolerance) << "P" << degree;
  }
}

class CurvatureOfEllipsoid : public testing::TestWithParam<int> {
 protected:
  const Mesh mesh = ellipsoid_mesh({2, 1.5, 1.2}, GetParam(), 2);
  const SurfaceSpace space{mesh};
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  DiscreteCurvature curvature{space};

  void SetUp() override {
    space.assemble(mesh.nodes, M, A);
    curvature.compute(mesh.nodes);
  }
  /// The L2 product over the surface.
  double product(const Field& some, const Field& other) const { return some.cwiseProduct(M * other).sum(); }
};

TEST_P(CurvatureOfEllipsoid, KappaIsTheGradientOfTheArea) {
  const Field direction = (3 * mesh.nodes).array().sin() + 0.3 * mesh.nodes.array();
  const double step = 1e-5;
  const double derivative =
      (space.area(mesh.nodes + step * direction) - space.area(mesh.nodes - step * direction)) / (2 * step);
  EXPECT_NEAR(product(curvature.kappa(), direction), derivative, 1e-8 * derivative);
  EXPECT_GT(std::abs(product(curvature.H().asDiagonal() * curvature.nu(), direction) - derivative),
            1e-8 * derivative)
      << "its normal part alone is another vector";
}

TEST_P(CurvatureOfEllipsoid, KappaHasTheIntegralsOfACurvatureVector) {
  const double area = space.area(mesh.nodes);
  EXPECT_NEAR(product(curvature.kappa(), mesh.nodes), 2 * area, 1e-12 * area);
  EXPECT_LT((M * curvature.kappa()).colwise().sum().norm(), 1e-12);
}

TEST_P(CurvatureOfEllipsoid, AgreesWithTheOtherDiscreteNormalAndCurvature) {
  const Field u = discrete_mean_curvature_state(space, mesh.nodes).u;
  EXPECT_LT((curvature.nu() - u.leftCols(3)).cwiseAbs().maxCoeff(), 1e-13);
  // The divergence of the discrete normal is another approximation of H.
  const Field difference = curvature.H() - u.col(3);
  EXPECT_LT(std::sqrt(M.energy(difference)),
            (GetParam() == 1 ? 0.3 : 0.05) * std::sqrt(M.energy(curvature.H())));
  EXPECT_GT(difference.norm(), 1e-6);
}

TEST_P(CurvatureOfEllipsoid, FollowsScalingAndReflectionOfTheSurface) {
  const Field kappa = curvature.kappa(), nu = curvature.nu(), H = curvature.H();
  curvature.compute(2 * mesh.nodes);
  EXPECT_LT((curvature.kappa() - kappa / 2).norm(), 1e-12 * kappa.norm());
  EXPECT_LT((curvature.nu() - nu).norm(), 1e-12 * nu.norm());
  // Reflected in the origin the surface is inside out: its normals are the same vectors and point inward.
  curvature.compute(-mesh.nodes);
  EXPECT_LT((curvature.kappa() + kappa).norm(), 1e-12 * kappa.norm());
  EXPECT_LT((curvature.nu() - nu).norm(), 1e-12 * nu.norm());
  EXPECT_LT((curvature.H() + H).norm(), 1e-12 * H.norm());
}

INSTANTIATE_TEST_SUITE_P(Degrees, CurvatureOfEllipsoid, testing::Values(1, 2, 3));

/// The deviation of the exact nu and H in the nodes of a mesh on the surface.
double deviation_of_exact(const Surface& surface, const Mesh& mesh) {
  const SurfaceSpace space(mesh);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  const Field u = mean_curvature_state_on(surface, mesh.nodes).u;
  return curvature.deviation(u.leftCols(3), u.col(3));
}

// kappa of P1 surfaces does not converge, but smoothed over an edge length it does.
TEST(DiscreteCurvature, DeviationOfTheExactFieldsConverges) {
  const Surface surface = torus(2, 0.8);
  for (int degree : {1, 2}) {
    const double coarse = deviation_of_exact(surface, torus_mesh(2, 0.8, degree, 24, 12)),
                 fine = deviation_of_exact(surface, torus_mesh(2, 0.8, degree, 48, 24));
    EXPECT_LT(coarse, 0.1) << "P" << degree;
    EXPECT_GT(order(coarse, fine), 0.8) << "P" << degree;
  }
}

TEST(DiscreteCurvature, DeviationIsRelative) {
  const Mesh mesh = sphere_mesh(3, 2, 2);
  const SurfaceSpace space(mesh);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  const Field nu = mesh.nodes / 3, H = Field::Constant(space.dofs(), 1, 2. / 3);
  EXPECT_LT(curvature.deviation(nu, H), 0.01);
  EXPECT_NEAR(curvature.deviation(nu, 1.3 * H), 0.3, 0.01);
  EXPECT_NEAR(curvature.deviation(0.7 * nu, H), 0.3, 0.01);
  EXPECT_NEAR(curvature.deviation(nu, -H), 2, 0.01);
  EXPECT_LT(curvature.distance(curvature.nu(), curvature.H()), 1e-14);
  EXPECT_NEAR(curvature.distance(nu, 1.3 * H), 0.3, 0.02);
}

}  // namespace
}  // namespace esfem::test_discrete_curvature
