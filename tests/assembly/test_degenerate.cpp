// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_degenerate {
namespace {

using testing::HasSubstr;

/// What `area`, `assemble` and `assemble_load` say about x; all must say the same.
std::string complaint(const SurfaceSpace& space, const Field& x) {
  std::string said[3];
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  Field load;
  auto one = [](const PointData<0>&, Integrand<1, 0>& out) { out.value[0] = pack(1); };
  const std::function<void()> calls[] = {[&] { space.area(x); }, [&] { space.assemble(x, M, A); },
                                         [&] { space.assemble_load<0, 1, 0>(x, Field(), one, load); }};
  for (int i = 0; i < 3; ++i) try {
      calls[i]();
    } catch (const NumericsError& error) {
      said[i] = error.what();
    }
  EXPECT_EQ(said[0], said[1]);
  EXPECT_EQ(said[0], said[2]);
  return said[0];
}

/// An element after the first batch and, of its P2 edge nodes, one whose other element has a larger number.
struct Place {
  int element, corner, edge_node;
};
Place a_place(const Mesh& mesh) {
  for (int e = 17; e < mesh.elements.rows(); ++e)
    for (int edge = 0; edge < 3; ++edge) {
      const int node = mesh.elements(e, 3 + edge);
      if ((mesh.elements.topRows(e).array() == node).any()) continue;
      return {e, mesh.elements(e, (edge + 2) % 3), node};
    }
  throw std::logic_error("no such element");
}

class Degenerate : public testing::Test {
 protected:
  const Mesh mesh = sphere_mesh(1, 2, 1);
  const SurfaceSpace space{mesh};
  const Place place = a_place(mesh);
  const std::string named = format("element %d (counted from 1", place.element + 1);
};

TEST_F(Degenerate, FoldedElementIsNamed) {
  Field x = mesh.nodes;
  // The edge's node is drawn beyond the opposite corner: the quadratic map turns over.
  x.row(place.edge_node) = 2 * mesh.nodes.row(place.corner) - mesh.nodes.row(place.edge_node);
  EXPECT_THAT(complaint(space, x), HasSubstr(named));
}

TEST_F(Degenerate, SlightlyMovedNodesAreFine) {
  Field x = mesh.nodes;
  x.row(place.edge_node) = 0.9 * mesh.nodes.row(place.edge_node) + 0.1 * mesh.nodes.row(place.corner);
  EXPECT_EQ(complaint(space, x), "");
}

TEST_F(Degenerate, NonFinitePositionsAreNamed) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (int component = 0; component < 3; ++component) {
      Field x = mesh.nodes;
      x(place.edge_node, component) = value;
      EXPECT_THAT(complaint(space, x), HasSubstr(named));
    }
}

TEST_F(Degenerate, TheSpaceIsUsableAfterwards) {
  const double area = space.area(mesh.nodes);
  Field x = mesh.nodes;
  x(place.edge_node, 0) = std::nan("");
  EXPECT_THROW(space.area(x), NumericsError);
  EXPECT_EQ(space.area(mesh.nodes), area);
}

TEST(DegenerateP1, CollapsedElementIsNamed) {
  const Mesh mesh = icosphere(1, 1);
  const SurfaceSpace space(mesh);
  const int from = mesh.elements(17, 0), onto = mesh.elements(17, 1);
  int first = 0;
  while (
      !((mesh.elements.row(first).array() == from).any() && (mesh.elements.row(first).array() == onto).any()))
    ++first;
  for (const double distance : {0.0, 1e-12}) {
    Field x = mesh.nodes;
    x.row(from) = (1 - distance) * mesh.nodes.row(onto) + distance * mesh.nodes.row(from);
    EXPECT_THAT(complaint(space, x), AllOf(HasSubstr(format("element %d (counted from 1", first + 1)),
                                           HasSubstr("is degenerate: Jacobian")));
  }
  Field thin = mesh.nodes;
  thin.row(from) = 0.999 * mesh.nodes.row(onto) + 0.001 * mesh.nodes.row(from);
  EXPECT_EQ(complaint(space, thin), "");
}

TEST(DegenerateP1, ScaleDoesNotMatter) {
  const Mesh mesh = icosphere(1, 1);
  const SurfaceSpace space(mesh);
  for (const double scale : {1e-8, 1e8}) {
    EXPECT_EQ(complaint(space, scale * mesh.nodes), "");
    EXPECT_NEAR(space.area(scale * mesh.nodes), scale * scale * space.area(mesh.nodes),
                1e-13 * scale * scale * 13);
  }
}

}  // namespace
}  // namespace esfem::test_degenerate
