// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "bench/benchmarks.hpp"
#include "bench/mean_curvature_step.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/write_file.hpp"

namespace esfem {
namespace {

template <class Matrix>
nlohmann::json rows_of(const Matrix& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(nlohmann::json::array());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) rows.back().push_back(matrix(i, j));
  }
  return rows;
}

}  // namespace

// K v = g and (mass_factor M + A) u_new = f + mass_factor M u: assembly, two factorisations, solves.
void write_peer_step(const std::string& file) {
  const double R = 2, mass_factor = 11.0 / 6 / 0.01;
  const Mesh mesh = quadratic_icosphere(R, 4);
  const Field u = normal_and_curvature(mesh, R);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = M;
  SpdSolver solver(space.pattern());
  Field load, v, u_new, Mu;
  double least_ms = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 20; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    space.assemble(mesh.nodes, M, A);
    space.assemble_load<4, 7, 3>(mesh.nodes, u, mean_curvature_load, load);
    v = load.leftCols(3);
    solver.factorise(1, M, 1, A);
    solver.solve(v);
    M.multiply(u, Mu);
    u_new = load.rightCols(4) + mass_factor * Mu;
    solver.factorise(mass_factor, M, 1, A);
    solver.solve(u_new);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    least_ms = std::min(least_ms, took.count());
  }
  write_file(file, nlohmann::json{{"nodes", rows_of(mesh.nodes)},
                                  {"elements", rows_of(mesh.elements)},
                                  {"quadrature_points", rows_of(space.quadrature().points)},
                                  {"quadrature_weights", rows_of(space.quadrature().weights)},
                                  {"u", rows_of(u)},
                                  {"mass_factor", mass_factor},
                                  {"v", rows_of(v)},
                                  {"u_new", rows_of(u_new)},
                                  {"ms", least_ms}}
                       .dump());
}

}  // namespace esfem
