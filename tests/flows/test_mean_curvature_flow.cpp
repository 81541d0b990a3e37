// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "solver/analysis/errors.hpp"
#include "solver/analysis/table.hpp"
#include "solver/flows/exact_evolution.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/read.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {
namespace {

const std::string independent = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/";

using State = MeanCurvatureFlow::State;
using Variant = MeanCurvatureFlow::Variant;

State run_sphere(const Mesh& mesh, const Quadrature& rule, const TimeGrid& grid, Variant variant = {}) {
  const ExactEvolution exact = shrinking_sphere(2);
  const auto state = [&](double t) { return exact_mean_curvature_state(exact, mesh.nodes, t); };
  const SurfaceSpace space(mesh, rule);
  MeanCurvatureFlow flow(space, variant);
  State last;
  integrate(flow, grid, state(0), std::function<State(double)>(state),
            [&](int, const State& now) { last = now; });
  return last;
}

/// The nodal values of a reference file, as N x c.
Field nodal(const nlohmann::json& rows) {
  Field field(rows.size(), rows[0].size());
  for (size_t i = 0; i < rows.size(); ++i) {
    for (size_t l = 0; l < rows[i].size(); ++l) field(i, l) = rows[i][l].get<double>();
  }
  return field;
}

double deviation(const State& state, const nlohmann::json& expected) {
  return std::max({(state.x - nodal(expected["x"])).cwiseAbs().maxCoeff(),
                   (state.v - nodal(expected["v"])).cwiseAbs().maxCoeff(),
                   (state.u - nodal(expected["u"])).cwiseAbs().maxCoeff()});
}

State run_reference_case(const nlohmann::json& reference, const Quadrature& rule, Variant variant = {}) {
  const Mesh mesh = read_mesh(independent + reference["mesh"].get<std::string>()).mesh;
  const TimeGrid grid{reference["q"].get<int>(), reference["tau"].get<double>(),
                      reference["nsteps"].get<int>(), parse_start(reference["start"].get<std::string>())};
  return run_sphere(mesh, rule, grid, variant);
}

TEST(MeanCurvatureFlow, AgreesWithTheIndependentImplementation) {
  for (const std::string name : {"mcf_kll_bdf3", "mcf_kll_bdf3_cascade"}) {
    const auto reference = read_json(independent + name + ".json");
    EXPECT_LT(deviation(run_reference_case(reference, conical_quadrature(12)), reference["nodal"]), 1e-11)
        << name;
    // A rule that is too weak, or another variant of the scheme, is seen.
    EXPECT_GT(deviation(run_reference_case(reference, conical_quadrature(4)), reference["nodal"]), 1e-8)
        << name;
  }
  const auto reference = read_json(independent + "mcf_kll_bdf3.json");
  Variant interpolation;
  interpolation.velocity = Variant::interpolation;
  Variant normalise;
  normalise.normalise = true;
  Variant stabilise;
  stabilise.stabilise = 1;
  for (const Variant& variant : {interpolation, normalise, stabilise}) {
    const double distance =
        deviation(run_reference_case(reference, conical_quadrature(12), variant), reference["nodal"]);
    EXPECT_GT(distance, 1e-7);
    EXPECT_LT(distance, 0.02);
  }
}

TEST(MeanCurvatureFlow, NormalisedNormalsHaveUnitLength) {
  Variant normalise;
  normalise.normalise = true;
  const Mesh mesh = lagrange_mesh(icosphere(2, 2), 2);
  const State end = run_sphere(mesh, default_quadrature(2), {2, 0.02, 5, {}}, normalise);
  EXPECT_LT((end.u.leftCols(3).rowwise().norm().array() - 1).abs().maxCoeff(), 1e-15);
  const State plain = run_sphere(mesh, default_quadrature(2), {2, 0.02, 5, {}});
  EXPECT_GT((plain.u.leftCols(3).rowwise().norm().array() - 1).abs().maxCoeff(), 1e-7);
}

TEST(MeanCurvatureFlow, StabilisingTermPullsTheNormalToTheSurfaceNormal) {
  // One step from normals that are too long: with alpha the length comes back towards 1.
  const ExactEvolution exact = shrinking_sphere(2);
  Mesh mesh = lagrange_mesh(icosphere(2, 2), 2);
  project_nodes(mesh, sphere(2));
  const SurfaceSpace space(mesh);
  State start = exact_mean_curvature_state(exact, mesh.nodes, 0);
  start.u.leftCols(3) *= 1.1;
  double length[2];
  for (int i : {0, 1}) {
    Variant variant;
    variant.stabilise = 10.0 * i;
    MeanCurvatureFlow flow(space, variant);
    State end;
    integrate(flow, {1, 0.01, 1, {}}, start, {}, [&](int, const State& now) { end = now; });
    length[i] = end.u.leftCols(3).rowwise().norm().mean();
  }
  EXPECT_NEAR(length[0], 1.1, 2e-3);
  EXPECT_NEAR(length[0] - length[1], 10 * 0.01 * 0.1, 1e-3);  // alpha tau (|nu| - 1)
}

TEST(MeanCurvatureFlow, DiscreteStartApproachesTheExactOne) {
  // A surface known by its nodes alone: normal and mean curvature get better with the mesh.
  double previous_nu = 1, previous_H = 1;
  for (int subdivisions : {1, 2, 3}) {
    Mesh mesh = lagrange_mesh(icosphere(2, subdivisions), 2);
    project_nodes(mesh, sphere(2));
    const SurfaceSpace space(mesh);
    const State exact = mean_curvature_state_on(sphere(2), mesh.nodes);
    const State found = discrete_mean_curvature_state(space, mesh.nodes);
    const double error_nu = (found.u - exact.u).leftCols(3).cwiseAbs().maxCoeff();
    const double error_H = (found.u - exact.u).col(3).cwiseAbs().maxCoeff();
    EXPECT_LT(error_nu, previous_nu / 4);
    EXPECT_LT(error_H, previous_H / 2);
    previous_nu = error_nu;
    previous_H = error_H;
  }
  EXPECT_LT(previous_nu, 1e-3);
  EXPECT_LT(previous_H, 1e-2);
}

TEST(MeanCurvatureFlow, StepsInATimeAfterTheCollapseAreAnError) {
  const Mesh mesh = lagrange_mesh(icosphere(2, 1), 2);
  EXPECT_THROW(run_sphere(mesh, default_quadrature(2), {3, 0.6, 3, {}}), InputError);
}

}  // namespace
}  // namespace esfem
