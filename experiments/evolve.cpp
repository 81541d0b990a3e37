// SPDX-License-Identifier: GPL-3.0-or-later
//
// Any flow on any surface or mesh, from a JSON file
//
// Sample runs:  build/bin/evolve reference/examples/sphere.json
//               build/bin/evolve reference/examples/dumbbell.json
//               build/bin/evolve reference/examples/tumour.json
//               build/bin/evolve reference/examples/willmore.json
//
// Writes the nodal values at the end, a time series and snapshots, as the file says; `evolve --help` explains
// its keys.
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <optional>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/evolve_advice.hpp"
#include "experiments/harness/evolve_config.hpp"
#include "experiments/harness/evolve_files.hpp"
#include "experiments/harness/evolve_start.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/grid.hpp"
#include "experiments/harness/provenance.hpp"
#include "experiments/harness/stop_signal.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/run_recorder.hpp"
#include "solver/analysis/table.hpp"
#include "solver/error.hpp"
#include "solver/flows/bgn_flow.hpp"
#include "solver/flows/coupled_diffusion.hpp"
#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/phase_separation.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/thread_count.hpp"
#include "solver/time/integrate.hpp"

namespace {

using namespace esfem;
using nlohmann::json;

template <class State>
using ExactState = std::function<State(double)>;

/// The field that adaptive steps follow: u where the flow has one, else the positions.
template <class State, class = void>
constexpr const char* controlled = "x";
template <class State>
constexpr const char* controlled<State, std::void_t<decltype(&State::u)>> = "u";

/// Their units on a surface with length L: L for positions, 1/L for H, none for normals and u.
template <class State>
std::vector<double> units_of_controlled(const State&, double L) {
  return controlled<State>[0] == 'x' ? std::vector<double>(3, L) : std::vector<double>();
}
std::vector<double> units_of_controlled(const MeanCurvatureFlow::State&, double L) {
  return {1, 1, 1, 1 / L};
}
std::vector<double> units_of_controlled(const WillmoreFlow::State&, double L) {
  return {1 / L, 1, 1, 1};
}

std::optional<Checkpoint> checkpoint_of(const EvolveConfig& config, const json& config_json,
                                        RunRecorder& recorder) {
  if (config.checkpoint.empty()) return {};
  std::optional<Checkpoint> checkpoint =
      Checkpoint(config.checkpoint, run_identity(config, config_json), checkpoint_seconds(), warn);
  attach(*checkpoint, recorder);
  return checkpoint;
}

/// A run: what is asked for, and what keeps it.
struct Run {
  const EvolveConfig& config;
  const SurfaceSpace& space;
  RunRecorder& recorder;
  Checkpoint* checkpoint;
  std::string& remark;  ///< on the result, for the status: empty, or that nu and H are not the surface's
};

/// Whether the flow evolves nu and H: then they are not those of the discrete surface.
bool evolves_curvature(const EvolveConfig& config) {
  return config.flow == "mean_curvature" || config.flow == "willmore" || config.flow == "surface_diffusion";
}

bool is_mean_curvature_flow(const EvolveConfig& config) {
  return config.flow == "mean_curvature" || config.flow == "dziuk" || config.flow == "bgn";
}

bool can_shrink_to_nothing(const EvolveConfig& config) {
  return is_mean_curvature_flow(config) || config.flow == "coupled_diffusion";
}

/// Says once that nu and H of the flow are no longer those of the surface.
void compare_curvature(const Run& run) {
  if (!run.remark.empty() || !evolves_curvature(run.config)) return;
  const auto found = run.recorder.compare_curvature();
  if (!found || !have_parted(run.config, *found)) return;
  run.remark = curvature_remark(*found, run.recorder.newest().t);
  warn(run.remark + "; " + curvature_cure(run.config));
}

void look_at_first_step(const Run& run) {
  if (run.config.flow != "bgn") return;
  run.remark = sliding_remark(run.recorder.series());
  warn(run.remark);
}

/// Throws ExtinctionError where a surface that shrinks will have no area left for the next step.
void require_area(const Run& run) {
  if (!can_shrink_to_nothing(run.config)) return;
  const Series& series = run.recorder.series();
  std::optional<double> end = extinction_time(series);
  if (is_mean_curvature_flow(run.config)) {
    const double latest = latest_end_of_mean_curvature_flow(series);
    if (series.at("t").back() >= latest) end = latest;
  }
  if (end) throw ExtinctionError(extinction(*end, series));
}

/// What the series of a flow have beside those of its surface.
template <class State>
void record_more(const Run&, const State&) {}

void record_more(const Run& run, const CahnHilliardState& state) {
  Series& series = run.recorder.series();
  series["mass"].push_back(state.Mu.sum());
  series["energy"].push_back(
      ginzburg_landau_energy(run.space, state.x, state.u, run.config.cahn_hilliard.epsilon));
}

/// The limits of a run; size_of_u: of what diffuses on the surface, where something does.
RegularityLimits limits(const Run& run, double size_of_u = 0) {
  const auto& asked = run.config.limits;
  RegularityLimits limits = limits_from_start(run.space, run.config.mesh.nodes);
  if (asked.curvature_size) limits.curvature_size = *asked.curvature_size;
  if (asked.radius_ratio) limits.radius_ratio = *asked.radius_ratio;
  if (asked.normal_length) limits.normal_length = *asked.normal_length;
  if (size_of_u > 0) limits.field_size = 1e3 * size_of_u;
  return limits;
}

/// Integrates from `initial` and records every step. exact: the exact solution, where one is known.
template <class Flow, class State = typename std::decay_t<Flow>::State>
void run_flow(Flow&& flow, const Run& run, const State& initial, const ExactState<State>& exact) {
  const EvolveConfig& config = run.config;
  UniformSteps grid = config.grid;
  if (!config.start_given && !exact) grid.start = parse_start("substeps:16");
  const double end = config.adaptive ? config.adaptive->end_time : grid.steps * grid.tau;
  const bool terminal = isatty(STDERR_FILENO);
  const auto observe = [&](int n, const State& state) {
    run.recorder.record(n, state.t, state.x, nodal_fields(state));
    record_more(run, state);
    if (n == 1) look_at_first_step(run);
    if (n % steps_between_comparisons == 0) compare_curvature(run);
    require_area(run);
    if (!config.adaptive && n == grid.steps) run.recorder.finish();
    if (terminal)
      std::fprintf(stderr, "\rstep %d, t = %g of %g%s", n, state.t, end, state.t >= end ? "\n" : "");
    return stop_signal() == 0;
  };
  note_stop_signals();
  if (config.adaptive) {
    AdaptiveSteps adaptive = *config.adaptive;
    adaptive.controlled = controlled<State>;
    adaptive.units = units_of_controlled(initial, run.space.length());
    integrate(flow, adaptive, initial, run.checkpoint, observe);
  } else {
    integrate(flow, grid, {initial, exact}, run.checkpoint, observe);
  }
}

/// A sphere and the self-shrinking torus have exact solutions under mean curvature flow.
std::optional<ExactEvolution> exact_solution(const EvolveConfig& config) {
  if (!config.surface) return {};
  const auto& name = config.surface->name;
  const auto& parameters = config.surface->parameters;
  if (name == "sphere") return shrinking_sphere(parameters.at("radius"));
  if (name == "angenent_torus") return shrinking_angenent_torus(parameters.at("scale"));
  return {};
}

void run_mean_curvature(const Run& run) {
  using State = MeanCurvatureFlow::State;
  const EvolveConfig& config = run.config;
  const Field& x0 = config.mesh.nodes;
  const std::optional<ExactEvolution> exact = exact_solution(config);
  ExactState<State> exact_state;
  if (exact) exact_state = [&](double t) { return exact_mean_curvature_state(*exact, x0, t); };
  const std::optional<State> from_file = mean_curvature_state_in_file(config);
  State initial = from_file        ? *from_file
                  : config.surface ? mean_curvature_state_on(*config.surface, x0)
                                   : discrete_mean_curvature_state(run.space, x0);
  MeanCurvatureFlow flow(run.space, config.mean_curvature, limits(run));
  flow.reinitialise(initial);
  run_flow(flow, run, initial, exact_state);
}

void run_dziuk(const Run& run) {
  using State = DziukFlow::State;
  const Field& x0 = run.config.mesh.nodes;
  const std::optional<ExactEvolution> exact = exact_solution(run.config);
  ExactState<State> exact_state;
  if (exact) exact_state = [&](double t) { return exact_dziuk_state(*exact, x0, t); };
  warn(dziuk_warning(run.config.adaptive ? run.config.adaptive->order : run.config.grid.order));
  run_flow(DziukFlow(run.space, limits(run)), run, dziuk_state_on(run.space, x0), exact_state);
}

void run_bgn(const Run& run) {
  run_flow(BgnFlow(run.space, limits(run)), run, bgn_state_on(run.space, run.config.mesh.nodes), {});
}

void run_growing_sphere(const Run& run) {
  const EvolveConfig::Coupled& coupled = run.config.coupled;
  const ExactEvolution exact = growing_sphere();
  const ExactState<CoupledDiffusionState> exact_state = [&](double t) {
    return exact_growing_sphere_state(run.space, exact, run.config.mesh.nodes, t);
  };
  const GrowingSphereProblem problem(coupled.parameters, coupled.variant.law, coupled.coupling);
  const CoupledDiffusionState initial = exact_state(0);
  run_flow(CoupledDiffusion(run.space, problem, coupled.parameters, coupled.variant,
                            limits(run, initial.u.cwiseAbs().maxCoeff())),
           run, initial, exact_state);
}

void run_tumour_growth(const Run& run) {
  const EvolveConfig::Coupled& coupled = run.config.coupled;
  std::optional<CoupledDiffusionState> initial = tumour_in_file(run.config, run.space);
  if (!initial)
    initial = tumour_growth_state(run.space, run.config.mesh.nodes, coupled.kinetics, coupled.disturbance,
                                  coupled.seed, run.config.disturbance_origin);
  // From nothing u grows to its steady state, which is no blow-up.
  const double size_of_u = std::max(initial->u.cwiseAbs().maxCoeff(),
                                    TumourGrowth::steady_state(coupled.kinetics).cwiseAbs().maxCoeff());
  run_flow(CoupledDiffusion(run.space, TumourGrowth(coupled.kinetics), coupled.parameters, coupled.variant,
                            limits(run, size_of_u)),
           run, *initial, {});
}

void run_willmore(const Run& run) {
  const EvolveConfig& config = run.config;
  const Field& x0 = config.mesh.nodes;
  std::optional<WillmoreStart> start = willmore_start_in_file(config, run.space);
  if (!start)
    start = config.surface ? willmore_start_on(run.space, *config.surface, x0, config.willmore.law,
                                               config.willmore_theta)
                           : discrete_willmore_start(run.space, x0, config.willmore.law);
  WillmoreFlow flow(run.space, config.willmore, start->theta, limits(run));
  flow.reinitialise(start->state);
  run_flow(flow, run, start->state, {});
}

void run_manufactured_cahn_hilliard(const Run& run) {
  const EvolveConfig& config = run.config;
  const UniformSteps& grid = config.grid;
  const ManufacturedCahnHilliard exact(EvolvingEllipsoid(), config.cahn_hilliard.epsilon);
  MovingNodes nodes(exact.ellipsoid().velocity(), config.mesh.nodes, grid.tau / grid.start.substeps_per_step);
  const NodalMotion motion = [&](double t) -> const Field& { return nodes.at(t); };
  const ExactState<CahnHilliardState> exact_state = [&](double t) {
    return exact_cahn_hilliard_state(run.space, exact, nodes.at(t), t, config.cahn_hilliard.initial);
  };
  const CahnHilliardState start = exact_state(0);
  Field theta;
  if (config.cahn_hilliard.theta)
    theta = cahn_hilliard_theta(run.space, start.x, start.u, start.w, exact.epsilon(),
                                load_of_g(run.space, DoubleWell(), 0, start.x, start.u));
  run_flow(CahnHilliard(run.space, exact.problem(), motion, exact.epsilon(), theta), run, start, exact_state);
}

void run_phase_separation(const Run& run) {
  const auto& [problem, epsilon, theta, initial, mean, disturbance, seed] = run.config.cahn_hilliard;
  const Field& x = run.config.mesh.nodes;
  std::optional<CahnHilliardState> start = mixture_in_file(run.config, run.space);
  if (!start)
    start = disturbed_mixture(run.space, x, epsilon, mean, disturbance, seed, run.config.disturbance_origin);
  PhaseSeparation flow(run.space, x, epsilon);
  run_flow(flow, run, *start, {});
  if (flow.replaced_steps() > 0)
    warn(format("steps in which the energy would have risen, replaced by smaller ones of backward Euler: %d",
                flow.replaced_steps()));
}

void run_cahn_hilliard(const Run& run) {
  const auto& asked = run.config.cahn_hilliard;
  asked.problem == asked.ellipsoid ? run_manufactured_cahn_hilliard(run) : run_phase_separation(run);
}

void run(const Run& run) {
  const std::string& flow = run.config.flow;
  if (flow == "mean_curvature") return run_mean_curvature(run);
  if (flow == "dziuk") return run_dziuk(run);
  if (flow == "bgn") return run_bgn(run);
  if (flow == "willmore" || flow == "surface_diffusion") return run_willmore(run);
  if (flow == "cahn_hilliard") return run_cahn_hilliard(run);
  const bool is_sphere = run.config.coupled.problem == EvolveConfig::Coupled::growing_sphere;
  is_sphere ? run_growing_sphere(run) : run_tumour_growth(run);
}

/// How a run has ended that met an error: extinct where a surface that shrinks had no area left for the step.
std::string end_of(const EvolveConfig& config, RunRecorder& recorder, const NumericsError& error) {
  const bool extinct = dynamic_cast<const ExtinctionError*>(&error) != nullptr;
  if (extinct || recorder.empty()) return error.what();
  if (can_shrink_to_nothing(config)) {
    if (const std::optional<double> end = extinction_time(recorder.series(), 3))
      return extinction(*end, recorder.series()) + "; the next step: " + error.what();
  }
  return std::string(error.what()) + "; " + cure(config);
}

/// How a run that a signal has stopped ends.
std::string stopped_status(const RunRecorder& recorder) {
  return format("stopped by signal %s at t = %g (step %d)", stop_signal() == SIGINT ? "SIGINT" : "SIGTERM",
                recorder.newest().t, recorder.newest().step);
}

int evolve(const std::string& file, const json& origin) {
  const json config_json = read_json(file);
  const EvolveConfig config = evolve_config(config_json, file);
  prepare_outputs(config, config_json, file);
  for (const std::string& remark : config.mesh_remarks) warn(remark);
  warn(thin_elements_remark(config.mesh, config.mesh_origin));
  const SurfaceSpace space(config.mesh, config.rule);
  const bool fourth_order = config.flow == "willmore" || config.flow == "surface_diffusion";
  SnapshotPlan plan = config.snapshots;
  plan.run = {config.flow, config_json.dump()};
  plan.origin = config.origin;
  RunRecorder recorder(space, plan,
                       fourth_order ? RunRecorder::of_flow_and_surface : RunRecorder::of_the_flow);
  std::optional<Checkpoint> checkpoint = checkpoint_of(config, config_json, recorder);
  warn(start_remark(config));
  if (evolves_curvature(config) && !config.surface && start_values(config, {"nu", "H"}).size() == 0)
    warn("no exact surface is given: nu and H at the start are computed on the discrete surface");
  std::string remark;
  if (checkpoint)
    checkpoint->attach([&] { return json(remark); },
                       [&](const json& saved) { remark = saved.get<std::string>(); });
  const Run asked = {config, space, recorder, checkpoint ? &*checkpoint : nullptr, remark};
  std::vector<std::string> failures;
  try {
    run(asked);
    compare_curvature(asked);
    failures =
        write_outputs(config, recorder, remark.empty() ? "ok" : "ok, but " + remark, config_json, origin);
  } catch (const NumericsError& error) {
    const std::string status = end_of(config, recorder, error);
    if (!recorder.empty()) {
      failures = write_outputs(config, recorder, status, config_json, origin);
      warn(failures.empty() ? format("what was computed up to t = %g is written", recorder.newest().t)
                            : joined(failures, config));
    }
    throw NumericsError(status);
  } catch (const StoppedError&) {
    const std::string status = stopped_status(recorder);
    failures = write_outputs(config, recorder, status, config_json, origin);
    failures.insert(failures.begin(), status);
    throw StoppedError(joined(failures, config));
  } catch (const InputError& error) {
    if (recorder.empty()) throw;
    failures =
        write_outputs(config, recorder, format("stopped at t = %g: %s", recorder.newest().t, error.what()),
                      config_json, origin, {error.what()});
  }
  if (!failures.empty()) throw InputError(joined(failures, config));
  return exit_done;
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main([&] {
    std::string file;
    int threads = 1;
    CommandLine line(
        "Evolves a surface: flow, surface or mesh, and method come from a JSON file.\n"
        "Example: evolve reference/examples/sphere.json\n\n" +
            evolve_config_help(),
        "evolve");
    line.argument("config", file, "the configuration", "CONFIG.json");
    line.integer("--threads", 1, 1024, threads, "threads that the factorisations may use");
    if (!line.parse(argc, argv)) return static_cast<int>(exit_done);
    set_thread_count(threads);
    return evolve(file, provenance(argc, argv));
  });
}
