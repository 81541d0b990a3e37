// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "solver/error.hpp"
#include "solver/linalg/symmetric_factor.hpp"
#include "solver/thread_count.hpp"
#include "tests/linalg/random_systems.hpp"

namespace esfem::test_symmetric_factor {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

template <class T>
using Dense = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

template <class Number, int size>
struct Kind {
  using T = Number;
  static constexpr int b = size;
};

template <class K>
class AllKinds : public testing::Test {};
using Kinds =
    testing::Types<Kind<double, 1>, Kind<double, 2>, Kind<double, 4>, Kind<std::complex<double>, 1>>;
TYPED_TEST_SUITE(AllKinds, Kinds);

template <class T>
double relative_residual(const Dense<T>& K, const Dense<T>& y, const Dense<T>& right) {
  return (K * y - right).norm() / (right.norm() + std::numeric_limits<double>::min());
}

template <class T, int b>
std::array<int, b> any_sign() {
  return {};
}

TYPED_TEST(AllKinds, SolvesOnSpecialGraphsForAnyNumberOfRightHandSides) {
  using T = typename TypeParam::T;
  constexpr int b = TypeParam::b;
  for (const auto& [name, pattern] : special_patterns()) {
    SCOPED_TRACE(name);
    SymmetricFactor<T, b> factor(pattern, any_sign<T, b>());
    for (int columns = 1; columns <= 9; ++columns) {
      const auto blocks = random_blocks<T, b>(pattern);
      const Dense<T> K = dense_matrix<T, b>(pattern, blocks);
      const Dense<T> right = Dense<T>::Random(b * pattern.size, columns);
      factor.factorise(entries<T, b>(blocks));
      Dense<T> y = right;
      factor.solve(y);
      ASSERT_LT(relative_residual(K, y, right), 1e-14);
    }
  }
}

// Fronts larger than a panel and than a tile, and next to their sizes.
TYPED_TEST(AllKinds, EliminatesDenseMatricesOfAllSizes) {
  using T = typename TypeParam::T;
  constexpr int b = TypeParam::b;
  std::vector<int> sizes(34);
  std::iota(sizes.begin(), sizes.end(), 1);
  for (const int size : {63, 64, 65, 127, 128, 129, 200}) sizes.push_back(size);
  for (const int size : sizes) {
    std::vector<std::pair<int, int>> edges;
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < i; ++j) edges.emplace_back(i, j);
    const SparsityPattern pattern = graph_pattern(size, edges);
    SymmetricFactor<T, b> factor(pattern, any_sign<T, b>());
    const auto blocks = random_blocks<T, b>(pattern);
    factor.factorise(entries<T, b>(blocks));
    const Dense<T> right = Dense<T>::Random(b * size, 3);
    Dense<T> y = right;
    factor.solve(y);
    ASSERT_LT(relative_residual(dense_matrix<T, b>(pattern, blocks), y, right), 1e-14) << size << " nodes";
  }
}

TYPED_TEST(AllKinds, AgreesWithDenseFactorisationsOnRandomMatrices) {
  using T = typename TypeParam::T;
  constexpr int b = TypeParam::b;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> size(1, 24 / b);
  std::uniform_real_distribution<double> edges(0, 3);
  double worst = 0;
  for (int n = 0; n < 2500; ++n) {
    const SparsityPattern pattern = random_pattern(size(random), edges(random), random);
    SymmetricFactor<T, b> factor(pattern, any_sign<T, b>());
    const auto blocks = random_blocks<T, b>(pattern);
    factor.factorise(entries<T, b>(blocks));
    const Dense<T> K = dense_matrix<T, b>(pattern, blocks), right = Dense<T>::Random(K.rows(), 2);
    Dense<T> y = right;
    factor.solve(y);
    const Dense<T> expected = K.partialPivLu().solve(right);
    worst = std::max(worst, (y - expected).norm() / expected.norm());
    ASSERT_LT(worst, 1e-13) << "matrix " << n << " of " << pattern.size << " nodes";
  }
  EXPECT_GT(worst, 1e-17) << "something was compared";
}

// The negative test of all these: a block that is not transposed where the order exchanges its nodes.
TYPED_TEST(AllKinds, RoundedFactorsHaveSingleAccuracyUntilTheNextFactorisation) {
  using T = typename TypeParam::T;
  constexpr int b = TypeParam::b;
  const SparsityPattern pattern = graph_pattern(400, grid_edges(20));
  SymmetricFactor<T, b> factor(pattern, any_sign<T, b>());
  EXPECT_THROW(factor.round(), NumericsError);
  const auto blocks = random_blocks<T, b>(pattern);
  const Dense<T> K = dense_matrix<T, b>(pattern, blocks);
  const auto residual = [&](int columns) {
    const Dense<T> right = Dense<T>::Random(b * pattern.size, columns);
    Dense<T> y = right;
    factor.solve(y);
    return relative_residual(K, y, right);
  };
  factor.factorise(entries<T, b>(blocks));
  factor.round();
  for (int columns = 1; columns <= 4; ++columns) {
    EXPECT_LT(residual(columns), 1e-5);
    if (std::is_same_v<T, double>) {
      EXPECT_GT(residual(columns), 1e-10);
    } else {
      EXPECT_LT(residual(columns), 1e-14);
    }
  }
  factor.factorise(entries<T, b>(blocks));
  EXPECT_LT(residual(1), 1e-14);
}

TEST(SymmetricFactor, BlocksBelowTheDiagonalAreNotSymmetric) {
  const SparsityPattern pattern = special_patterns()[8].pattern;
  auto blocks = random_blocks<double, 2>(pattern);
  const Dense<double> K = dense_matrix<double, 2>(pattern, blocks),
                      right = Dense<double>::Random(K.rows(), 1);
  for (auto& block : blocks) block.transposeInPlace();
  SymmetricFactor<double, 2> factor(pattern, {1, 1});
  factor.factorise(entries<double, 2>(blocks));
  Dense<double> y = right;
  factor.solve(y);
  EXPECT_GT(relative_residual(K, y, right), 1e-4);
}

// Quasi-definite: positive pivots for the first unknown of a node, negative ones for the others, in each
// order.
TEST(SymmetricFactor, QuasiDefiniteMatricesNeedNoPivotingInAnyOrder) {
  std::mt19937 random(2);
  for (int n = 0; n < 200; ++n) {
    const SparsityPattern pattern = random_pattern(20, 2, random);
    auto blocks = random_blocks<double, 4>(pattern);
    for (auto& block : blocks) {
      block.bottomRightCorner<3, 3>() *= -1;
      block.topRightCorner<1, 3>() *= 100;  // does not matter
      block.bottomLeftCorner<3, 1>() *= 100;
    }
    std::vector<int> order(pattern.size);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    SymmetricFactor<double, 4> factor(assembly_tree(pattern, order), {1, -1, -1, -1});
    factor.factorise(entries<double, 4>(blocks));
    const Dense<double> K = dense_matrix<double, 4>(pattern, blocks),
                        right = Dense<double>::Random(K.rows(), 2);
    Dense<double> y = right;
    factor.solve(y);
    ASSERT_LT(relative_residual(K, y, right), 1e-12);
    SymmetricFactor<double, 4> positive(assembly_tree(pattern, order), {1, 1, 1, 1});
    ASSERT_THROW(positive.factorise(entries<double, 4>(blocks)), NumericsError);
  }
}

class Errors : public testing::Test {
 protected:
  const SparsityPattern pattern = special_patterns()[8].pattern;
  std::vector<Eigen::Matrix<double, 1, 1>> blocks = random_blocks<double, 1>(pattern);
  SymmetricFactor<double> factor{pattern, {1}};
  Field right = Field::Random(pattern.size, 2);

  int diagonal(int node) const { return pattern.column_start[node]; }
  void expect_error(const std::string& what) {
    EXPECT_THAT([&] { factor.factorise(entries<double, 1>(blocks)); },
                ThrowsMessage<NumericsError>(HasSubstr(what)));
    EXPECT_THAT([&] { factor.solve(right); }, ThrowsMessage<NumericsError>(HasSubstr("call factorise()")));
  }
};

TEST_F(Errors, NotPositiveDefinite) {
  blocks[diagonal(41)](0, 0) *= -1;
  expect_error("matrix is not positive definite: pivot -");
  expect_error("at node 42 of 100");
}

TEST_F(Errors, ZeroPivots) {
  for (auto& block : blocks) block.setZero();
  expect_error("matrix is not positive definite: pivot 0");
}

TEST_F(Errors, PivotsThatHaveLostAllDigits) {
  // The Laplacian of the graph: constants are its kernel, and the last pivot is round-off.
  std::vector<double> sum(pattern.size, 0);
  for (int j = 0; j < pattern.size; ++j)
    for (int k = diagonal(j) + 1; k < diagonal(j + 1); ++k) {
      blocks[k](0, 0) = -1 / 3.0;
      sum[j] += 1 / 3.0;
      sum[pattern.row[k]] += 1 / 3.0;
    }
  for (int j = 0; j < pattern.size; ++j) blocks[diagonal(j)](0, 0) = sum[j];
  expect_error("not positive definite");
  for (int j = 0; j < pattern.size; ++j) blocks[diagonal(j)](0, 0) = sum[j] * (1 + 1e-12);
  factor.factorise(entries<double, 1>(blocks));
  Field y = right;
  factor.solve(y);
  EXPECT_LT((dense_matrix<double, 1>(pattern, blocks) * y - right).norm(), 1e-13 * y.norm());
}

TEST_F(Errors, NumbersThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const int entry : {diagonal(41), diagonal(41) + 1}) {
      const double good = blocks[entry](0, 0);
      blocks[entry](0, 0) = bad;
      expect_error("not finite at node");
      blocks[entry](0, 0) = good;
    }
  }
  factor.factorise(entries<double, 1>(blocks));
  Field y = right;
  factor.solve(y);
  EXPECT_LT((dense_matrix<double, 1>(pattern, blocks) * y - right).norm(), 1e-13 * right.norm());
}

TEST_F(Errors, RightHandSidesOfAnotherSize) {
  factor.factorise(entries<double, 1>(blocks));
  Field wrong(99, 1);
  EXPECT_THAT([&] { factor.solve(wrong); },
              ThrowsMessage<InputError>(HasSubstr("has 99 rows, expected 100")));
}

// Replaced pivots leave factors of a matrix nearby: y differs, but not by much more than the replacement.
TEST(SymmetricFactor, ReplacesSmallPivotsWhereAsked) {
  const SparsityPattern pattern = graph_pattern(2, {{0, 1}});
  const auto antidiagonal = [](int k) -> Eigen::Matrix2d {
    return k == 1 ? Eigen::Matrix2d::Zero() : (Eigen::Matrix2d() << 0, 1, 1, 0).finished();
  };
  SymmetricFactor<double, 2> strict(pattern, {0, 0}), lenient(pattern, {0, 0}, SmallPivots::are_replaced);
  EXPECT_THROW(strict.factorise(antidiagonal), NumericsError);
  lenient.factorise(antidiagonal);
  Field y(4, 1);
  y << 1, 2, 3, 4;
  lenient.solve(y);
  EXPECT_LT((y - Eigen::Vector4d(2, 1, 4, 3)).norm(), 1e-6);
}

class Threads : public testing::Test {
 protected:
  static constexpr int width = 150;
  const SparsityPattern pattern = graph_pattern(width * width, grid_edges(width));
  ~Threads() override { set_thread_count(1); }
};

TEST_F(Threads, GiveTheSameBits) {
  const auto blocks = random_blocks<double, 1>(pattern);
  const Field right = Field::Random(pattern.size, 3);
  Field first;
  for (const int threads : {1, 2, 3, 8}) {
    set_thread_count(threads);
    SymmetricFactor<double> factor(pattern, {1});
    for (int repetition = 0; repetition < 3; ++repetition) {
      factor.factorise(entries<double, 1>(blocks));
      Field y = right;
      factor.solve(y);
      if (first.size() == 0) first = y;
      ASSERT_EQ(y, first) << threads << " threads";
    }
  }
  EXPECT_THROW(set_thread_count(0), InputError);
}

TEST_F(Threads, AnErrorInOneOfThemIsThrown) {
  set_thread_count(2);
  const auto good = random_blocks<double, 1>(pattern);
  SymmetricFactor<double> factor(pattern, {1});
  for (int node = 0; node < pattern.size; node += 1234) {
    auto blocks = good;
    blocks[pattern.column_start[node]](0, 0) *= -1;
    EXPECT_THAT([&] { factor.factorise(entries<double, 1>(blocks)); },
                ThrowsMessage<NumericsError>(HasSubstr(format("at node %d of", node + 1))));
  }
}

TEST(AssemblyTree, EliminatesEachNodeOnceChildrenFirst) {
  std::mt19937 random(3);
  for (int n = 0; n < 100; ++n) {
    const SparsityPattern pattern = random_pattern(1 + n, 0.02 * n, random);
    const AssemblyTree tree = assembly_tree(pattern);
    std::vector<int> seen(pattern.size, 0);
    for (const int node : tree.ordering) ++seen[node];
    EXPECT_THAT(seen, testing::Each(1));
    EXPECT_EQ(static_cast<int>(tree.entries.size()), pattern.entry_count());
    int first = 0;
    for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
      const Front& front = tree.fronts[f];
      EXPECT_EQ(front.first, first);
      first += front.columns;
      EXPECT_TRUE(front.parent == -1 ? front.updated() == 0 : front.parent > static_cast<int>(f));
      for (int r = front.rows_begin; r < front.rows_end; ++r) {
        const Front& parent = tree.fronts[front.parent];
        const int place = tree.position[r];
        ASSERT_LT(place, parent.size());
        const int row = place < parent.columns ? parent.first + place
                                               : tree.rows[parent.rows_begin + place - parent.columns];
        EXPECT_EQ(row, tree.rows[r]);
      }
    }
    EXPECT_EQ(first, pattern.size);
  }
}

TEST(SplitTree, PartsNeedNobodyElse) {
  std::mt19937 random(4);
  const AssemblyTree tree = assembly_tree(random_pattern(2000, 1.2, random));
  for (const int count : {1, 2, 5}) {
    const SplitTree split = split_tree(tree, count);
    std::vector<int> part(tree.fronts.size(), -1);
    std::size_t fronts = split.top.size();
    for (int p = 0; p < count; ++p)
      for (const int f : split.parts[p]) part[f] = p, ++fronts;
    EXPECT_EQ(fronts, tree.fronts.size());
    for (std::size_t f = 0; f < tree.fronts.size(); ++f) {
      const int parent = tree.fronts[f].parent;
      if (part[f] == -1 && parent != -1) {
        EXPECT_EQ(part[parent], -1);
      }
      if (parent != -1 && part[parent] != -1) {
        EXPECT_EQ(part[f], part[parent]);
      }
    }
  }
}

}  // namespace
}  // namespace esfem::test_symmetric_factor
