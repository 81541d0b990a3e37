// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem {
namespace {

const double pi = std::acos(-1.0);

class SurfaceSpaceOfDegree : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degrees, SurfaceSpaceOfDegree, testing::Values(1, 2, 3, 4));

TEST_P(SurfaceSpaceOfDegree, MassOfOneIsTheArea) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, GetParam(), 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  const Field one = Field::Ones(space.dofs(), 1);
  EXPECT_NEAR((M * one).sum(), space.area(mesh.nodes), 1e-13 * space.area(mesh.nodes));
  EXPECT_NEAR(M.energy(one), space.area(mesh.nodes), 1e-13 * space.area(mesh.nodes));
}

TEST_P(SurfaceSpaceOfDegree, StiffnessOfConstantsIsZero) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, GetParam(), 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  EXPECT_LT((A * Field::Ones(space.dofs(), 1)).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_GT((A * mesh.nodes).cwiseAbs().maxCoeff(), 1e-2);
}

TEST_P(SurfaceSpaceOfDegree, AreaAndVolumeOfTheSphereConverge) {
  const int k = GetParam(), coarse = k < 3 ? 2 : 1;
  const double R = 2;
  double area_error[2], volume_error[2];
  for (int level = 0; level < 2; ++level) {
    const Mesh mesh = sphere_mesh(R, k, coarse + level);
    const SurfaceSpace space(mesh, conical_quadrature(8));
    area_error[level] = space.area(mesh.nodes) - 4 * pi * R * R;
    volume_error[level] = space.volume(mesh.nodes) - 4 * pi * R * R * R / 3;
  }
  // Even degrees gain an order by symmetry.
  const double expected = k % 2 == 0 ? k + 2 : k + 1;
  EXPECT_GE(order(area_error[0], area_error[1]), expected - 0.15);
  EXPECT_GE(order(volume_error[0], volume_error[1]), expected - 0.15);
}

TEST_P(SurfaceSpaceOfDegree, LoadsAgreeWithMatrices) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, GetParam(), 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix(), W = space.matrix();
  space.assemble(mesh.nodes, M, A);
  const Field u = (3 * mesh.nodes).array().sin();
  Field value_load, flux_load;
  space.assemble_load<3, 3, 0>(
      mesh.nodes, u,
      [](const PointData<3>& at, Integrand<3, 0>& out) {
        for (int l = 0; l < 3; ++l) out.value[l] = at.u[l];
      },
      value_load);
  space.assemble_load<3, 3, 3>(
      mesh.nodes, u,
      [](const PointData<3>& at, Integrand<3, 3>& out) {
        for (int l = 0; l < 3; ++l) {
          out.value[l] = Pack{};
          for (int i = 0; i < 3; ++i) out.flux[l][i] = at.grad[l][i];
        }
      },
      flux_load);
  EXPECT_LT((value_load - M * u).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LT((flux_load - A * u).cwiseAbs().maxCoeff(), 1e-12);
  space.assemble_weighted_mass<0>(
      mesh.nodes, Field(), [](const PointData<0>&) { return pack(1); }, W);
  EXPECT_LT((W.values - M.values).cwiseAbs().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace esfem
