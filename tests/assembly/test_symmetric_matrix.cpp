// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/assembly/symmetric_matrix.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/pack.hpp"

namespace esfem::test_symmetric_matrix {
namespace {

Eigen::MatrixXd dense(const SymmetricMatrix& matrix) {
  const int n = matrix.pattern->size;
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
  for (int j = 0; j < n; ++j)
    for (int k = matrix.pattern->column_start[j]; k < matrix.pattern->column_start[j + 1]; ++k)
      result(matrix.pattern->row[k], j) = result(j, matrix.pattern->row[k]) = matrix.values[k];
  return result;
}

SymmetricMatrix arbitrary_matrix(int degree) {
  const Mesh mesh = lagrange_mesh(icosphere(1, 0), degree);
  auto pattern =
      std::make_shared<SparsityPattern>(element_pattern(mesh.elements, static_cast<int>(mesh.nodes.rows())));
  const int entries = pattern->entry_count();
  return {pattern, Eigen::VectorXd::LinSpaced(entries, -1, 2).array().sin()};
}

TEST(SymmetricMatrix, ProductsAgreeWithTheDenseMatrix) {
  for (int degree = 1; degree <= 4; ++degree) {
    const SymmetricMatrix matrix = arbitrary_matrix(degree);
    const Field u = Field::Random(matrix.pattern->size, 3);
    const Field expected = dense(matrix) * u;
    EXPECT_LT((matrix * u - expected).cwiseAbs().maxCoeff(), 1e-12);
    Field out = Field::Constant(1, 1, 7);
    matrix.multiply(u, out);
    EXPECT_LT((out - expected).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_NEAR(matrix.energy(u), (u.transpose() * expected).trace(), 1e-11);
  }
}

TEST(SymmetricMatrix, PatternHoldsThePairsOfNodesThatShareAnElement) {
  for (int degree = 1; degree <= 4; ++degree) {
    const Mesh mesh = lagrange_mesh(icosphere(1, 0), degree);
    const int n = static_cast<int>(mesh.nodes.rows());
    Eigen::MatrixXi shared = Eigen::MatrixXi::Zero(n, n);
    for (const auto element : mesh.elements.rowwise())
      for (const int i : element)
        for (const int j : element) shared(i, j) = 1;
    const SparsityPattern pattern = element_pattern(mesh.elements, n);
    EXPECT_EQ(pattern.entry_count(), (shared.sum() + n) / 2);
    for (int j = 0; j < n; ++j) {
      EXPECT_EQ(pattern.row[pattern.column_start[j]], j) << "the diagonal comes first";
      for (int i = j; i < n; ++i) {
        if (!shared(i, j)) continue;
        EXPECT_EQ(pattern.row[pattern.entry(i, j)], i);
        EXPECT_EQ(pattern.entry(i, j), pattern.entry(j, i));
      }
    }
  }
}

TEST(Pack, FunctionsActLaneByLane) {
  for (const double scale : {1e-3, 0.1, 1.0, 40.0, 1e10}) {
    Pack p;
    for (int lane = 0; lane < pack_size; ++lane) p[lane] = scale * (lane + 1);
    const Pack root = sqrt(p), inverse_root = inverse_sqrt(p), exponential = exp(-p), sine = sin(p),
               cosine = cos(p);
    for (int lane = 0; lane < pack_size; ++lane) {
      EXPECT_DOUBLE_EQ(root[lane], std::sqrt(p[lane]));
      EXPECT_DOUBLE_EQ(inverse_root[lane], 1 / std::sqrt(p[lane]));
      EXPECT_DOUBLE_EQ(exponential[lane], std::exp(-p[lane]));
      EXPECT_DOUBLE_EQ(sine[lane], std::sin(p[lane]));
      EXPECT_DOUBLE_EQ(cosine[lane], std::cos(p[lane]));
      EXPECT_EQ(pack(2.5)[lane], 2.5);
    }
  }
}

}  // namespace
}  // namespace esfem::test_symmetric_matrix
