// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/exact_evolution.hpp"

#include <algorithm>
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
  const int rows = static_cast<int>(x.rows());
  Field values(rows, components());
  FieldsAtPoints at_points(components());
  Pack position[3];
  for (int first = 0; first < rows; first += pack_size) {
    // The last pack is filled up with the last point.
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < pack_size; ++lane) position[i][lane] = x(std::min(first + lane, rows - 1), i);
    SurfacePoints points = now.closest_points(position);
    // The points lie on the surface to round-off, and are kept unchanged.
    std::copy(position, position + 3, points.y);
    fields(t, points, at_points);
    for (int l = 0; l < values.cols(); ++l)
      for (int lane = 0; lane < std::min(pack_size, rows - first); ++lane)
        values(first + lane, l) = at_points.value[l][lane];
  }
  return values;
}

namespace {

/// Position and normal from these columns on: grad id = P, grad nu = A.
void set_position_and_normal(const SurfacePoints& at, int x, int nu, FieldsAtPoints& out) {
  for (int i = 0; i < 3; ++i) {
    out.value[x + i] = at.y[i];
    out.value[nu + i] = at.normal[i];
    for (int j = 0; j < 3; ++j) {
      out.gradient[x + i][j] = at.projection(i, j);
      out.gradient[nu + i][j] = at.weingarten[i][j];
    }
  }
}

}  // namespace

ExactEvolution round_sphere(const std::function<double(double t)>& radius,
                            const std::function<double(double R)>& outward_speed, const std::string& scalar,
                            const std::function<double(double R)>& scalar_of) {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"v", 3}, {"nu", 3}, {scalar, 1}};
  exact.surface = [=](double t) { return sphere(radius(t)); };
  exact.trajectories = [=](const Field& x0, double t) -> Field { return x0 * (radius(t) / radius(0)); };
  exact.fields = [=](double t, const SurfacePoints& at, FieldsAtPoints& out) {
    const double R = radius(t), speed = outward_speed(R);
    set_position_and_normal(at, 0, 6, out);
    for (int i = 0; i < 3; ++i) {  // v = speed nu, constant on the sphere
      out.value[3 + i] = speed * at.normal[i];
      for (int j = 0; j < 3; ++j) out.gradient[3 + i][j] = speed * at.weingarten[i][j];
    }
    out.value[9] = pack(scalar_of(R));
    out.gradient[9] = {};
  };
  return exact;
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
  const auto H = [](double R) { return 2 / R; };
  return round_sphere(
      radius, [](double R) { return -2 / R; }, "H", H);
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
  exact.fields = [scale](double t, const SurfacePoints& at, FieldsAtPoints& out) {
    const double factor = 0.5 / (scale(t) * scale(t));
    const Pack H = factor * dot(at.y, at.normal);
    set_position_and_normal(at, 0, 6, out);
    out.value[9] = H;
    // grad H = A y/(2 scale²), v = -H nu.
    for (int j = 0; j < 3; ++j) out.gradient[9][j] = factor * dot(at.weingarten[j], at.y);
    for (int i = 0; i < 3; ++i) {
      out.value[3 + i] = -H * at.normal[i];
      for (int j = 0; j < 3; ++j)
        out.gradient[3 + i][j] = -H * at.weingarten[i][j] - at.normal[i] * out.gradient[9][j];
    }
  };
  return exact;
}

ExactEvolution homothetic_angenent_torus(double initial_scale) {
  ExactEvolution exact = shrinking_angenent_torus(initial_scale);
  const double squared = initial_scale * initial_scale;
  exact.trajectories = [squared](const Field& x0, double t) -> Field {
    return std::sqrt(1 - t / squared) * x0;
  };
  exact.fields = [squared, along_normals = exact.fields](double t, const SurfacePoints& at,
                                                         FieldsAtPoints& out) {
    along_normals(t, at, out);
    const double rate = -0.5 / (squared - t);
    for (int i = 0; i < 3; ++i) {
      out.value[3 + i] = rate * at.y[i];
      for (int j = 0; j < 3; ++j)
        out.gradient[3 + i][j] = rate * ((i == j ? 1.0 : 0.0) - at.normal[i] * at.normal[j]);
    }
  };
  return exact;
}

namespace {

/// A surface at rest with quantities x, nu, H; mean_curvature(at, gradient) returns H and sets grad_Gamma H.
ExactEvolution stationary(
    const Surface& surface,
    const std::function<Pack(const SurfacePoints& at, std::array<Pack, 3>& gradient)>& mean_curvature) {
  ExactEvolution exact;
  exact.quantities = {{"x", 3}, {"nu", 3}, {"H", 1}};
  exact.surface = [surface](double) { return surface; };
  exact.trajectories = [](const Field& x0, double) { return x0; };
  exact.fields = [mean_curvature](double, const SurfacePoints& at, FieldsAtPoints& out) {
    set_position_and_normal(at, 0, 3, out);
    out.value[6] = mean_curvature(at, out.gradient[6]);
  };
  return exact;
}

}  // namespace

ExactEvolution stationary_sphere(double radius) {
  return stationary(sphere(radius), [radius](const SurfacePoints&, std::array<Pack, 3>& gradient) {
    gradient = {};
    return pack(2 / radius);
  });
}

ExactEvolution stationary_torus(double major, double minor) {
  return stationary(torus(major, minor), [=](const SurfacePoints& at, std::array<Pack, 3>& gradient) {
    // H = 1/r + cos(theta)/rho with rho = R + r cos(theta); its gradient is R/(r rho²) P e_rho.
    const Pack inverse_rho = inverse_sqrt(at.y[0] * at.y[0] + at.y[1] * at.y[1]);
    const Pack outward[3] = {at.y[0] * inverse_rho, at.y[1] * inverse_rho, Pack{}};
    const Pack along_normal = dot(at.normal, outward);
    for (int i = 0; i < 3; ++i)
      gradient[i] = major / minor * inverse_rho * inverse_rho * (outward[i] - along_normal * at.normal[i]);
    return 2 / minor - major / minor * inverse_rho;
  });
}

}  // namespace esfem
