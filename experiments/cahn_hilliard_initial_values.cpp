// SPDX-License-Identifier: GPL-3.0-or-later
//
// What the initial values and the correction theta of (3.13) do to the Cahn-Hilliard equation on an evolving
// ellipsoid (bk22 §9.3, Figure 8)
//
// Sample runs:  build/bin/cahn_hilliard_initial_values --preset check --output initial_values.json
//               build/bin/cahn_hilliard_initial_values --schemes ritz,interpolation_theta --levels 1
//               build/bin/cahn_hilliard_initial_values --constants printed --epsilon 0.1 --levels 2
//
// Writes:       results/paper/cahn_hilliard_initial_values.{json,csv,tex}, from which
//               plots/cahn_hilliard_initial_values.py draws figures/bk22/fig8, and the surfaces as
//               results/paper/cells/cahn_hilliard_initial_values/CELL/surfaces.pvd
//
// d•u + u div v = Lap w, w = -epsilon Lap u + (u³ - u)/epsilon on {x1²/a(t) + x2² + x3² = 25}, a(t) = 1 + 0.5
// sin(2 pi t/5), from u = c (x1 + x1² x2² x3), by (8.3) with linear elements and BDF2. Schemes:
//   interpolation        u interpolated, no theta: (3.12)
//   ritz_theta           the Ritz map (5.4) of u, and theta = M (w* - w) from that of w(0): (3.15)
//   ritz, interpolation_theta    one of the two
// and constants c:
//   unit      1/226.7724255776, for which max |u| = 1 as the paper says
//   printed   225/56693, for which it is 0.9
// The paper does not say what epsilon is here; 0.5 is that of its convergence tests, whose interfaces
// (thickness about 3 epsilon) the elements of the published mesh (edges up to 0.38) can resolve. Those of
// 0.1, as in §9.2, they cannot.
//
// Expected: both solutions look alike, u differs by 0.4% with 4,098 nodes, and by O(h²); but w(0) from the
// second equation does not converge in all nodes.
#include <algorithm>
#include <cmath>

#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/analysis/energy_series.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/error.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/evolving_ellipsoid.hpp"
#include "solver/flows/ritz_map.hpp"

namespace {

using namespace esfem;
using State = CahnHilliardState;

/// The paper's Ritz map has no length in it, though the radius is 5.
const double ritz_length = 1;
const double radius = 5, end_time = 5, largest_tau = 0.0125, default_epsilon = 0.5;
const EvolvingEllipsoid moving_ellipsoid{0.5, 5, radius};
const std::vector<double> snapshot_times = {1, 2, 3};  // beside the start and the end

/// Level 0: 258 nodes of linear elements, an octahedron subdivided three times; level 2: 4,098, as published.
const int level_count = 4, coarsest_subdivisions = 3;

const std::vector<std::string> known_schemes = {"interpolation", "ritz_theta", "ritz", "interpolation_theta"};
const std::vector<std::string> known_constants = {"unit", "printed"};

double factor(const std::string& constant) {
  return constant == "unit" ? 1 / 226.7724255776 : 225.0 / 56693;
}

/// One run.
struct Run {
  std::string scheme, constant;
  int level, k;

  bool by_ritz_map() const { return scheme == "ritz" || scheme == "ritz_theta"; }
  bool with_theta() const { return scheme == "ritz_theta" || scheme == "interpolation_theta"; }
};

struct OwnOptions {
  std::vector<std::string> schemes, constants;
  double epsilon = default_epsilon;
};

struct Setting {
  std::vector<Run> runs;
  int degree, bdf;
  Start start;
  double epsilon;
  std::vector<std::string> meshes;
};

std::vector<Run> preset_runs(const std::string& preset) {
  const bool paper = preset == "paper";
  const int k = 0, finest = paper ? 2 : 1;
  std::vector<Run> runs;
  for (const std::string& scheme : known_schemes) {
    if (scheme == "interpolation") runs.push_back({scheme, "unit", finest, k});
    if (scheme == "ritz_theta" || paper)
      for (const int level : range(0, finest))
        if (scheme != "interpolation") runs.push_back({scheme, "unit", level, k});
  }
  runs.push_back({"interpolation", "printed", 0, k});
  return runs;
}

Setting resolve(const Options& options, const OwnOptions& own) {
  Setting setting;
  setting.degree = options.degree.value_or(1);
  setting.bdf = options.bdf.value_or(2);
  setting.start = options.start.value_or(parse_start("cascade"));
  setting.epsilon = own.epsilon;
  setting.meshes = options.meshes;
  if (setting.start.kind == Start::exact)
    throw InputError("--start exact: there is no exact solution; expected cascade or substeps:K");
  if (!options.levels && !options.steps && own.schemes.empty() && own.constants.empty() &&
      options.meshes.empty()) {
    setting.runs = preset_runs(options.preset);
    return setting;
  }
  const std::vector<int> levels = mesh_levels(options, {1});
  if (options.meshes.empty()) require_levels(levels, level_count, "levels");
  for (const std::string& scheme : own.schemes.empty() ? known_schemes : own.schemes)
    for (const std::string& constant :
         own.constants.empty() ? std::vector{known_constants[0]} : own.constants)
      for (const int level : levels)
        for (const int k : options.steps.value_or(std::vector<int>{0}))
          setting.runs.push_back({scheme, constant, level, k});
  return setting;
}

/// u at t = 0 as a function of space.
struct Concentration {
  double c;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    return c * (x1 + x1 * x1 * x2 * x2 * x3);
  }
};

/// w = -epsilon Delta_Gamma u + (u³ - u)/epsilon on the initial sphere. There Delta_Gamma p = Delta p - l (l
/// + 1) p/radius² for p homogeneous of degree l, here 1 and 5.
struct Potential {
  Concentration u;
  double epsilon;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    const double inverse = 1 / (radius * radius);
    const T laplacian =
        u.c * (2.0 * (x1 * x1 + x2 * x2) * x3 - inverse * (2.0 * x1 + 30.0 * x1 * x1 * x2 * x2 * x3));
    const T value = u(x1, x2, x3);
    return value * (value * value - 1.0) / epsilon - epsilon * laplacian;
  }
};

/// Value and tangential gradient on the initial sphere of a function in space.
template <class Function>
std::function<ValueAndGradient(const Vec3&)> on_sphere(const Function& f) {
  return [f](const Vec3& y) {
    const LevelSetJet jet = level_set_jet(f, y);
    const Vec3 normal = y.normalized();
    return ValueAndGradient{jet.value, jet.gradient - normal.dot(jet.gradient) * normal};
  };
}

/// The maximum of |f| on the initial sphere: from the best node of a mesh, steps along the tangential
/// gradient, halved where they lead down.
template <class Function>
double largest_on_sphere(const Function& f) {
  const Field nodes = octasphere(radius, 5).nodes;
  const auto size = [&](const Vec3& y) { return std::abs(f(y[0], y[1], y[2])); };
  Vec3 best = nodes.row(0);
  for (int j = 1; j < nodes.rows(); ++j)
    if (size(nodes.row(j)) > size(best)) best = nodes.row(j);
  for (double step = radius / 10; step > 1e-9 * radius;) {
    const ValueAndGradient at = on_sphere(f)(best);
    const Vec3 uphill = at.value > 0 ? at.gradient : Vec3(-at.gradient);
    if (uphill.norm() == 0) break;
    const Vec3 next = radius * (best + step * uphill.normalized()).normalized();
    if (size(next) > size(best))
      best = next;
    else
      step /= 2;
  }
  return size(best);
}

struct InitialValues {
  State state;
  Field theta;  ///< empty: none
};

InitialValues initial_values(const SurfaceSpace& space, const Field& x, const Run& run, double epsilon) {
  const Surface sphere = moving_ellipsoid.surface(0);
  const Concentration u_0{factor(run.constant)};
  Field u(x.rows(), 1);
  if (run.by_ritz_map()) {
    u = ritz_map(space, x, sphere, on_sphere(u_0), ritz_length);
  } else {
    for (int j = 0; j < x.rows(); ++j) u(j, 0) = u_0(x(j, 0), x(j, 1), x(j, 2));
  }
  if (!run.with_theta()) return {cahn_hilliard_start(space, DoubleWell(), epsilon, 0, x, u), {}};
  const Field g = load_of_g(space, DoubleWell(), 0, x, u);
  const Field w = ritz_map(space, x, sphere, on_sphere(Potential{u_0, epsilon}), ritz_length);
  return {cahn_hilliard_state(space, 0, x, u, w), cahn_hilliard_theta(space, x, u, w, epsilon, g)};
}

/// Integrates a scheme from its initial values.
void integrate_scheme(const SurfaceSpace& space, const Mesh& mesh, const Setting& setting, const Run& run,
                      const UniformSteps& grid, const std::function<void(int, const State&)>& observe) {
  const InitialValues start = initial_values(space, mesh.nodes, run, setting.epsilon);
  MovingNodes nodes(moving_ellipsoid.velocity(), mesh.nodes, grid.tau / grid.start.substeps_per_step);
  const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
  CahnHilliard flow(space, DoubleWell(), motion, setting.epsilon, start.theta);
  integrate(flow, grid, start.state, observe);
}

/// The solution of (3.12) at each step, which that of another scheme is compared with.
struct Reference {
  std::vector<Field> u, w;
};

Reference interpolation_run(const SurfaceSpace& space, const Mesh& mesh, const Setting& setting, Run run,
                            const UniformSteps& grid) {
  run.scheme = "interpolation";
  Reference reference;
  integrate_scheme(space, mesh, setting, run, grid, [&](int, const State& state) {
    reference.u.push_back(state.u);
    reference.w.push_back(state.w);
  });
  return reference;
}

/// Appends L2 and maximum norm of u and w minus those of (3.12), relative to the norms of the latter.
void record_differences(const SurfaceSpace& space, const State& state, const Reference& reference, int n,
                        Series& series) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(state.x, M, A);
  const auto record = [&](const std::string& name, const Field& values, const Field& others) {
    const Field difference = values - others;
    const auto L2 = [&](const Field& f) { return std::sqrt(f.col(0).dot((M * f).col(0))); };
    series[name + "_difference_L2"].push_back(L2(difference) / L2(others));
    series[name + "_difference_max"].push_back(difference.cwiseAbs().maxCoeff() /
                                               others.cwiseAbs().maxCoeff());
  };
  record("u", state.u, reference.u.at(n));
  record("w", state.w, reference.w.at(n));
}

/// Differences at the times of the figure, as values and, for their orders, as errors; extrema of u.
void describe_differences(const Series& series, Row& row) {
  for (const double t : {0.0, 1.0, 2.0, 3.0, 5.0}) {
    for (const std::string name : {"u", "w"}) {
      for (const std::string norm : {"L2", "max"}) {
        const double value = series.at(name + "_difference_" + norm)[nearest(series, t)];
        row.values[name + "_difference_" + norm + format("_at_%g", t)] = value;
        row.errors[name + format("_at_%g", t)]["difference_" + norm] = value;
      }
    }
  }
}

std::string cell_name(const Run& run) {
  return format("%s_%s_h%d_tau%d", run.scheme.c_str(), run.constant.c_str(), run.level, run.k);
}

Row run_cell(const Setting& setting, const Run& run, Row row, const std::string& folder) {
  // 1. The initial sphere and the finite element space on it.
  const auto generate = [&] { return octasphere(radius, coarsest_subdivisions + run.level); };
  const Mesh mesh =
      initial_mesh(setting.meshes, run.level, generate, moving_ellipsoid.surface(0), setting.degree);
  const SurfaceSpace space(mesh);
  describe_mesh(mesh, row);

  // 2. The scheme, and beside it (3.12).
  const UniformSteps grid{setting.bdf, row.tau, row.steps, setting.start};
  const bool compared = run.scheme != "interpolation";
  Reference reference;
  if (compared) reference = interpolation_run(space, mesh, setting, run, grid);
  Series series;
  RunRecorder recorder(space, snapshot_plan(folder, snapshot_times, "cahn_hilliard", row));
  std::size_t next_snapshot = 0;
  integrate_scheme(space, mesh, setting, run, grid, [&](int n, const State& state) {
    record_energy(space, state, setting.epsilon, series);
    if (compared) record_differences(space, state, reference, n, series);
    const bool due = next_snapshot < snapshot_times.size() && state.t > snapshot_times[next_snapshot] - 1e-9;
    if (due) ++next_snapshot;
    if (due || n == 0 || n == row.steps) recorder.record(n, state.t, state.x, nodal_fields(state));
  });
  recorder.finish();

  // 3. The row of the table.
  describe_run(recorder, row);
  row.series = thinned(series, 1000);
  row.values["largest_u0"] = largest_on_sphere(Concentration{factor(run.constant)});
  row.values["mass_drift"] = std::abs(series["mass"].back() - series["mass"].front());
  row.values["last_min_u"] = series["min_u"].back();
  row.values["last_max_u"] = series["max_u"].back();
  if (compared) describe_differences(series, row);
  return row;
}

/// Seconds on one core.
double estimated_cost(const Run& run) {
  const double nodes = 258 * std::pow(4.0, run.level);
  const int runs = run.scheme == "interpolation" ? 1 : 2;
  return runs * HalvedSteps{end_time, largest_tau}.count(run.k) * (1e-3 + 3.4e-6 * nodes);
}

std::vector<Cell> cells(const Setting& setting) {
  const HalvedSteps steps{end_time, largest_tau};
  std::vector<Cell> list;
  for (const Run& run : setting.runs) {
    list.push_back(
        {cell_name(run), estimated_cost(run),
         [=](const Row& row, const std::string& folder) { return run_cell(setting, run, row, folder); },
         planned_row(run.level, steps, run.k, {{"scheme", run.scheme}, {"constant", run.constant}})});
  }
  return list;
}

nlohmann::json parameters(const Setting& setting, const std::string& preset) {
  return {{"preset", preset},
          {"end_time", end_time},
          {"epsilon", setting.epsilon},
          {"radius", radius},
          {"amplitude", moving_ellipsoid.amplitude},
          {"period", moving_ellipsoid.period},
          {"degree", setting.degree},
          {"bdf", setting.bdf},
          {"start", to_string(setting.start)},
          {"largest_tau", largest_tau},
          {"meshes", mesh_parameter(setting.meshes, "subdivided octahedron, level 0: 258 nodes")}};
}

}  // namespace

int main(int argc, char** argv) {
  OwnOptions own;
  Experiment experiment;
  experiment.stem = "cahn_hilliard_initial_values";
  experiment.paper = "bk22";
  experiment.help =
      "The Cahn-Hilliard equation on an evolving ellipsoid from interpolated initial values and from their "
      "Ritz maps with the\n"
      "correction theta (bk22 Figure 8): snapshots, and how far the solutions differ, relative to that of "
      "interpolation. Step\n"
      "sizes 0.0125 2^-k, t to 5; levels 0 to 3: 258, 1,026, 4,098 (as published), 16,386 nodes of linear "
      "elements. No units.\n"
      "Without --schemes, --constants, --levels, --steps, --mesh: the runs of the preset. With one of them: "
      "all combinations,\n"
      "where not given of all schemes, the constant unit, level 1, k = 0.\n\n"
      "Example: cahn_hilliard_initial_values --schemes ritz_theta --levels 0-2 --output table.json";
  experiment.add_options = [&](CommandLine& line) {
    line.names("--schemes", known_schemes, own.schemes,
               "initial u by interpolation or Ritz map, without or with the correction theta");
    line.names("--constants", known_constants, own.constants,
               "of the initial u: unit: max |u| = 1 | printed: 225/56693");
    line.positive("--epsilon", own.epsilon, "of the equation");
  };
  experiment.cells = [&](const Options& options) { return cells(resolve(options, own)); };
  experiment.parameters = [&](const Options& options) {
    return parameters(resolve(options, own), options.preset);
  };
  return run_experiment(experiment, argc, argv);
}
