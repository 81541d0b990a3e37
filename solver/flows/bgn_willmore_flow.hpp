// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/bgn_system.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// The Weingarten map of a discrete surface by the third equation of kll21 (2.14): A_h with
///   (A_h, phi) = -(nu, div phi) + (H nu, phi nu)     for all phi in S_h^{3x3},
/// nu the normal of Gamma_h[x]. It is symmetric, and its trace is H.
class WeakWeingarten {
 public:
  /// The space must outlive the object.
  explicit WeakWeingarten(const SurfaceSpace& space);

  /// Computes A_h for Gamma_h[x] and its mass matrix M = M(x), H: N x 1. No allocation after the first call.
  void compute(const Field& x, const Field& H, const SymmetricMatrix& M);
  /// N x 6: the entries 11, 12, 13, 22, 23, 33 in the nodes.
  const Field& A() const { return A_; }
  /// The load of Q = (|A_h|² - H²/2) H of the last x and H: out is N x 1.
  void assemble_Q(const Field& x, const Field& H, Field& out);

 private:
  const SurfaceSpace& space_;
  SpdSolver spd_;
  Field A_, H_and_A_;
};

/// Willmore flow by the scheme of Barrett, Garcke and Nürnberg (SIAM J. Sci. Comput. 31, 2008; kll21 (2.14)),
/// which moves nodes tangentially so that the mesh stays good: find x^n and H^n with
///   (1/tau) ((x^n - x^{n-1}) . nu, chi) + (grad H^n, grad chi) = (Q^{n-1}, chi)    for all chi in S_h,
///   (H^n nu, eta) - (grad x^n, grad eta) = 0                                       for all eta in S_h^3
/// on Gamma_h[x^{n-1}], nu its own normal, with H = div nu (2/R on a sphere: their kappa is -H) and Q from
/// H^{n-1} and the WeakWeingarten that belongs to it.
///
/// Q is explicit: it is (kappa_1 - kappa_2)²/2 H, and its implicit version with (|A|² - H²/2) H^n, the factor
/// before H never negative, would only reduce the definiteness of the matrix. On the Clifford torus the
/// scheme is stable for tau <= 0.01, with the implicit Q it oscillates there.
///
/// For the lumped scheme of the paper (P1) give the space the rule of the vertices, vertex_quadrature().
class BgnWillmoreFlow {
 public:
  /// What a step starts from and computes.
  struct State {
    double t = 0;  ///< time of the nodal values
    Field x;       ///< N x 3
    Field v;       ///< N x 3: (x^n - x^{n-1})/tau, with its tangential part
    Field H;       ///< N x 1

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"H", &State::H}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  explicit BgnWillmoreFlow(const SurfaceSpace& space);

  /// One step; q must be 1 (InputError), the scheme is of first order. Throws SingularityError where the
  /// surface is singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

 private:
  const SurfaceSpace& space_;
  BgnSystem system_;
  WeakWeingarten weingarten_;
  SymmetricMatrix tau_A_;
  Field tau_Q_;
};

/// The state on nodes x at time 0: H is the projection of M(x)^-1 A(x) x onto the discrete normal, and
/// v = V nu with (V, chi) = -(grad H, grad chi) + (Q, chi).
BgnWillmoreFlow::State bgn_willmore_state_on(const SurfaceSpace& space, const Field& x);

/// The flow's own nodal fields beside x: v, H.
NodalFields nodal_fields(const BgnWillmoreFlow::State& state);

}  // namespace esfem
