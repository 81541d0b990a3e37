// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "solver/analysis/errors.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_angenent_torus_orders {
namespace {

const std::string quantities[] = {"x", "v", "nu", "H"};

/// The order of each quantity in h, from the grids of 2n x n cells, n = 12 and 18, quadratic elements: BDF2
/// with tau = 0.01 on [0, 0.1], where the error in space dominates. errors(space, x0): those of a run.
template <class RunErrors>
std::map<std::string, double> orders_in_h(const std::string& norm, RunErrors errors) {
  std::map<std::string, double> error[2];
  double h[2];
  const int cells[] = {12, 18};
  for (int i = 0; i < 2; ++i) {
    Mesh mesh = lagrange_mesh(angenent_torus_grid(2 * cells[i], cells[i]), 2);
    project_nodes(mesh, shrinking_angenent_torus().surface(0));
    h[i] = mesh_quality(corner_mesh(mesh).elements, corner_mesh(mesh).nodes).h;
    const SurfaceSpace space(mesh, default_quadrature(2));
    const Errors found = errors(space, mesh.nodes);
    for (const std::string& quantity : quantities) error[i][quantity] = found.at(quantity).at(norm);
  }
  std::map<std::string, double> orders;
  for (const std::string& quantity : quantities)
    orders[quantity] = std::log(error[0][quantity] / error[1][quantity]) / std::log(h[0] / h[1]);
  return orders;
}

const UniformSteps grid{2, 0.01, 10, Start{}};

/// Errors of (5.1) against `exact`, which gives the starting values, too.
Errors mean_curvature_errors(const SurfaceSpace& space, const Field& x0, const ExactEvolution& exact) {
  MeanCurvatureFlow flow(space, {});
  ErrorRecorder errors(space, exact, x0);
  const std::function<MeanCurvatureFlow::State(double)> state = [&](double t) {
    return exact_mean_curvature_state(exact, x0, t);
  };
  integrate(flow, grid, {state(0), state}, errors);
  return errors.maxima();
}

/// Whether all orders are between 1.75 and 2.6, as the theory's 2 shows on these meshes.
bool have_the_orders_of_the_theory(const std::map<std::string, double>& orders) {
  for (const auto& [quantity, order] : orders)
    if (order < 1.75 || order > 2.6) return false;
  return true;
}

TEST(AngenentTorusOrders, QuadraticElementsHaveTheOrdersOfTheTheory) {
  const auto orders = orders_in_h("lifted_H1", [](const SurfaceSpace& space, const Field& x0) {
    return mean_curvature_errors(space, x0, shrinking_angenent_torus());
  });
  EXPECT_TRUE(have_the_orders_of_the_theory(orders))
      << orders.at("x") << " " << orders.at("v") << " " << orders.at("nu") << " " << orders.at("H");
}

TEST(AngenentTorusOrders, NeitherDziuksSchemeNorParticlesOnRaysHaveThem) {
  EXPECT_FALSE(
      have_the_orders_of_the_theory(orders_in_h("lifted_H1", [](const SurfaceSpace& space, const Field& x0) {
        const ExactEvolution exact = shrinking_angenent_torus();
        DziukFlow flow(space);
        ErrorRecorder errors(space, exact, x0);
        const std::function<DziukFlow::State(double)> state = [&](double t) {
          return exact_dziuk_state(exact, x0, t);
        };
        integrate(flow, grid, {state(0), state}, errors);
        return errors.maxima();
      })));
  // Particles that do not slide along the profile: errors of x do not tend to zero.
  EXPECT_FALSE(
      have_the_orders_of_the_theory(orders_in_h("lifted_H1", [](const SurfaceSpace& space, const Field& x0) {
        ExactEvolution on_rays = shrinking_angenent_torus();
        on_rays.trajectories = [](const Field& start, double t) -> Field { return std::sqrt(1 - t) * start; };
        return mean_curvature_errors(space, x0, on_rays);
      })));
}

}  // namespace
}  // namespace esfem::test_angenent_torus_orders
