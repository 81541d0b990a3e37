// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "solver/assembly/pointwise_load.hpp"
#include "solver/flows/species_diffusion.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/geometry/regularity.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/nodal_field.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// How surface evolution coupled to diffusion is discretised (see CoupledDiffusion).
struct CoupledDiffusionVariant {
  /// The mass matrices of u (and v) at the times before the new one.
  enum Mass {
    extrapolated,         ///< (2.19): M(x̃^{n-j}) u^{n-j}, kept from the steps before
    reassembled           ///< (7.2): M(x^{n-j}) u^{n-j}; loses an order in time
  } mass = extrapolated;  ///< of the history

  /// The velocity laws of CoupledDiffusion.
  enum Law { regularised, dynamic } law = regularised;  ///< of the velocity
};

/// What a step starts from and computes.
struct CoupledDiffusionState {
  double t = 0;  ///< time of the nodal values
  Field x;       ///< N x 3
  Field v;       ///< N x 3
  Field u;       ///< N x m
  Field Mu;      ///< N x m: M u with the mass matrix of the variant, so that no old matrix is needed
  Field Mv;      ///< N x 3: the same for v (history of the dynamic law)

  /// Names of the fields, for checkpoints and messages (History).
  static constexpr NamedField<CoupledDiffusionState> fields[] = {{"x", &CoupledDiffusionState::x},
                                                                 {"v", &CoupledDiffusionState::v},
                                                                 {"u", &CoupledDiffusionState::u},
                                                                 {"Mu", &CoupledDiffusionState::Mu},
                                                                 {"Mv", &CoupledDiffusionState::Mv}};
};

/// Coefficients of the velocity laws and of diffusion.
struct CoupledDiffusionParameters {
  double alpha = 1;                     ///< positive
  double beta = 1;                      ///< >= 0; the dynamic law has no such term
  std::vector<double> diffusion = {1};  ///< D_l >= 0, one per species
  double reaction_rate = 0;  ///< of f, 1/time, for messages about steps too large for it; 0: not known
};

/// Nodal values, N x 1, of a function of x (N x 3) and u (N x m) at a time.
using NodalFunction = std::function<void(double t, const Field& x, const Field& u, Field& values)>;

/// alpha > 0 and beta >= 0 of the velocity laws as functions of the surface, in the place of the parameters;
/// none: the parameters. They are interpolated in the nodes, with x̃ and ũ.
struct VariableLaw {
  NodalFunction alpha = {};  ///< positive
  NodalFunction beta = {};   ///< >= 0; the dynamic law has none
};

/// A step of nick18 (2.18)-(2.21) with its loads given: what does not depend on f and g.
///
/// With a VariableLaw the regularised law is v - div(alpha grad v) + beta H nu = g nu. Since
///   -div(beta grad x) = beta H nu - grad beta,
/// its weak form has, with (A_c)_ij = int c grad phi_i . grad phi_j, the lines of (2.20)
///   M(x̃) v + A_alpha(x̃) v + A_beta(x̃) x + int grad beta . phi = g(x̃, ũ).
class CoupledDiffusionScheme {
 public:
  /// The type of the states.
  using State = CoupledDiffusionState;

  /// Throws InputError for parameters out of range and when there is not one D per species.
  CoupledDiffusionScheme(const SurfaceSpace& space, int species, CoupledDiffusionParameters parameters,
                         CoupledDiffusionVariant variant, const RegularityLimits& limits,
                         VariableLaw law = {});

  /// (2.18) for x and u, and M(x̃), A(x̃). Throws SingularityError where Gamma_h[x̃] is degenerate.
  void extrapolate(const BdfStep<State>& step);
  /// The extrapolated nodes, N x 3.
  const Field& x_tilde() const { return x_tilde_; }
  /// The extrapolated concentrations, N x m.
  const Field& u_tilde() const { return u_tilde_; }

  /// After extrapolate: solves (2.19)-(2.21) for all fields of next. loads: N x (m + 3), f(x̃, ũ) and g(x̃,
  /// ũ). Throws SingularityError where u grows without bound, or elements of Gamma_h[x] have degenerated
  /// (regularity.hpp).
  void advance(const BdfStep<State>& step, const Field& loads, State& next);

 private:
  void require_bounded_u(double tau, const Field& u) const;
  void diffuse(const BdfStep<State>& step, const Field& loads, Field& u);
  void move_regularised(const BdfStep<State>& step, const Field& loads, State& next);
  void move_dynamic(const BdfStep<State>& step, const Field& loads, State& next);
  void find_coefficients(double t);

  const SurfaceSpace& space_;
  CoupledDiffusionParameters parameters_;
  CoupledDiffusionVariant variant_;
  RegularityLimits limits_;
  VariableLaw law_;
  SpeciesDiffusion diffusion_;
  SymmetricMatrix M_, A_;
  SymmetricMatrix A_alpha_, A_beta_, K_;  ///< of a variable law; empty without one
  SpdSolver spd_;
  Field coefficient_, grad_beta_;
  Field x_tilde_, u_tilde_, x_sum_, A_x_sum_, Mu_sum_, Mv_sum_;
};

/// Surface evolution coupled to diffusion on the surface (nick18 (2.7)-(2.9), here for species u_1..u_m):
///   d•u_l + u_l div v - D_l Lap u_l = f_l(u, grad u),   l = 1..m,
/// and one of two velocity laws,
///   regularised (2.8):              v - alpha Lap v + beta H nu = g(u, grad u) nu,
///   dynamic (Kovács, Lubich 2018):  d•v + v div v - alpha Lap v = g(u, grad u) nu,
/// discretised by linearly implicit BDF as in (2.19)-(2.21).
///
/// A Problem says what f and g are; both are evaluated in the quadrature points of Gamma_h[x̃] with u = ũ, at
/// the time t of the new step:
///   struct Problem {
///     static constexpr int species = 1;
///     void f(double t, const PointData<species>& p, Pack (&out)[species]) const;
///     Pack g(double t, const PointData<species>& p) const;
///   };
template <class Problem>
class CoupledDiffusion {
 public:
  /// The type of the states.
  using State = CoupledDiffusionState;

  /// The space gives elements, degree and quadrature; it must outlive the flow. Throws InputError for
  /// parameters out of range and when there is not one D per species.
  CoupledDiffusion(const SurfaceSpace& space, Problem problem, CoupledDiffusionParameters parameters,
                   CoupledDiffusionVariant variant, const RegularityLimits& limits = {})
      : space_(space),
        problem_(std::move(problem)),
        scheme_(space, species, std::move(parameters), variant, limits) {}

  /// One step with BDF of order q: fills all fields of next. Throws SingularityError where u grows without
  /// bound, or the surface has degenerated.
  void step(const BdfStep<State>& step, State& next) {
    scheme_.extrapolate(step);
    const auto f_and_g = [&](const PointData<species>& p, Integrand<species + 3, 0>& load) {
      Pack f[species];
      problem_.f(next.t, p, f);
      const Pack g = problem_.g(next.t, p);
      for (int l = 0; l < species; ++l) load.value[l] = f[l];
      for (int i = 0; i < 3; ++i) load.value[species + i] = g * p.normal[i];
    };
    space_.assemble_load<species, species + 3, 0>(scheme_.x_tilde(), scheme_.u_tilde(), f_and_g, loads_);
    scheme_.advance(step, loads_, next);
  }

 private:
  static constexpr int species = Problem::species;

  const SurfaceSpace& space_;
  Problem problem_;
  CoupledDiffusionScheme scheme_;
  Field loads_;
};

/// Values of f_1, .., f_m and, for CoupledKinetics, g at a quadrature point: x (3), the unit normal (3), u_1,
/// .., u_m (assemble_pointwise_load) and, where CoupledKinetics computes it, H.
using PointwiseKinetics = std::function<void(double t, const Pack* point, Pack* values)>;

/// CoupledDiffusion for f and g that are known only at run time, without gradients of u. They may depend on
/// the mean curvature H of Gamma_h[x̃] (DiscreteCurvature), which costs a factorisation a step and, on P_k
/// surfaces, converges with order k - 1 in L2.
class CoupledKinetics {
 public:
  /// The type of the states.
  using State = CoupledDiffusionState;

  /// The number of species is that of the diffusion coefficients. Otherwise as CoupledDiffusion.
  CoupledKinetics(const SurfaceSpace& space, PointwiseKinetics kinetics,
                  CoupledDiffusionParameters parameters, CoupledDiffusionVariant variant,
                  const RegularityLimits& limits = {}, VariableLaw law = {}, bool with_curvature = false);

  /// As that of CoupledDiffusion.
  void step(const BdfStep<State>& step, State& next);

 private:
  const SurfaceSpace& space_;
  PointwiseKinetics kinetics_;
  int species_;
  CoupledDiffusionScheme scheme_;
  std::optional<DiscreteCurvature> curvature_;  ///< where f or g depend on H
  Field u_and_H_, loads_;
};

/// The state with given nodal values, and Mu = M(x) u, Mv = M(x) v: x̃ = x at the starting values. Throws
/// InputError when v is not N x 3 or u has not N rows.
CoupledDiffusionState coupled_diffusion_state(const SurfaceSpace& space, double t, Field x, Field v, Field u);

/// u or, for several species, u1, u2, ..
std::vector<std::string> concentration_names(int species);

/// v (N x 3) and the concentrations (N x m) under their names.
NodalFields concentration_fields(const Field& v, const Field& u);

/// The flow's own nodal fields beside x: v, and u or, for several species, u1, u2, ...
NodalFields nodal_fields(const CoupledDiffusionState& state);

}  // namespace esfem
