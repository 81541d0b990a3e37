// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "solver/error.hpp"
#include "solver/geometry/regularity.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_regularity {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The message of the SingularityError; empty where the surface is regular.
std::string complaint(const SurfaceSpace& space, const Field& x, const Field& H,
                      const RegularityLimits& limits = {}) {
  try {
    require_regular(space, x, H, limits);
  } catch (const SingularityError& error) {
    return error.what();
  }
  return "";
}

/// A triaxial ellipsoid, so that no two elements around a node are of the same size.
class Regularity : public testing::Test {
 protected:
  const Mesh mesh = ellipsoid_mesh({1, 1.1, 1.3}, 2, 1);
  const SurfaceSpace space{mesh};
  const Field zero = Field::Zero(space.dofs(), 1);

  double longest_edge(int element) const { return mesh_quality(mesh.elements.row(element), mesh.nodes).h; }
};

TEST_F(Regularity, CurvatureTimesEdgeLengthIsBounded) {
  const int named = 17;
  Field H = zero;
  H(mesh.elements(named, 0), 0) = 5 / longest_edge(named);
  int worst = named;
  for (int e = 0; e < space.element_count(); ++e) {
    const bool neighbour = (mesh.elements.row(e).array() == mesh.elements(named, 0)).any();
    if (neighbour && longest_edge(e) > longest_edge(worst)) worst = e;
  }
  H *= longest_edge(named) / longest_edge(worst);
  EXPECT_EQ(complaint(space, mesh.nodes, 0.999 * H), "");
  const std::string said = complaint(space, mesh.nodes, 1.001 * H);
  EXPECT_THAT(said, StartsWith(format("in element %d (counted from 1, around (", worst + 1)));
  EXPECT_THAT(said, HasSubstr("is 5.005; expected at most 5"));
  RegularityLimits wider;
  wider.curvature_size = 6;
  EXPECT_EQ(complaint(space, mesh.nodes, 1.001 * H, wider), "");
}

TEST_F(Regularity, CurvatureCountsByItsLengthWhateverItsSign) {
  Field H = zero;
  H(mesh.elements(17, 0), 0) = 1e3;
  const std::string said = complaint(space, mesh.nodes, H);
  EXPECT_THAT(said, HasSubstr("|H| = 1000"));
  EXPECT_EQ(complaint(space, mesh.nodes, -H), said);
  const Vec3 direction = Vec3(2, -1, 2) / 3;
  EXPECT_EQ(complaint(space, mesh.nodes, H * direction.transpose()), said);
}

TEST_F(Regularity, RadiusRatioIsBounded) {
  // A node comes close to its neighbour: two elements become needles.
  const Mesh sound = corner_mesh(mesh);
  const int from = sound.elements(17, 0), onto = sound.elements(17, 1);
  for (const auto& [distance, regular] : {std::pair{3e-3, false}, std::pair{3e-2, true}}) {
    Mesh needles = sound;
    needles.nodes.row(from) = (1 - distance) * sound.nodes.row(onto) + distance * sound.nodes.row(from);
    const MeshQuality quality = mesh_quality(needles.elements, needles.nodes);
    ASSERT_EQ(quality.min_radius_ratio >= 0.01, regular);
    ASSERT_LT(quality.min_radius_ratio, 0.1);
    const Field flat = Field::Zero(needles.nodes.rows(), 1);
    const std::string said = complaint(SurfaceSpace(needles), needles.nodes, flat);
    if (regular) {
      EXPECT_EQ(said, "");
      continue;
    }
    EXPECT_THAT(said, StartsWith(format("element %d (counted from 1, around (", quality.worst_element + 1)));
    EXPECT_THAT(said,
                HasSubstr(format("has radius ratio %g; expected at least 0.01", quality.min_radius_ratio)));
  }
}

TEST(RequireNormal, BoundsTheLengthOfTheNormalBothWays) {
  const auto complains = [](double length) {
    Field nu = Field::Zero(5, 3), x = Field::Zero(5, 3);
    nu.col(1).setOnes();
    nu(3, 1) = length;
    x.row(3) << 1, 2, 3;
    try {
      require_normal(x, nu, {});
    } catch (const SingularityError& error) {
      EXPECT_THAT(error.what(), HasSubstr("at node 4 (counted from 1, at (1, 2, 3)), nu_h has length"));
      return true;
    }
    return false;
  };
  EXPECT_FALSE(complains(-1));
  EXPECT_FALSE(complains(3.9));
  EXPECT_TRUE(complains(4.1));
  EXPECT_FALSE(complains(0.26));
  EXPECT_TRUE(complains(0.24));
}

TEST(RequireBounded, NamesFieldValueAndNode) {
  RegularityLimits limits;
  Field x = Field::Zero(5, 3), u = Field::Ones(5, 2);
  const auto complaint_about = [&](const Field& u) {
    try {
      require_bounded("u", x, u, limits);
    } catch (const SingularityError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  u(2, 1) = -4.7e22;
  EXPECT_EQ(complaint_about(u), "") << "without a limit all but what is not a number is fine";
  limits.field_size = 1000;
  EXPECT_EQ(complaint_about(u),
            "u2 = -4.7e+22 at node 3 (counted from 1, at (0, 0, 0)); expected at most 1000 in size");
  EXPECT_THAT(complaint_about(u.col(1)), StartsWith("u = -4.7e+22 at node 3"));
  u(2, 1) = 999;
  EXPECT_EQ(complaint_about(u), "");
  u(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(complaint_about(u), StartsWith("u1 = "));
}

TEST_F(Regularity, WhatTheStartHasItselfIsNoSingularity) {
  const Mesh fine = ellipsoid_mesh({1, 1.1, 1.3}, 2, 2);
  const RegularityLimits defaults, smooth = limits_from_start(SurfaceSpace(fine), fine.nodes);
  EXPECT_EQ(smooth.curvature_size, defaults.curvature_size);
  EXPECT_EQ(smooth.radius_ratio, defaults.radius_ratio);
  EXPECT_EQ(smooth.normal_length, defaults.normal_length);

  // An octahedron: |kappa| times the edge is 5.66 in its corners.
  const Mesh corners = octasphere(1, 0);
  const SurfaceSpace octahedron(corners);
  const RegularityLimits rough = limits_from_start(octahedron, corners.nodes);
  EXPECT_NEAR(rough.curvature_size, 4 * 4 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(rough.radius_ratio, defaults.radius_ratio);
  EXPECT_NEAR(limits_from_start(octahedron, 1e-6 * corners.nodes).curvature_size, rough.curvature_size, 1e-9);

  const Mesh sound = corner_mesh(mesh);
  const int from = sound.elements(17, 0), onto = sound.elements(17, 1);
  for (const double distance : {3e-3, 3e-2}) {
    Mesh needles = sound;
    needles.nodes.row(from) = (1 - distance) * sound.nodes.row(onto) + distance * sound.nodes.row(from);
    const double ratio = mesh_quality(needles.elements, needles.nodes).min_radius_ratio;
    EXPECT_NEAR(limits_from_start(SurfaceSpace(needles), needles.nodes).radius_ratio,
                ratio < 0.01 ? 0 : ratio * ratio, 1e-15);
  }
}

/// The node of an edge is drawn beyond the opposite corner: the quadratic map of element 17 turns over, and
/// the corners do not show it.
Field folded(const Mesh& mesh) {
  Field x = mesh.nodes;
  x.row(mesh.elements(17, 3)) =
      2 * mesh.nodes.row(mesh.elements(17, 2)) - mesh.nodes.row(mesh.elements(17, 3));
  return x;
}

TEST_F(Regularity, FoldedElementIsNamed) {
  const Field x = folded(mesh);
  EXPECT_EQ(mesh_quality(mesh.elements, x).min_radius_ratio,
            mesh_quality(mesh.elements, mesh.nodes).min_radius_ratio);
  EXPECT_THAT(complaint(space, x, zero), StartsWith("element 18 (counted from 1, near ("));
  EXPECT_EQ(complaint(space, mesh.nodes, zero), "");
}

TEST_F(Regularity, WhatIsNotFiniteIsLeftToTheTimeLoop) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Field x = folded(mesh);
  EXPECT_NE(complaint(space, x, zero), "");
  x(0, 0) = nan;
  EXPECT_EQ(complaint(space, x, zero), "");
  EXPECT_EQ(complaint(space, folded(mesh), Field::Constant(space.dofs(), 1, nan)), "");
}

TEST_F(Regularity, FoldedExtrapolationIsASingularityAndNamed) {
  SymmetricMatrix M = space.matrix(), A = space.matrix(), expected_M = M, expected_A = A;
  assemble_regular(space, mesh.nodes, M, A);
  space.assemble(mesh.nodes, expected_M, expected_A);
  EXPECT_EQ(M.values, expected_M.values);
  EXPECT_EQ(A.values, expected_A.values);
  try {
    assemble_regular(space, folded(mesh), M, A);
    FAIL() << "a folded element is no singularity";
  } catch (const SingularityError& error) {
    EXPECT_THAT(error.what(), StartsWith("on the extrapolated surface, element 18 (counted from 1, near ("));
  }
}

}  // namespace
}  // namespace esfem::test_regularity
