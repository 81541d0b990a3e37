// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/surfaces/angenent_torus.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

#include "solver/constants.hpp"
#include "solver/error.hpp"

namespace esfem {

namespace {

const int table_size = 1024;

// The inner radius and the length for which the solution closes; its entropy is 1.85121667.
const double inner_radius = 0.437123967096460, profile_length = 7.50842399705255;

/// r, z, a on the grid's points and, as the last column, at the end of the curve.
Eigen::Matrix3Xd integrate_profile() {
  using State = std::array<double, 3>;
  const auto slope = [](const State& y, State& derivative, double) {
    const auto [r, z, a] = y;
    derivative = {std::sin(a), std::cos(a), (1 / r - r / 2) * std::cos(a) + z / 2 * std::sin(a)};
  };
  boost::numeric::odeint::runge_kutta_fehlberg78<State> stepper;
  Eigen::Matrix3Xd points(3, table_size + 1);
  State y = {inner_radius, 0, 0};
  const double step = profile_length / table_size;
  for (int j = 0; j <= table_size; ++j) {
    points.col(j) << y[0], y[1], y[2];
    stepper.do_step(slope, y, j * step, step);
  }
  return points;
}

/// The table of r, z, a - turn s/length.
PeriodicTable<3> curve_table(const Eigen::Matrix3Xd& points) {
  Eigen::Matrix3Xd values = points.leftCols(table_size);
  for (int j = 0; j < table_size; ++j) values(2, j) -= turn * j / table_size;
  return {profile_length, values};
}

PeriodicTable<1> speed_table(const Eigen::Matrix3Xd& points) {
  Eigen::RowVectorXd values(table_size);
  for (int j = 0; j < table_size; ++j) {
    const double r = points(0, j), z = points(1, j), a = points(2, j);
    values[j] = (r * std::sin(a) + z * std::cos(a)) / 2;
  }
  return {profile_length, values};
}

/// The arclength over the angle around (centre, 0), less length angle/turn: Newton's method at each angle.
PeriodicTable<1> radial_table(const PeriodicTable<3>& curve, double centre) {
  Eigen::RowVectorXd values(table_size);
  for (int j = 0; j < table_size; ++j) {
    const double angle = turn * j / table_size, along_r = -std::cos(angle), along_z = std::sin(angle);
    double s = j == 0 ? 0 : profile_length * j / table_size + values[j - 1];
    for (int iteration = 0; iteration < 8; ++iteration) {
      const Eigen::Vector3d y = curve(s);
      const double a = y[2] + turn * s / profile_length;
      s -= ((y[0] - centre) * along_z - y[1] * along_r) / (std::sin(a) * along_z - std::cos(a) * along_r);
    }
    values[j] = s - profile_length * j / table_size;
  }
  return {turn, values};
}

}  // namespace

AngenentProfile::AngenentProfile()
    : curve_(profile_length, Eigen::Matrix3Xd::Zero(3, 8)),
      speed_(profile_length, Eigen::RowVectorXd::Zero(8)),
      radial_(turn, Eigen::RowVectorXd::Zero(8)) {
  const Eigen::Matrix3Xd points = integrate_profile();
  gap_ = (points.col(table_size) - points.col(0) - Eigen::Vector3d(0, 0, turn)).norm();
  centre_ = (points(0, 0) + points(0, table_size / 2)) / 2;
  curve_ = curve_table(points);
  speed_ = speed_table(points);
  radial_ = radial_table(curve_, centre_);
}

AngenentProfile::Point AngenentProfile::at(double s) const {
  const Eigen::Vector3d y = curve_(s);
  const double r = y[0], z = y[1], a = y[2] + turn * s / length(), sine = std::sin(a), cosine = std::cos(a);
  return {{r, z}, {sine, cosine}, {-cosine, sine}, (1 / r - r / 2) * cosine + z / 2 * sine, -cosine / r};
}

double AngenentProfile::radial_arclength(double r, double z) const {
  const double angle = std::atan2(z, centre_ - r);
  return length() * angle / turn + radial_(angle)[0];
}

double AngenentProfile::radial_level(double r, double z) const {
  const Eigen::Vector3d y = curve_(radial_arclength(r, z));
  return std::hypot(r - centre_, z) - std::hypot(y[0] - centre_, y[1]);
}

double AngenentProfile::closest_arclength(double r, double z) const {
  const Eigen::Vector2d x(r, z);
  double s = radial_arclength(r, z);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Point p = at(s);
    const double slope = (p.position - x).dot(p.tangent);
    const double second = 1 + p.normal.dot(x - p.position) * p.meridian_curvature;
    // Beyond the curve's evolute `second` is negative; its absolute value keeps the step downhill.
    const double step = -slope / std::max(std::abs(second), 0.2);
    s += std::clamp(step, -0.2, 0.2);
    if (std::abs(step) <= 1e-8 && second > 0.2) return s;  // then s is exact: order 2
    if (std::abs(step) <= 1e-14) return s;
  }
  return NAN;
}

PeriodicTable<1> AngenentProfile::displacement(double sigma) const {
  const auto slope = [this](const double& s, double& derivative, double) { derivative = speed_(s)[0]; };
  boost::numeric::odeint::runge_kutta_fehlberg78<double> stepper;
  const int steps = 1 + static_cast<int>(std::abs(sigma) / 0.05);
  Eigen::RowVectorXd values(table_size);
  for (int j = 0; j < table_size; ++j) {
    const double start = length() * j / table_size;
    double s = start;
    for (int n = 0; n < steps; ++n) stepper.do_step(slope, s, 0, sigma / steps);
    values[j] = s - start;
  }
  return {length(), values};
}

const AngenentProfile& angenent_profile() {
  static const AngenentProfile profile;
  return profile;
}

namespace {

/// A point of the half plane at the angle of x around the axis.
struct HalfPlane {
  double r, z;
  Vec3 outward;  ///< unit vector away from the axis

  explicit HalfPlane(const Vec3& x) : r(std::hypot(x[0], x[1])), z(x[2]) {
    outward = r > 0 ? Vec3(x[0] / r, x[1] / r, 0) : Vec3(1, 0, 0);
  }
  Vec3 vector(const Eigen::Vector2d& p) const { return p[0] * outward + p[1] * Vec3::UnitZ(); }
};

/// The profile's point closest to x/scale.
AngenentProfile::Point closest(const HalfPlane& x, double scale) {
  const AngenentProfile& profile = angenent_profile();
  return profile.at(profile.closest_arclength(x.r / scale, x.z / scale));
}

/// Hessian of the signed distance at x, whose closest point is p and whose distance is delta:
/// kappa/(1 + delta kappa) in each principal direction.
Mat3 distance_hessian(const HalfPlane& x, const AngenentProfile::Point& p, double scale, double delta) {
  const double meridian = p.meridian_curvature / (scale + delta * p.meridian_curvature),
               parallel = p.parallel_curvature / (scale + delta * p.parallel_curvature);
  const Vec3 tangent = x.vector(p.tangent), around = x.outward.cross(Vec3::UnitZ());
  return meridian * tangent * tangent.transpose() + parallel * around * around.transpose();
}

LevelSetJet signed_distance(const Vec3& y, double scale) {
  const HalfPlane x(y);
  const AngenentProfile::Point p = closest(x, scale);
  const double delta = p.normal.dot(Eigen::Vector2d(x.r, x.z) - scale * p.position);
  return {delta, x.vector(p.normal), distance_hessian(x, p, scale, delta)};
}

/// One search in the profile for the closest point and the shape there.
SurfacePoints closest_points_of_angenent_torus(const Pack (&y)[3], double scale) {
  SurfacePoints points;
  for (int lane = 0; lane < pack_size; ++lane) {
    const HalfPlane x(lane_of(y, lane));
    const AngenentProfile::Point p = closest(x, scale);
    set_lane(points, lane, scale * x.vector(p.position),
             {x.vector(p.normal), distance_hessian(x, p, scale, 0)});
  }
  return points;
}

/// H, continued constantly along normals, and its derivatives in a point of the surface. On the shrinker H =
/// <y, nu>/2 and grad H = A y/2; Delta H + |A|² H + H/2 - <y, grad H>/2 = H, and Delta H = H'' + r' H'/r by
/// arclength.
LevelSetJet shrinker_mean_curvature(const Vec3& y, double scale) {
  const HalfPlane x(y);
  const AngenentProfile::Point p = closest(x, scale);
  const double k1 = p.meridian_curvature, k2 = p.parallel_curvature, H = k1 + k2;
  const double along = p.position.dot(p.tangent), slope = k1 * along / 2;
  const double laplacian = H / 2 - (k1 * k1 + k2 * k2) * H + along * slope / 2;
  const double around_part = slope * p.tangent[0] / p.position[0];
  const Vec3 normal = x.vector(p.normal), tangent = x.vector(p.tangent),
             around = x.outward.cross(Vec3::UnitZ());
  const Mat3 hessian = (laplacian - around_part) * tangent * tangent.transpose() +
                       around_part * around * around.transpose() -
                       k1 * slope * (tangent * normal.transpose() + normal * tangent.transpose());
  return {H / scale, slope * tangent / (scale * scale), hessian / (scale * scale * scale)};
}

/// The greatest distance from the origin and the greatest curvature of the profile's surface.
std::pair<double, double> extent_and_curvature() {
  const AngenentProfile& profile = angenent_profile();
  double extent = 0, curvature = 0;
  for (int j = 0; j < table_size; ++j) {
    const AngenentProfile::Point p = profile.at(profile.length() * j / table_size);
    extent = std::max(extent, p.position.norm());
    curvature = std::max({curvature, std::abs(p.meridian_curvature), std::abs(p.parallel_curvature)});
  }
  return {extent, curvature};
}

}  // namespace

Surface angenent_torus(double scale) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw InputError(format("self-shrinking torus with scale %g; expected a positive number", scale));
  static const auto size = extent_and_curvature();
  Surface surface;
  surface.name = "angenent_torus";
  surface.parameters = {{"scale", scale}};
  surface.level_set = [scale](const Vec3& y) { return signed_distance(y, scale); };
  surface.level = [scale](const Vec3& y) {
    return scale * angenent_profile().radial_level(std::hypot(y[0], y[1]) / scale, y[2] / scale);
  };
  surface.bounding_radius = scale * size.first;
  surface.smallest_curvature_radius = scale / size.second;
  surface.euler_characteristic = 0;
  surface.own_closest_point = [scale](const Vec3& y) -> Vec3 {
    const HalfPlane x(y);
    return scale * x.vector(closest(x, scale).position);
  };
  surface.own_closest_points = [scale](const Pack(&y)[3]) {
    return closest_points_of_angenent_torus(y, scale);
  };
  surface.mean_curvature_jet = [scale](const Vec3& y) { return shrinker_mean_curvature(y, scale); };
  return surface;
}

}  // namespace esfem
