// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/surfaces/surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/constants.hpp"
#include "solver/error.hpp"

namespace esfem {

Vec3 Surface::normal(const Vec3& y) const {
  return level_set(y).gradient.normalized();
}

Mat3 Surface::weingarten(const Vec3& y) const {
  return shape_at(y).weingarten;
}

double Surface::mean_curvature(const Vec3& y) const {
  return shape_at(y).weingarten.trace();
}

// |kappa_1 + kappa_2|/2 + |kappa_1 - kappa_2|/2, where A - H/2 P has the eigenvalues +-(kappa_1 - kappa_2)/2.
double Surface::largest_curvature(const Vec3& y) const {
  const auto [nu, A] = shape_at(y);
  const double H = A.trace();
  const Mat3 rest = A - H / 2 * (Mat3::Identity() - nu * nu.transpose());
  return std::abs(H) / 2 + rest.norm() / std::sqrt(2);
}

Surface::Shape Surface::shape_at(const Vec3& y) const {
  const LevelSetJet d = level_set(y);
  const double slope = d.gradient.norm();
  const Vec3 nu = d.gradient / slope;
  const Mat3 projection = Mat3::Identity() - nu * nu.transpose();
  return {nu, projection * d.hessian * projection / slope};
}

Vec3 Surface::mean_curvature_gradient(const Vec3& y) const {
  const Vec3 nu = normal(y), gradient = mean_curvature_jet(y).gradient;
  return gradient - nu.dot(gradient) * nu;
}

// For an extension f of a function on the surface, grad_Gamma f = grad f - (nu . grad f) nu, whose surface
// divergence is tr(P Hess f) - (nu . grad f) div_Gamma nu - nu . grad_Gamma(nu . grad f); the last is zero.
double Surface::mean_curvature_laplacian(const Vec3& y) const {
  const Vec3 nu = normal(y);
  const LevelSetJet H = mean_curvature_jet(y);
  return H.hessian.trace() - nu.dot(H.hessian * nu) - H.value * nu.dot(H.gradient);
}

namespace {

/// The point of {d = 0} that Newton's method along the gradient finds from x; |d| is at round-off.
Vec3 onto_surface(const Surface& surface, const Vec3& x) {
  Vec3 y = x;
  const double longest = 0.2 * surface.bounding_radius, tolerance = 1e-15 * surface.bounding_radius;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const LevelSetJet d = surface.level_set(y);
    Vec3 correction = d.value * d.gradient / d.gradient.squaredNorm();
    const double length = correction.norm();
    if (!(length < INFINITY)) break;
    if (length > longest) correction *= longest / length;
    y -= correction;
    if (length <= tolerance) break;
  }
  return y;
}

/// Newton's direction for the squared distance to x on the surface, at y: (I + s A) step = P (x - y), where
/// x - y = s nu + tangential part. Beyond the focal surface I + s A is not positive; its eigenvalues are kept
/// above 0.2 so that the step descends.
Vec3 descent_step(const Surface& surface, const Vec3& x, const Vec3& y) {
  const auto [nu, weingarten] = surface.shape_at(y);
  const double s = nu.dot(x - y);
  const Eigen::SelfAdjointEigenSolver<Mat3> modes(Mat3::Identity() + s * weingarten);
  const Vec3 tangential = x - y - s * nu;
  const Vec3 step = modes.eigenvectors() * (modes.eigenvectors().transpose() * tangential)
                                               .cwiseQuotient(modes.eigenvalues().cwiseAbs().cwiseMax(0.2));
  const double longest = 0.5 * surface.smallest_curvature_radius;
  return step.norm() > longest ? Vec3(step * (longest / step.norm())) : step;
}

NumericsError no_closest_point(const Surface& surface, const Vec3& x) {
  return NumericsError(
      format("no closest point of the %s found for (%.17g, %.17g, %.17g): is it near the surface?",
             surface.name.c_str(), x[0], x[1], x[2]));
}

}  // namespace

Vec3 Surface::closest_point(const Vec3& x) const {
  if (own_closest_point) {
    const Vec3 y = own_closest_point(x);
    if (y.allFinite()) return y;
    throw no_closest_point(*this, x);
  }
  Vec3 y = onto_surface(*this, x);
  double previous = INFINITY;
  for (int iteration = 0; iteration < 100; ++iteration) {
    Vec3 step = descent_step(*this, x, y);
    const double length = step.norm();
    Vec3 next = onto_surface(*this, y + step);
    // Far from the end the distance must decrease; near it the decrease is below round-off.
    for (int halvings = 0; halvings < 20 && length > 1e-6 * bounding_radius &&
                           (next - x).squaredNorm() >= (y - x).squaredNorm();
         ++halvings) {
      step *= 0.5;
      next = onto_surface(*this, y + step);
    }
    y = next;
    const bool tiny = length <= 1e-13 * bounding_radius;
    if (length <= 1e-15 * bounding_radius || (tiny && length >= 0.5 * previous)) return y;
    previous = length;
  }
  throw no_closest_point(*this, x);
}

void set_lane(SurfacePoints& points, int lane, const Vec3& y, const Surface::Shape& shape) {
  for (int i = 0; i < 3; ++i) {
    points.y[i][lane] = y[i];
    points.normal[i][lane] = shape.normal[i];
    for (int j = 0; j < 3; ++j) points.weingarten[i][j][lane] = shape.weingarten(i, j);
  }
}

SurfacePoints Surface::closest_points(const Pack (&x)[3]) const {
  SurfacePoints points;
  if (own_closest_points) {
    points = own_closest_points(x);
    const Pack sum = points.y[0] + points.y[1] + points.y[2];
    if (all(sum - sum == 0.0)) return points;
  }
  for (int lane = 0; lane < pack_size; ++lane) {
    const Vec3 y = closest_point(lane_of(x, lane));
    set_lane(points, lane, y, shape_at(y));
  }
  return points;
}

namespace {

SurfacePoints closest_points_of_sphere(double radius, const Pack (&x)[3]) {
  const Pack inverse_distance = inverse_sqrt(dot(x, x));
  const double curvature = 1 / radius;
  SurfacePoints points;
  for (int i = 0; i < 3; ++i) {
    points.normal[i] = inverse_distance * x[i];
    points.y[i] = radius * points.normal[i];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) points.weingarten[i][j] = curvature * points.projection(i, j);
  return points;
}

}  // namespace

Surface sphere(double radius) {
  auto d = [radius](const auto& x1, const auto& x2, const auto& x3) {
    return (x1 * x1 + x2 * x2 + x3 * x3 - radius * radius) / (2.0 * radius);
  };
  Surface surface = make_surface("sphere", d, radius, radius, 2, {{"radius", radius}});
  surface.own_closest_point = [radius](const Vec3& x) -> Vec3 { return x * (radius / x.norm()); };
  // The same as by Jets, in a tenth of their time: error norms need it in every quadrature point.
  surface.level_set = [radius](const Vec3& y) -> LevelSetJet {
    return {(y.squaredNorm() - radius * radius) / (2 * radius), y / radius, Mat3::Identity() / radius};
  };
  surface.own_closest_points = [radius](const Pack(&x)[3]) { return closest_points_of_sphere(radius, x); };
  return surface;
}

/// The closest point of the ellipsoid is y_i = a_i² x_i/(a_i² + s) with sum y_i²/a_i² = 1, which falls and is
/// convex for s > -min a_i²: from the left of its root Newton's method is monotone. r = s + min a_i².
Vec3 closest_point_of_ellipsoid(const Vec3& axes, const Vec3& x) {
  const Vec3 squares = axes.cwiseAbs2();
  const double smallest = squares.minCoeff();
  // There one term alone is 1, so this is at the root or left of it.
  const double left = (axes.cwiseProduct(x.cwiseAbs()) - squares).maxCoeff() + smallest;
  double r = std::max(smallest, left);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vec3 inverse = (squares.array() - smallest + r).inverse();
    const Vec3 y = axes.cwiseProduct(x).cwiseProduct(inverse);  // y_i/a_i
    const double excess = y.squaredNorm() - 1, slope = -2 * y.cwiseAbs2().dot(inverse);
    const double next = std::max(left, r - excess / slope);
    const bool done = std::abs(next - r) <= 1e-9 * r;  // then next is exact: order 2
    r = next;
    if (done) return squares.cwiseProduct(x).cwiseQuotient(Vec3(squares.array() - smallest + r));
  }
  return Vec3::Constant(NAN);
}

namespace {

Pack larger(const Pack& a, const Pack& b) {
  return a > b ? a : b;
}

/// closest_point_of_ellipsoid for pack_size points: lanes that have converged continue at their roots. There
/// grad d = D y and Hess d = D with D = diag(1/a_i²).
SurfacePoints closest_points_of_ellipsoid(const Vec3& axes, const Pack (&x)[3]) {
  const Vec3 squares = axes.cwiseAbs2(), excess = squares.array() - squares.minCoeff();
  Pack left = pack(-INFINITY);
  for (int i = 0; i < 3; ++i) left = larger(left, axes[i] * larger(x[i], -x[i]) - excess[i]);
  Pack r = larger(left, pack(squares.minCoeff()));
  Lanes done = {};
  for (int iteration = 0; iteration < 100 && !all(done); ++iteration) {
    Pack sum = pack(-1), slope = {};
    for (int i = 0; i < 3; ++i) {
      const Pack inverse = 1.0 / (excess[i] + r), scaled = axes[i] * x[i] * inverse;  // y_i/a_i
      sum += scaled * scaled;
      slope += 2.0 * scaled * scaled * inverse;
    }
    const Pack next = larger(left, r + sum / slope), change = larger(next - r, r - next);
    done = change <= 1e-9 * r;  // then next is exact: order 2
    r = next;
  }
  SurfacePoints points;
  if (!all(done)) r = pack(NAN);
  Pack gradient[3];
  for (int i = 0; i < 3; ++i) {
    gradient[i] = x[i] / (excess[i] + r);
    points.y[i] = squares[i] * gradient[i];
  }
  const Pack inverse_slope = inverse_sqrt(dot(gradient, gradient));
  Pack D_normal[3];
  for (int i = 0; i < 3; ++i) {
    points.normal[i] = inverse_slope * gradient[i];
    D_normal[i] = points.normal[i] / squares[i];
  }
  // P D P = D - nu (D nu)^T - (D nu) nu^T + (nu . D nu) nu nu^T
  const Pack along_normal = dot(points.normal, D_normal);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Pack mixed = points.normal[i] * D_normal[j] + D_normal[i] * points.normal[j];
      points.weingarten[i][j] = inverse_slope * ((i == j ? 1 / squares[i] : 0.0) - mixed +
                                                 along_normal * points.normal[i] * points.normal[j]);
    }
  }
  return points;
}

/// From the centre of the tube's circle that is closest to x. The curvatures are 1/r along the circle and nu
/// . e_rho/rho around the axis.
SurfacePoints closest_points_of_torus(double major, double minor, const Pack (&x)[3]) {
  const Pack inverse_rho = inverse_sqrt(x[0] * x[0] + x[1] * x[1]);
  const Pack outward[3] = {x[0] * inverse_rho, x[1] * inverse_rho, Pack{}};
  const Pack around[3] = {-outward[1], outward[0], Pack{}};
  Pack from_centre[3];
  for (int i = 0; i < 3; ++i) from_centre[i] = x[i] - major * outward[i];
  const Pack inverse_distance = inverse_sqrt(dot(from_centre, from_centre));
  SurfacePoints points;
  for (int i = 0; i < 3; ++i) {
    points.normal[i] = inverse_distance * from_centre[i];
    points.y[i] = major * outward[i] + minor * points.normal[i];
  }
  const Pack cosine = dot(points.normal, outward), parallel = cosine / (major + minor * cosine);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      points.weingarten[i][j] =
          points.projection(i, j) / minor + (parallel - 1 / minor) * around[i] * around[j];
  return points;
}

}  // namespace

Surface ellipsoid(double a, double b, double c) {
  auto d = [=](const auto& x1, const auto& x2, const auto& x3) {
    return 0.5 * (x1 * x1 / (a * a) + x2 * x2 / (b * b) + x3 * x3 / (c * c) - 1.0);
  };
  const double longest = std::max({a, b, c}), shortest = std::min({a, b, c});
  // At the end of the longest axis the curvature of the section with the shortest axis is longest/shortest².
  Surface surface =
      make_surface("ellipsoid", d, longest, shortest * shortest / longest, 2, {{"a", a}, {"b", b}, {"c", c}});
  surface.own_closest_point = [axes = Vec3(a, b, c)](const Vec3& x) {
    return closest_point_of_ellipsoid(axes, x);
  };
  // The result of Jets, without them: errors on moving ellipsoids need it in every quadrature point.
  surface.level_set = [weights = Vec3(1 / (a * a), 1 / (b * b), 1 / (c * c))](const Vec3& x) -> LevelSetJet {
    const Vec3 gradient = weights.cwiseProduct(x);
    return {0.5 * (gradient.dot(x) - 1), gradient, weights.asDiagonal()};
  };
  surface.own_closest_points = [axes = Vec3(a, b, c)](const Pack(&x)[3]) {
    return closest_points_of_ellipsoid(axes, x);
  };
  return surface;
}

Surface torus(double major, double minor) {
  // Half of ((|x|² + R² - r²)² - 4R²(x1² + x2²)) / (4R²): polynomial, so smooth on the axis, too.
  auto d = [=](const auto& x1, const auto& x2, const auto& x3) {
    const auto rho2 = x1 * x1 + x2 * x2;
    const auto s = rho2 + x3 * x3 + (major * major - minor * minor);
    return (s * s - 4.0 * major * major * rho2) / (8.0 * major * major * minor);
  };
  Surface surface = make_surface("torus", d, major + minor, std::min(minor, major - minor), 0,
                                 {{"major", major}, {"minor", minor}});
  surface.own_closest_point = [=](const Vec3& x) -> Vec3 {
    const Vec3 centre = Vec3(x[0], x[1], 0).normalized() * major;
    return centre + (x - centre).normalized() * minor;
  };
  surface.own_closest_points = [=](const Pack(&x)[3]) { return closest_points_of_torus(major, minor, x); };
  return surface;
}

Surface dumbbell() {
  auto d = [](const auto& x1, const auto& x2, const auto& x3) {
    const auto s = x3 * x3;
    return x1 * x1 + x2 * x2 + 2.0 * s * (s - 199.0 / 200.0) - 0.04;
  };
  // The profile r(x3) has r(0) = 0.2 and r r'' = 199/100 there: the neck's meridian curves most, with radius
  // 0.2/1.99.
  return make_surface("dumbbell", d, 1.08, 0.2 / 1.99, 2);
}

namespace {

/// The smallest radius of curvature in the points of a grid on the surface, less 0.1% for what lies between
/// them: point(s, t) with s, t in [0, 1], ends included.
template <class Parametrisation>
double sampled_curvature_radius(const Surface& surface, Parametrisation point, int n_s, int n_t) {
  double largest_curvature = 0;
  for (int i = 0; i <= n_s; ++i) {
    for (int j = 0; j <= n_t; ++j) {
      const Mat3 weingarten = surface.weingarten(point(i / double(n_s), j / double(n_t)));
      const Eigen::SelfAdjointEigenSolver<Mat3> modes(weingarten, Eigen::EigenvaluesOnly);
      largest_curvature = std::max(largest_curvature, modes.eigenvalues().cwiseAbs().maxCoeff());
    }
  }
  return 0.999 / largest_curvature;
}

/// The same for a surface of revolution around the x3 axis, symmetric to its equator, from its profile
/// (distance from the axis, x3) over the latitude 0, ..., pi/2.
template <class Profile>
double profile_curvature_radius(const Surface& surface, Profile profile) {
  const auto point = [&](double s, double) {
    const auto [rho, x3] = profile(s * pi / 2);
    return Vec3(rho, 0, x3);
  };
  return sampled_curvature_radius(surface, point, 2000, 1);
}

}  // namespace

Surface perturbed_torus(double major, double minor, double amplitude, int waves) {
  auto d = [=](const auto& x1, const auto& x2, const auto& x3) {
    using std::sqrt;
    // The tiny number keeps d finite on the axis, where the angle u is undefined.
    const auto rho = sqrt(x1 * x1 + x2 * x2 + 1e-30);
    const auto cosine = x1 / rho, sine = x2 / rho;
    auto re = cosine, im = sine;  // of exp(i k u), k = 1, ..., waves
    for (int k = 1; k < waves; ++k) {
      const auto previous = re;
      re = re * cosine - im * sine;
      im = previous * sine + im * cosine;
    }
    const auto from_circle = rho - major, tube = amplitude * re + minor;
    return (from_circle * from_circle + x3 * x3 - tube * tube) / (2.0 * minor);
  };
  Surface surface =
      make_surface("perturbed_torus", d, major + minor + amplitude, minor, 0,
                   {{"major", major}, {"minor", minor}, {"amplitude", amplitude}, {"waves", waves}});
  const auto point = [=](double s, double t) {
    const double u = pi * s / waves, v = pi * t, tube = minor + amplitude * std::cos(waves * u);
    const double rho = major + tube * std::cos(v);
    return Vec3(rho * std::cos(u), rho * std::sin(u), tube * std::sin(v));
  };
  surface.smallest_curvature_radius = sampled_curvature_radius(surface, point, 100, 100);
  return surface;
}

Surface red_blood_cell() {
  auto d = [](const auto& x1, const auto& x2, const auto& x3) {
    const auto s = 1.0 - 0.25 * (x1 * x1 + x2 * x2);
    const auto height = 1.0 - 0.7 * s * s;
    return x3 * x3 - s * height * height;
  };
  // d has zeros of its own at rho = 2.96, outside the bounding ball (d does not change its sign there).
  Surface surface = make_surface("red_blood_cell", d, 2, 1, 2);
  surface.smallest_curvature_radius = profile_curvature_radius(surface, [](double latitude) {
    const double s = std::pow(std::sin(latitude), 2);
    return std::pair(2 * std::cos(latitude), (1 - 0.7 * s * s) * std::sin(latitude));
  });
  return surface;
}

Surface evans_fung_cell() {
  const auto height = [](const auto& s) { return 0.5 * (0.207161 + s * (2.002558 - 1.122762 * s)); };
  auto d = [height](const auto& x1, const auto& x2, const auto& x3) {
    const auto s = x1 * x1 + x2 * x2;
    const auto h = height(s);
    return 2.0 * (x3 * x3 - (1.0 - s) * h * h);
  };
  // d has zeros of its own at rho = 1.37, outside the bounding ball (d does not change its sign there).
  Surface surface = make_surface("evans_fung_cell", d, 1, 1, 2);
  surface.smallest_curvature_radius = profile_curvature_radius(surface, [height](double latitude) {
    const double rho = std::cos(latitude);
    return std::pair(rho, std::sin(latitude) * height(rho * rho));
  });
  return surface;
}

}  // namespace esfem
