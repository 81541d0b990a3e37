// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "solver/error.hpp"
#include "solver/flows/regularity.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_regularity {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// The message of the SingularityError; empty where the surface is regular.
std::string complaint(const SurfaceSpace& space, const Field& x, const Field& H) {
  try {
    require_regular(space, x, H);
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
  H(mesh.elements(named, 0), 0) = largest_curvature_size / longest_edge(named);
  int worst = named;
  for (int e = 0; e < space.element_count(); ++e) {
    const bool neighbour = (mesh.elements.row(e).array() == mesh.elements(named, 0)).any();
    if (neighbour && longest_edge(e) > longest_edge(worst)) worst = e;
  }
  H *= longest_edge(named) / longest_edge(worst);
  EXPECT_EQ(complaint(space, mesh.nodes, 0.999 * H), "");
  const std::string said = complaint(space, mesh.nodes, 1.001 * H);
  EXPECT_THAT(said, StartsWith(format("in element %d, |H| = ", worst)));
  EXPECT_THAT(said, HasSubstr("is 5.005; expected at most 5"));
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
    ASSERT_EQ(quality.min_radius_ratio >= smallest_radius_ratio, regular);
    ASSERT_LT(quality.min_radius_ratio, 10 * smallest_radius_ratio);
    const std::string said = format("element %d has radius ratio %g; expected at least 0.01",
                                    quality.worst_element, quality.min_radius_ratio);
    const Field flat = Field::Zero(needles.nodes.rows(), 1);
    EXPECT_EQ(complaint(SurfaceSpace(needles), needles.nodes, flat), regular ? "" : said);
  }
}

TEST(RequireNormal, BoundsTheLengthOfTheNormalBothWays) {
  const auto complains = [](double length) {
    Field nu = Field::Zero(5, 3);
    nu.col(1).setOnes();
    nu(3, 1) = length;
    try {
      require_normal(nu);
    } catch (const SingularityError& error) {
      EXPECT_THAT(error.what(), HasSubstr("at node 3, nu_h has length"));
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
  EXPECT_THAT(complaint(space, x, zero), StartsWith("element 17 is degenerate"));
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
    EXPECT_THAT(error.what(), StartsWith("on the extrapolated surface, element 17 is degenerate"));
  }
}

}  // namespace
}  // namespace esfem::test_regularity
