// SPDX-License-Identifier: GPL-3.0-or-later
// Identities of closed surfaces that hold for Gamma_h up to its order; the edge length is halved and the
// order asserted one-sidedly.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/assembly/surface_space.hpp"
#include "solver/constants.hpp"
#include "solver/surfaces/surface.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_identities {
namespace {

/// Integral over Gamma_h of a pointwise formula of the nodal field u.
template <int inputs, class Function>
double integral(const SurfaceSpace& space, const Field& x, const Field& u, const Function& function) {
  Field load;
  space.assemble_load<inputs, 1, 0>(
      x, u, [&](const PointData<inputs>& at, Integrand<1, 0>& out) { out.value[0] = function(at); }, load);
  return load.sum();
}

Pack divergence(const PointData<3>& at) {
  return at.grad[0][0] + at.grad[1][1] + at.grad[2][2];
}

/// kappa_1 kappa_2 = (tr(B)² - tr(B²))/2 of B = grad nu_h.
Pack gauss_curvature(const PointData<3>& nu) {
  Pack square = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) square += nu.grad[i][j] * nu.grad[j][i];
  return 0.5 * (divergence(nu) * divergence(nu) - square);
}

Field normals(const Surface& surface, const Field& x) {
  Field nu(x.rows(), 3);
  for (int j = 0; j < x.rows(); ++j) nu.row(j) = surface.normal(x.row(j));
  return nu;
}

class IdentitiesOfDegree : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, IdentitiesOfDegree, testing::Values(1, 2, 3, 4));

TEST_P(IdentitiesOfDegree, GaussBonnet) {
  const int k = GetParam(), coarse = k < 3 ? 2 : 1;
  double sphere_error[2], torus_error[2];
  for (int level = 0; level < 2; ++level) {
    const Mesh ball = ellipsoid_mesh({1, 0.9, 0.7}, k, coarse + level);
    sphere_error[level] = integral<3>(SurfaceSpace(ball), ball.nodes,
                                      normals(ellipsoid(1, 0.9, 0.7), ball.nodes), gauss_curvature) -
                          2 * pi * euler_characteristic(ball);
    const Mesh ring = torus_mesh(1, 0.5, k, 16 << level, 8 << level);
    torus_error[level] =
        integral<3>(SurfaceSpace(ring), ring.nodes, normals(torus(1, 0.5), ring.nodes), gauss_curvature) -
        2 * pi * euler_characteristic(ring);
  }
  EXPECT_LT(std::abs(sphere_error[1]), 0.1);
  EXPECT_GE(order(sphere_error[0], sphere_error[1]), k - 0.15);
  EXPECT_LT(std::abs(torus_error[1]), 0.1);
  // The symmetric P1 torus has the right integral exactly.
  if (k > 1) {
    EXPECT_GE(order(torus_error[0], torus_error[1]), k - 0.15);
  }
}

TEST_P(IdentitiesOfDegree, DivergenceOfThePositionIsTwo) {
  // On a sphere the interpolated normal is x/R, and div x = 2 holds on every surface: H = 2/R exactly.
  const double R = 2;
  const Mesh mesh = sphere_mesh(R, GetParam(), 1);
  integral<3>(SurfaceSpace(mesh), mesh.nodes, mesh.nodes / R, [&](const PointData<3>& nu) {
    const Pack H = divergence(nu);
    for (int lane = 0; lane < pack_size; ++lane) EXPECT_NEAR(H[lane], 2 / R, 1e-13);
    return H;
  });
}

TEST_P(IdentitiesOfDegree, DivergenceOfTheNormalIsTheMeanCurvature) {
  const int k = GetParam(), coarse = k < 3 ? 2 : 1;
  const Surface surface = ellipsoid(1, 0.9, 0.7);
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const Mesh mesh = ellipsoid_mesh({1, 0.9, 0.7}, k, coarse + level);
    const SurfaceSpace space(mesh);
    const Field nu = normals(surface, mesh.nodes);
    error[level] = std::sqrt(integral<3>(space, mesh.nodes, nu, [&](const PointData<3>& at) {
      Pack difference = divergence(at);
      for (int lane = 0; lane < pack_size; ++lane)
        difference[lane] -= surface.mean_curvature({at.x[0][lane], at.x[1][lane], at.x[2][lane]});
      return difference * difference;
    }));
  }
  EXPECT_LT(error[1], 0.5);
  EXPECT_GE(order(error[0], error[1]), k - 0.15);
}

TEST_P(IdentitiesOfDegree, SurfaceDivergenceTheorem) {
  const int k = GetParam(), coarse = k < 3 ? 2 : 1;
  for (const Vec3& axes : {Vec3(1, 1, 1), Vec3(1, 0.9, 0.7)}) {
    const Surface surface = ellipsoid(axes[0], axes[1], axes[2]);
    double error[2];
    for (int level = 0; level < 2; ++level) {
      const Mesh mesh = ellipsoid_mesh(axes, k, coarse + level);
      const SurfaceSpace space(mesh);
      const auto x1 = mesh.nodes.col(0).array(), x2 = mesh.nodes.col(1).array(),
                 x3 = mesh.nodes.col(2).array();
      Field w(mesh.nodes.rows(), 3), H_w_nu(mesh.nodes.rows(), 1);
      w << x1 + x2 * x3, x2.cube(), x1 * x3 + x3.exp();
      const Field nu = normals(surface, mesh.nodes);
      for (int j = 0; j < w.rows(); ++j)
        H_w_nu(j) = surface.mean_curvature(mesh.nodes.row(j)) * w.row(j).dot(nu.row(j));
      const double left = integral<3>(space, mesh.nodes, w, divergence);
      const double right =
          integral<1>(space, mesh.nodes, H_w_nu, [](const PointData<1>& at) { return at.u[0]; });
      ASSERT_GT(std::abs(left), 1);
      error[level] = left - right;
    }
    EXPECT_GE(order(error[0], error[1]), k - 0.15);
    EXPECT_LT(std::abs(error[1]), 0.2);
  }
}

TEST_P(IdentitiesOfDegree, RayleighQuotientOfASphericalHarmonic) {
  const int k = GetParam();
  const double R = 2;
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const Mesh mesh = sphere_mesh(R, k, 3 + level);
    const SurfaceSpace space(mesh);
    SymmetricMatrix M = space.matrix(), A = space.matrix();
    space.assemble(mesh.nodes, M, A);
    const Field xyz = mesh.nodes.rowwise().prod();
    error[level] = A.energy(xyz) / M.energy(xyz) - 12 / (R * R);
  }
  // The order of the geometry with equidistant nodes: k + 1, and one more for even k by symmetry.
  const double expected[] = {2, 4, 4, 6};
  EXPECT_GE(order(error[0], error[1]), expected[k - 1] - 0.15);
}

}  // namespace
}  // namespace esfem::test_identities
