// SPDX-License-Identifier: GPL-3.0-or-later
// The default rules are so accurate that the next better one does not change the results of the sphere
// experiment.
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/errors.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_default_quadrature {
namespace {

/// Errors of ten steps of the sphere experiment (small ones, so that the spatial error shows) on the coarsest
/// published mesh.
Errors sphere_errors(int degree, const Quadrature& rule) {
  static const Mesh triangles = generate_mesh(sphere(2), 0.5);
  Mesh mesh = lagrange_mesh(triangles, degree);
  project_nodes(mesh, sphere(2));
  const SurfaceSpace space(mesh, rule), fine(mesh, conical_quadrature(12));
  const ExactEvolution exact = shrinking_sphere(2);
  const std::function<MeanCurvatureFlow::State(double)> state = [&](double t) {
    return exact_mean_curvature_state(exact, mesh.nodes, t);
  };
  MeanCurvatureFlow flow(space, {});
  // The errors of all rules are measured by one rule.
  ErrorRecorder errors(fine, exact, mesh.nodes);
  integrate(flow, {3, 0.003, 10, {}}, {state(0), state}, errors);
  return errors.maxima();
}

/// The largest relative change of an error above round-off.
double largest_change(const Errors& some, const Errors& others) {
  double largest = 0;
  for (const auto& [quantity, norms] : some) {
    for (const auto& [norm, error] : norms) {
      const double other = others.at(quantity).at(norm);
      if (other > 1e-9) largest = std::max(largest, std::abs(error / other - 1));
    }
  }
  return largest;
}

TEST(DefaultQuadrature, IsNotWorseThanTheNextBetterRuleButAWeakerOneIsSeen) {
  for (int degree : {1, 2, 3, 4}) {
    const Quadrature rule = default_quadrature(degree), better = symmetric_quadrature(rule.degree + 2);
    EXPECT_GT(better.weights.size(), rule.weights.size());
    const Errors errors = sphere_errors(degree, rule);
    EXPECT_LT(largest_change(errors, sphere_errors(degree, better)), 1e-3) << "P" << degree;
    if (degree > 1) {
      const Quadrature weaker = symmetric_quadrature(2 * degree - 2);
      EXPECT_GT(largest_change(sphere_errors(degree, weaker), errors), 1e-3) << "P" << degree;
    }
  }
}

}  // namespace
}  // namespace esfem::test_default_quadrature
