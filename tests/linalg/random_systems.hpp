// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <complex>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// The pattern of a graph: pairs of different nodes, in any order.
inline SparsityPattern graph_pattern(int nodes, const std::vector<std::pair<int, int>>& edges) {
  std::vector<std::set<int>> rows(nodes);
  for (int j = 0; j < nodes; ++j) rows[j].insert(j);
  for (const auto& [i, j] : edges) rows[std::min(i, j)].insert(std::max(i, j));
  SparsityPattern pattern;
  pattern.size = nodes;
  pattern.column_start = {0};
  for (const std::set<int>& column : rows) {
    pattern.row.insert(pattern.row.end(), column.begin(), column.end());
    pattern.column_start.push_back(pattern.entry_count());
  }
  return pattern;
}

/// Edges between neighbours in the rows and columns of a square grid, whose nodes are numbered row by row.
inline std::vector<std::pair<int, int>> grid_edges(int width) {
  std::vector<std::pair<int, int>> edges;
  for (int i = 1; i < width * width; ++i) {
    if (i % width) edges.emplace_back(i, i - 1);
    if (i >= width) edges.emplace_back(i, i - width);
  }
  return edges;
}

struct NamedPattern {
  std::string name;
  SparsityPattern pattern;
};

inline SparsityPattern random_pattern(int nodes, double edges_per_node, std::mt19937& random) {
  std::vector<std::pair<int, int>> edges;
  std::uniform_int_distribution<int> node(0, nodes - 1);
  for (int e = 0; e < edges_per_node * nodes; ++e) {
    const int i = node(random), j = node(random);
    if (i != j) edges.emplace_back(i, j);
  }
  return graph_pattern(nodes, edges);
}

/// Graphs that an elimination could trip over.
inline std::vector<NamedPattern> special_patterns() {
  std::vector<NamedPattern> patterns;
  const auto add = [&](const std::string& name, int nodes, const std::vector<std::pair<int, int>>& edges) {
    patterns.push_back({name, graph_pattern(nodes, edges)});
  };
  std::vector<std::pair<int, int>> path, star, tree, clique, cliques, arrow;
  for (int i = 1; i < 100; ++i) {
    path.emplace_back(i - 1, i);
    star.emplace_back(0, i);
    tree.emplace_back((i - 1) / 2, i);
    for (int j = 0; j < i; ++j) {
      clique.emplace_back(i, j);
      if (i / 10 == j / 10) cliques.emplace_back(i, j);
    }
    for (int j = 90; j < i; ++j) arrow.emplace_back(i, j);
    if (i < 90) arrow.emplace_back(i, 95);
  }
  add("one node", 1, {});
  add("two nodes", 2, {{0, 1}});
  add("isolated nodes", 7, {});
  add("path", 100, path);
  add("star", 100, star);
  add("binary tree", 100, tree);
  add("clique", 100, clique);
  add("ten cliques", 100, cliques);
  add("grid", 100, grid_edges(10));
  add("arrow", 100, arrow);
  add("a grid and isolated nodes", 130, grid_edges(10));
  return patterns;
}

/// Random symmetric blocks on a pattern, the k-th that of its k-th entry, which is not symmetric itself off
/// the diagonal; positive definite (complex: with a positive definite real part) by a dominant diagonal.
template <class T, int b>
std::vector<Eigen::Matrix<T, b, b>> random_blocks(const SparsityPattern& pattern) {
  using Block = Eigen::Matrix<T, b, b>;
  std::vector<Block> blocks(pattern.entry_count());
  std::vector<double> sum(pattern.size, 1);
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      blocks[k].setRandom();
      sum[j] += 2 * blocks[k].cwiseAbs().sum();
      sum[pattern.row[k]] += 2 * blocks[k].cwiseAbs().sum();
    }
  for (int j = 0; j < pattern.size; ++j) {
    Block& diagonal = blocks[pattern.column_start[j]];
    diagonal = (diagonal + diagonal.transpose()).eval();
    diagonal.diagonal().array() += sum[j];
  }
  return blocks;
}

template <class T, int b>
Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> dense_matrix(
    const SparsityPattern& pattern, const std::vector<Eigen::Matrix<T, b, b>>& blocks) {
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> K;
  K.setZero(b * pattern.size, b * pattern.size);
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      K.template block<b, b>(b * i, b * j) = blocks[k];
      K.template block<b, b>(b * j, b * i) = blocks[k].transpose();
    }
  return K;
}

/// What SymmetricFactor::factorise takes.
template <class T, int b>
auto entries(const std::vector<Eigen::Matrix<T, b, b>>& blocks) {
  return [&blocks](int k) {
    if constexpr (b == 1) {
      return blocks[k](0, 0);
    } else {
      return blocks[k];
    }
  };
}

}  // namespace esfem
