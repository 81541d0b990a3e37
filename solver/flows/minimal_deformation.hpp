// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/factor_service.hpp"
#include "solver/linalg/spd_solver.hpp"

namespace esfem {

/// The velocity of minimal deformation rate (Hu, Li, Numer. Math. 152, 2022): of all v with v . nu = -V the
/// one with the least int |grad v|². With the multiplier kappa of the constraint, -Lap v = kappa nu: find v
/// in S_h^3 and kappa in S_h with
///   int grad v : grad chi = int kappa nu . chi    for all chi in S_h^3,
///   int (v . nu) phi = -int V phi                 for all phi in S_h.
///
/// With A_a = A the stiffness matrix and (B_a)_ij = int nu_a phi_i phi_j, a = 1, 2, 3, it is the saddle point
/// system
///   A v_a = B_a kappa,   sum_a B_a v_a = -M V,
/// symmetric and indefinite, whose first block is singular. It is reduced to kappa: A_g is A with a node of
/// each component of the surface held fixed, c_a is the mean motion of a component, C_a = B_a 1 on it. Then
/// v_a = A_g^-1 B_a kappa + c_a, and
///   S kappa + sum_a C_a c_a = -M V,   C_a^T kappa = 0,   S = sum_a B_a A_g^-1 B_a,
/// where S is positive definite: conjugate gradients on the kappa with C_a^T kappa = 0 (Gould, Hribar,
/// Nocedal, SIAM J. Sci. Comput. 23, 2001). Without tangential motion kappa = (-Lap + |A|²) V, so that S^-1
/// is close to P = M^-1 (A + W) M^-1, W_ij = int |grad nu|² phi_i phi_j: both have the principal symbol of
/// -Lap, since sum_a nu_a² = 1, and P S is the identity and a compact operator. The number of iterations does
/// not depend on the mesh. In P, D M_0 D stands for M: M_0 is that of an earlier step, whose factors
/// serve as long as FactorService says, D_ii² = M_ii / (M_0)_ii. It is M where all triangles of a flat
/// surface grow by the same factor, and differs by O(h) where the factor varies smoothly. With E_a the nodal
/// values of nu_a, E^T C is regular, and 1 - E (C^T E)^-1 C^T and its transpose project onto these kappa and
/// their residuals. It takes three unknowns a node less than a factorisation of the whole system does.
class MinimalDeformation {
 public:
  /// The space must outlive the object.
  explicit MinimalDeformation(const SurfaceSpace& space);

  /// v (N x 3) on Gamma_h[x] with its matrices M and A, nu_V: N x 4, the normal and V. Throws NumericsError
  /// when a matrix is singular or not finite, or the iteration does not converge. No allocation after the
  /// first call.
  void velocity(const Field& x, const Field& nu_V, const SymmetricMatrix& M, const SymmetricMatrix& A,
                Field& v);

  /// The multiplier of the last velocity, N x 1.
  const Field& kappa() const { return kappa_; }
  /// Iterations that it took.
  int iterations() const { return iterations_; }

  /// What later velocities depend on to the last bit, for checkpoints: kappa of the last ones, from which the
  /// next iteration starts, and the nodes of the mass matrix that is factorised.
  nlohmann::json progress() const;
  /// Resumes from there; factorises. Throws InputError when a field has not N rows, or there are too
  /// many kappa.
  void resume(const nlohmann::json& saved);

 private:
  void set_matrices(const Field& x, const Field& nu_V, const SymmetricMatrix& M, const SymmetricMatrix& A);
  void ground(const SymmetricMatrix& A);
  void factorise_mass(const Field& x, const SymmetricMatrix& M);
  void set_mass(const Field& x, const SymmetricMatrix& M);
  void solve_mass(Field& r);
  void multiply_B(const Field& kappa, Field& out) const;
  void multiply_B_transposed(const Field& v, Field& out) const;
  void multiply_S(const Field& p, Field& v_p);
  void guess();
  void keep_for_guesses();
  void precondition(const Field& r, Field& out);
  void set_constraint(const Field& nu_V);
  void split_mean_motion();
  void keep_constraint(Field& p) const;

  const SurfaceSpace& space_;
  std::vector<int> component_;    ///< of the surface, by node
  std::vector<int> fixed_nodes_;  ///< one in each component
  SymmetricMatrix B_W_[4];        ///< B_1, B_2, B_3 and, with A added to it, W
  SymmetricMatrix grounded_;
  SpdSolver grounded_solver_, mass_solver_;
  FactorService mass_service_;
  Field mass_x_, mass_diagonal_;  ///< nodes and diagonal of the M_0 that is factorised
  Field mass_scale_;              ///< the diagonal of D^-1
  Field C_, E_;                   ///< three columns a component; E: nodal values of nu
  Field EC_inverse_;              ///< of E^T C
  Field kappa_, mean_motion_;
  Field differences_;  ///< of kappa of the last velocities: backward ones of order 0, 1, ..
  int known_differences_ = 0;
  Field V_, b_, ones_, r_, z_, p_, v_p_, S_p_, work_;
  int iterations_ = 0;
};

}  // namespace esfem
