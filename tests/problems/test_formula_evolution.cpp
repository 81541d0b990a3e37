// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/errors.hpp"
#include "solver/problems/formula_data.hpp"
#include "solver/problems/formula_evolution.hpp"

namespace esfem::test_formula_evolution {
namespace {

const FormulaNames in_space_time = names_in_space_time({});

/// u = x y (1 + z) on the ellipsoid with the axes a = 1 + t, 1 and 0.8.
ExactEvolution on_ellipsoid(const std::function<Surface(double)>& surface) {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"u", 1}};
  exact.surface = surface;
  exact.fields = formula_fields(
      {{exact.quantities[0], {}}, {exact.quantities[1], {Formula("x*y*(1+z)", in_space_time, "u")}}});
  return exact;
}

Mesh ellipsoid_mesh(double t, int subdivisions) {
  Mesh corners = icosphere(1, subdivisions);
  corners.nodes.col(0) *= 1 + t;
  corners.nodes.col(2) *= 0.8;
  Mesh mesh = lagrange_mesh(corners, 2);
  project_nodes(mesh, ellipsoid(1 + t, 1, 0.8));
  return mesh;
}

std::function<Surface(double)> by_formula() {
  return formula_level_set(Formula("x^2/(1+t)^2+y^2+z^2/0.64-1", in_space_time, "d"), 1);
}

TEST(FormulaLevelSet, HasTheClosestPointsOfTheEllipsoid) {
  const double t = 0.3;
  const Surface formula = by_formula()(t), named = ellipsoid(1 + t, 1, 0.8);
  const Mesh mesh = ellipsoid_mesh(t, 1);
  const ElementBatches batches(mesh.elements, 2, default_quadrature(2));
  Batch batch;
  batches.load(1, mesh.nodes, batch);
  for (double distance : {0.0, 0.02, -0.05}) {
    Pack x[3];
    for (int lane = 0; lane < pack_size; ++lane) {
      const Vec3 y = mesh.nodes.row(5 * lane), at = y + distance * named.normal(y);
      for (int i = 0; i < 3; ++i) x[i][lane] = at[i];
    }
    const SurfacePoints found = formula.closest_points(x), expected = named.closest_points(x);
    for (int lane = 0; lane < pack_size; ++lane) {
      EXPECT_LT((lane_of(found.y, lane) - lane_of(expected.y, lane)).norm(), 1e-13) << distance;
      EXPECT_LT((lane_of(found.normal, lane) - lane_of(expected.normal, lane)).norm(), 1e-13);
      for (int i = 0; i < 3; ++i)
        EXPECT_LT((lane_of(found.weingarten[i], lane) - lane_of(expected.weingarten[i], lane)).norm(), 1e-12);
    }
  }
  // Far away Newton's method in space finds it, or says that it does not.
  const Vec3 far(0.2, 1.4, 0.1);
  EXPECT_LT((formula.closest_point(far) - named.closest_point(far)).norm(), 1e-11);
}

TEST(UnliftedErrors, HaveTheOrdersOfTheLiftedOnes) {
  const double t = 0.2;
  SquaredNorms lifted[2], unlifted[2];
  for (int i : {0, 1}) {
    const Mesh mesh = ellipsoid_mesh(t, 2 + i);
    const SurfaceSpace space(mesh);
    const ExactEvolution exact = on_ellipsoid(by_formula());
    Field w(space.dofs(), 4);
    for (int j = 0; j < w.rows(); ++j) {
      const Vec3 y = mesh.nodes.row(j);
      w.row(j) << y.transpose(), y[0] * y[1] * (1 + y[2]);
    }
    lifted[i] = lifted_errors(space, mesh.nodes, exact, t, w);
    unlifted[i] = unlifted_errors(space, mesh.nodes, exact, t, w);
    const SquaredNorms named = lifted_errors(
        space, mesh.nodes, on_ellipsoid([](double at) { return ellipsoid(1 + at, 1, 0.8); }), t, w);
    EXPECT_LT((lifted[i].L2 - named.L2).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((lifted[i].H1_semi - named.H1_semi).cwiseAbs().maxCoeff(), 1e-13);
  }
  for (const SquaredNorms* norms : {lifted, unlifted}) {
    EXPECT_NEAR(std::log2(norms[0].L2[3] / norms[1].L2[3]) / 2, 3, 0.35);
    EXPECT_NEAR(std::log2(norms[0].H1_semi[3] / norms[1].H1_semi[3]) / 2, 2, 0.35);
  }
  EXPECT_GT(std::abs(lifted[1].L2[3] / unlifted[1].L2[3] - 1), 0.01);  // another number, though
  EXPECT_LT(unlifted[1].L2.head(3).sum(), 1e-25);                      // the position is that of the surface
}

}  // namespace
}  // namespace esfem::test_formula_evolution
