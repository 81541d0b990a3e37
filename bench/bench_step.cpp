// SPDX-License-Identifier: GPL-3.0-or-later
// Time of one step of kll19 (5.1), linearly implicit BDF3 on P2 icospheres of radius 2, by phase, and its
// ratio to a naive step. One row per mesh, N = 2.5k, 10k, 41k, 164k; milliseconds of CPU time of all threads,
// medians. Then a whole step of the flow, loads included, on the dumbbell of kll19 §13.2 with 10.5k nodes, as
// a ratio to the two factorisations and solves in it; and a step of Willmore flow (kll21) with about 10k and
// 12k nodes, as a ratio to its factorisation and solves and to a naive one, and a step that has a
// factorisation already. A step of Cahn-Hilliard (bk22 §9.2) on P1 with 10,242 nodes, motion and loads
// included, as a ratio to a naive one. Finally (5.1) with tangential motion of minimal deformation rate, as a
// ratio to (5.1) without, in runs of 40 steps.
//
// bench_factor.cpp then compares factorisations with those of other libraries, and peer_step.cpp writes a
// step for `make bench-peers`.
//
//   bench_step                                   all sizes; the naive step up to N = 41k
//   bench_step --write-step FILE.json            nothing but the step for `make bench-peers`
//   bench_step --benchmark_filter=nodes:163842   peak memory of one size alone (column peak_MiB)
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/benchmarks.hpp"
#include "bench/mean_curvature_step.hpp"
#include "bench/naive_step.hpp"
#include "solver/assembly/surface_space.hpp"
#include "solver/constants.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/flows/willmore_terms.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"

namespace {

using namespace esfem;

constexpr double R = 2, tau = 0.01, delta0 = 11.0 / 6;
constexpr int largest_naive = 41000;

double cpu_ms() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * now.tv_sec + 1e-6 * now.tv_nsec;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      double kib = 0;
      status >> kib;
      return kib / 1024;
    }
  return 0;
}

/// Milliseconds of the phases of a step, in the order of the step.
class Phases {
 public:
  void start() { last_ = cpu_ms(); }
  void end(const std::string& phase) {
    const double now = cpu_ms();
    samples_[phase].push_back(now - last_);
    last_ = now;
  }
  double operator[](const std::string& phase) const { return median(samples_.at(phase)); }
  const std::map<std::string, std::vector<double>>& samples() const { return samples_; }

 private:
  double last_ = 0;
  std::map<std::string, std::vector<double>> samples_;
};

void step(benchmark::State& state, int subdivisions) {
  const Mesh mesh = quadratic_icosphere(R, subdivisions);
  const Field u = normal_and_curvature(mesh, R);
  const double analysis_start = cpu_ms();
  const SurfaceSpace space(mesh);
  SpdSolver spd(space.pattern());
  const double analysis = cpu_ms() - analysis_start;
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  Field load, v, nu_H;

  Phases phases;
  for (auto _ : state) {
    const double begin = cpu_ms();
    phases.start();
    space.assemble(mesh.nodes, M, A);
    phases.end("1_M_A");
    space.assemble_load<4, 7, 3>(mesh.nodes, u, mean_curvature_load, load);
    v = load.leftCols(3);
    nu_H = load.rightCols(4);
    phases.end("2_loads");
    spd.factorise(1, M, 1, A);
    phases.end("3_factor_K");
    spd.solve(v);
    phases.end("4_solve_3");
    spd.factorise(delta0 / tau, M, 1, A);
    phases.end("5_factor_u");
    spd.solve(nu_H);
    phases.end("6_solve_4");
    state.SetIterationTime((cpu_ms() - begin) / 1e3);
  }

  double total = 0;
  for (const auto& [phase, samples] : phases.samples()) {
    state.counters[phase] = median(samples);
    total += median(samples);
  }
  state.counters["7_step"] = total;
  state.counters["8_ns_per_element"] = 1e6 * phases["1_M_A"] / space.element_count();
  state.counters["9_once"] = analysis;
  state.counters["peak_MiB"] = peak_mib();
  if (space.dofs() > largest_naive) return;

  std::vector<double> naive_samples;
  const int repetitions = space.dofs() < 20000 ? 5 : 3;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const double begin = cpu_ms();
    const Field naive = naive_step(mesh, space.quadrature(), u, delta0 / tau);
    naive_samples.push_back(cpu_ms() - begin);
    if ((naive.leftCols(3) - v).norm() > 1e-8 * v.norm() ||
        (naive.rightCols(4) - nu_H).norm() > 1e-8 * nu_H.norm())
      throw std::runtime_error("the naive step gives another solution");
  }
  state.counters["naive"] = median(naive_samples);
  state.counters["ratio"] = median(naive_samples) / total;
}

/// MeanCurvatureFlow::step as a run calls it, and the share of its factorisations and solves.
void flow_step(benchmark::State& state) {
  Mesh mesh = lagrange_mesh(generate_mesh(dumbbell(), 0.0902), 2);
  project_nodes(mesh, dumbbell());
  const SurfaceSpace space(mesh);
  MeanCurvatureFlow flow(space, {});
  History<MeanCurvatureFlow::State> history(2);
  MeanCurvatureFlow::State next = mean_curvature_state_on(dumbbell(), mesh.nodes);
  for (int i = 0; i < 2; ++i) {
    next.t = i * tau;
    history.push(next);
  }
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  SpdSolver spd(space.pattern());

  Phases phases;
  for (auto _ : state) {
    const double begin = cpu_ms();
    phases.start();
    flow.step(history.equal_step(2, 1e-5, 3e-5), next);
    phases.end("step");
    Field v = next.v, u = next.u;
    phases.start();
    spd.factorise(1, M, 1, A);
    spd.solve(v);
    spd.factorise(1.5 / 1e-5, M, 1, A);
    spd.solve(u);
    phases.end("factor_solve");
    state.SetIterationTime((cpu_ms() - begin) / 1e3);
  }
  state.counters["nodes"] = space.dofs();
  state.counters["step"] = phases["step"];
  state.counters["factor_solve"] = phases["factor_solve"];
  state.counters["step_over_factor_solve"] = phases["step"] / phases["factor_solve"];
}

/// f + F w and g of kll21 (3.5), inputs (H, nu, V, z).
void willmore_load(const PointData<8>& p, Integrand<8, 4>& load) {
  load = {};
  const WillmorePoint at = willmore_point(p, willmore_law());
  add_f(at, load.value, load.flux);
  add_F(at, p.u + 4, load.value);
  add_g(at, load.value + 4);
}

/// A whole step of Willmore flow with extrapolated F, on the ellipsoid with half axes 2, 1, 1, compared with
/// its factorisation and solves and with the naive one; and a step that reuses the factors of another one.
void willmore_step(benchmark::State& state, double edge_length) {
  const Surface surface = ellipsoid(2, 1, 1);
  Mesh mesh = lagrange_mesh(generate_mesh(surface, edge_length), 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  const double step_size = 1e-5, mass_factor = 1.5 / step_size;
  WillmoreFlow flow(space, {});
  const nlohmann::json without_factors = flow.progress();
  History<WillmoreFlow::State> history(2);
  WillmoreFlow::State next = willmore_start_on(space, surface, mesh.nodes, willmore_law(), false).state;
  Field u_w(space.dofs(), 8), loads, u, w;
  u_w << next.u, next.w;
  for (int i = 0; i < 2; ++i) {
    next.t = i * step_size;
    history.push(next);
  }
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  BlockSolver block(space.pattern());

  Phases phases;
  for (auto _ : state) {
    const double begin = cpu_ms();
    phases.start();
    flow.step(history.equal_step(2, step_size, 2 * step_size), next);
    phases.end("step");
    flow.step(history.equal_step(2, step_size, 2 * step_size), next);
    phases.end("lagged_step");
    flow.resume(without_factors);
    space.assemble_load<8, 8, 4>(mesh.nodes, u_w, willmore_load, loads);
    u = loads.leftCols(4);
    w = loads.rightCols(4);
    phases.start();
    block.factorise(mass_factor, 1, 1, M, A);
    phases.end("factor");
    block.solve(u, w);
    phases.end("solve");
    state.SetIterationTime((cpu_ms() - begin) / 1e3);
  }
  for (int repetition = 0; repetition < 3; ++repetition) {
    phases.start();
    const Field naive = naive_willmore_step(mesh, space.quadrature(), u_w, mass_factor);
    phases.end("naive");
    if ((naive.leftCols(4) - u).norm() > 1e-6 * u.norm() || (naive.rightCols(4) - w).norm() > 1e-6 * w.norm())
      throw std::runtime_error("the naive Willmore step gives another solution");
  }
  state.counters["nodes"] = space.dofs();
  for (const char* phase : {"step", "lagged_step", "factor", "solve", "naive"})
    state.counters[phase] = phases[phase];
  state.counters["step_over_factor_solve"] = phases["step"] / (phases["factor"] + phases["solve"]);
  state.counters["naive_over_step"] = phases["naive"] / phases["step"];
}

/// Steps of BDF2 of the energy runs of bk22 §9.2.
void cahn_hilliard_step(benchmark::State& state) {
  const double step_size = 1e-4, epsilon = 0.1;
  Mesh mesh = icosphere(1, 5);
  const SurfaceSpace space(mesh);
  MovingNodes nodes(EvolvingEllipsoid{0.25, 0.2, 1}.velocity(), mesh.nodes, step_size);
  CahnHilliard flow(
      space, DoubleWell(), [&](double t) -> const Field& { return nodes.at(t); }, epsilon);
  History<CahnHilliardState> history(2);
  const Field u0 = 0.1 * (turn * mesh.nodes).array().cos().rowwise().prod();
  CahnHilliardState next = cahn_hilliard_state(space, 0, mesh.nodes, u0, u0);
  history.push(next);
  int n = 1;
  const auto take_step = [&](int order) {
    next.t = n * step_size;
    flow.step(history.equal_step(order, step_size, next.t), next);
  };

  Phases phases;
  take_step(1);
  for (auto _ : state) {
    history.push(next);
    ++n;
    const double begin = cpu_ms();
    phases.start();
    take_step(2);
    phases.end("step");
    state.SetIterationTime((cpu_ms() - begin) / 1e3);
  }
  Field u_tilde, old;
  const auto last_step = history.equal_step(2, step_size, next.t);
  last_step.extrapolate(&CahnHilliardState::u, u_tilde);
  last_step.known_sum(&CahnHilliardState::Mu, old);
  old /= -step_size;
  mesh.nodes = next.x;
  for (int repetition = 0; repetition < 3; ++repetition) {
    phases.start();
    const Field naive =
        naive_cahn_hilliard_step(mesh, space.quadrature(), u_tilde, old, epsilon, 1.5 / step_size);
    phases.end("naive");
    if ((naive.col(0) - next.u).norm() > 1e-6 * next.u.norm() ||
        (naive.col(1) - next.w).norm() > 1e-6 * next.w.norm())
      throw std::runtime_error("the naive Cahn-Hilliard step gives another solution");
  }
  state.counters["nodes"] = space.dofs();
  for (const char* phase : {"step", "naive"}) state.counters[phase] = phases[phase];
  state.counters["naive_over_step"] = phases["naive"] / phases["step"];
}

/// A run of BDF2, the first step of BDF1.
struct Run {
  MeanCurvatureFlow flow;
  History<MeanCurvatureFlow::State> history;
  MeanCurvatureFlow::State next;
  double step_size;

  Run(const SurfaceSpace& space, const MeanCurvatureFlow::Variant& variant,
      const MeanCurvatureFlow::State& start, double step_size)
      : flow(space, variant), history(2), next(start), step_size(step_size) {
    history.push(next);
  }

  void take_step(int n) {
    next.t = n * step_size;
    flow.step(history.equal_step(std::min(n, 2), step_size, next.t), next);
    history.push(next);
  }
};

/// Steps with tangential motion of minimal deformation rate and steps without in turn; medians.
void tangential_step(benchmark::State& state, const Surface& surface, double edge_length, double step_size) {
  Mesh mesh = lagrange_mesh(generate_mesh(surface, edge_length), 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  MeanCurvatureFlow::Variant sliding;
  sliding.tangential = MeanCurvatureFlow::Variant::minimal_deformation;
  const MeanCurvatureFlow::State start = mean_curvature_state_on(surface, mesh.nodes);
  Run plain(space, {}, start, step_size), tangential(space, sliding, start, step_size);
  Phases phases;
  int n = 0;
  for (auto _ : state) {
    const double begin = cpu_ms();
    phases.start();
    plain.take_step(++n);
    phases.end(n > 8 ? "step" : "start");
    tangential.take_step(n);
    phases.end(n > 8 ? "with_tangential_motion" : "start");
    state.SetIterationTime((cpu_ms() - begin) / 1e3);
  }
  state.counters["nodes"] = space.dofs();
  for (const char* phase : {"step", "with_tangential_motion"}) state.counters[phase] = phases[phase];
  state.counters["ratio"] = phases["with_tangential_motion"] / phases["step"];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "--write-step") {
    esfem::write_peer_step(argv[2]);
    return 0;
  }
  std::vector<char*> arguments(argv, argv + argc);
  std::string tabular = "--benchmark_counters_tabular=true";
  arguments.insert(arguments.begin() + 1, tabular.data());
  int count = static_cast<int>(arguments.size());
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 1;
  for (const int subdivisions : {3, 4, 5, 6}) {
    const int nodes = 10 * (4 << 2 * subdivisions) + 2;
    benchmark::RegisterBenchmark(("step/nodes:" + std::to_string(nodes)).c_str(),
                                 [=](benchmark::State& state) { step(state, subdivisions); })
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(subdivisions < 5 ? 20 : 5);
  }
  benchmark::RegisterBenchmark("flow_step/dumbbell", flow_step)
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime()
      ->Iterations(20);
  for (const double edge_length : {0.1365, 0.1246}) {
    benchmark::RegisterBenchmark("flow_step/willmore",
                                 [=](benchmark::State& state) { willmore_step(state, edge_length); })
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(20);
  }
  benchmark::RegisterBenchmark("flow_step/cahn_hilliard", cahn_hilliard_step)
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime()
      ->Iterations(20);
  const auto register_tangential = [](const char* name, const Surface& surface, double h, double step_size) {
    benchmark::RegisterBenchmark(
        name, [=](benchmark::State& state) { tangential_step(state, surface, h, step_size); })
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(40);
  };
  register_tangential("tangential_motion/dumbbell", dumbbell(), 0.0902, 0.001);
  register_tangential("tangential_motion/ellipsoid_4_1_1", ellipsoid(4, 1, 1), 0.19, 0.005);
  register_tangential("tangential_motion/ellipsoid_2_1_1", ellipsoid(2, 1, 1), 0.1365, 0.005);
  esfem::register_factor_benchmarks();
  benchmark::RunSpecifiedBenchmarks();
}
