// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/assembly/surface_space.hpp"

#include "solver/assembly/size.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

/// Local node pairs a >= b, the pairs a > b first.
std::vector<std::pair<int, int>> node_pairs(int nodes) {
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < nodes; ++a)
    for (int b = 0; b < a; ++b) pairs.emplace_back(a, b);
  for (int a = 0; a < nodes; ++a) pairs.emplace_back(a, a);
  return pairs;
}

/// A table with rows of numbers to be summed against the same terms: blocks of six rows (the last of three or
/// fewer, filled up with zeros), in a block term by term. coefficient(row, term) gives the numbers.
template <class Coefficient>
std::vector<double> blocked_table(int rows, int terms, const Coefficient& coefficient) {
  std::vector<double> table;
  for (int first = 0; first < rows;) {
    const int height = rows - first > 3 ? 6 : 3;
    for (int term = 0; term < terms; ++term)
      for (int row = first; row < first + height; ++row)
        table.push_back(row < rows ? coefficient(row, term) : 0.0);
    first += height;
  }
  return table;
}

/// out[row] = sum of table(row, term) term[term], `height` rows at once so that they stay in registers.
template <int height>
const double* sum_block(const double* table, const Pack* terms, int count, Pack* out) {
  Pack sum[height] = {};
  for (int term = 0; term < count; ++term) {
    for (int row = 0; row < height; ++row) sum[row] += table[row] * terms[term];
    table += height;
  }
  for (int row = 0; row < height; ++row) out[row] = sum[row];
  return table;
}

/// out = table * terms for a blocked_table; out has room for the rows that fill the last block up.
void sum_table(const std::vector<double>& table, const Pack* terms, int count, int rows,
               std::vector<Pack>& out) {
  const double* next = table.data();
  for (int first = 0; first < rows;) {
    const int height = rows - first > 3 ? 6 : 3;
    next = height == 6 ? sum_block<6>(next, terms, count, &out[first])
                       : sum_block<3>(next, terms, count, &out[first]);
    first += height;
  }
}

}  // namespace

SurfaceSpace::SurfaceSpace(const Mesh& mesh) : SurfaceSpace(mesh, default_quadrature(mesh.degree)) {}

SurfaceSpace::SurfaceSpace(const Mesh& mesh, const Quadrature& rule)
    : degree_(mesh.degree),
      elements_(mesh.elements),
      rule_(rule),
      length_(characteristic_length(mesh)),
      pattern_(std::make_shared<SparsityPattern>(
          element_pattern(mesh.elements, static_cast<int>(mesh.nodes.rows())))),
      batches_(mesh.elements, mesh.degree, rule) {
  pairs_ = node_pairs(batches_.nodes());
  entries_ = static_cast<int>(pairs_.size());
  off_diagonals_ = entries_ - batches_.nodes();
  for (int batch = 0; batch < batches_.count(); ++batch)
    for (const auto& [a, b] : pairs_)
      for (int lane = 0; lane < pack_size; ++lane) {
        const int element = batches_.element(batch, lane);
        position_.push_back(pattern_->entry(elements_(element, a), elements_(element, b)));
      }

  const int points = batches_.points();
  mass_table_ = blocked_table(entries_, points, [&](int row, int q) {
    const ElementBatches::Shape* shape = batches_.shapes(q);
    return shape[pairs_[row].first].value * shape[pairs_[row].second].value;
  });
  // grad phi_a . grad phi_b = sum over i, j of (inverse metric)_ij d_i phi_a d_j phi_b: terms 11, 12, 22 a
  // point.
  stiffness_table_ = blocked_table(off_diagonals_, 3 * points, [&](int row, int term) {
    const ElementBatches::Shape& a = batches_.shapes(term / 3)[pairs_[row].first];
    const ElementBatches::Shape& b = batches_.shapes(term / 3)[pairs_[row].second];
    if (term % 3 == 0) return a.dxi * b.dxi;
    return term % 3 == 1 ? a.dxi * b.deta + a.deta * b.dxi : a.deta * b.deta;
  });
  const int padding = 5;
  mass_point_.resize(points);
  stiffness_point_.resize(3 * points);
  mass_entry_.resize(entries_ + padding);
  stiffness_entry_.resize(entries_ + padding);
}

SymmetricMatrix SurfaceSpace::matrix() const {
  return {pattern_, Eigen::VectorXd::Zero(pattern_->entry_count())};
}

void SurfaceSpace::require_rows(const Field& field, int columns) const {
  if (field.cols() < columns || (columns > 0 && field.rows() != dofs()))
    throw InputError(format("nodal field is %d x %d, expected %d x %d", static_cast<int>(field.rows()),
                            static_cast<int>(field.cols()), dofs(), columns));
}

void SurfaceSpace::require_matrix(const SymmetricMatrix& matrix) const {
  if (matrix.pattern != pattern_ || matrix.values.size() != pattern_->entry_count())
    throw InputError("matrix is not one of this surface space");
}

void SurfaceSpace::assemble(const Field& x, SymmetricMatrix& M, SymmetricMatrix& A) const {
  require_rows(x, 3);
  require_matrix(M);
  require_matrix(A);
  M.values.setZero();
  A.values.setZero();
  double* mass = M.values.data();
  double* stiffness = A.values.data();
  Batch batch;
  BatchPoint point;
  for (int b = 0; b < batches_.count(); ++b) {
    batches_.load(b, x, batch);
    Lanes regular = ~Lanes{};
    for (int q = 0; q < batches_.points(); ++q) {
      regular &= batches_.evaluate(batch, q, point);
      const Pack weight = batch.one * batches_.weight(q);
      mass_point_[q] = weight * point.jacobian;
      set_stiffness_point(q, weight, point);
    }
    batches_.require_regular(regular, batch);

    sum_stiffness();
    sum_table(mass_table_, mass_point_.data(), batches_.points(), entries_, mass_entry_);
    const int* position = &position_[b * entries_ * pack_size];
    for (int k = 0; k < entries_; ++k, position += pack_size) {
      for (int lane = 0; lane < pack_size; ++lane) {
        mass[position[lane]] += mass_entry_[k][lane];
        stiffness[position[lane]] += stiffness_entry_[k][lane];
      }
    }
  }
}

void SurfaceSpace::sum_stiffness() const {
  sum_table(stiffness_table_, stiffness_point_.data(), 3 * batches_.points(), off_diagonals_,
            stiffness_entry_);
  for (int a = 0; a < batches_.nodes(); ++a) stiffness_entry_[off_diagonals_ + a] = Pack{};
  for (int k = 0; k < off_diagonals_; ++k) {
    stiffness_entry_[off_diagonals_ + pairs_[k].first] -= stiffness_entry_[k];
    stiffness_entry_[off_diagonals_ + pairs_[k].second] -= stiffness_entry_[k];
  }
}

void SurfaceSpace::add_entries(const Batch& batch, const std::vector<Pack>& entry,
                               SymmetricMatrix& out) const {
  const int* position = &position_[batch.number * entries_ * pack_size];
  for (int k = 0; k < entries_; ++k)
    for (int lane = 0; lane < pack_size; ++lane) out.values[position[pack_size * k + lane]] += entry[k][lane];
}

void SurfaceSpace::add_stiffness(const Batch& batch, SymmetricMatrix& A) const {
  sum_stiffness();
  add_entries(batch, stiffness_entry_, A);
}

void SurfaceSpace::add_mass(const Batch& batch, const Pack* weights, SymmetricMatrix& M) const {
  sum_table(mass_table_, weights, batches_.points(), entries_, mass_entry_);
  add_entries(batch, mass_entry_, M);
}

template <class Function>
double SurfaceSpace::integrate(const Field& x, const Function& function) const {
  require_rows(x, 3);
  Batch batch;
  BatchPoint point;
  Pack sum = {};
  for (int b = 0; b < batches_.count(); ++b) {
    batches_.load(b, x, batch);
    Lanes regular = ~Lanes{};
    for (int q = 0; q < batches_.points(); ++q) {
      regular &= batches_.evaluate(batch, q, point);
      sum += batch.one * batches_.weight(q) * function(batch, batches_.shapes(q), point);
    }
    batches_.require_regular(regular, batch);
  }
  return sum_of_lanes(sum);
}

double SurfaceSpace::area(const Field& x) const {
  return integrate(
      x, [](const Batch&, const ElementBatches::Shape*, const BatchPoint& point) { return point.jacobian; });
}

double SurfaceSpace::volume(const Field& x) const {
  const Vec3 centre = far_centre(x, length_);
  return integrate(x, [&](const Batch& batch, const ElementBatches::Shape* shape, const BatchPoint& point) {
    Pack sum = {};
    for (int a = 0; a < batches_.nodes(); ++a) {
      Pack from_centre[3];
      for (int i = 0; i < 3; ++i) from_centre[i] = batch.x[a][i] - centre[i];
      sum += shape[a].value * dot(from_centre, point.normal);
    }
    return sum / 3.0;
  });
}

}  // namespace esfem
