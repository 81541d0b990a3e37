// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/bgn_flow.hpp"

#include <Eigen/UmfPackSupport>
#include <algorithm>
#include <utility>
#include <vector>

#include "solver/flows/discrete_curvature.hpp"
#include "solver/flows/regularity.hpp"

namespace esfem {

/// With N_a the integrals of nu_a phi_i phi_j (a = 1, 2, 3) on the old surface, x its nodes and x + dx the
/// new ones, the two equations are
///   tau M H + sum_a N_a dx_a = 0,
///   N_a H - A dx_a = A x_a,
/// a symmetric indefinite system. Unknowns and equations go node by node, H, dx_1, dx_2, dx_3: each pair of
/// nodes that share an element has a block
///   [tau M  N_1  N_2  N_3]
///   [N_1    -A           ]
///   [N_2         -A      ]
///   [N_3              -A ].
struct BgnFlow::System {
  SymmetricMatrix M, A, N[3];
  std::vector<int> neighbour_start;  ///< compressed columns of the whole pattern, of both triangles
  std::vector<int> entry;            ///< where M, A and N_a have the entry that it holds
  Eigen::SparseMatrix<double> K;
  Eigen::UmfPackLU<Eigen::SparseMatrix<double>> lu;
  Field Ax;
  Eigen::VectorXd right, solution;

  explicit System(const SurfaceSpace& space);
  void assemble(const SurfaceSpace& space, const Field& x, double tau);
  void solve(const Field& x);
  double H(int node) const { return solution[4 * node]; }
  Eigen::RowVector3d dx(int node) const { return solution.segment<3>(4 * node + 1); }

 private:
  void find_pattern(const SparsityPattern& pattern);
};

BgnFlow::System::System(const SurfaceSpace& space) : M(space.matrix()), A(M), N{M, M, M} {
  find_pattern(*space.pattern());
  right.setZero(K.rows());
  solution.setZero(K.rows());
  lu.umfpackControl()[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  lu.umfpackControl()[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  lu.analyzePattern(K);
  if (lu.info() != Eigen::Success) {
    throw NumericsError(format("symbolic LU analysis of %d unknowns failed", static_cast<int>(K.rows())));
  }
}

void BgnFlow::System::find_pattern(const SparsityPattern& pattern) {
  const int nodes = pattern.size;
  std::vector<std::vector<std::pair<int, int>>> neighbours(nodes);  // node and entry, ascending
  for (int j = 0; j < nodes; ++j) {
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      neighbours[j].emplace_back(i, k);
      if (i != j) neighbours[i].emplace_back(j, k);
    }
  }
  neighbour_start = {0};
  std::vector<int> column_start = {0}, row;
  for (auto& column : neighbours) {
    std::sort(column.begin(), column.end());
    for (const auto& [i, k] : column) {
      entry.push_back(k);
      for (int a = 0; a < 4; ++a) row.push_back(4 * i + a);
    }
    column_start.push_back(row.size());
    for (int a = 1; a < 4; ++a) {
      for (const auto& [i, k] : column) row.insert(row.end(), {4 * i, 4 * i + a});
      column_start.push_back(row.size());
    }
    neighbour_start.push_back(entry.size());
  }
  const std::vector<double> values(row.size(), 1.0);
  K = Eigen::Map<const Eigen::SparseMatrix<double>>(4 * nodes, 4 * nodes, row.size(), column_start.data(),
                                                    row.data(), values.data());
}

void BgnFlow::System::assemble(const SurfaceSpace& space, const Field& x, double tau) {
  space.assemble(x, M, A);
  for (int a = 0; a < 3; ++a) {
    const auto normal = [a](const PointData<0>& p) { return p.normal[a]; };
    space.assemble_weighted_mass<0>(x, x, normal, N[a]);
  }
  double* value = K.valuePtr();
  for (size_t j = 0; j + 1 < neighbour_start.size(); ++j) {
    const auto each_neighbour = [&](const auto& write) {
      for (int k = neighbour_start[j]; k < neighbour_start[j + 1]; ++k) write(entry[k]);
    };
    each_neighbour([&](int k) {
      *value++ = tau * M.values[k];
      for (const SymmetricMatrix& N_a : N) *value++ = N_a.values[k];
    });
    for (const SymmetricMatrix& N_a : N) {
      each_neighbour([&](int k) {
        *value++ = N_a.values[k];
        *value++ = -A.values[k];
      });
    }
  }
}

void BgnFlow::System::solve(const Field& x) {
  lu.factorize(K);
  if (lu.info() != Eigen::Success) {
    throw NumericsError(format("LU factorisation of %d unknowns failed (UMFPACK status %d)",
                               static_cast<int>(K.rows()), lu.umfpackFactorizeReturncode()));
  }
  A.multiply(x, Ax);
  for (int j = 0; j < x.rows(); ++j) right.segment<3>(4 * j + 1) = Ax.row(j);
  solution = lu.solve(right);
}

BgnFlow::BgnFlow(const SurfaceSpace& space) : space_(space), system_(std::make_unique<System>(space)) {}

BgnFlow::~BgnFlow() = default;

void BgnFlow::step(const History<State>& history, int q, double tau, State& next) {
  if (q != 1) {
    throw InputError(
        format("BDF order %d: expected 1, the order of the scheme of Barrett, Garcke and Nürnberg", q));
  }
  const Field& x = history.back(0).x;
  system_->assemble(space_, x, tau);
  system_->solve(x);
  for (int j = 0; j < x.rows(); ++j) {
    next.H(j, 0) = system_->H(j);
    next.v.row(j) = system_->dx(j) / tau;
  }
  next.x = x + tau * next.v;
  require_regular(space_, next.x, next.H);
}

BgnFlow::State bgn_state_on(const SurfaceSpace& space, const Field& x) {
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  return {0, x, -curvature.kappa(), curvature.H()};
}

std::vector<PointField> point_fields(const BgnFlow::State& state) {
  return {{"v", state.v}, {"H", state.H}};
}

}  // namespace esfem
