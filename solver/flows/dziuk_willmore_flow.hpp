// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "solver/assembly/surface_space.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// Willmore flow by Dziuk's scheme (Numer. Math. 111, 2008; kll21 (2.13)), linearly implicit: find x^n and
/// w^n with
///   (w^n, psi) = -(grad x^n, grad psi),
///   ((x^n - x^{n-1})/tau, phi) = 1/2 (|w^{n-1}|², div phi) + (grad w^n, grad phi) + (div w^n, div phi) -
///                                (D(phi) grad x^{n-1}, grad w^n),   D(phi) = grad phi + (grad phi)^T,
/// for all psi, phi in S_h^3, on Gamma_h[x^{n-1}]. w approximates -H nu. In space the right-hand side is
/// minus the derivative of the discrete energy 1/2 int |w|², so that the semi-discrete flow decreases it.
///
/// The step size is limited by the mesh. The terms with w^n on the right are the second variation B of the
/// area as a function of the nodes, which is negative on a third of them, the rough tangential displacements.
/// The step has the matrix M/tau + B M^-1 A, and M^-1 B M^-1 A has eigenvalues down to -mu, mu about c/h²:
/// beyond tau = 1/mu the matrix can be singular. Seen with P2 on the unit sphere: tau = h²/1000 runs, h²/500
/// ends with a destroyed mesh; on an ellipsoid (1, 1, 0.6) h²/2600 runs, h²/800 does not. The cause is that
/// A(x^{n-1}) x^n treats a tangential displacement as curvature; B(x^{n-1}) does not, and M/tau + B M^-1 B is
/// positive definite for all tau. It allows steps 10 to 50 times as large, which are then limited by the
/// explicit |w^{n-1}|².
class DziukWillmoreFlow {
 public:
  /// The equation of w^n, M w^n = -A x^n on the old surface (dziuk), or with the derivative of A(x) x by the
  /// nodes x, M w^n = -A x^{n-1} - B (x^n - x^{n-1}) (linearised; not in the literature).
  enum Curvature { dziuk, linearised };

  /// What a step starts from and computes.
  struct State {
    double t = 0;  ///< time of the nodal values
    Field x;       ///< N x 3
    Field v;       ///< N x 3: (x^n - x^{n-1})/tau
    Field w;       ///< N x 3

    /// Names of the fields, for checkpoints and messages (History).
    static constexpr NamedField<State> fields[] = {{"x", &State::x}, {"v", &State::v}, {"w", &State::w}};
  };

  /// The space gives elements, degree and quadrature; it must outlive the flow.
  explicit DziukWillmoreFlow(const SurfaceSpace& space, Curvature curvature = dziuk);
  ~DziukWillmoreFlow();
  /// Moves; a flow cannot be copied.
  DziukWillmoreFlow(DziukWillmoreFlow&&);

  /// One step; q must be 1 (InputError), the scheme is of first order. Throws SingularityError where the
  /// surface is singular or no longer resolved (regularity.hpp).
  void step(const BdfStep<State>& step, State& next);

 private:
  struct System;
  const SurfaceSpace& space_;
  std::unique_ptr<System> system_;
};

/// The right-hand side of kll21 (2.13) on Gamma_h[x], for given w (N x 3): out (N x 3) has the test functions
/// phi_j e_l. For w = -M(x)^-1 A(x) x it is minus the derivative of 1/2 w^T M(x) w with respect to the nodes.
void assemble_willmore_force(const SurfaceSpace& space, const Field& x, const Field& w, Field& out);

/// The state on nodes x at time 0, with w = -M(x)^-1 A(x) x and v from (2.13).
DziukWillmoreFlow::State dziuk_willmore_state_on(const SurfaceSpace& space, const Field& x);

/// The flow's own nodal fields beside x: v, w.
NodalFields nodal_fields(const DziukWillmoreFlow::State& state);

}  // namespace esfem
