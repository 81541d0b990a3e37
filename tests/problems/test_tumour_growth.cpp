// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/error.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/problems/tumour_growth.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_tumour_growth {
namespace {

struct TumourOnTheUnitSphere : testing::Test {
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  TumourOnTheUnitSphere() { project_nodes(mesh, sphere(1)); }

  CoupledDiffusionState run(double disturbance, double gamma, const UniformSteps& grid, double D = 10) const {
    const SurfaceSpace space(mesh);
    TumourGrowth::Kinetics kinetics;
    kinetics.gamma = gamma;
    CoupledDiffusionParameters parameters = tumour_growth_parameters();
    parameters.diffusion[1] = D;
    CoupledDiffusion<TumourGrowth> flow(space, TumourGrowth(kinetics), parameters, {});
    CoupledDiffusionState end;
    integrate(flow, grid, tumour_growth_state(space, mesh.nodes, kinetics, disturbance),
              [&](int, const CoupledDiffusionState& state) { end = state; });
    return end;
  }
};

TEST_F(TumourOnTheUnitSphere, KeepsTheSymmetryOfTheUndisturbedState) {
  // Without space: r' (1 + 2 alpha/r²) + 2 epsilon/r = delta u_1, u_l' = f_l - 2 r'/r u_l; Runge-Kutta with
  // small steps.
  const double tau = 0.01, gamma = 30;
  using State3 = Eigen::Vector3d;
  const auto slope = [&](const State3& y) {
    const double r = y[0], growth = (0.4 * y[1] - 0.02 / r) / (1 + 2 / (r * r)),
                 reaction = y[1] * y[1] * y[2];
    return State3(growth, gamma * (0.1 - y[1] + reaction) - 2 * growth / r * y[1],
                  gamma * (0.9 - reaction) - 2 * growth / r * y[2]);
  };
  State3 y(1, 1, 0.9);
  const int fine = 2000;
  for (int n = 0; n < fine; ++n) {
    const double h = 50 * tau / fine;
    const State3 k1 = slope(y), k2 = slope(y + h / 2 * k1), k3 = slope(y + h / 2 * k2),
                 k4 = slope(y + h * k3);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const CoupledDiffusionState end = run(0, gamma, {3, tau, 50, parse_start("substeps:16")});
  EXPECT_GT(y[0], 1.05);
  EXPECT_NEAR(end.x.rowwise().norm().mean(), y[0], 2e-4);
  EXPECT_NEAR(end.u.col(0).mean(), y[1], 2e-3);
  EXPECT_NEAR(end.u.col(1).mean(), y[2], 2e-3);
  EXPECT_LT((end.u.col(0).array() - end.u.col(0).mean()).abs().maxCoeff(), 5e-3);
}

TEST_F(TumourOnTheUnitSphere, FormsAPatternFromASmallDisturbance) {
  const UniformSteps grid{2, 0.01, 300, parse_start("substeps:8")};
  const auto contrast = [](const CoupledDiffusionState& state) {
    return state.u.col(0).maxCoeff() - state.u.col(0).minCoeff();
  };
  EXPECT_GT(contrast(run(0.01, 30, grid)), 0.5);
  EXPECT_LT(contrast(run(0.01, 30, grid, 1)), 0.05) << "equal diffusion: no Turing instability";
}

TEST_F(TumourOnTheUnitSphere, StartsFromTheSameDisturbanceOnEveryMesh) {
  const SurfaceSpace space(mesh);
  const Field u = tumour_growth_state(space, mesh.nodes, {}).u;
  EXPECT_EQ(u, tumour_growth_state(space, mesh.nodes, {}).u);
  EXPECT_NE(u, tumour_growth_state(space, mesh.nodes, {}, 0.01, 2).u);
  EXPECT_LE((u.col(0).array() - 1).abs().maxCoeff(), 0.01);
  EXPECT_GT((u.col(0).array() - 1).abs().maxCoeff(), 0.001);
  // A function of space: a finer mesh has the same values in the nodes that it shares with this one.
  Mesh finer = lagrange_mesh(subdivide(corner_mesh(mesh)), 2);
  const SurfaceSpace finer_space(finer);
  const Field v = tumour_growth_state(finer_space, finer.nodes, {}).u;
  int shared = 0;
  for (int j = 0; j < finer.nodes.rows(); ++j) {
    if ((finer.nodes.row(j) - mesh.nodes.row(0)).norm() > 1e-14) continue;
    EXPECT_NEAR(v(j, 0), u(0, 0), 1e-14);
    ++shared;
  }
  EXPECT_EQ(shared, 1);
  TumourGrowth::Kinetics kinetics;
  kinetics.gamma = 0;
  EXPECT_THROW(TumourGrowth{kinetics}, InputError);
}

}  // namespace
}  // namespace esfem::test_tumour_growth
