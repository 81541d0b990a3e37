// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/assembly/symmetric_matrix.hpp"

#include <algorithm>

namespace esfem {
namespace {

/// For every node the elements that contain it, compressed: those of node j are element[start[j] ..
/// start[j+1]).
struct NodeElements {
  std::vector<int> start, element;
};

NodeElements elements_of_nodes(const Connectivity& elements, int nodes) {
  NodeElements result;
  result.start.assign(nodes + 1, 0);
  for (Eigen::Index k = 0; k < elements.size(); ++k) ++result.start[elements.data()[k] + 1];
  for (int j = 0; j < nodes; ++j) result.start[j + 1] += result.start[j];
  result.element.resize(elements.size());
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (int e = 0; e < elements.rows(); ++e)
    for (int a = 0; a < elements.cols(); ++a) result.element[next[elements(e, a)]++] = e;
  return result;
}

}  // namespace

int SparsityPattern::entry(int i, int j) const {
  const auto first = row.begin() + column_start[std::min(i, j)];
  const auto last = row.begin() + column_start[std::min(i, j) + 1];
  return static_cast<int>(std::lower_bound(first, last, std::max(i, j)) - row.begin());
}

SparsityPattern element_pattern(const Connectivity& elements, int nodes) {
  const NodeElements around = elements_of_nodes(elements, nodes);
  SparsityPattern pattern;
  pattern.size = nodes;
  pattern.column_start = {0};
  pattern.column_start.reserve(nodes + 1);
  std::vector<int> rows;
  for (int j = 0; j < nodes; ++j) {
    rows.assign(1, j);
    for (int k = around.start[j]; k < around.start[j + 1]; ++k)
      for (int a = 0; a < elements.cols(); ++a)
        if (elements(around.element[k], a) > j) rows.push_back(elements(around.element[k], a));
    std::sort(rows.begin(), rows.end());
    pattern.row.insert(pattern.row.end(), rows.begin(), std::unique(rows.begin(), rows.end()));
    pattern.column_start.push_back(pattern.entry_count());
  }
  return pattern;
}

void SymmetricMatrix::multiply(const Field& u, Field& out) const {
  const int* start = pattern->column_start.data();
  const int* row = pattern->row.data();
  out.setZero(u.rows(), u.cols());
  for (int component = 0; component < u.cols(); ++component) {
    const double* in = u.col(component).data();
    double* result = out.col(component).data();
    for (int j = 0; j < pattern->size; ++j) {
      // The pattern's first entry of a column is its diagonal.
      double sum = values[start[j]] * in[j];
      for (int k = start[j] + 1; k < start[j + 1]; ++k) {
        sum += values[k] * in[row[k]];
        result[row[k]] += values[k] * in[j];
      }
      result[j] += sum;
    }
  }
}

Field SymmetricMatrix::operator*(const Field& u) const {
  Field out;
  multiply(u, out);
  return out;
}

double SymmetricMatrix::energy(const Field& e) const {
  const int* start = pattern->column_start.data();
  const int* row = pattern->row.data();
  double sum = 0;
  for (int component = 0; component < e.cols(); ++component) {
    const double* in = e.col(component).data();
    for (int j = 0; j < pattern->size; ++j) {
      double off_diagonal = 0;
      for (int k = start[j] + 1; k < start[j + 1]; ++k) off_diagonal += values[k] * in[row[k]];
      sum += in[j] * (values[start[j]] * in[j] + 2 * off_diagonal);
    }
  }
  return sum;
}

double SymmetricMatrix::trace() const {
  double sum = 0;
  for (int j = 0; j < pattern->size; ++j) sum += values[pattern->column_start[j]];
  return sum;
}

}  // namespace esfem
