// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/assembly/surface_space.hpp"
#include "solver/mesh/read.hpp"
#include "solver/mesh/refine.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem::test_refine {
namespace {

/// A curved mesh: the elements are not flat, and no two of them alike.
Mesh curved(int degree) {
  Mesh mesh = lagrange_mesh(icosphere(1, 1), degree);
  project_nodes(mesh, sphere(1));
  mesh.nodes.col(0) += 0.1 * mesh.nodes.col(1).cwiseProduct(mesh.nodes.col(2));
  return mesh;
}

TEST(Refine, KeepsTheSurface) {
  for (int degree = 1; degree <= 4; ++degree)
    for (int times : {0, 1, 2}) {
      const Mesh mesh = curved(degree);
      RefinedMesh refined = refine(mesh, times);
      EXPECT_EQ(refined.mesh.degree, degree);
      EXPECT_EQ(refined.mesh.elements.rows(), mesh.elements.rows() << (2 * times));
      EXPECT_EQ(check_closed_surface(refined.mesh, "refined"), "");
      // A rule that is exact for the volume, a polynomial.
      const Quadrature rule = symmetric_quadrature(12);
      const double before = SurfaceSpace(mesh, rule).volume(mesh.nodes),
                   after = SurfaceSpace(refined.mesh, rule).volume(refined.mesh.nodes);
      EXPECT_NEAR(after, before, 1e-12) << degree;
    }
}

TEST(Refine, NodalValuesAreThoseOfTheSameFunction) {
  const Mesh mesh = curved(3);
  const RefinedMesh refined = refine(mesh, 2);
  // The coordinates are functions of the mesh.
  EXPECT_LT((refined_values(mesh, mesh.nodes, refined) - refined.mesh.nodes).norm(), 1e-13);
  const Mesh corners = corner_mesh(mesh);
  EXPECT_LT((refined.mesh.nodes.topRows(corners.nodes.rows()) - corners.nodes).norm(), 1e-13);
}

}  // namespace
}  // namespace esfem::test_refine
