// SPDX-License-Identifier: GPL-3.0-or-later
//
// The projections of kll21 §7.1 for Willmore flow: why they destroy the order in time, and what keeps it
//
// Sample runs:  build/bin/willmore_projection --preset check --output projection.json
//               build/bin/willmore_projection --projection coefficients --bdf 3 --steps 4-6
//
// Writes:       results/paper/willmore_projection.{json,csv,tex}, from which plots/willmore_projection.py
// draws
//               figures/gallery/willmore_projection
//
// nu_h of kll21 (3.4)-(3.5) does not stay of unit length. The paper recommends to normalise it, and to
// project z_h, in the nodes after each step: the runs projected. Runs coefficients project only nu~ and z~,
// of which f, g and F are made (WillmoreFlow::Variant::Projection). docs/findings/projection.md has reasons
// and results.
//   order   ellipsoid with half axes 2, 2, 1.6 on [0.1, 0.5]: errors of x, u = (H, nu) and w = (V, z) against
//           BDF5 with 1,024 steps on the same mesh, which gives the starting values. Before t = 0.1, in the
//           initial layer that interpolated values leave, no method shows its order.
//   sphere  the unit sphere on [0, 1] from exact values, as in Figure 7.3: errors over the step size
//   length  a sphere with theta, from nu_h longer than 1 by a millionth: the rate of |nu_h| - 1
//
// Expected: order q without projections and with coefficients, 0.2 to 0.4 with projected, whatever q is. The
// length grows like exp(8t/R⁴) without projections, and decays like exp(-4t/R⁴) with coefficients.
#include <cmath>

#include "experiments/harness/grid.hpp"
#include "experiments/harness/small_steps.hpp"
#include "experiments/harness/stationary_willmore.hpp"
#include "solver/analysis/series.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/time/last_state.hpp"

namespace {

using namespace esfem;
using State = WillmoreFlow::State;

const HalvedSteps order_steps{0.4, 0.1}, sphere_steps{1, 0.2};
const int reference_k = 8;   ///< tau = 0.4/1,024
const Vec3 axes(2, 2, 1.6);  ///< half axes of the ellipsoid

Block otherwise(bool paper) {
  return {{"run", "order"},
          {"flow", "willmore"},
          {"F", "extrapolated"},
          {"mesh_of", "icosphere"},
          {"radius", 1.0},
          {"degree", 2},
          {"bdf", paper ? range(1, 5) : range(2, 3)},
          {"level", 0},
          {"step", range(paper ? 3 : 4, 6)}};
}

std::vector<Block> preset(bool paper) {
  const std::vector<int> sphere_step = paper ? range(1, 6) : std::vector<int>{2, 5};
  std::vector<Block> blocks = {{},
                               {{"run", "sphere"}, {"bdf", 2}, {"step", sphere_step}},
                               {{"run", "length"},
                                {"projection", {"none", "coefficients"}},
                                {"bdf", 2},
                                {"radius", {1.0, 1.5}},
                                {"step", 5}}};
  if (!paper) return blocks;
  blocks.push_back({{"F", "implicit"}, {"bdf", {2, 3}}});
  blocks.push_back({{"flow", "surface_diffusion"}, {"bdf", {2, 3}}});
  blocks.push_back({{"mesh_of", "delaunay"}, {"bdf", {2, 3}}});
  blocks.push_back({{"degree", {3, 4}}, {"bdf", {2, 3}}});
  return blocks;
}

HalvedSteps steps(const Choice& choice) {
  const double R4 = std::pow(choice.number("radius"), 4);
  if (choice["run"] == "length") return {0.5 * R4, 0.1 * R4};
  if (choice["run"] == "sphere") return sphere_steps;
  if (const int k = choice.step(), last = reference_k - 2; k < 1 || k > last)
    throw InputError(format("--steps: found %d, expected 1 to %d", k, last));
  return order_steps;
}

/// With projections after each step |nu_h| is 1; radius and mesh_of are of one kind of runs each.
bool is_a_run(const Choice& choice) {
  const bool is_length = choice["run"] == "length";
  return (is_length ? choice["projection"] != "projected" : choice.number("radius") == 1) &&
         (choice["run"] == "order" || choice["mesh_of"] == "icosphere");
}

WillmoreFlow::Variant variant_of(const Choice& choice) {
  WillmoreFlow::Variant variant;
  variant.projection = projection_of(choice["projection"]);
  if (choice["flow"] == "surface_diffusion") variant.law = surface_diffusion_law();
  if (choice["F"] == "implicit") variant.F = WillmoreFlow::Variant::implicit;
  return variant;
}

/// The ellipsoid: a distorted icosphere, or an unstructured mesh of as many nodes.
Mesh ellipsoid_mesh(const Choice& choice, const Surface& surface) {
  const auto generate = [&] {
    if (choice["mesh_of"] == "delaunay") return generate_mesh(surface, 1.25);
    Mesh mesh = icosphere(1, 1);
    mesh.nodes *= axes.asDiagonal();
    return mesh;
  };
  return initial_mesh({}, 0, generate, surface, choice.degree());
}

/// Errors against small steps: the largest over the steps n >= q.
void measure_order(const Choice& choice, Row& row) {
  const Surface surface = ellipsoid(axes[0], axes[1], axes[2]);
  const Mesh mesh = ellipsoid_mesh(choice, surface);
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);
  const WillmoreFlow::Variant variant = variant_of(choice);
  WillmoreFlow flow(space, variant);
  const WillmoreStart start = willmore_start_on(space, surface, mesh.nodes, variant.law, false);
  const State behind_the_layer = last_state(flow, {2, 2e-4, 500, parse_start("substeps:16")}, start.state);

  const UniformSteps small{5, order_steps.tau(reference_k), order_steps.count(reference_k),
                           parse_start("substeps:128")};
  const SmallSteps reference(flow, small, behind_the_layer, {}, small.steps / row.steps);
  LargestDifferences differences(space, {{"x", 3}, {"u", 4}, {"w", 4}});
  reference.compare(choice.bdf(), row.tau, choice.bdf(), [&](int, const State& state, const State& exact) {
    differences.add(exact.x, state, exact);
  });
  row.errors = differences.errors();
}

/// Errors against the exact solution at rest, of nu_h as the scheme has it and normalised in the nodes.
void measure_sphere(const Choice& choice, Row& row) {
  const auto generate = [] { return generate_mesh(sphere(1), 0.55); };
  const Mesh mesh = initial_mesh({}, 0, generate, sphere(1), choice.degree());
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);
  const ExactEvolution exact = stationary_sphere(1);
  ErrorRecorder normalised(space, exact, mesh.nodes);
  const StationaryWillmore setting{variant_of(choice), false, {choice.bdf(), row.tau, row.steps, {}}};
  const auto observe = [&](State state) {
    state.u.rightCols(3).rowwise().normalize();
    normalised.record(state);
  };
  run_stationary_willmore(space, mesh, exact, setting, 8 * pi, observe, row);
  row.errors["nu_normalised"] = normalised.maxima().at("nu");
}

/// The rate of the mean of |nu_h| - 1 in the second half of the time.
void measure_length(const Choice& choice, Row& row) {
  const double radius = choice.number("radius");
  const Surface surface = sphere(radius);
  const auto generate = [&] { return icosphere(radius, 2); };
  const Mesh mesh = initial_mesh({}, 0, generate, surface, choice.degree());
  const SurfaceSpace space(mesh, choice.quadrature());
  describe_mesh(mesh, row);
  const WillmoreFlow::Variant variant = variant_of(choice);
  WillmoreStart start = willmore_start_on(space, surface, mesh.nodes, variant.law, true);
  WillmoreFlow flow(space, variant, start.theta);
  start.state.u.rightCols(3) *= 1 + 1e-6;
  const UniformSteps grid{choice.bdf(), row.tau, row.steps, parse_start("substeps:16")};
  integrate(flow, grid, start.state, [&](int, const State& state) {
    row.series["t"].push_back(state.t);
    row.series["nu_excess"].push_back(state.u.rightCols(3).rowwise().norm().mean() - 1);
  });
  const double rate = growth_rate(row.series["t"], row.series["nu_excess"], 0.5 * steps(choice).end_time);
  row.values["rate_times_R4"] = rate * std::pow(radius, 4);
}

void run(const Choice& choice, Row& row, const std::string&) {
  if (choice["run"] == "order") return measure_order(choice, row);
  choice["run"] == "sphere" ? measure_sphere(choice, row) : measure_length(choice, row);
}

}  // namespace

int main(int argc, char** argv) {
  Experiment experiment("willmore_projection", "kll21", run, otherwise, preset);
  experiment.help =
      "Willmore flow without projections of nu_h and z_h, with those of kll21 §7.1 after each step, and "
      "with\n"
      "projections in the coefficients alone: orders in time, errors on the sphere, |nu_h|. No units.\n\n"
      "Example: willmore_projection --projection coefficients --bdf 3 --steps 4-6 --output table.json";
  experiment.grid.axes = {
      {"run",
       {"order", "sphere", "length"},
       "order: of an ellipsoid, against small steps | sphere: errors at rest | length: rate of |nu_h| - 1"},
      {"projection",
       {"none", "projected", "coefficients"},
       "projected: after each step | coefficients: in f, g and F"},
      {"flow", {"willmore", "surface_diffusion"}, "with Q, or without"},
      {"F", {"extrapolated", "implicit"}, "F(x, u) w of (3.5a)"},
      {"mesh_of", {"icosphere", "delaunay"}, "the ellipsoid: distorted icosphere | unstructured"},
      {"radius", {}, "of the sphere of the runs length"}};
  experiment.grid.labels = {"run", "projection", "flow", "F", "mesh_of", "degree", "bdf", "radius"};
  const std::string why = "meshes and starting values are those of the runs";
  experiment.grid.refused = {{"mesh", why}, {"start", why}, {"level", why}};
  experiment.grid.admits = is_a_run;
  experiment.steps = steps;
  experiment.cost = [](const Choice& choice) { return choice.degree() * choice.degree() * 0.2; };
  experiment.known_end = [](const Choice& choice) {
    const bool grows =
        choice["run"] == "sphere" && choice["flow"] == "willmore" && choice["projection"] == "none";
    return grows ? "without projection |nu_h| - 1 grows like exp(8t/R^4)" : "";
  };
  experiment.parameters = {{"errors", "order: against BDF5 with 1,024 steps on the same mesh, from t = 0.1"}};
  return run_experiment(experiment, argc, argv);
}
