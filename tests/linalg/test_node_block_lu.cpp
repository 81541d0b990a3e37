// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"
#include "solver/linalg/node_block_lu.hpp"
#include "solver/mesh/mesh.hpp"

namespace esfem::test_node_block_lu {
namespace {

using testing::HasSubstr;

/// Two unknowns a node on the icosahedron; the blocks have no entry (1, 0).
const NodeBlockLu::BlockRows block_rows = {{0}, {0, 1}};

class NodeBlockLuTest : public testing::Test {
 protected:
  static double value(int k, bool above, int a, int b) {
    return std::sin(1 + k + 3 * a + 5 * b) + (above ? 0.3 : 0);
  }
  /// The same matrix, entry by entry.
  Eigen::MatrixXd dense() const {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(24, 24);
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j)
        for (int k = pattern.column_start[std::min(i, j)]; k < pattern.column_start[std::min(i, j) + 1];
             ++k) {
          if (pattern.row[k] != std::max(i, j)) continue;
          for (int b = 0; b < 2; ++b)
            for (int a : block_rows[b]) K(2 * i + a, 2 * j + b) = value(k, i < j, a, b);
        }
    return K;
  }
  const SparsityPattern pattern = element_pattern(icosphere(1, 0).elements, 12);
  const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(24, -1, 2);
  Eigen::VectorXd solution = Eigen::VectorXd::Zero(24);
};

TEST_F(NodeBlockLuTest, SolvesTheSystemOfTheBlocks) {
  NodeBlockLu lu(pattern, block_rows);
  lu.factorise(value);
  lu.solve(right, solution);
  EXPECT_LT((dense() * solution - right).norm(), 1e-11 * right.norm() + 1e-12 * solution.norm());
  EXPECT_GT((dense().transpose() * solution - right).norm(), 1e-3) << "the blocks above differ";
  // Other numbers on the same pattern.
  lu.factorise([](int k, bool above, int a, int b) { return 2 * value(k, above, a, b); });
  lu.solve(right, solution);
  EXPECT_LT((2 * dense() * solution - right).norm(), 1e-11 * right.norm() + 1e-12 * solution.norm());
}

TEST_F(NodeBlockLuTest, ASingularMatrixIsAnError) {
  NodeBlockLu lu(pattern, block_rows);
  try {
    lu.factorise([](int, bool, int a, int) { return a == 0 ? 1.0 : 0.0; });
    FAIL() << "a singular matrix was factorised";
  } catch (const NumericsError& error) {
    EXPECT_THAT(error.what(), HasSubstr("LU factorisation of 24 unknowns failed (UMFPACK status"));
  }
}

}  // namespace
}  // namespace esfem::test_node_block_lu
