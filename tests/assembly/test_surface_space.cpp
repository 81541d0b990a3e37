// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/assembly/size.hpp"
#include "solver/assembly/surface_space.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_surface_space {
namespace {

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

TEST_P(SurfaceSpaceOfDegree, VolumeKeepsItsDigitsFarFromTheOrigin) {
  Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, GetParam(), 1);
  // Coordinates that stay exact far away.
  mesh.nodes = mesh.nodes.unaryExpr([](double x) { return std::ldexp(std::round(std::ldexp(x, 30)), -30); });
  const SurfaceSpace space(mesh);
  const double volume = space.volume(mesh.nodes), area = space.area(mesh.nodes);
  const Field far = mesh.nodes.rowwise() + Eigen::RowVector3d(1 << 20, -(1 << 19), 0);
  EXPECT_NEAR(space.volume(far) / volume, 1, 1e-10);
  EXPECT_NEAR(space.area(far) / area, 1, 1e-9);
  EXPECT_EQ(far_centre(mesh.nodes, space.length()), Vec3::Zero());
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
  space.assemble_weighted_stiffness<0>(
      mesh.nodes, Field(), [](const PointData<0>&) { return pack(1); }, W);
  EXPECT_LT((W.values - A.values).cwiseAbs().maxCoeff(), 1e-13);
}

TEST_P(SurfaceSpaceOfDegree, ResultsDoNotDependOnTheOrderOfElementsOrOnRotations) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, GetParam(), 1);
  Mesh reversed = mesh;
  reversed.elements = mesh.elements.colwise().reverse().eval();
  const SurfaceSpace space(mesh), reversed_space(reversed);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  SymmetricMatrix reversed_M = reversed_space.matrix(), reversed_A = reversed_space.matrix();
  space.assemble(mesh.nodes, M, A);
  const Mat3 rotation = Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  reversed_space.assemble(mesh.nodes * rotation, reversed_M, reversed_A);
  EXPECT_LT((M.values - reversed_M.values).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((A.values - reversed_A.values).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SurfaceSpace, ResultsDoNotDependOnTheFirstCornerOfAnElement) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, 1);
  Mesh turned = mesh;
  for (int e = 0; e < mesh.elements.rows(); e += 2)
    for (int a = 0; a < 3; ++a) {
      turned.elements(e, a) = mesh.elements(e, (a + 1) % 3);
      turned.elements(e, 3 + a) = mesh.elements(e, 3 + (a + 1) % 3);
    }
  const SurfaceSpace space(mesh), turned_space(turned);
  SymmetricMatrix M = space.matrix(), A = space.matrix(), turned_M = turned_space.matrix(),
                  turned_A = turned_space.matrix();
  space.assemble(mesh.nodes, M, A);
  turned_space.assemble(mesh.nodes, turned_M, turned_A);
  EXPECT_LT((M.values - turned_M.values).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LT((A.values - turned_A.values).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(SurfaceSpace, TooWeakQuadratureLosesTheOrder) {
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const Mesh mesh = sphere_mesh(2, 2, 2 + level);
    error[level] = SurfaceSpace(mesh, symmetric_quadrature(1)).area(mesh.nodes) - 16 * pi;
  }
  EXPECT_LT(order(error[0], error[1]), 2.5);
}

TEST(SurfaceSpace, WeightedMassAgreesWithTheLoadOfTheProduct) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix W = space.matrix();
  const Field u = mesh.nodes.leftCols(2);
  auto weight = [](const PointData<2>& at) { return at.u[0] * at.x[2] + dot(at.grad[1], at.normal) + 2.0; };
  space.assemble_weighted_mass<2>(mesh.nodes, u, weight, W);
  Field load;
  space.assemble_load<2, 1, 0>(
      mesh.nodes, u,
      [&](const PointData<2>& at, Integrand<1, 0>& out) { out.value[0] = weight(at) * at.u[1]; }, load);
  EXPECT_LT((W * u.col(1) - load).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SurfaceSpace, WeightedMassesInOnePassAreThoseOfOnePassEach) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix both[2] = {space.matrix(), space.matrix()}, W = space.matrix();
  const auto weights = [](const PointData<3>& at, Pack* weight) {
    weight[0] = at.u[0] * at.x[2];
    weight[1] = at.grad[1][1] + 2.0;
  };
  space.assemble_weighted_masses<3>(mesh.nodes, mesh.nodes, weights, both);
  for (int l = 0; l < 2; ++l) {
    const auto one = [&](const PointData<3>& at) {
      Pack weight[2];
      weights(at, weight);
      return weight[l];
    };
    space.assemble_weighted_mass<3>(mesh.nodes, mesh.nodes, one, W);
    EXPECT_LT((both[l].values - W.values).cwiseAbs().maxCoeff(), 1e-15) << l;
  }
}

TEST(SurfaceSpace, WeightedStiffnessAgreesWithTheLoadOfTheFlux) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix W = space.matrix();
  const Field u = mesh.nodes.leftCols(2);
  auto weight = [](const PointData<2>& at) { return at.u[0] * at.x[2] + 2.0; };
  space.assemble_weighted_stiffness<2>(mesh.nodes, u, weight, W);
  Field load;
  const auto flux = [&](const PointData<2>& at, Integrand<1, 1>& out) {
    out.value[0] = Pack{};
    for (int i = 0; i < 3; ++i) out.flux[0][i] = weight(at) * at.grad[1][i];
  };
  space.assemble_load<2, 1, 1>(mesh.nodes, u, flux, load);
  EXPECT_LT((W * u.col(1) - load).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((W * Field::Ones(space.dofs(), 1)).cwiseAbs().maxCoeff(), 1e-13);
  double sum = 0;
  for (int i = 0; i < space.dofs(); ++i)
    sum += (W * Field(Field::Identity(space.dofs(), space.dofs()).col(i)))(i);
  EXPECT_NEAR(W.trace(), sum, 1e-11);
}

TEST(SurfaceSpace, PointDataIsConsistent) {
  const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, 1);
  const SurfaceSpace space(mesh);
  auto check = [&](const PointData<3>& at, Integrand<1, 0>& out) {
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < pack_size; ++lane) {
        EXPECT_NEAR(at.u[i][lane], at.x[i][lane], 1e-15);
        EXPECT_NEAR(dot(at.normal, at.normal)[lane], 1, 1e-14);
        // The tangential gradient of the position is the projection I - n nᵀ.
        for (int j = 0; j < 3; ++j)
          EXPECT_NEAR(at.grad[i][j][lane], (i == j) - at.normal[i][lane] * at.normal[j][lane], 1e-13);
      }
    out.value[0] = dot(at.x, at.normal);
  };
  Field load;
  space.assemble_load<3, 1, 0>(mesh.nodes, mesh.nodes, check, load);
  EXPECT_NEAR(load.sum(), 3 * space.volume(mesh.nodes), 1e-13) << "the normal is outward";
  EXPECT_GT(load.sum(), 1);
}

TEST(SurfaceSpace, FieldsOfAnotherSizeAreRefused) {
  const Mesh mesh = icosphere(1, 1);
  const SurfaceSpace space(mesh), other(icosphere(1, 0));
  SymmetricMatrix M = space.matrix(), A = other.matrix();
  EXPECT_THROW(space.area(mesh.nodes.topRows(12)), InputError);
  EXPECT_THROW(space.area(mesh.nodes.leftCols(2)), InputError);
  EXPECT_THROW(space.assemble(mesh.nodes, M, A), InputError);
}

}  // namespace
}  // namespace esfem::test_surface_space
