// SPDX-License-Identifier: GPL-3.0-or-later
// Initial values of the mean curvature flow on curved elements: their orders on smooth surfaces as an STL
// file has them.
#include <gmock/gmock.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/mesh/curve.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/read.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/mesh/test_folder.hpp"

namespace esfem::test_start_on_curved_elements {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// The mesh as a binary STL file keeps it: triangles with single precision.
Mesh through_stl(const Mesh& mesh, const std::string& file) {
  std::string bytes(84, ' ');
  const auto append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const std::uint32_t triangles = std::uint32_t(mesh.elements.rows());
  bytes.replace(80, 4, reinterpret_cast<const char*>(&triangles), 4);
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    for (int l = 0; l < 3; ++l) append(0.0f);
    for (int i = 0; i < 3; ++i)
      for (int l = 0; l < 3; ++l) append(float(mesh.nodes(mesh.elements(e, i), l)));
    append(std::uint16_t(0));
  }
  std::ofstream(file, std::ios::binary) << bytes;
  return read_mesh(file).mesh;
}

struct Errors {
  double nu, H, max_H;                ///< L2, L2, largest at a node
  double area, energy, kappa_energy;  ///< relative; W(H) and 1/2 int |kappa|²
};

struct Reference {
  double area, energy;
};

Reference reference(const Surface& surface, const Mesh& corners) {
  Mesh mesh = lagrange_mesh(corners, 3);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  return {space.area(mesh.nodes), 0.5 * M.energy(mean_curvature_state_on(surface, mesh.nodes).u.col(3))};
}

/// Of the initial values that a flow computes on the discrete surface.
Errors errors(const Surface& surface, const Mesh& mesh, const Reference& right) {
  const SurfaceSpace space(mesh);
  const Field u = discrete_mean_curvature_state(space, mesh.nodes).u;
  Mesh projected = mesh;
  project_nodes(projected, surface);
  const Field off = u - mean_curvature_state_on(surface, projected.nodes).u;
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  return {std::sqrt(M.energy(off.leftCols(3))),
          std::sqrt(M.energy(off.col(3))),
          off.col(3).cwiseAbs().maxCoeff(),
          space.area(mesh.nodes) / right.area - 1,
          0.5 * M.energy(u.col(3)) / right.energy - 1,
          curvature.willmore_energy() / right.energy - 1};
}

/// Names of the quantities that do not converge from a mesh to one of half the edge length.
std::string not_converging(const Errors& coarse, const Errors& fine) {
  std::string names;
  // Integrals have errors of both signs: below the floor their order says nothing.
  const auto check = [&](const char* name, double some, double other, double least_order, double floor) {
    if (!(std::abs(other) <= std::max(floor, std::abs(some) / std::pow(2, least_order))))
      names += std::string(" ") + name + format(" %.1e %.1e", some, other);
  };
  check("nu", coarse.nu, fine.nu, 1.8, 0);
  check("H", coarse.H, fine.H, 1, 0);
  check("max_H", coarse.max_H, fine.max_H, 0.8, 0);
  check("area", coarse.area, fine.area, 2, 1e-5);
  check("energy", coarse.energy, fine.energy, 1.5, 1e-5);
  check("kappa_energy", coarse.kappa_energy, fine.kappa_energy, 2, 1e-5);
  return names;
}

/// Quadratic elements through normals in the corners: a middle node where the cubic between two corners has
/// it. weight(a, b) of the corner between the edges a and b.
template <class Weight>
Mesh curved_by_normals(const Mesh& flat, const Weight& weight) {
  Field normals = Field::Zero(flat.nodes.rows(), 3);
  const auto x = [&](int e, int i) { return Vec3(flat.nodes.row(flat.elements(e, i % 3))); };
  for (int e = 0; e < flat.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = x(e, i + 1) - x(e, i), b = x(e, i + 2) - x(e, i);
      normals.row(flat.elements(e, i)) += weight(a, b) * a.cross(b).transpose();
    }
  normals.rowwise().normalize();
  Mesh mesh = lagrange_mesh(flat, 2);
  for (int e = 0; e < flat.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) {
      const Vec3 edge = x(e, i + 1) - x(e, i), n = normals.row(flat.elements(e, i)),
                 m = normals.row(flat.elements(e, (i + 1) % 3));
      mesh.nodes.row(mesh.elements(e, 3 + i)) = x(e, i) + edge / 2 + (edge.dot(m) * m - edge.dot(n) * n) / 8;
    }
  return mesh;
}

struct Case {
  Surface surface;
  double h;
};

class Curve : public Folder, public testing::WithParamInterface<int> {
 protected:
  const Case& surface_case() const {
    static const Case cases[] = {{sphere(1), 0.42}, {ellipsoid(2, 1.5, 1.2), 0.42}, {torus(2, 0.8), 0.5}};
    return cases[GetParam()];
  }
};

// nu, H, area and energies on unstructured meshes. Measured orders of nu 3.7, 2.0, 2.1, of H in L2 2.6, 1.7,
// 1.3, of max |H| 2.6, 1.4, 1.0 (sphere, ellipsoid, torus): the interpolant's.
TEST_P(Curve, ConvergesOnSmoothSurfacesReadFromStl) {
  const auto& [surface, h] = surface_case();
  const Mesh coarse = through_stl(generate_mesh(surface, h), path("coarse.stl")),
             fine = through_stl(generate_mesh(surface, h / 2), path("fine.stl"));
  const Reference right = reference(surface, fine);
  const CurvedMesh curved = curved_mesh(fine, 2);
  EXPECT_EQ(curved.straight, 0);
  EXPECT_EQ(curved.sharp_edges, 0);
  const Errors some = errors(surface, curved_mesh(coarse, 2).mesh, right),
               others = errors(surface, curved.mesh, right);
  EXPECT_EQ(not_converging(some, others), "");
  EXPECT_LT(std::abs(others.energy), 1e-3);
  EXPECT_LT(std::abs(others.kappa_energy), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(SphereEllipsoidTorus, Curve, testing::Range(0, 3));

/// What does not converge on unstructured meshes of the unit sphere that `curve` makes elements of.
template <class Function>
std::string not_converging_on_a_sphere(const Function& curve) {
  const Surface surface = sphere(1);
  const Mesh coarse = generate_mesh(surface, 0.42), fine = generate_mesh(surface, 0.21);
  const Reference right = {4 * pi, 8 * pi};
  return not_converging(errors(surface, curve(coarse), right), errors(surface, curve(fine), right));
}

TEST(CurvedMesh, IsBetterThanStraightEdgesAndNormalsWeightedByArea) {
  EXPECT_EQ(not_converging_on_a_sphere([](const Mesh& flat) { return curved_mesh(flat, 2).mesh; }), "");
  EXPECT_THAT(not_converging_on_a_sphere([](const Mesh& flat) { return lagrange_mesh(flat, 2); }),
              AllOf(HasSubstr(" H "), HasSubstr("max_H"), HasSubstr("kappa_energy")));
  EXPECT_THAT(not_converging_on_a_sphere([](const Mesh& flat) {
                return curved_by_normals(flat, [](const Vec3&, const Vec3&) { return 1; });
              }),
              AllOf(HasSubstr(" H "), HasSubstr("max_H"), HasSubstr("kappa_energy")));
}

TEST(CurvedMesh, HasTheOrdersOfCubicElements) {
  const Surface surface = sphere(1);
  const auto errors_of = [&](double edge_length) {
    return errors(surface, curved_mesh(generate_mesh(surface, edge_length), 3).mesh, {4 * pi, 8 * pi});
  };
  const Errors some = errors_of(0.42), others = errors_of(0.21);
  EXPECT_GT(order(some.nu, others.nu), 2.8);
  EXPECT_GT(order(some.H, others.H), 1.8);
}

TEST(CurvedMesh, HasTheCurvatureOfASphereOn320Triangles) {
  const Mesh mesh = curved_mesh(icosphere(1, 2), 2).mesh;
  const SurfaceSpace space(mesh);
  const Field H = discrete_mean_curvature_state(space, mesh.nodes).u.col(3);
  DiscreteCurvature curvature(space);
  curvature.compute(mesh.nodes);
  EXPECT_NEAR(H.maxCoeff(), 2, 0.1);
  EXPECT_NEAR(H.minCoeff(), 2, 0.1);
  EXPECT_NEAR(curvature.willmore_energy(), 8 * pi, 0.02 * 8 * pi);
}

}  // namespace
}  // namespace esfem::test_start_on_curved_elements
