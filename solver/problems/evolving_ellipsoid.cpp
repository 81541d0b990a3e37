// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/evolving_ellipsoid.hpp"

#include <cmath>

#include "solver/constants.hpp"
#include "solver/geometry/ritz_map.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem {

namespace {

/// d(x, t) of (9.2) at one time.
struct LevelSet {
  double a, radius;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    return x1 * x1 / a + x2 * x2 + x3 * x3 - radius * radius;
  }
};

/// u as a function of space at one time.
struct Concentration {
  double factor;
  template <class T>
  T operator()(const T& x1, const T& x2, const T&) const {
    return factor * (x1 * x2);
  }
};

/// w = -epsilon Delta_Gamma u + (u³ - u)/epsilon as a function of space: on each level set its own Laplacian.
///
/// With g = grad d/2, D = Hess d/2 = diag(1/a, 1, 1), s = |g|², nu = g/sqrt(s) and u = c x1 x2:
///   H = tr D/sqrt(s) - g . D g/s^(3/2),   nu . grad u = (1 + 1/a) u/sqrt(s),   nu . (Hess u) nu = 2u/(a s),
/// so Delta_Gamma u = Delta u - nu . (Hess u) nu - H nu . grad u
///                  = -u (2/(a s) + (1 + 1/a) (tr D/s - g . D g/s²)).
struct Potential {
  LevelSet d;
  Concentration u;
  double epsilon;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    const double inverse = 1 / d.a;
    const T along = x1 * x1 * (inverse * inverse), across = x2 * x2 + x3 * x3;
    const T one_over_s = 1.0 / (along + across);
    const T g_D_g = along * inverse + across;
    const T bending = one_over_s * (2 * inverse + (1 + inverse) * (2 + inverse - g_D_g * one_over_s));
    const T value = u(x1, x2, x3);
    return value * ((value * value - 1.0) / epsilon + epsilon * bending);
  }
};

Concentration concentration(double t) {
  return {std::exp(-6 * t)};
}

/// Value and tangential gradient of a function in space, where the normal is nu.
template <class Function>
ValueAndGradient value_and_tangential_gradient(const Function& f, const Vec3& x, const Vec3& nu) {
  using Jet = SpaceJet<double>;
  const Jet jet = f(Jet(x[0], 0), Jet(x[1], 1), Jet(x[2], 2));
  return {jet.a, jet.v - nu.dot(jet.v) * nu};
}

Vec3 normal_of(const LevelSet& d, const Vec3& x) {
  return Vec3(x[0] / d.a, x[1], x[2]).normalized();
}

}  // namespace

double EvolvingEllipsoid::a(double t) const {
  return 1 + amplitude * std::sin(2 * pi * t / period);
}

double EvolvingEllipsoid::a_t(double t) const {
  return amplitude * 2 * pi / period * std::cos(2 * pi * t / period);
}

Surface EvolvingEllipsoid::surface(double t) const {
  return ellipsoid(radius * std::sqrt(a(t)), radius, radius);
}

Velocity EvolvingEllipsoid::velocity() const {
  return [*this](double t, const Field& x, Field& v) {
    const double now = a(t), half_of_minus_d_t = a_t(t) / (2 * now * now);
    v = x;
    v.col(0) /= now;
    v.array().colwise() *= half_of_minus_d_t * x.col(0).array().square() / v.rowwise().squaredNorm().array();
  };
}

Velocity EvolvingEllipsoid::stretching_velocity() const {
  return [*this](double t, const Field& x, Field& v) {
    v = Field::Zero(x.rows(), 3);
    v.col(0) = a_t(t) / (2 * a(t)) * x.col(0);
  };
}

double ManufacturedCahnHilliard::u(const Vec3& x, double t) const {
  return concentration(t)(x[0], x[1], x[2]);
}

double ManufacturedCahnHilliard::w(const Vec3& x, double t) const {
  const LevelSet d{ellipsoid_.a(t), ellipsoid_.radius};
  return Potential{d, concentration(t), epsilon_}(x[0], x[1], x[2]);
}

double ManufacturedCahnHilliard::b(const Vec3& x, double t) const {
  // d•u = u_t + v . grad u, div v = V H for v = V nu.
  const LevelSet d{ellipsoid_.a(t), ellipsoid_.radius};
  const Concentration u_now = concentration(t);
  const Potential w_now{d, u_now, epsilon_};
  const Vec3 slope = level_set_jet(d, x).gradient, normal = slope.normalized();
  const double d_t = -ellipsoid_.a_t(t) * x[0] * x[0] / (d.a * d.a), V = -d_t / slope.norm();
  const std::array<double, 3> at = {x[0], x[1], x[2]};
  const double material_derivative = -6 * u(x, t) + V * normal.dot(level_set_jet(u_now, x).gradient);
  return material_derivative + u(x, t) * V * level_set_mean_curvature<double>(d, at) -
         surface_laplacian<double>(d, w_now, at);
}

Vec3 ManufacturedCahnHilliard::gradient_of_u(const Vec3& x, double t) const {
  const LevelSet d{ellipsoid_.a(t), ellipsoid_.radius};
  return value_and_tangential_gradient(concentration(t), x, normal_of(d, x)).gradient;
}

Vec3 ManufacturedCahnHilliard::gradient_of_w(const Vec3& x, double t) const {
  const LevelSet d{ellipsoid_.a(t), ellipsoid_.radius};
  return value_and_tangential_gradient(Potential{d, concentration(t), epsilon_}, x, normal_of(d, x)).gradient;
}

void ManufacturedCahnHilliard::Problem::b(double t, const Field& x, Field& nodal) const {
  nodal.resize(x.rows(), 1);
  for (int j = 0; j < x.rows(); ++j) nodal(j, 0) = exact->b(x.row(j), t);
}

ExactEvolution exact_evolution(const ManufacturedCahnHilliard& exact, MovingNodes& nodes) {
  ExactEvolution evolution;
  evolution.quantities = {{"u", 1}, {"w", 1}};
  evolution.surface = [&exact](double t) { return exact.ellipsoid().surface(t); };
  evolution.trajectories = [&nodes](const Field&, double t) { return nodes.at(t); };
  evolution.fields = [&exact](double t, const SurfacePoints& at, FieldsAtPoints& out) {
    const LevelSet d{exact.ellipsoid().a(t), exact.ellipsoid().radius};
    const Concentration u = concentration(t);
    const Potential w{d, u, exact.epsilon()};
    for (int lane = 0; lane < pack_size; ++lane) {  // Jets are made of doubles
      const Vec3 y = lane_of(at.y, lane), nu = lane_of(at.normal, lane);
      const ValueAndGradient both[] = {value_and_tangential_gradient(u, y, nu),
                                       value_and_tangential_gradient(w, y, nu)};
      for (int l = 0; l < 2; ++l) {
        out.value[l][lane] = both[l].value;
        for (int i = 0; i < 3; ++i) out.gradient[l][i][lane] = both[l].gradient[i];
      }
    }
  };
  return evolution;
}

CahnHilliardState exact_cahn_hilliard_state(const SurfaceSpace& space, const ManufacturedCahnHilliard& exact,
                                            Field x, double t, StartValues values) {
  const auto u = [&](const Vec3& y) { return ValueAndGradient{exact.u(y, t), exact.gradient_of_u(y, t)}; };
  const auto w = [&](const Vec3& y) { return ValueAndGradient{exact.w(y, t), exact.gradient_of_w(y, t)}; };
  const auto nodal = [&](const auto& function) -> Field {
    if (values == StartValues::ritz)
      return ritz_map(space, x, exact.ellipsoid().surface(t), function, space.length());
    Field result(x.rows(), 1);
    for (int j = 0; j < x.rows(); ++j) result(j, 0) = function(x.row(j)).value;
    return result;
  };
  Field nodal_u = nodal(u), nodal_w = nodal(w);
  return cahn_hilliard_state(space, t, std::move(x), std::move(nodal_u), std::move(nodal_w));
}

}  // namespace esfem
