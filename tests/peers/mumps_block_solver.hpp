// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// What BlockSolver does, by ZMUMPS without pivoting.
class MumpsBlockSolver {
 public:
  explicit MumpsBlockSolver(std::shared_ptr<const SparsityPattern> pattern);
  ~MumpsBlockSolver();
  MumpsBlockSolver(const MumpsBlockSolver&) = delete;
  MumpsBlockSolver& operator=(const MumpsBlockSolver&) = delete;

  /// alpha M u - beta A w = r, gamma A u + M w = s.
  void factorise(double alpha, double beta, double gamma, const SymmetricMatrix& M, const SymmetricMatrix& A);
  void solve(Field& r_to_u, Field& s_to_w);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// What SymmetricBlockSolver does, by DMUMPS with threshold pivoting.
class MumpsSymmetricBlockSolver {
 public:
  explicit MumpsSymmetricBlockSolver(std::shared_ptr<const SparsityPattern> pattern);
  ~MumpsSymmetricBlockSolver();
  MumpsSymmetricBlockSolver(const MumpsSymmetricBlockSolver&) = delete;
  MumpsSymmetricBlockSolver& operator=(const MumpsSymmetricBlockSolver&) = delete;

  /// P u + Q w = r, Q u + R w = s.
  void factorise(const SymmetricMatrix& P, const SymmetricMatrix& Q, const SymmetricMatrix& R);
  void solve(Field& r_to_u, Field& s_to_w);

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace esfem
