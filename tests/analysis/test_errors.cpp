// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/diagnostics.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/constants.hpp"

namespace esfem::test_errors {
namespace {

/// Position, normal and a constant on a fixed surface, as an "evolution".
ExactEvolution still(const Surface& surface) {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"nu", 3}, {"one", 1}};
  exact.surface = [surface](double) { return surface; };
  exact.trajectories = [](const Field& x0, double) { return x0; };
  exact.fields = [](double, const Vec3& y, const Surface::Shape& shape, Eigen::VectorXd& value,
                    Eigen::MatrixXd& gradient) {
    value << y, shape.normal, 1;
    gradient << Mat3::Identity() - shape.normal * shape.normal.transpose(), shape.weingarten, Vec3::Zero();
  };
  return exact;
}

Mesh curved(const Surface& surface, const Mesh& coarse, int degree) {
  Mesh mesh = lagrange_mesh(coarse, degree);
  project_nodes(mesh, surface);
  return mesh;
}

Mesh stretched_icosphere(int subdivisions) {
  Mesh mesh = icosphere(1, subdivisions);
  mesh.nodes.col(2) *= 0.6;
  return mesh;
}

/// Area of the ellipsoid (1, 1, 0.6), from its closed form.
double oblate_area() {
  const double c = 0.6, e = std::sqrt(1 - c * c);
  return 2 * pi * (1 + c * c / e * std::atanh(e));
}

TEST(LiftedErrors, OfZeroAreTheNormsOnTheExactSurface) {
  // Known by closed forms: the area from the constant 1, twice the area from |grad id|² = |P|² = 2.
  const Surface surface = ellipsoid(1, 1, 0.6);
  for (int degree : {1, 2, 3}) {
    const Mesh mesh = curved(surface, stretched_icosphere(3), degree);
    const SurfaceSpace space(mesh, conical_quadrature(6));
    const SquaredNorms norms =
        lifted_errors(space, mesh.nodes, still(surface), 0, Field::Zero(space.dofs(), 7));
    EXPECT_NEAR(norms.L2[6], oblate_area(), 1e-8) << degree;
    EXPECT_EQ(norms.H1_semi[6], 0);
    EXPECT_NEAR(norms.H1_semi.head(3).sum(), 2 * oblate_area(), 1e-8) << degree;
    EXPECT_NEAR(norms.L2.segment(3, 3).sum(), oblate_area(), 1e-8) << degree;
  }
  // The discrete surface alone is further away: without the lift this accuracy is missed.
  const Mesh mesh = curved(surface, stretched_icosphere(3), 2);
  EXPECT_GT(std::abs(SurfaceSpace(mesh).area(mesh.nodes) - oblate_area()), 1e-7);
}

TEST(LiftedErrors, OfTheInterpolationHaveTheOrdersOfInterpolation) {
  const Surface surface = ellipsoid(1, 1, 0.6);
  for (int degree : {1, 2, 3, 4}) {
    double L2[2], H1_semi[2], h[2];
    for (int i : {0, 1}) {
      const Mesh mesh = curved(surface, stretched_icosphere(i + 2), degree);
      const SurfaceSpace space(mesh);
      const ExactEvolution exact = still(surface);
      const Field w = exact.nodal_values(mesh.nodes, 0);
      const SquaredNorms norms = lifted_errors(space, mesh.nodes, exact, 0, w);
      L2[i] = std::sqrt(norms.L2.segment(3, 3).sum());
      H1_semi[i] = std::sqrt(norms.H1_semi.segment(3, 3).sum());
      h[i] = mesh_quality(mesh.elements, mesh.nodes).h;
    }
    EXPECT_NEAR(std::log(L2[0] / L2[1]) / std::log(h[0] / h[1]), degree + 1, 0.35) << degree;
    EXPECT_NEAR(std::log(H1_semi[0] / H1_semi[1]) / std::log(h[0] / h[1]), degree, 0.35) << degree;
  }
}

TEST(NodalNorms, AreTheNormsOfTheDifference) {
  const Mesh mesh = curved(sphere(1), icosphere(1, 3), 2);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  Field e(space.dofs(), 4);
  e << mesh.nodes, Eigen::VectorXd::Constant(space.dofs(), 2);
  const SquaredNorms norms = nodal_norms(M, A, e);
  const double area = 4 * pi;
  EXPECT_NEAR(norms.L2.head(3).sum(), area, 1e-3);
  EXPECT_NEAR(norms.H1_semi.head(3).sum(), 2 * area, 2e-3);  // grad id = P
  EXPECT_NEAR(norms.L2[3], 4 * area, 1e-3);
  EXPECT_NEAR(norms.H1_semi[3], 0, 1e-12);
}

TEST(ErrorRecorder, KeepsTheMaximumOverTime) {
  const ExactEvolution exact = shrinking_sphere(2);
  const Mesh mesh = curved(sphere(2), icosphere(2, 2), 2);
  const SurfaceSpace space(mesh);
  ErrorRecorder recorder(space, exact, mesh.nodes);
  const double shifts[] = {0.1, 0.3, 0.2};
  for (int n = 0; n < 3; ++n) {
    Field w = exact.nodal_values(exact.trajectories(mesh.nodes, 0.1 * n), 0.1 * n);
    w.col(9).array() += shifts[n];  // H
    recorder.record(0.1 * n, w);
  }
  const double area = 4 * pi * (4 - 4 * 0.1);
  const auto& H = recorder.maxima().at("H");
  EXPECT_NEAR(H.at("nodal_L2"), 0.3 * std::sqrt(area), 1e-3);
  EXPECT_NEAR(H.at("nodal_H1"), H.at("nodal_L2"), 1e-6);
  EXPECT_NEAR(H.at("lifted_L2"), 0.3 * std::sqrt(area), 1e-6);
  EXPECT_NEAR(recorder.maxima().at("x").at("nodal_L2"), 0, 1e-12);
  EXPECT_GT(recorder.maxima().at("nu").at("lifted_H1_semi"), 1e-3);
  EXPECT_EQ(recorder.series().at("t").size(), 3u);
  EXPECT_NEAR(recorder.series().at("H_lifted_L2")[2] / recorder.series().at("H_lifted_L2")[0],
              2 * std::sqrt((4 - 0.8) / 4), 1e-6);
}

TEST(Diagnostics, OfASphereAreItsClosedForms) {
  const Mesh mesh = curved(sphere(2), icosphere(2, 3), 2);
  const SurfaceSpace space(mesh);
  Series series;
  record_geometry(space, 0.5, mesh.nodes, series);
  record_curvature(space, mesh.nodes, Field::Ones(space.dofs(), 1), series);
  record_normal_length(mesh.nodes / 2, series);
  EXPECT_EQ(series.at("t")[0], 0.5);
  EXPECT_NEAR(series.at("area")[0], 16 * pi, 1e-3);
  EXPECT_NEAR(series.at("volume")[0], 32 * pi / 3, 1e-3);
  EXPECT_NEAR(series.at("willmore_energy")[0], 8 * pi, 1e-3);
  EXPECT_NEAR(series.at("max_nu")[0], 1, 1e-14);
  EXPECT_GT(series.at("worst_angle")[0], 50);
}

}  // namespace
}  // namespace esfem::test_errors
