// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/evolving_ellipsoid.hpp"

#include <cmath>

#include "solver/flows/ritz_map.hpp"

namespace esfem {

namespace {

const double pi = std::acos(-1.0);

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
struct Potential {
  LevelSet d;
  Concentration u;
  double epsilon;
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    const T value = u(x1, x2, x3);
    return value * (value * value - 1.0) / epsilon - epsilon * surface_laplacian<T>(d, u, {x1, x2, x3});
  }
};

Concentration concentration(double t) {
  return {std::exp(-6 * t)};
}

/// Tangential gradient of a function in space.
template <class Function>
Vec3 tangential_gradient(const LevelSet& d, const Function& f, const Vec3& x) {
  const Vec3 normal = level_set_jet(d, x).gradient.normalized(), gradient = level_set_jet(f, x).gradient;
  return gradient - normal.dot(gradient) * normal;
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
  return normal_velocity([*this](const Vec3& x, double t, double& d_t, Vec3& gradient) {
    const double now = a(t);
    d_t = -a_t(t) / (now * now) * x[0] * x[0];
    gradient = 2 * Vec3(x[0] / now, x[1], x[2]);
  });
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
  const Vec3 v = ellipsoid_.velocity()(x, t), normal = level_set_jet(d, x).gradient.normalized();
  const std::array<double, 3> at = {x[0], x[1], x[2]};
  const double material_derivative = -6 * u(x, t) + v.dot(level_set_jet(u_now, x).gradient);
  return material_derivative + u(x, t) * v.dot(normal) * level_set_mean_curvature<double>(d, at) -
         surface_laplacian<double>(d, w_now, at);
}

Vec3 ManufacturedCahnHilliard::gradient_of_u(const Vec3& x, double t) const {
  return tangential_gradient(LevelSet{ellipsoid_.a(t), ellipsoid_.radius}, concentration(t), x);
}

Vec3 ManufacturedCahnHilliard::gradient_of_w(const Vec3& x, double t) const {
  const LevelSet d{ellipsoid_.a(t), ellipsoid_.radius};
  return tangential_gradient(d, Potential{d, concentration(t), epsilon_}, x);
}

void ManufacturedCahnHilliard::Problem::b(double t, const Field& x, Field& nodal) const {
  nodal.resize(x.rows(), 1);
  for (int j = 0; j < x.rows(); ++j) nodal(j, 0) = exact->b(x.row(j), t);
}

CahnHilliardState exact_cahn_hilliard_state(const SurfaceSpace& space, const ManufacturedCahnHilliard& exact,
                                            Field x, double t, StartValues values) {
  const auto u = [&](const Vec3& y) { return ValueAndGradient{exact.u(y, t), exact.gradient_of_u(y, t)}; };
  const auto w = [&](const Vec3& y) { return ValueAndGradient{exact.w(y, t), exact.gradient_of_w(y, t)}; };
  const auto nodal = [&](const auto& function) -> Field {
    if (values == StartValues::ritz) return ritz_map(space, x, exact.ellipsoid().surface(t), function);
    Field result(x.rows(), 1);
    for (int j = 0; j < x.rows(); ++j) result(j, 0) = function(x.row(j)).value;
    return result;
  };
  Field nodal_u = nodal(u), nodal_w = nodal(w);
  return cahn_hilliard_state(space, t, std::move(x), std::move(nodal_u), std::move(nodal_w));
}

}  // namespace esfem
