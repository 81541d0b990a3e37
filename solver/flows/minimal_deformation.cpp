// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/minimal_deformation.hpp"

#include <algorithm>
#include <cmath>

#include "solver/disjoint_sets.hpp"
#include "solver/error.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {
namespace {

/// Of the error of v in the norm |grad v|, estimated by the preconditioner, relative to that of v = 0.
constexpr double cg_tolerance = 1e-9;

constexpr int most_cg_iterations = 200;

/// Velocities that the guess of kappa is extrapolated from at most: seven take a quarter of the iterations
/// less than four.
constexpr int most_differences = 7;

/// Iterations that take as long as a factorisation of the mass matrix.
constexpr double mass_factorisation_cost = 1.5;

/// The component of the surface that each node belongs to, counted from 0.
std::vector<int> components(const SparsityPattern& pattern) {
  DisjointSets sets(pattern.size);
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) sets.unite(j, pattern.row[k]);
  return sets.numbered();
}

void diagonal(const SymmetricMatrix& M, Field& entries) {
  entries.resize(M.pattern->size, 1);
  for (int j = 0; j < M.pattern->size; ++j) entries(j, 0) = M.values[M.pattern->column_start[j]];
}

}  // namespace

MinimalDeformation::MinimalDeformation(const SurfaceSpace& space)
    : space_(space),
      component_(components(*space.pattern())),
      B_W_{space.matrix(), space.matrix(), space.matrix(), space.matrix()},
      grounded_(space.matrix()),
      grounded_solver_(space.pattern()),
      mass_solver_(space.pattern()),
      mass_service_(mass_factorisation_cost) {
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

void MinimalDeformation::factorise_mass(const Field& x, const SymmetricMatrix& M) {
  mass_service_.end();
  mass_solver_.factorise(1, M, 0, M);
  mass_solver_.round();
  mass_x_ = x;
  diagonal(M, mass_diagonal_);
  mass_service_.start();
}

/// M is factorised, or scaled factors of an earlier one serve.
void MinimalDeformation::set_mass(const Field& x, const SymmetricMatrix& M) {
  if (mass_service_.is_over()) factorise_mass(x, M);
  diagonal(M, mass_scale_);
  mass_scale_ = (mass_diagonal_.array() / mass_scale_.array()).sqrt();
}

/// out_a = B_a kappa.
void MinimalDeformation::multiply_B(const Field& kappa, Field& out) const {
  out.setZero(kappa.rows(), 3);
  double* result[3] = {out.col(0).data(), out.col(1).data(), out.col(2).data()};
  const double *B[3] = {B_W_[0].values.data(), B_W_[1].values.data(), B_W_[2].values.data()},
               *in = kappa.data();
  const SparsityPattern& pattern = *B_W_[0].pattern;
  for (int j = 0; j < pattern.size; ++j) {
    const int begin = pattern.column_start[j], end = pattern.column_start[j + 1];
    double sum[3];
    for (int a = 0; a < 3; ++a) sum[a] = B[a][begin] * in[j];
    for (int k = begin + 1; k < end; ++k) {
      const int i = pattern.row[k];
      for (int a = 0; a < 3; ++a) {
        result[a][i] += B[a][k] * in[j];
        sum[a] += B[a][k] * in[i];
      }
    }
    for (int a = 0; a < 3; ++a) result[a][j] += sum[a];
  }
}

/// out = sum_a B_a v_a.
void MinimalDeformation::multiply_B_transposed(const Field& v, Field& out) const {
  out.setZero(v.rows(), 1);
  double* result = out.data();
  const double *B[3] = {B_W_[0].values.data(), B_W_[1].values.data(), B_W_[2].values.data()},
               *in[3] = {v.col(0).data(), v.col(1).data(), v.col(2).data()};
  const SparsityPattern& pattern = *B_W_[0].pattern;
  for (int j = 0; j < pattern.size; ++j) {
    const int begin = pattern.column_start[j], end = pattern.column_start[j + 1];
    double sum = 0;
    for (int a = 0; a < 3; ++a) sum += B[a][begin] * in[a][j];
    for (int k = begin + 1; k < end; ++k) {
      const int i = pattern.row[k];
      double of_j = 0;
      for (int a = 0; a < 3; ++a) {
        of_j += B[a][k] * in[a][j];
        sum += B[a][k] * in[a][i];
      }
      result[i] += of_j;
    }
    result[j] += sum;
  }
}

/// r becomes M^-1 r, to about the change of the surface since M was factorised.
void MinimalDeformation::solve_mass(Field& r) {
  r.array() *= mass_scale_.array();
  mass_solver_.solve(r);
  r.array() *= mass_scale_.array();
}

/// out = P r with C^T out = 0.
void MinimalDeformation::precondition(const Field& r, Field& out) {
  work_ = r;
  solve_mass(work_);
  B_W_[3].multiply(work_, out);
  solve_mass(out);
  keep_constraint(out);
}

/// S_p_ = S p and v_p = A_g^-1 B p.
void MinimalDeformation::multiply_S(const Field& p, Field& v_p) {
  multiply_B(p, v_p);
  grounded_solver_.solve(v_p);
  multiply_B_transposed(v_p, S_p_);
}

/// kappa extrapolated from the last velocities, and C^T kappa = 0. The order is the one up to which the
/// differences fall: higher ones are rounding errors, or steps of other sizes.
void MinimalDeformation::guess() {
  if (differences_.size() == 0) differences_.setZero(space_.dofs(), most_differences);
  kappa_ = differences_.col(0);
  for (int order = 1; order < known_differences_; ++order) {
    if (differences_.col(order).norm() >= differences_.col(order - 1).norm()) break;
    kappa_ += differences_.col(order);
  }
  keep_constraint(kappa_);
}

void MinimalDeformation::keep_for_guesses() {
  work_ = kappa_;
  for (int order = 0; order < most_differences; ++order) {
    work_.col(0).swap(differences_.col(order));
    work_ = differences_.col(order) - work_.col(0);
  }
  known_differences_ = std::min(known_differences_ + 1, most_differences);
}

/// C, E and (E^T C)^-1.
void MinimalDeformation::set_constraint(const Field& nu_V) {
  ones_.setOnes(space_.dofs(), 1);
  multiply_B(ones_, v_p_);
  C_.setZero(space_.dofs(), 3 * fixed_nodes_.size());
  E_.setZero(space_.dofs(), 3 * fixed_nodes_.size());
  for (int j = 0; j < space_.dofs(); ++j) {
    C_.block<1, 3>(j, 3 * component_[j]) = v_p_.row(j);
    E_.block<1, 3>(j, 3 * component_[j]) = nu_V.block<1, 3>(j, 0);
  }
  EC_inverse_ = (E_.transpose() * C_).inverse();
}

/// The part of r that belongs to the mean motions goes to these; E^T r = 0 is left.
void MinimalDeformation::split_mean_motion() {
  const Field motion = EC_inverse_ * (E_.transpose() * r_);
  r_ -= C_ * motion;
  mean_motion_ += motion;
}

/// C^T p = 0 for the p that is left; r . p stays when E^T r = 0.
void MinimalDeformation::keep_constraint(Field& p) const {
  p -= E_ * (EC_inverse_.transpose() * (C_.transpose() * p));
}

/// B_a; A + W for the preconditioner; and factors.
void MinimalDeformation::set_matrices(const Field& x, const Field& nu_V, const SymmetricMatrix& M,
                                      const SymmetricMatrix& A) {
  const auto weights = [](const PointData<3>& p, Pack* weight) {
    weight[3] = Pack{};
    for (int a = 0; a < 3; ++a) {
      weight[a] = p.u[a];
      weight[3] += dot(p.grad[a], p.grad[a]);
    }
  };
  space_.assemble_weighted_masses<3>(x, nu_V, weights, B_W_);
  B_W_[3].values += A.values;
  ground(A);
  set_mass(x, M);
  set_constraint(nu_V);
}

void MinimalDeformation::velocity(const Field& x, const Field& nu_V, const SymmetricMatrix& M,
                                  const SymmetricMatrix& A, Field& v) {
  set_matrices(x, nu_V, M, A);
  V_ = nu_V.col(3);
  M.multiply(V_, b_);
  b_ = -b_;
  guess();
  multiply_S(kappa_, v);
  r_ = b_ - S_p_;
  mean_motion_.setZero(C_.cols(), 1);
  split_mean_motion();
  precondition(r_, z_);
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
    split_mean_motion();
    precondition(r_, z_);
    const double next_size = r_.col(0).dot(z_.col(0));
    p_ = z_ + next_size / size * p_;
    size = next_size;
  }
  if (!std::isfinite(size)) throw NumericsError("velocity of minimal deformation rate is not finite");
  for (int j = 0; j < space_.dofs(); ++j)
    v.row(j) += mean_motion_.middleRows<3>(3 * component_[j]).transpose();
  keep_for_guesses();
  mass_service_.add_step(iterations_);
}

nlohmann::json MinimalDeformation::progress() const {
  return {{"kappa_differences", packed(differences_.leftCols(known_differences_))},
          {"mass_x", packed(mass_service_.serves() ? mass_x_ : Field())},
          {"mass_service", mass_service_.progress()}};
}

void MinimalDeformation::resume(const nlohmann::json& saved) {
  const Field known = unpacked(saved.at("kappa_differences")), mass_x = unpacked(saved.at("mass_x"));
  if (known.cols() > most_differences || (known.cols() > 0 && known.rows() != space_.dofs()))
    throw InputError(format("differences of kappa are %td x %td, expected %d x %d at most", known.rows(),
                            known.cols(), space_.dofs(), most_differences));
  if (mass_x.size() > 0 && (mass_x.rows() != space_.dofs() || mass_x.cols() != 3))
    throw InputError(format("nodes of the mass matrix are %td x %td, expected %d x 3", mass_x.rows(),
                            mass_x.cols(), space_.dofs()));
  differences_.setZero(space_.dofs(), most_differences);
  differences_.leftCols(known.cols()) = known;
  known_differences_ = static_cast<int>(known.cols());
  if (mass_x.size() > 0) {
    SymmetricMatrix M = space_.matrix(), A = space_.matrix();
    space_.assemble(mass_x, M, A);
    factorise_mass(mass_x, M);
    mass_service_.resume(saved.at("mass_service"));
  }
}

}  // namespace esfem
