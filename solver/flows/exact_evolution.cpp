// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/exact_evolution.hpp"

#include <cmath>
#include <utility>

#include "solver/error.hpp"
#include "solver/surfaces/angenent_torus.hpp"

namespace esfem {

int ExactEvolution::components() const {
  int sum = 0;
  for (const Quantity& quantity : quantities) sum += quantity.components;
  return sum;
}

int ExactEvolution::column(const std::string& name) const {
  int column = 0;
  for (const Quantity& quantity : quantities) {
    if (quantity.name == name) return column;
    column += quantity.components;
  }
  throw InputError("the exact solution has no quantity " + name);
}

Field ExactEvolution::nodal_values(const Field& x, double t) const {
  const Surface now = surface(t);
  Field values(x.rows(), components());
  Eigen::VectorXd value(components());
  Eigen::MatrixXd gradient(3, components());
  for (int j = 0; j < x.rows(); ++j) {
    const Vec3 y = x.row(j);
    fields(t, y, now.shape_at(y), value, gradient);
    values.row(j) = value;
  }
  return values;
}

ExactEvolution shrinking_sphere(double initial_radius) {
  const auto radius = [initial_radius](double t) {
    const double squared = initial_radius * initial_radius - 4 * t;
    if (squared <= 0) {
      throw InputError(format("the sphere of radius %g has shrunk to a point at t = %g; t = %g was asked for",
                              initial_radius, initial_radius * initial_radius / 4, t));
    }
    return std::sqrt(squared);
  };
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"v", 3}, {"nu", 3}, {"H", 1}};
  exact.surface = [radius](double t) { return sphere(radius(t)); };
  exact.trajectories = [radius, initial_radius](const Field& x0, double t) -> Field {
    return x0 * (radius(t) / initial_radius);
  };
  exact.fields = [radius](double t, const Vec3& y, const Surface::Shape& shape, Eigen::VectorXd& value,
                          Eigen::MatrixXd& gradient) {
    const double H = 2 / radius(t);
    value << y, -H * shape.normal, shape.normal, H;
    // grad id = P, grad nu = A, and H is constant on the sphere.
    const Mat3 projection = Mat3::Identity() - shape.normal * shape.normal.transpose();
    gradient << projection, -H * shape.weingarten, shape.weingarten, Vec3::Zero();
  };
  return exact;
}

namespace {

/// Slides the particles along the profile of the self-shrinking torus and scales it from `initial` to `now`.
Field angenent_trajectories(const Field& x0, double initial, double now) {
  const AngenentProfile& profile = angenent_profile();
  const PeriodicTable<1> displacement = profile.displacement(2 * std::log(initial / now));
  Field x(x0.rows(), 3);
  for (int j = 0; j < x0.rows(); ++j) {
    const double r = std::hypot(x0(j, 0), x0(j, 1));
    const double s = profile.radial_arclength(r / initial, x0(j, 2) / initial);
    const Eigen::Vector2d position = now * profile.at(s + displacement(s)[0]).position;
    x.row(j) << position[0] * x0(j, 0) / r, position[0] * x0(j, 1) / r, position[1];
  }
  return x;
}

}  // namespace

ExactEvolution shrinking_angenent_torus(double initial_scale) {
  const auto scale = [initial_scale](double t) {
    const double squared = initial_scale * initial_scale - t;
    if (squared <= 0)
      throw InputError(
          format("the self-shrinking torus of scale %g has shrunk to a point at t = %g; t = %g was asked for",
                 initial_scale, initial_scale * initial_scale, t));
    return std::sqrt(squared);
  };
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"v", 3}, {"nu", 3}, {"H", 1}};
  exact.surface = [scale](double t) { return angenent_torus(scale(t)); };
  exact.trajectories = [scale, initial_scale](const Field& x0, double t) {
    return angenent_trajectories(x0, initial_scale, scale(t));
  };
  exact.fields = [scale](double t, const Vec3& y, const Surface::Shape& shape, Eigen::VectorXd& value,
                         Eigen::MatrixXd& gradient) {
    const Vec3& nu = shape.normal;
    const double factor = 0.5 / (scale(t) * scale(t)), H = factor * y.dot(nu);
    value << y, -H * nu, nu, H;
    // grad id = P, grad nu = A, grad H = A y/(2 scale²).
    const Mat3 projection = Mat3::Identity() - nu * nu.transpose();
    const Vec3 gradient_of_H = factor * shape.weingarten * y;
    gradient << projection, -H * shape.weingarten - gradient_of_H * nu.transpose(), shape.weingarten,
        gradient_of_H;
  };
  return exact;
}

namespace {

/// A surface at rest with quantities x, nu, H, from H and grad_Gamma H in a point where the normal is nu.
ExactEvolution stationary(
    const Surface& surface,
    const std::function<std::pair<double, Vec3>(const Vec3& y, const Vec3& nu)>& mean_curvature) {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"nu", 3}, {"H", 1}};
  exact.surface = [surface](double) { return surface; };
  exact.trajectories = [](const Field& x0, double) { return x0; };
  exact.fields = [mean_curvature](double, const Vec3& y, const Surface::Shape& shape, Eigen::VectorXd& value,
                                  Eigen::MatrixXd& gradient) {
    const auto [H, gradient_of_H] = mean_curvature(y, shape.normal);
    value << y, shape.normal, H;
    // grad id = P, grad nu = A.
    const Mat3 projection = Mat3::Identity() - shape.normal * shape.normal.transpose();
    gradient << projection, shape.weingarten, gradient_of_H;
  };
  return exact;
}

}  // namespace

ExactEvolution stationary_sphere(double radius) {
  return stationary(sphere(radius), [radius](const Vec3&, const Vec3&) {
    return std::pair<double, Vec3>(2 / radius, Vec3::Zero());
  });
}

ExactEvolution stationary_torus(double major, double minor) {
  return stationary(torus(major, minor), [major, minor](const Vec3& y, const Vec3& nu) {
    // H = 1/r + cos(theta)/rho with rho = R + r cos(theta); its gradient is R/(r rho²) P e_rho.
    const double rho = std::hypot(y[0], y[1]);
    const Vec3 outward = Vec3(y[0], y[1], 0) / rho;
    const Vec3 gradient = major / (minor * rho * rho) * (outward - nu.dot(outward) * nu);
    return std::pair<double, Vec3>(2 / minor - major / (minor * rho), gradient);
  });
}

}  // namespace esfem
