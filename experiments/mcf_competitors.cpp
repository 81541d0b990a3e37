// SPDX-License-Identifier: GPL-3.0-or-later
//
// Mean curvature flow by three schemes side by side, error against time: kll19 (5.1), Dziuk's (3.6), and that
// of Barrett, Garcke and Nürnberg
//
// Sample runs:  build/bin/mcf_competitors --preset check --output competitors.json
//               build/bin/mcf_competitors --surfaces sphere --schemes kll19,bgn --levels 0 --steps 0-2
//
// Writes:       results/paper/mcf_competitors.{json,csv,tex}, from which plots/mcf_competitors.py draws
//               figures/gallery/mcf_competitors
//
// The sphere of radius 2 on [0, 0.6] and the self-shrinking torus on [0, 0.2], whose solutions are known. All
// schemes run on the same meshes with quadratic elements, kll19 and Dziuk's with BDF 1 to 3 and exact
// starting values, BGN's, which is of first order, also with linear elements and lumped masses, as published.
// Seconds are those of the processor in the steps alone; errors are recorded at about 12 times in between.
// The nodes of BGN's scheme slide along the surface, which counts as an error of x; `distance` is that of the
// nodes from the exact surface (root mean square), the greatest of those recorded.
//
// Expected: BGN's scheme, of order 1 in time and with a system for four unknowns a node, is the least
// accurate per second. Between the others it depends on what one asks for. Dziuk's steps take half as long.
// Its nodes keep as near to the surface, on the sphere even nearer; but where the mesh is not that of a
// sphere they slide, and its normals and curvatures, those of the discrete surface, are 10 to 100 times less
// accurate.
#include <algorithm>
#include <cmath>

#include "experiments/harness/distance.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/timed.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/profile_grid.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace {

using namespace esfem;

const int recorded_steps = 12;

/// A surface to start from, its solution, meshes and step sizes. Each level of the mesh has twice as many
/// triangles as the one before.
struct Case {
  std::string name;
  Surface surface;
  ExactEvolution exact;
  HalvedSteps time_steps;
  double largest_h, vertices;  ///< of level 0
};

std::vector<Case> known_cases() {
  return {{"sphere", sphere(2), shrinking_sphere(2), {0.6, 0.05}, 0.5, 440},
          {"angenent_torus", angenent_torus(), shrinking_angenent_torus(), {0.2, 0.02}, 0.66, 715}};
}

const std::vector<std::string> known_surfaces = {"sphere", "angenent_torus"};
const std::vector<std::string> known_schemes = {"kll19", "dziuk", "bgn"};

/// One run; k is the exponent of the step size.
struct Run {
  std::string surface, scheme;
  int degree, bdf, level, k;
};

struct OwnOptions {
  std::vector<std::string> surfaces = known_surfaces, schemes = known_schemes;
};

/// The cases of one scheme.
void add_runs(const std::string& scheme, int degree, int bdf, const std::vector<std::string>& surfaces,
              const std::vector<int>& levels, const std::vector<int>& steps, std::vector<Run>& runs) {
  for (const std::string& surface : surfaces)
    for (const int level : levels)
      for (const int k : steps) runs.push_back({surface, scheme, degree, bdf, level, k});
}

std::vector<Run> preset_runs(const std::string& preset) {
  std::vector<Run> runs;
  const auto add = [&](const char* scheme, int degree, int bdf, const std::vector<int>& levels,
                       const std::vector<int>& steps) {
    add_runs(scheme, degree, bdf, known_surfaces, levels, steps, runs);
  };
  const bool paper = preset == "paper";
  const std::vector<int> some = paper ? range(0, 2) : range(1, 1), many = paper ? range(0, 3) : some;
  const std::vector<int> two = paper ? range(0, 1) : range(0, 0), three = paper ? range(0, 2) : two;
  add("kll19", 2, 3, three, many);
  add("dziuk", 2, 3, three, many);
  add("dziuk", 2, 2, two, some);
  add("bgn", 2, 1, {0}, many);
  add("bgn", 1, 1, two, many);
  if (paper) {
    add("kll19", 2, 1, {0}, many);
    add("dziuk", 2, 1, {0}, many);
  }
  return runs;
}

std::vector<Run> resolve(const Options& options, const OwnOptions& own) {
  if (!options.meshes.empty() || options.start)
    throw InputError(
        "--mesh, --start: all schemes run on generated meshes from exact starting values; expected "
        "--surfaces, "
        "--schemes, --degree, --bdf, --levels, --steps");
  const bool as_in_the_preset = !options.levels && !options.steps && !options.bdf && !options.degree &&
                                own.surfaces == known_surfaces && own.schemes == known_schemes;
  if (as_in_the_preset) return preset_runs(options.preset);
  std::vector<Run> runs;
  for (const std::string& scheme : own.schemes)
    add_runs(scheme, options.degree.value_or(2), scheme == "bgn" ? 1 : options.bdf.value_or(2), own.surfaces,
             options.levels.value_or(range(0, 0)), options.steps.value_or(range(0, 2)), runs);
  return runs;
}

/// Runs the flow from exact_state(0), and fills in errors, distance and seconds.
template <class Flow, class ExactState>
void run_flow(Flow&& flow, int bdf, const ExactState& exact_state, const SurfaceSpace& space, const Field& x0,
              const ExactEvolution& exact, Row& row) {
  using State = typename std::decay_t<Flow>::State;
  Timed<std::decay_t<Flow>> timed{flow};
  ErrorRecorder errors(space, exact, x0);
  const int every = std::max(1, row.steps / recorded_steps);
  double farthest = 0;
  integrate(timed, UniformSteps{bdf, row.tau, row.steps, Start{}},
            {exact_state(0.0), std::function<State(double)>(exact_state)}, [&](int n, const State& state) {
              if (n % every != 0 && n != row.steps) return;
              errors.record(state);
              farthest = std::max(farthest, distance(exact.surface(state.t), state.x));
            });
  row.errors = errors.maxima();
  row.values = {{"distance", farthest},
                {"seconds_of_steps", timed.seconds},
                {"seconds_per_step", timed.seconds / (row.steps - bdf + 1)}};
}

Row run_cell(const Run& run, const Case& start, Row row) {
  // 1. The initial surface and the finite element space on it; that of BGN for P1 is lumped.
  const double h = edge_length(start.largest_h, run.level);
  const auto generate = [&] {
    return run.surface == "sphere" ? generate_mesh(start.surface, h)
                                   : generate_mesh(start.surface, angenent_torus_edge_length(h));
  };
  const Mesh mesh = initial_mesh({}, 0, generate, start.surface, run.degree);
  const bool lumped = run.scheme == "bgn" && run.degree == 1;
  const SurfaceSpace space(mesh, lumped ? vertex_quadrature() : default_quadrature(run.degree));
  describe_mesh(mesh, row);

  // 2. The time steps, some with their errors.
  const ExactEvolution& exact = start.exact;
  const auto go = [&](auto&& flow, const auto& exact_state) {
    run_flow(flow, run.bdf, exact_state, space, mesh.nodes, exact, row);
  };
  if (run.scheme == "kll19")
    go(MeanCurvatureFlow(space, {}),
       [&](double t) { return exact_mean_curvature_state(exact, mesh.nodes, t); });
  else if (run.scheme == "dziuk")
    go(DziukFlow(space), [&](double t) { return exact_dziuk_state(exact, mesh.nodes, t); });
  else
    go(BgnFlow(space), [&](double) { return bgn_state_on(space, mesh.nodes); });
  return row;
}

std::string cell_name(const Run& run) {
  return format("%s_%s_p%d_bdf%d_h%d_tau%d", run.surface.c_str(), run.scheme.c_str(), run.degree, run.bdf,
                run.level, run.k);
}

/// Seconds on one core: BGN's scheme has a system for four unknowns a node.
double estimated_cost(const Run& run, const Case& start) {
  const double nodes = start.vertices * run.degree * run.degree * std::pow(2, run.level),
               steps = start.time_steps.count(run.k);
  return nodes * (2e-4 + steps * (run.scheme == "bgn" ? 30e-6 * run.degree : 4e-6) +
                  std::min<double>(steps, recorded_steps) * 8e-6);
}

std::vector<Cell> cells(const std::vector<Run>& runs) {
  const std::vector<Case> cases = known_cases();
  std::vector<Cell> list;
  for (const Run& run : runs) {
    const Case& start =
        *std::find_if(cases.begin(), cases.end(), [&](const Case& one) { return one.name == run.surface; });
    list.push_back(
        {cell_name(run), estimated_cost(run, start),
         [=](const Row& row, const std::string&) { return run_cell(run, start, row); },
         planned_row(
             run.level, start.time_steps, run.k,
             {{"surface", run.surface}, {"scheme", run.scheme}, {"degree", run.degree}, {"bdf", run.bdf}})});
  }
  return list;
}

nlohmann::json parameters(const std::string& preset) {
  return {{"preset", preset},
          {"start", "exact"},
          {"end_time", {{"sphere", 0.6}, {"angenent_torus", 0.2}}},
          {"largest_tau", {{"sphere", 0.05}, {"angenent_torus", 0.02}}},
          {"meshes", "generated, edge lengths 0.5 (sphere), 0.33 to 0.66 (torus) times 2^(-level/2)"}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "mcf_competitors";
  experiment.paper = "esfem";
  experiment.help =
      "Mean curvature flow of the sphere of radius 2 on [0, 0.6] and the self-shrinking torus on [0, 0.2] by "
      "three "
      "schemes:\n"
      "errors, distance of the nodes from the exact surface, and seconds of the steps. Step sizes 0.05 2^-k "
      "and "
      "0.02 2^-k;\n"
      "level j of the meshes has 2^j times as many triangles as level 0. No units.\n"
      "Without --surfaces, --schemes, --degree, --bdf, --levels, --steps: the runs of the preset.\n\n"
      "Example: mcf_competitors --surfaces sphere --schemes kll19,bgn --steps 0-3 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--surfaces", known_surfaces, own.surfaces, "surfaces to start from");
    line.names("--schemes", known_schemes, own.schemes,
               "kll19: (5.1) | dziuk: kll19 (3.6) | bgn: Barrett, Garcke, Nürnberg 2008, with BDF1 only");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) { return parameters(options.preset); };
  return run_experiment(experiment, argc, argv);
}
