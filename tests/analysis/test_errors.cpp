// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/diagnostics.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/constants.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem::test_errors {
namespace {

/// Position, normal and a constant on a fixed surface, as an "evolution".
ExactEvolution still(const Surface& surface) {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"nu", 3}, {"one", 1}};
  exact.surface = [surface](double) { return surface; };
  exact.trajectories = [](const Field& x0, double) { return x0; };
  exact.fields = [](double, const SurfacePoints& at, FieldsAtPoints& out) {
    for (int i = 0; i < 3; ++i) {
      out.value[i] = at.y[i];
      out.value[3 + i] = at.normal[i];
      for (int j = 0; j < 3; ++j) {
        out.gradient[i][j] = at.projection(i, j);
        out.gradient[3 + i][j] = at.weingarten[i][j];
      }
    }
    out.value[6] = pack(1);
    out.gradient[6] = {};
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

/// lifted_errors point by point, as its definition says.
SquaredNorms errors_one_by_one(const SurfaceSpace& space, const Field& x, const ExactEvolution& exact,
                               double t, const Field& w) {
  const Surface surface = exact.surface(t);
  const Quadrature& rule = space.quadrature();
  const ShapeTable shapes = shape_functions(space.degree(), rule.points);
  const int components = exact.components();
  FieldsAtPoints fields(components);
  SquaredNorms norms{Eigen::VectorXd::Zero(components), Eigen::VectorXd::Zero(components)};
  for (int element = 0; element < space.element_count(); ++element) {
    const auto nodes = space.elements().row(element);
    const Field x_e = x(nodes, Eigen::all), w_e = w(nodes, Eigen::all);
    for (int q = 0; q < rule.weights.size(); ++q) {
      Eigen::Matrix<double, 2, Eigen::Dynamic> d_shapes(2, nodes.size());
      d_shapes << shapes.dxi.row(q), shapes.deta.row(q);
      const Vec3 position = (shapes.value.row(q) * x_e).transpose();
      const Vec3 y = surface.closest_point(position);
      const Surface::Shape shape = surface.shape_at(y);
      const double s = shape.normal.dot(position - y);
      const Mat3 projection = Mat3::Identity() - shape.normal * shape.normal.transpose();
      const Eigen::Matrix<double, 3, 2> tangents =
          (Mat3::Identity() + s * shape.weingarten).inverse() * projection * (d_shapes * x_e).transpose();
      const Eigen::Matrix2d metric = tangents.transpose() * tangents;
      const double dA = rule.weights[q] * std::sqrt(metric.determinant());

      SurfacePoints points;
      for (int lane = 0; lane < pack_size; ++lane) set_lane(points, lane, y, shape);
      exact.fields(t, points, fields);
      const Eigen::MatrixXd w_gradient = tangents * metric.inverse() * (d_shapes * w_e);
      for (int l = 0; l < components; ++l) {
        const double e = shapes.value.row(q).dot(w_e.col(l)) - fields.value[l][0];
        Vec3 e_gradient = w_gradient.col(l);
        for (int i = 0; i < 3; ++i) e_gradient[i] -= fields.gradient[l][i][0];
        norms.L2[l] += dA * e * e;
        norms.H1_semi[l] += dA * e_gradient.squaredNorm();
      }
    }
  }
  return norms;
}

/// The largest relative difference of two squared norms.
double difference(const SquaredNorms& a, const SquaredNorms& b) {
  const auto relative = [](const Eigen::VectorXd& p, const Eigen::VectorXd& q) {
    return ((p - q).cwiseAbs().array() / q.array()).maxCoeff();
  };
  return std::max(relative(a.L2, b.L2), relative(a.H1_semi, b.H1_semi));
}

TEST(LiftedErrors, InBatchesAreThoseOfTheDefinitionPointByPoint) {
  Surface without_own_closest_point = ellipsoid(1, 1, 0.6);
  without_own_closest_point.own_closest_point = {};
  without_own_closest_point.own_closest_points = {};
  const struct {
    ExactEvolution exact;
    double t;
    Mesh coarse;
  } cases[] = {{shrinking_sphere(1), 0.1, icosphere(std::sqrt(0.6), 1)},
               {still(ellipsoid(1, 1, 0.6)), 0, stretched_icosphere(1)},
               {still(without_own_closest_point), 0, stretched_icosphere(1)},
               {stationary_torus(1, 0.4), 0, torus_grid(1, 0.4, 9, 7)},
               {shrinking_angenent_torus(), 0, angenent_torus_grid(12, 9)}};
  for (const auto& [exact, t, coarse] : cases) {
    for (int degree : {1, 2, 3, 4}) {
      // The last batch is not full, whatever the width of a Pack.
      Mesh part = coarse;
      part.elements.conservativeResize(coarse.elements.rows() - 1, Eigen::NoChange);
      const Mesh mesh = curved(exact.surface(t), part, degree);
      const SurfaceSpace space(mesh);
      Field w(space.dofs(), exact.components());
      for (int l = 0; l < w.cols(); ++l)
        for (int j = 0; j < w.rows(); ++j) w(j, l) = std::sin(1 + l + 2 * mesh.nodes(j, l % 3));
      const SquaredNorms expected = errors_one_by_one(space, mesh.nodes, exact, t, w);
      EXPECT_LT(difference(lifted_errors(space, mesh.nodes, exact, t, w), expected), 1e-12) << degree;
      // An error of 1e-9 would be seen.
      w(0, 0) += 1e-6;
      EXPECT_GT(difference(lifted_errors(space, mesh.nodes, exact, t, w), expected), 1e-11) << degree;
    }
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

struct StateWithNormal {
  double t = 0;
  Field x, nu;
  static constexpr NamedField<StateWithNormal> fields[] = {{"x", &StateWithNormal::x}};
};
NodalFields nodal_fields(const StateWithNormal& state) {
  return {{"nu", state.nu}};
}

// A flow may evolve nu without H, as the generalised mean curvature flow does.
TEST(Quantities, NuIsTheFlowsOwnWhereItHasOne) {
  const Mesh mesh = icosphere(1, 2);
  const SurfaceSpace space(mesh);
  Quantities quantities(space, {{"nu", 3}, {"H", 1}});
  const Field columns = quantities.of(StateWithNormal{0, mesh.nodes, 0.5 * mesh.nodes});
  EXPECT_EQ(columns.leftCols(3), 0.5 * mesh.nodes);
  EXPECT_NEAR(columns.col(3).mean(), 2, 0.1) << "H of the surface";
}

}  // namespace
}  // namespace esfem::test_errors
