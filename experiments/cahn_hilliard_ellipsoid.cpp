// SPDX-License-Identifier: GPL-3.0-or-later
//
// Cahn-Hilliard equation on an evolving ellipsoid: convergence in space and time (bk22 §9.1, Figures 2 to 5)
//
// Sample runs:  build/bin/cahn_hilliard_ellipsoid --preset check --output ellipsoid.json
//               build/bin/cahn_hilliard_ellipsoid --bdf 3 --levels 0-2 --steps 2-4
//               build/bin/cahn_hilliard_ellipsoid --runs interpolation --degree 2 --levels 0,1 --steps 4
//
// Writes:       results/paper/cahn_hilliard_ellipsoid.{json,csv,tex}, from which
//               plots/cahn_hilliard_ellipsoid.py draws figures/bk22/fig2 .. fig5
//
// The unit sphere moves as {x1²/a(t) + x2² + x3² = 1}, a(t) = 1 + sin(2 pi t)/4, by its normal velocity;
// u = exp(-6t) x1 x2 and the w that belongs to it solve
//   d•u + u div v - Lap w = b,   w + epsilon Lap u = (u³ - u)/epsilon   (9.1)
// on [0, 1] with epsilon = 1/2. The discretisation is (8.3) as corrected in cahn_hilliard.hpp: linear
// elements, BDF1 and BDF3, tau = 0.2 2^-i, i = 1, .., 7, and h halved from mesh to mesh; nodes move by the
// Runge-Kutta method of order 4 with the smallest tau.
//
// The analysis (§3.6, Theorem 4.1) starts from Ritz maps, with the correction theta (3.13) in the second
// equation: the runs ritz_theta, of which the errors are maxima over all n >= 0. The text of §9 starts from
// nodal interpolations and does not mention theta: the runs interpolation, where w(0) has to come from the
// second equation and does not converge; their errors are maxima over n >= q. All runs have the errors at
// the start apart, as u_initial and w_initial.
//
// Beside the published runs: BDF 2, 4 and 5; quadratic elements; the orders of BDF 1 to 5 against a solution
// of the same discretisation with small steps; the errors of d•u that Theorem 4.1 bounds, in L2 over time;
// (8.3) as it is printed, with a load that is not multiplied by tau.
//
// Expected orders (Theorem 4.1 and the BDF methods): tau^q + h^k in H1, one more in h in L2. The nodal H1
// errors, of the difference to the interpolated solution, are better than O(h): those of w least, because
// maxima over n >= 0 contain how far Ritz maps are from interpolations. BDF5 amplifies what Ritz maps as
// starting values are off the discrete solution (w 0.030 at tau = 0.025 on 2,491 nodes; BDF4 0.004).
#include <cmath>
#include <deque>
#include <map>
#include <memory>
#include <optional>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/method_options.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/evolving_ellipsoid.hpp"
#include "solver/mesh/generate.hpp"

namespace {

using namespace esfem;
using State = CahnHilliardState;

const double epsilon = 0.5;
const double largest_h = 0.84;  ///< 40, 160, 636, 2491, 9994 vertices on the levels 0 to 4
const HalvedSteps time_steps{1, 0.2};
const int smallest_step = 7;  ///< the i of the smallest published tau
/// When the runs of the kind "order" begin: the discrete solution has forgotten by then that its initial
/// values are only close to a smooth one.
const double orders_begin = 0.4;

/// The kinds of runs, as --runs names them and as rows are labelled.
const std::vector<std::string> known_runs = {"ritz_theta", "interpolation", "order", "derivative", "printed"};

/// One run of the grid: tau = 0.2 2^-i.
struct Run {
  std::string kind;
  int degree, bdf, level, i;
};

struct OwnOptions {
  std::string quadrature;
  std::vector<std::string> runs;
};

struct Setting {
  std::vector<Run> runs;
  Start start;
  std::vector<std::string> meshes;
  std::string quadrature;
  int smallest;  ///< the i of the smallest tau, with which the nodes move
};

/// Appends all combinations.
struct Grid {
  std::string kind;
  int degree;
  std::vector<int> orders, levels, steps;

  void add_to(std::vector<Run>& runs) const {
    for (int bdf : orders) {
      for (int level : levels) {
        for (int i : steps) runs.push_back({kind, degree, bdf, level, i});
      }
    }
  }
};

std::vector<Run> preset_runs(const std::string& preset) {
  std::vector<Grid> grids;
  if (preset == "paper") {
    grids = {{"ritz_theta", 1, {1, 3}, range(0, 4), range(1, 7)},
             {"ritz_theta", 1, {2, 4, 5}, range(0, 3), range(2, 5)},
             {"ritz_theta", 2, {4}, range(0, 2), {4}},
             {"interpolation", 1, {3}, range(0, 3), {4, 5}},
             {"order", 1, {1}, {1}, {5, 6, 7}},
             {"order", 1, {2, 3, 4, 5}, {1}, {3, 4, 5}},
             {"derivative", 1, {3}, range(1, 3), {3}},
             {"printed", 1, {1}, {1}, {3, 4, 5}}};
  } else {
    grids = {{"ritz_theta", 1, {1}, range(1, 3), range(3, 5)},
             {"ritz_theta", 1, {3}, range(1, 3), range(2, 4)},
             {"ritz_theta", 2, {4}, range(0, 2), {4}},
             {"interpolation", 1, {3}, range(0, 3), {4}},
             {"order", 1, {1}, {0}, {5, 6, 7}},
             {"order", 1, {2, 3, 4, 5}, {0}, {3, 4, 5}},
             {"derivative", 1, {3}, range(1, 3), {3}},
             {"printed", 1, {1}, {1}, {3, 4, 5}}};
  }
  std::vector<Run> runs;
  for (const Grid& grid : grids) grid.add_to(runs);
  return runs;
}

/// Throws InputError when a run of the kind "order" does not find all its starting values before its begin.
void require_starting_values(const Run& run) {
  if (run.kind == "order" && run.bdf * time_steps.tau(run.i) > orders_begin * (1 + 1e-9))
    throw InputError(
        format("--steps: found %d, expected more for --runs order: BDF%d needs %d steps of "
               "0.2 2^-i before t = %g",
               run.i, run.bdf, run.bdf, orders_begin));
}

Setting resolve(const Options& options, const OwnOptions& own) {
  Setting setting;
  setting.start = options.start.value_or(Start{});
  setting.meshes = options.meshes;
  setting.quadrature = own.quadrature;
  const bool as_in_the_preset = !options.degree && !options.levels && !options.steps && !options.bdf &&
                                options.meshes.empty() && own.runs.empty();
  if (as_in_the_preset) {
    setting.runs = preset_runs(options.preset);
  } else {
    const std::vector<std::string> kinds =
        own.runs.empty() ? std::vector<std::string>{"ritz_theta"} : own.runs;
    for (const std::string& kind : kinds) {
      Grid{kind,
           options.degree.value_or(1),
           {options.bdf.value_or(3)},
           mesh_levels(options, {1}),
           options.steps.value_or(range(2, 5))}
          .add_to(setting.runs);
    }
  }
  setting.smallest = smallest_step;
  for (const Run& run : setting.runs) {
    setting.smallest = std::max(setting.smallest, run.i);
    require_starting_values(run);
  }
  return setting;
}

/// A mesh and what all runs on it share: above all the positions of its nodes, at all steps of the smallest
/// tau. Runs that are processes of their own compute them anew: that takes 0.03 microseconds a node and step,
/// beside 12 for a step of a run with its errors, and reading them from a file would not take less.
struct MovingMesh {
  ManufacturedCahnHilliard exact{EvolvingEllipsoid{}, epsilon};
  Mesh mesh;
  SurfaceSpace space;
  double smallest_tau;
  MovingNodes nodes;

  /// substeps: how many of them the starting steps take. The positions at all of them are too many to keep.
  MovingMesh(Mesh initial, const Quadrature& rule, double tau, int substeps)
      : mesh(std::move(initial)),
        space(mesh, rule),
        smallest_tau(tau),
        nodes(exact.ellipsoid().velocity(), mesh.nodes, tau / substeps,
              substeps > 1 ? MovingNodes::newest_few : MovingNodes::all) {}
};

/// Made by the first run that needs it.
using SharedMesh = std::shared_ptr<std::optional<MovingMesh>>;

MovingMesh& moving_mesh(const Setting& setting, const Run& run, std::optional<MovingMesh>& shared) {
  if (!shared) {
    const Surface surface = sphere(1);
    const auto generate = [&] { return generate_mesh(surface, edge_length(largest_h, 2 * run.level)); };
    shared.emplace(initial_mesh(setting.meshes, run.level, generate, surface, run.degree),
                   quadrature_or_default(setting.quadrature, run.degree), time_steps.tau(setting.smallest),
                   setting.start.substeps_per_step);
  }
  return *shared;
}

/// The load of the exact solution times a factor.
struct ScaledLoad : ManufacturedCahnHilliard::Problem {
  double factor = 1;

  void b(double t, const Field& x, Field& nodal) const {
    Problem::b(t, x, nodal);
    nodal *= factor;
  }
};

using Flow = CahnHilliard<ScaledLoad>;

/// theta for the given start.
Field theta_of(const SurfaceSpace& space, const State& start) {
  return cahn_hilliard_theta(space, start.x, start.u, start.w, epsilon,
                             load_of_g(space, DoubleWell(), 0, start.x, start.u));
}

using ExactState = std::function<State(double t)>;

/// Starting values. From interpolated u, w comes from the second equation.
ExactState exact_starts(MovingMesh& on, StartValues values) {
  return [&on, values](double t) {
    State state = exact_cahn_hilliard_state(on.space, on.exact, on.nodes.at(t), t, values);
    if (values == StartValues::interpolation) {
      state.w = cahn_hilliard_w(on.space, state.x, state.u, epsilon,
                                load_of_g(on.space, DoubleWell(), t, state.x, state.u));
    }
    return state;
  };
}

Flow cahn_hilliard_flow(MovingMesh& on, Field theta, double factor_of_load = 1) {
  ScaledLoad problem;
  problem.exact = &on.exact;
  problem.factor = factor_of_load;
  return Flow(
      on.space, problem, [&on](double t) -> const Field& { return on.nodes.at(t); }, epsilon,
      std::move(theta));
}

/// d•u = -6u + v . grad u of the exact solution, its quantity u_derivative. The gradient by differences in
/// space.
ExactEvolution exact_derivative(MovingMesh& on) {
  const auto value = [&on, velocity = on.exact.ellipsoid().velocity()](const Vec3& x, double t) {
    Field v;
    velocity(t, x.transpose(), v);
    return -6 * on.exact.u(x, t) + std::exp(-6 * t) * (v(0, 0) * x[1] + v(0, 1) * x[0]);
  };
  ExactEvolution exact;
  exact.quantities = {{"u_derivative", 1}};
  exact.surface = [&on](double t) { return on.exact.ellipsoid().surface(t); };
  exact.trajectories = [&on](const Field&, double t) { return on.nodes.at(t); };
  exact.fields = [value](double t, const SurfacePoints& at, FieldsAtPoints& out) {
    const double step = 1e-5;
    for (int lane = 0; lane < pack_size; ++lane) {
      const Vec3 y = lane_of(at.y, lane), nu = lane_of(at.normal, lane);
      Vec3 gradient;
      for (int i = 0; i < 3; ++i)
        gradient[i] = (value(y + step * Vec3::Unit(i), t) - value(y - step * Vec3::Unit(i), t)) / (2 * step);
      gradient -= nu.dot(gradient) * nu;
      out.value[0][lane] = value(y, t);
      for (int i = 0; i < 3; ++i) out.gradient[0][i][lane] = gradient[i];
    }
  };
  return exact;
}

/// Errors of d•u from Ritz maps with theta, where the backward differences of u stand for the derivative
/// along the nodes: in L2 over [q tau, 1], the integrals as sums over the steps.
void run_derivative(MovingMesh& on, const UniformSteps& grid, Row& row) {
  const ExactState starts = exact_starts(on, StartValues::ritz);
  const State start = starts(0);
  Flow flow = cahn_hilliard_flow(on, theta_of(on.space, start));
  const ExactEvolution exact = exact_derivative(on);
  const std::vector<double> delta = bdf_delta(grid.order);
  std::deque<Field> newest;  // first, of q + 1 steps
  double L2 = 0, H1_semi = 0;
  integrate(flow, grid, {start, starts}, [&](int n, const State& state) {
    newest.push_front(state.u);
    if (n < grid.order) return;
    newest.resize(grid.order + 1);
    Field derivative = Field::Zero(state.u.rows(), 1);
    for (int j = 0; j <= grid.order; ++j) derivative += delta[j] / grid.tau * newest[j];
    const SquaredNorms norms = lifted_errors(on.space, state.x, exact, state.t, derivative);
    L2 += grid.tau * norms.L2[0];
    H1_semi += grid.tau * norms.H1_semi[0];
  });
  row.errors["u_derivative"] = {{"lifted_L2", std::sqrt(L2)},
                                {"lifted_H1", std::sqrt(L2 + H1_semi)},
                                {"lifted_H1_semi", std::sqrt(H1_semi)}};
}

/// Errors against the exact solution: maxima over n >= 0, or n >= q from interpolated starting values. As
/// printed the first line of (8.3) has f where it should have tau f: the load is too large by 1/tau.
void run_convergence(MovingMesh& on, const std::string& kind, const UniformSteps& grid, Row& row) {
  const bool ritz = kind != "interpolation";
  const ExactState starts = exact_starts(on, ritz ? StartValues::ritz : StartValues::interpolation);
  const State start = starts(0);
  Flow flow = cahn_hilliard_flow(on, ritz ? theta_of(on.space, start) : Field(),
                                 kind == "printed" ? 1 / grid.tau : 1);

  const ExactEvolution exact = exact_evolution(on.exact, on.nodes);
  ErrorRecorder errors(on.space, exact, on.mesh.nodes), initial_errors(on.space, exact, on.mesh.nodes);
  initial_errors.record(start);
  const int first = ritz ? 0 : grid.order;
  integrate(flow, grid, {start, starts}, [&](int n, const State& state) {
    if (n >= first) errors.record(state);
  });
  row.errors = errors.maxima();
  for (const auto& [quantity, norms] : initial_errors.maxima()) row.errors[quantity + "_initial"] = norms;
  row.series = errors.series();
}

/// Errors from orders_begin on against the solution of the same discretisation in space, by BDF5 and small
/// steps.
void run_order(MovingMesh& on, const UniformSteps& grid, Row& row) {
  const UniformSteps small{
      5, on.smallest_tau, static_cast<int>(std::lround(time_steps.end_time / on.smallest_tau)), {}};
  const ExactState starts = exact_starts(on, StartValues::ritz);
  const State start = starts(0);
  Flow flow = cahn_hilliard_flow(on, theta_of(on.space, start));
  const SmallSteps reference(flow, small, start, starts, small.steps / grid.steps);

  LargestDifferences differences(on.space, {{"u", 1}, {"w", 1}});
  const int first = static_cast<int>(std::lround(orders_begin / grid.tau));
  reference.compare(grid.order, grid.tau, first, [&](int, const State& state, const State& exact) {
    differences.add(state.x, state, exact);
  });
  row.errors = differences.errors();
}

nlohmann::json labels(const Run& run) {
  return {{"run", run.kind}, {"bdf", run.bdf}, {"degree", run.degree}};
}

Row run_cell(const Setting& setting, const Run& run, const SharedMesh& shared, Row row) {
  MovingMesh& on = moving_mesh(setting, run, *shared);
  describe_mesh(on.mesh, row);
  const UniformSteps grid{run.bdf, row.tau, row.steps, setting.start};
  if (run.kind == "order") {
    run_order(on, grid, row);
  } else if (run.kind == "derivative") {
    run_derivative(on, grid, row);
  } else {
    run_convergence(on, run.kind, grid, row);
  }
  return row;
}

std::string cell_name(const Run& run) {
  const std::string kind = run.kind == "ritz_theta" ? "" : run.kind + "_";
  const std::string degree = run.degree == 1 ? "" : format("p%d_", run.degree);
  return kind + degree + format("bdf%d_h%d_tau%d", run.bdf, run.level, run.i);
}

/// Seconds on one core: a step with its errors takes about 12 microseconds a P1 node and 8 a P2 node, without
/// errors 5; a mesh with its trajectories takes 0.1 ms a vertex.
double estimated_cost(const Run& run) {
  const double vertices = 27.5 / std::pow(edge_length(largest_h, 2 * run.level), 2);
  const double nodes = vertices * run.degree * run.degree;
  const double steps = time_steps.count(run.i);
  const double microseconds = run.kind == "order" ? 5 * (steps + time_steps.count(smallest_step))
                                                  : (run.degree == 1 ? 12 : 8) * steps;
  return 0.02 + 1e-4 * vertices + 1e-6 * nodes * microseconds;
}

std::vector<Cell> cells(const Setting& setting) {
  std::map<std::pair<int, int>, SharedMesh> meshes;
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    SharedMesh& mesh = meshes[{run.level, run.degree}];
    if (!mesh) mesh = std::make_shared<std::optional<MovingMesh>>();
    list.push_back({cell_name(run), estimated_cost(run),
                    [=](const Row& row, const std::string&) { return run_cell(setting, run, mesh, row); },
                    planned_row(run.level, time_steps, run.i, labels(run))});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", time_steps.end_time},
          {"epsilon", epsilon},
          {"start", to_string(setting.start)},
          {"quadrature", setting.quadrature.empty() ? "that of the degree" : setting.quadrature},
          {"tau_of_the_nodes", time_steps.tau(setting.smallest) / setting.start.substeps_per_step},
          {"errors", "maxima over n >= 0; interpolation: over n >= q; u_derivative: L2 over time, n >= q"},
          {"meshes", mesh_parameter(setting.meshes, "generated, edge length 0.84 2^-level")}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "cahn_hilliard_ellipsoid";
  experiment.paper = "bk22";
  experiment.help =
      "The Cahn-Hilliard equation on an evolving ellipsoid (bk22 Figures 2 to 5): errors of u and w over "
      "step "
      "size and mesh\n"
      "width, maxima over time. Step sizes 0.2 2^-i, i = 1, 2, ..; edge lengths 0.84 2^-j, level j = 0, 1, "
      ".. No units:\n"
      "epsilon = 1/2.\n"
      "Without --runs, --degree, --bdf, --levels, --steps, --mesh: the runs of the preset. With one of them: "
      "all\n"
      "combinations, where not given ritz_theta, linear elements, BDF3, level 1, i = 2..5.\n\n"
      "Example: cahn_hilliard_ellipsoid --bdf 3 --levels 0-2 --steps 2-4 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--runs", known_runs, own.runs,
               "ritz_theta: Ritz maps and theta | interpolation: interpolated u, no theta | order: "
               "errors against small steps | derivative: errors of d•u | printed: (8.3) without tau before "
               "its load");
    add_quadrature_option(line, own.quadrature);
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  experiment.fit_range.tau_max = 0.05;
  return run_experiment(experiment, argc, argv);
}
