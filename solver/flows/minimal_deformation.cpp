// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/minimal_deformation.hpp"

#include <cmath>
#include <numeric>

#include "solver/error.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {
namespace {

/// Of the error of v in the norm |grad v|, estimated by the preconditioner, relative to that of v = 0.
constexpr double cg_tolerance = 1e-9;

constexpr int most_cg_iterations = 200;

/// The component of the surface that each node belongs to, counted from 0.
std::vector<int> components(const SparsityPattern& pattern) {
  std::vector<int> parent(pattern.size);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int j) {
    while (parent[j] != j) j = parent[j] = parent[parent[j]];
    return j;
  };
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
      const int a = root(j), b = root(pattern.row[k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::vector<int> component(pattern.size);
  int count = 0;
  for (int j = 0; j < pattern.size; ++j) component[j] = root(j) == j ? count++ : component[root(j)];
  return component;
}

}  // namespace

MinimalDeformation::MinimalDeformation(const SurfaceSpace& space)
    : space_(space),
      mass_factor_(1 / (space.length() * space.length())),
      component_(components(*space.pattern())),
      B_{space.matrix(), space.matrix(), space.matrix()},
      grounded_(space.matrix()),
      grounded_solver_(space.pattern()),
      mass_solver_(space.pattern()) {
  for (int j = 0; j < space.dofs(); ++j)
    if (component_[j] == int(fixed_nodes_.size())) fixed_nodes_.push_back(j);
}

/// A_g: the sum of its rows is zero but for those of the fixed nodes, so that A_g v = r with 1^T r = 0 on a
/// component has v = 0 there, and A v = r.
void MinimalDeformation::ground(const SymmetricMatrix& A) {
  grounded_.values = A.values;
  for (const int j : fixed_nodes_) grounded_.values[grounded_.pattern->column_start[j]] *= 2;
  grounded_solver_.factorise(0, A, 1, grounded_);
}

/// out_a = B_a kappa.
void MinimalDeformation::multiply_B(const Field& kappa, Field& out) const {
  const SparsityPattern& pattern = *B_[0].pattern;
  out.setZero(kappa.rows(), 3);
  for (int j = 0; j < pattern.size; ++j) {
    const int diagonal = pattern.column_start[j];
    for (int a = 0; a < 3; ++a) out(j, a) += B_[a].values[diagonal] * kappa(j);
    for (int k = diagonal + 1; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      for (int a = 0; a < 3; ++a) {
        out(i, a) += B_[a].values[k] * kappa(j);
        out(j, a) += B_[a].values[k] * kappa(i);
      }
    }
  }
}

/// out = sum_a B_a v_a.
void MinimalDeformation::multiply_B_transposed(const Field& v, Field& out) const {
  const SparsityPattern& pattern = *B_[0].pattern;
  out.setZero(v.rows(), 1);
  for (int j = 0; j < pattern.size; ++j) {
    const int diagonal = pattern.column_start[j];
    for (int a = 0; a < 3; ++a) out(j) += B_[a].values[diagonal] * v(j, a);
    for (int k = diagonal + 1; k < pattern.column_start[j + 1]; ++k) {
      const int i = pattern.row[k];
      for (int a = 0; a < 3; ++a) {
        out(i) += B_[a].values[k] * v(j, a);
        out(j) += B_[a].values[k] * v(i, a);
      }
    }
  }
}

/// out = P r, for one column or more.
void MinimalDeformation::precondition(const SymmetricMatrix& A, const Field& r, Field& out) {
  work_ = r;
  mass_solver_.solve(work_);
  A.multiply(work_, out);
  out += mass_factor_ * r;
  mass_solver_.solve(out);
}

/// S_p_ = S p and v_p = A_g^-1 B p.
void MinimalDeformation::multiply_S(const Field& p, Field& v_p) {
  multiply_B(p, v_p);
  grounded_solver_.solve(v_p);
  multiply_B_transposed(v_p, S_p_);
}

/// kappa extrapolated from the last two velocities, and C^T kappa = 0.
void MinimalDeformation::guess() {
  if (kappa_.size() == 0) kappa_.setZero(space_.dofs(), 1);
  if (kappa_change_.size() == 0) kappa_change_.setZero(space_.dofs(), 1);
  old_kappa_ = kappa_;
  kappa_ += kappa_change_;
  kappa_ -= PC_ * CPC_.solve(C_.transpose() * kappa_);
}

/// C, P C and (C^T P C)^-1.
void MinimalDeformation::factorise_constraint(const SymmetricMatrix& A) {
  ones_.setOnes(space_.dofs(), 1);
  multiply_B(ones_, v_p_);
  C_.setZero(space_.dofs(), 3 * fixed_nodes_.size());
  for (int j = 0; j < space_.dofs(); ++j) C_.block<1, 3>(j, 3 * component_[j]) = v_p_.row(j);
  precondition(A, C_, PC_);
  CPC_.compute(C_.transpose() * PC_);
}

/// The part of r that belongs to the mean motions goes to these; C^T P r = 0 is left.
void MinimalDeformation::project() {
  const Field of_constraint = CPC_.solve(PC_.transpose() * r_);
  r_ -= C_ * of_constraint;
  mean_motion_ += of_constraint;
}

void MinimalDeformation::velocity(const Field& x, const Field& nu_V, const SymmetricMatrix& M,
                                  const SymmetricMatrix& A, Field& v) {
  for (int a = 0; a < 3; ++a) {
    const auto normal = [a](const PointData<3>& p) { return p.u[a]; };
    space_.assemble_weighted_mass<3>(x, nu_V, normal, B_[a]);
  }
  ground(A);
  mass_solver_.factorise(1, M, 0, A);
  factorise_constraint(A);

  V_ = nu_V.col(3);
  M.multiply(V_, b_);
  b_ = -b_;
  guess();
  multiply_S(kappa_, v);
  r_ = b_ - S_p_;
  mean_motion_.setZero(C_.cols(), 1);
  project();
  precondition(A, r_, z_);
  p_ = z_;
  double size = r_.col(0).dot(z_.col(0));
  const auto energy = [&] { return kappa_.col(0).dot(b_.col(0) - r_.col(0)); };  // int |grad v|²
  for (iterations_ = 0; size > cg_tolerance * cg_tolerance * energy(); ++iterations_) {
    if (iterations_ == most_cg_iterations)
      throw NumericsError(
          format("velocity of minimal deformation rate: relative error %g after %d iterations, expected %g",
                 std::sqrt(size / energy()), most_cg_iterations, cg_tolerance));
    multiply_S(p_, v_p_);
    const double length = size / p_.col(0).dot(S_p_.col(0));
    v += length * v_p_;
    kappa_ += length * p_;
    r_ -= length * S_p_;
    project();
    precondition(A, r_, z_);
    const double next_size = r_.col(0).dot(z_.col(0));
    p_ = z_ + next_size / size * p_;
    size = next_size;
  }
  if (!std::isfinite(size)) throw NumericsError("velocity of minimal deformation rate is not finite");
  for (int j = 0; j < space_.dofs(); ++j)
    v.row(j) += mean_motion_.middleRows<3>(3 * component_[j]).transpose();
  kappa_change_ = kappa_ - old_kappa_;
}

nlohmann::json MinimalDeformation::progress() const {
  return {{"kappa", packed(kappa_)}, {"kappa_change", packed(kappa_change_)}};
}

void MinimalDeformation::resume(const nlohmann::json& saved) {
  const Field kappa = unpacked(saved.at("kappa")), change = unpacked(saved.at("kappa_change"));
  for (const Field* field : {&kappa, &change})
    if (field->size() > 0 && field->rows() != space_.dofs())
      throw InputError(format("kappa has %td rows, expected %d", field->rows(), space_.dofs()));
  kappa_ = kappa;
  kappa_change_ = change;
}

}  // namespace esfem
