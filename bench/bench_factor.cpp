// SPDX-License-Identifier: GPL-3.0-or-later
// One factorisation and its solves, compared with other libraries in the same run (tests/peers): the two
// systems of kll19 (5.1), 3 and 4 right-hand sides, with CHOLMOD; the block system of kll21 (3.5), 4
// right-hand sides, with ZMUMPS; the same with two threads. Each number is the minimum over `rounds` rounds
// in ms. Each round measures every library once, so that a busy period of the machine affects all of them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <string>

#include "bench/benchmarks.hpp"
#include "bench/mean_curvature_step.hpp"
#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/block_solver.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/thread_count.hpp"
#include "tests/peers/cholmod_solver.hpp"
#include "tests/peers/mumps_block_solver.hpp"

namespace esfem {
namespace {

constexpr double mass_factor = 11.0 / 6 / 0.01;

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// The least milliseconds of each kind of work.
class Least {
 public:
  template <class Work>
  void time(const std::string& name, const Work& work) {
    const double begin = now_ms();
    work();
    const double ms = now_ms() - begin;
    const auto [entry, is_new] = ms_.try_emplace(name, ms);
    if (!is_new) entry->second = std::min(entry->second, ms);
  }
  double operator[](const std::string& name) const { return ms_.at(name); }

 private:
  std::map<std::string, double> ms_;
};

void require_equal(const Field& found, const Field& expected) {
  if (!((found - expected).norm() <= 1e-10 * expected.norm()))
    throw std::runtime_error("another library gives another solution");
}

/// Multiplications and additions of a factorisation.
double flops(const SparsityPattern& pattern) {
  double work = 0;
  for (const Front& front : assembly_tree(pattern).fronts) work += 2 * elimination_work(front);
  return work;
}

template <class Solver>
Solver with_threads(int count, const std::shared_ptr<const SparsityPattern>& pattern) {
  set_thread_count(count);
  Solver solver(pattern);
  set_thread_count(1);
  return solver;
}

void factor(benchmark::State& state, const Mesh& mesh) {
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = M;
  space.assemble(mesh.nodes, M, A);
  SpdSolver spd(space.pattern()), spd_2 = with_threads<SpdSolver>(2, space.pattern());
  CholmodSolver cholmod(space.pattern());
  BlockSolver block(space.pattern());
  MumpsBlockSolver mumps(space.pattern());

  const Field right = Field::Random(space.dofs(), 4);
  Field y[3], u[2], w[2];
  Least least;
  const auto two_systems = [&](auto& solver, const std::string& name, Field& y) {
    y = right.leftCols(3);
    least.time(name + "_factor", [&] { solver.factorise(1, M, 1, A); });
    least.time(name + "_solve", [&] { solver.solve(y); });
    y = right;
    least.time(name + "_factor", [&] { solver.factorise(mass_factor, M, 1, A); });
    least.time(name + "_solve_4", [&] { solver.solve(y); });
  };
  const auto block_system = [&](auto& solver, const std::string& name, Field& u, Field& w) {
    u = w = right;
    least.time(name + "_factor", [&] { solver.factorise(mass_factor, 1, 1, M, A); });
    least.time(name + "_solve", [&] { solver.solve(u, w); });
  };
  for (auto _ : state) {
    two_systems(spd, "spd", y[0]);
    two_systems(cholmod, "cholmod", y[1]);
    two_systems(spd_2, "spd_2", y[2]);
    block_system(block, "block", u[0], w[0]);
    block_system(mumps, "mumps", u[1], w[1]);
  }
  require_equal(y[0], y[1]);
  if (y[0] != y[2]) throw std::runtime_error("two threads give other bits");
  require_equal(u[0], u[1]);
  require_equal(w[0], w[1]);

  const auto both = [&](const std::string& name) {
    return 2 * least[name + "_factor"] + least[name + "_solve"] + least[name + "_solve_4"];
  };
  const auto one = [&](const std::string& name) { return least[name + "_factor"] + least[name + "_solve"]; };
  const double gflop = 1e-9 * flops(*space.pattern());
  auto& counters = state.counters;
  counters["nodes"] = space.dofs();
  counters["1_factor"] = least["spd_factor"];
  counters["2_solve_4"] = least["spd_solve_4"];
  counters["3_over_cholmod"] = both("cholmod") / both("spd");
  counters["4_over_1_thread"] = both("spd") / both("spd_2");
  counters["5_block"] = least["block_factor"];
  counters["6_solve_4"] = least["block_solve"];
  counters["7_over_mumps"] = one("mumps") / one("block");
  counters["8_Gflops"] = 1e3 * gflop / least["spd_factor"];
  counters["9_block_Gflops"] = 4e3 * gflop / least["block_factor"];
  counters["MiB_over_cholmod"] = double(spd.memory()) / cholmod.memory();
}

/// The rate of a large product on this core, for comparison.
void dense_product(benchmark::State& state) {
  const int n = 1024;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n), b = Eigen::MatrixXd::Random(n, n);
  Eigen::MatrixXd c(n, n);
  Least least;
  for (auto _ : state) least.time("product", [&] { c.noalias() = a * b; });
  state.counters["8_Gflops"] = 2e-6 * n * n * n / least["product"];
}

Mesh torus_mesh(double edge_length, int degree) {
  const Surface surface = torus(2, 0.8);
  Mesh mesh = lagrange_mesh(generate_mesh(surface, edge_length), degree);
  project_nodes(mesh, surface);
  return mesh;
}

}  // namespace

void register_factor_benchmarks() {
  const auto add = [](const std::string& name, int rounds, auto mesh) {
    benchmark::RegisterBenchmark(("factor/" + name).c_str(),
                                 [=](benchmark::State& state) { factor(state, mesh()); })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(rounds);
  };
  for (const int subdivisions : {3, 4, 5, 6}) {
    const int rounds = subdivisions < 5 ? 30 : 7;
    const std::string nodes = std::to_string(10 * (4 << 2 * subdivisions) + 2);
    add("sphere/P1/" + nodes, rounds, [=] { return icosphere(2, subdivisions + 1); });
    add("sphere/P2/" + nodes, rounds, [=] { return quadratic_icosphere(2, subdivisions); });
  }
  // About as many nodes, not in rows.
  for (const double edge_length : {0.47, 0.235, 0.117, 0.058})
    for (const int degree : {1, 2})
      add("torus/P" + std::to_string(degree) + "/" + std::to_string(edge_length), edge_length > 0.2 ? 30 : 7,
          [=] { return torus_mesh(degree == 1 ? edge_length / 2 : edge_length, degree); });
  benchmark::RegisterBenchmark("factor/dense_product", dense_product)
      ->Unit(benchmark::kMillisecond)
      ->Iterations(10);
}

}  // namespace esfem
