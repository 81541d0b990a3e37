// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/willmore_flow.hpp"

#include "solver/error.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_terms.hpp"
#include "solver/geometry/l2_project.hpp"
#include "solver/linalg/gmres.hpp"

namespace esfem {

namespace {

/// The right-hand sides of (3.5): f(x, u) (+ F(x, u) w) in columns 0-3, g(x, u) in columns 4-7; inputs u, w.
struct WillmoreLoads {
  const WillmoreLaw& law;
  double t, lambda_A, lambda_V;
  bool with_F;
  double relaxation;

  void operator()(const PointData<8>& p, Integrand<8, 4>& load) const {
    load = {};
    WillmorePoint at = willmore_point(p, law, t);
    at.Q -= lambda_A * at.H + lambda_V;
    add_f(at, load.value, load.flux);
    add_g(at, load.value + 4);
    if (with_F) add_F(at, p.u + 4, load.value);
    if (relaxation > 0) add_relaxation(at, relaxation, p.normal, load.value, load.flux);
  }
};

/// Their derivatives with respect to a multiplier: those of the rows nu in columns 0-2, V in column 3.
struct MultiplierLoads {
  Multipliers::Quantity quantity;

  void operator()(const PointData<8>& p, Integrand<4, 3>& load) const {
    load = {};
    const WillmorePoint at = willmore_point(p);
    const Pack Q = multiplied_by(quantity, at);
    add_Q(at, Q, load.value, load.flux);
    load.value[3] = Q;
  }
};

/// v = V nu in the nodes (3.4b).
Field interpolated_velocity(const Field& u, const Field& w) {
  return w.col(0).asDiagonal() * u.rightCols(3);
}

/// nu_h to unit length and z_h to the plane normal to it, node by node (§7.1); u and w are N x 4.
template <class Fields>
void project(Fields&& u, Fields&& w) {
  for (int j = 0; j < u.rows(); ++j) {
    const Vec3 nu = u.row(j).template tail<3>().normalized(), z = w.row(j).template tail<3>();
    u.row(j).template tail<3>() = nu;
    w.row(j).template tail<3>() = z - z.dot(nu) * nu;
  }
}

/// A u - g(x, u), the left-hand side of (3.5b) without M w; g without multipliers.
Field constraint(const SurfaceSpace& space, const SymmetricMatrix& A, double t, const Field& x,
                 const Field& u, const WillmoreLaw& law) {
  const auto g = [&law, t](const PointData<4>& p, Integrand<4, 0>& load) {
    for (Pack& value : load.value) value = Pack{};
    add_g(willmore_point(p, law, t), load.value);
  };
  Field load;
  space.assemble_load<4, 4, 0>(x, u, g, load);
  return A * u - load;
}

}  // namespace

/// F(x~, u~) w^n of the variant `implicit`. With S the solution of the block system, (u, w) = S(r + F w, s),
/// w solves w - S_w(F w, 0) = S_w(r, s), by GMRES on the factors that are there. Its unknowns have one unit:
/// L V and z.
struct WillmoreFlow::ImplicitCoupling {
  static constexpr double tolerance = 1e-12;
  static constexpr int most_iterations = 100;

  Field input, image, zero;
  Eigen::VectorXd w, rhs;

  /// image = F(x, u) w for w = (L V, z); the first four columns of `input` are u.
  void apply_F(const SurfaceSpace& space, const Field& x, Eigen::Map<const Field> w_now) {
    const auto F = [](const PointData<8>& p, Integrand<4, 0>& load) {
      for (Pack& value : load.value) value = Pack{};
      add_F(willmore_point(p), p.u + 4, load.value);
    };
    input.rightCols(4) = w_now;
    input.col(4) /= space.length();
    space.assemble_load<8, 4, 0>(x, input, F, image);
  }

  /// Replaces r, s by u, w. u_w: u~ and a guess of w.
  void solve(const SurfaceSpace& space, const Field& x, const Field& u_w, BlockSolver& block, Field& r,
             Field& s) {
    const Eigen::Index n = r.rows();
    input = u_w;
    w = Eigen::Map<const Eigen::VectorXd>(u_w.col(4).data(), 4 * n);
    w.head(n) *= space.length();
    Field u_explicit = r, w_explicit = s;
    block.solve(u_explicit, w_explicit);
    w_explicit.col(0) *= space.length();
    rhs = Eigen::Map<const Eigen::VectorXd>(w_explicit.data(), 4 * n);
    const LinearMap map = [&](const Eigen::VectorXd& from, Eigen::VectorXd& to) {
      apply_F(space, x, {from.data(), n, 4});
      zero.setZero(n, 4);
      block.solve(image, zero);
      zero.col(0) *= space.length();
      to = from - Eigen::Map<const Eigen::VectorXd>(zero.data(), 4 * n);
    };
    solve_gmres(map, rhs, tolerance, most_iterations, w);
    apply_F(space, x, {w.data(), n, 4});
    r += image;
    block.solve(r, s);
  }
};

WillmoreFlow::WillmoreFlow(const SurfaceSpace& space, Variant variant, Field theta,
                           const RegularityLimits& limits)
    : space_(space),
      variant_(variant),
      limits_(limits),
      theta_(std::move(theta)),
      M_(space.matrix()),
      A_(space.matrix()),
      lagged_(space),
      multipliers_(space, variant.prescribed),
      reinitialisation_(space, variant.reinitialise, {space, multipliers_, variant.law}) {
  if (!(variant.relaxation >= 0))
    throw InputError(format("relaxation: found %g, expected a number >= 0", variant.relaxation));
  if (variant.F == Variant::implicit) implicit_ = std::make_unique<ImplicitCoupling>();
  // Its v belongs to V~, so that no multiplier of the step could keep the area or the volume of x^n.
  if (variant.tangential == MeanCurvatureFlow::Variant::minimal_deformation &&
      !multipliers_.unknowns().empty())
    throw InputError(
        "tangential motion of minimal deformation rate with prescribed area or volume: expected one of them "
        "alone");
  if (variant.tangential == MeanCurvatureFlow::Variant::minimal_deformation)
    deformation_ = std::make_unique<MinimalDeformation>(space);
}

WillmoreFlow::~WillmoreFlow() = default;

nlohmann::json WillmoreFlow::progress() const {
  nlohmann::json saved = lagged_.progress();
  saved.update(esfem::progress(tilde_));
  if (deformation_) saved["deformation"] = deformation_->progress();
  return saved;
}

void WillmoreFlow::resume(const nlohmann::json& saved) {
  lagged_.resume(saved);
  esfem::resume(tilde_, saved, space_.dofs());
  if (deformation_) deformation_->resume(saved.at("deformation"));
}

/// v of the normal speed V~, and its convective term, (v . grad) u~ tested with phi.
void WillmoreFlow::move_along_surface(Field& v) {
  nu_V_.resize(u_w_tilde_.rows(), 4);
  nu_V_ << u_w_tilde_.middleCols(1, 3), -u_w_tilde_.col(4);
  deformation_->velocity(x_tilde_, nu_V_, M_, A_, v);
  u_v_.resize(v.rows(), 7);
  u_v_ << u_w_tilde_.leftCols(4), v;
  const auto convection = [](const PointData<7>& p, Integrand<4, 0>& load) {
    for (int l = 0; l < 4; ++l)
      load.value[l] = p.u[4] * p.grad[l][0] + p.u[5] * p.grad[l][1] + p.u[6] * p.grad[l][2];
  };
  space_.assemble_load<7, 4, 0>(x_tilde_, u_v_, convection, convection_);
}

void WillmoreFlow::extrapolate(const BdfStep<State>& step) {
  step.extrapolate(&State::x, x_tilde_);
  step.extrapolate(&State::u, u_tilde_);
  step.extrapolate(&State::w, w_tilde_);
  step.extrapolate(&State::lambda, lambda_tilde_);
  const Eigen::Index n = x_tilde_.rows(), columns = 4 * (1 + multipliers_.unknowns().size());
  tilde_.u.setZero(n, columns);
  tilde_.w.setZero(n, columns);
  tilde_.u.leftCols(4) = u_tilde_;
  tilde_.w.leftCols(4) = w_tilde_;
  u_w_tilde_.resize(n, 8);
  u_w_tilde_ << u_tilde_, w_tilde_;
  if (variant_.projection == Variant::in_coefficients)
    project(u_w_tilde_.leftCols(4), u_w_tilde_.rightCols(4));
}

/// f(x~, u~) (+ F(x~, u~) w~) and g(x~, u~) with lambda~, and their derivatives with respect to multipliers.
void WillmoreFlow::assemble_loads(const BdfStep<State>& step) {
  const std::size_t unknowns = multipliers_.unknowns().size();
  const WillmoreLoads loads{variant_.law,
                            step.t,
                            lambda_tilde_(0, Multipliers::area),
                            lambda_tilde_(0, Multipliers::volume),
                            variant_.F == Variant::extrapolated,
                            variant_.relaxation};
  space_.assemble_load<8, 8, 4>(x_tilde_, u_w_tilde_, loads, loads_);

  // (3.5a): delta_0/tau M u - A w = F w + f - M 1/tau sum_{j>=1} delta_j u^{n-j};  (3.7): A u + M w = g +
  // theta
  u_.setZero(tilde_.u.rows(), tilde_.u.cols());
  w_.setZero(tilde_.u.rows(), tilde_.u.cols());
  step.known_sum(&State::u, u_sum_);
  M_.multiply(u_sum_, M_sum_);
  u_.leftCols(4) = loads_.leftCols(4) - M_sum_ / step.tau;
  w_.leftCols(4) = loads_.rightCols(4);
  if (theta_.size() > 0) w_.leftCols(4) += theta_;
  if (deformation_) u_.leftCols(4) += convection_;
  for (std::size_t i = 0; i < unknowns; ++i) {
    const MultiplierLoads of_multiplier{multipliers_.unknowns()[i]};
    space_.assemble_load<8, 4, 3>(x_tilde_, u_w_tilde_, of_multiplier, loads_);
    u_.middleCols(4 * (1 + i) + 1, 3) = loads_.leftCols(3);
    w_.col(4 * (1 + i)) = loads_.col(3);
  }
}

void WillmoreFlow::solve_systems(const BdfStep<State>& step) {
  const double alpha = step.delta[0] / step.tau;
  if (!implicit_) return lagged_.solve(alpha, x_tilde_, M_, A_, tilde_, u_, w_);
  BlockSolver& block = lagged_.factorise(alpha, x_tilde_, M_, A_);
  for (int i = 0; i < u_.cols() / 4; ++i) {
    Field u = u_.middleCols(4 * i, 4), w = w_.middleCols(4 * i, 4);
    if (i > 0) u_w_tilde_.rightCols(4).setZero();
    implicit_->solve(space_, x_tilde_, u_w_tilde_, block, u, w);
    u_.middleCols(4 * i, 4) = u;
    w_.middleCols(4 * i, 4) = w;
  }
}

/// next.u, next.w, next.v and next.x for the multipliers next.lambda.
void WillmoreFlow::advance(const BdfStep<State>& step, State& next) const {
  next.u = u_.leftCols(4);
  next.w = w_.leftCols(4);
  for (std::size_t i = 0; i < multipliers_.unknowns().size(); ++i) {
    const Multipliers::Quantity quantity = multipliers_.unknowns()[i];
    const double mu = next.lambda(0, quantity) - lambda_tilde_(0, quantity);
    next.u += mu * u_.middleCols(4 * (1 + i), 4);
    next.w += mu * w_.middleCols(4 * (1 + i), 4);
  }
  if (variant_.projection == Variant::after_steps) project(next.u, next.w);

  // (3.4): v = V nu, delta_0 x = tau v - sum_{j>=1} delta_j x^{n-j}
  if (!deformation_) next.v = interpolated_velocity(next.u, next.w);
  next.x = (step.tau * next.v - x_sum_) / step.delta[0];
}

/// The derivatives of x with respect to the multipliers: tau/delta_0 (V_i nu + V nu_i). The projection of nu
/// is left out, which is a matter of nu_i = O(tau).
void WillmoreFlow::rates_of_x(const BdfStep<State>& step, const State& next) {
  for (std::size_t i = 0; i < multipliers_.unknowns().size(); ++i)
    x_rates_[i] = step.tau / step.delta[0] *
                  (w_.col(4 * (1 + i)).asDiagonal() * next.u.rightCols(3) +
                   next.w.col(0).asDiagonal() * u_.middleCols(4 * (1 + i) + 1, 3));
}

void WillmoreFlow::step(const BdfStep<State>& step, State& next) {
  extrapolate(step);
  assemble_regular(space_, x_tilde_, M_, A_);
  if (deformation_) move_along_surface(next.v);
  assemble_loads(step);
  solve_systems(step);

  step.known_sum(&State::x, x_sum_);
  next.lambda = lambda_tilde_;
  advance(step, next);
  if (!multipliers_.unknowns().empty()) {
    rates_of_x(step, next);
    for (int i = 0; multipliers_.correct(step.t, next.x, x_rates_, next.lambda); ++i) {
      if (i == Multipliers::most_iterations)
        throw NumericsError("Newton's method finds no multipliers for the prescribed area or volume");
      advance(step, next);
      rates_of_x(step, next);
    }
  }
  require_regular(space_, next.x, next.u.col(0), limits_);
  require_normal(next.x, next.u.rightCols(3), limits_);
}

namespace {

/// The state with given nodes and u = (H, nu) and, where it is given, w without multipliers; otherwise w from
/// (3.5b).
WillmoreStart start_from(const SurfaceSpace& space, double t, const Field& x, Field u, Field exact_w,
                         const WillmoreLaw& law, const Multipliers& multipliers) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  const Field rest = constraint(space, A, t, x, u, law);
  WillmoreStart start;
  if (exact_w.size() > 0) {
    // The multipliers' parts of M w and of g are the same.
    start.theta = M * exact_w + rest;
    start.state.w = std::move(exact_w);
  } else {
    start.state.w = l2_project(M, -rest);
  }
  start.state.t = t;
  start.state.lambda = multipliers.at_start(M, u.col(0), start.state.w.col(0));
  const double lambda_A = start.state.lambda(0, Multipliers::area),
               lambda_V = start.state.lambda(0, Multipliers::volume);
  start.state.w.col(0).array() -= lambda_A * u.col(0).array() + lambda_V;
  start.state.x = x;
  start.state.v = interpolated_velocity(u, start.state.w);
  start.state.u = std::move(u);
  return start;
}

/// The point of kll21 (3.5) with the shape of a surface in a point: what a law sees.
WillmorePoint exact_point(const Vec3& x, const Surface::Shape& shape) {
  WillmorePoint at = {};
  for (int i = 0; i < 3; ++i) {
    at.x[i] = pack(x[i]);
    at.nu[i] = pack(shape.normal[i]);
  }
  at.H = pack(shape.weingarten.trace());
  at.A_squared = pack(shape.weingarten.squaredNorm());
  return at;
}

}  // namespace

void WillmoreFlow::Fields::complete(State& state) const {
  state = start_from(space, state.t, state.x, state.u, {}, law, multipliers).state;
}

WillmoreStart willmore_start_on(const SurfaceSpace& space, const Surface& surface, const Field& x,
                                const WillmoreLaw& law, bool with_theta, const AreaAndVolume& prescribed) {
  Field u(x.rows(), 4), w;
  if (with_theta) w.resize(x.rows(), 4);
  for (int j = 0; j < x.rows(); ++j) {
    const Vec3 y = x.row(j);
    const Surface::Shape shape = surface.shape_at(y);
    u.row(j) << shape.weingarten.trace(), shape.normal.transpose();
    if (!with_theta) continue;
    Pack Q;
    law(exact_point(y, shape), Q);
    w.row(j) << surface.mean_curvature_laplacian(y) + Q[0], surface.mean_curvature_gradient(y).transpose();
  }
  return start_from(space, 0, x, std::move(u), std::move(w), law, Multipliers(space, prescribed));
}

WillmoreStart willmore_start_from(const SurfaceSpace& space, const Field& x, Field u, Field w,
                                  const WillmoreLaw& law, const AreaAndVolume& prescribed) {
  WillmoreStart start =
      start_from(space, 0, x, std::move(u), std::move(w), law, Multipliers(space, prescribed));
  start.theta = {};
  return start;
}

WillmoreStart discrete_willmore_start(const SurfaceSpace& space, const Field& x, const WillmoreLaw& law,
                                      const AreaAndVolume& prescribed) {
  const MeanCurvatureFlow::State curvature = discrete_mean_curvature_state(space, x);
  Field u(x.rows(), 4);
  u << curvature.u.col(3), curvature.u.leftCols(3);
  return start_from(space, 0, x, std::move(u), {}, law, Multipliers(space, prescribed));
}

NodalFields nodal_fields(const WillmoreFlow::State& state) {
  return {{"v", state.v},
          {"nu", state.u.rightCols(3)},
          {"H", state.u.col(0)},
          {"V", state.w.col(0)},
          {"z", state.w.rightCols(3)}};
}

}  // namespace esfem
