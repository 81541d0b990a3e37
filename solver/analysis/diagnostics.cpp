// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/diagnostics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "solver/constants.hpp"
#include "solver/linalg/least_squares.hpp"

namespace esfem {

void record_geometry(const SurfaceSpace& space, double t, const Field& x, Series& series) {
  const MeshQuality quality = mesh_quality(space.elements(), x);
  series["t"].push_back(t);
  series["area"].push_back(space.area(x));
  series["volume"].push_back(space.volume(x));
  series["h"].push_back(quality.h);
  series["worst_angle"].push_back(quality.min_angle);
  series["worst_radius_ratio"].push_back(quality.min_radius_ratio);
}

void record_curvature(const SurfaceSpace& space, const Field& x, const Field& H, Series& series) {
  const auto square = [](const PointData<1>& p, Integrand<1, 0>& load) { load.value[0] = p.u[0] * p.u[0]; };
  Field load;
  space.assemble_load<1, 1, 0>(x, H, square, load);
  series["willmore_energy"].push_back(0.5 * load.sum());  // the shape functions sum to 1
  series["max_H"].push_back(H.cwiseAbs().maxCoeff());
}

void record_normal_length(const Field& nu, Series& series) {
  const Eigen::VectorXd length = nu.rowwise().norm();
  series["min_nu"].push_back(length.minCoeff());
  series["max_nu"].push_back(length.maxCoeff());
}

namespace {

/// Squared radius at x3 = 0: least squares fit of r² = a + b x3 + c x3² + d x3⁴.
double squared_neck_radius(const Field& x, const Eigen::VectorXd& squared_radius) {
  const double window = 0.1;
  const int fewest = 12;
  std::vector<int> nodes(x.rows());
  std::iota(nodes.begin(), nodes.end(), 0);
  std::sort(nodes.begin(), nodes.end(), [&](int i, int j) { return std::abs(x(i, 2)) < std::abs(x(j, 2)); });
  int count = std::min<int>(fewest, nodes.size());
  while (count < static_cast<int>(nodes.size()) && std::abs(x(nodes[count], 2)) < window) ++count;
  Eigen::MatrixXd terms(count, 4);
  Eigen::VectorXd values(count);
  for (int i = 0; i < count; ++i) {
    const double z = x(nodes[i], 2);
    terms.row(i) << 1, z, z * z, z * z * z * z;
    values[i] = squared_radius[nodes[i]];
  }
  return least_squares(terms, values)[0];
}

}  // namespace

void record_profile(const Field& x, Series& series) {
  const Eigen::VectorXd squared_radius = x.leftCols(2).rowwise().squaredNorm();
  series["neck_radius"].push_back(std::sqrt(std::max(squared_neck_radius(x, squared_radius), 0.0)));
  series["widest_radius"].push_back(std::sqrt(squared_radius.maxCoeff()));
  series["tip"].push_back(x.col(2).cwiseAbs().maxCoeff());
}

void record_node_density(const Connectivity& elements, const Field& x, Series& series) {
  const int rings = 10;
  const double tip = x.col(2).cwiseAbs().maxCoeff();
  std::vector<double> area(rings, 0), count(rings, 0);
  for (Eigen::Index e = 0; e < elements.rows(); ++e) {
    const Vec3 a = x.row(elements(e, 0)), b = x.row(elements(e, 1)), c = x.row(elements(e, 2));
    const int ring = std::min(rings - 1, static_cast<int>(rings * std::abs((a + b + c)[2] / 3) / tip));
    area[ring] += (b - a).cross(c - a).norm() / 2;
    count[ring] += 1;
  }
  const double mean_of_all = std::accumulate(area.begin(), area.end(), 0.0) / elements.rows();
  double smallest = mean_of_all, x3 = 0;
  for (int ring = 0; ring < rings; ++ring) {
    if (count[ring] == 0 || area[ring] / count[ring] >= smallest) continue;
    smallest = area[ring] / count[ring];
    x3 = (ring + 0.5) / rings * tip;
  }
  Eigen::Index widest;
  x.leftCols(2).rowwise().norm().maxCoeff(&widest);
  series["smallest_elements"].push_back(smallest / mean_of_all);
  series["smallest_elements_x3"].push_back(x3 / std::abs(x(widest, 2)));
}

double fitted_sphere_radius(const Field& x) {
  Eigen::MatrixXd terms(x.rows(), 4);
  terms << 2 * x, Eigen::VectorXd::Ones(x.rows());
  const Eigen::Vector4d fit = least_squares(terms, x.rowwise().squaredNorm());
  return std::sqrt(fit[3] + fit.head<3>().squaredNorm());
}

TorusRadii fitted_torus_radii(const Field& x) {
  const Field centred = x.rowwise() - x.colwise().mean();
  const Eigen::VectorXd rho = centred.leftCols(2).rowwise().norm();
  Eigen::MatrixXd terms(x.rows(), 2);
  terms << 2 * rho, Eigen::VectorXd::Ones(x.rows());
  const Eigen::Vector2d fit = least_squares(terms, centred.rowwise().squaredNorm());
  return {fit[0], std::sqrt(fit[1] + fit[0] * fit[0])};
}

std::optional<double> extinction_time(const Series& series, int steps) {
  const std::vector<double>&t = series.at("t"), &area = series.at("area");
  if (area.size() < 3) return {};
  const std::size_t n = area.size() - 1;
  const double tau = t[n] - t[n - 1], rate = (area[n - 1] - area[n]) / tau;
  const double rate_before = (area[n - 2] - area[n - 1]) / (t[n - 1] - t[n - 2]);
  const bool is_trend = rate <= 4 * rate_before && area[n] <= steps * tau * rate;
  if (!(rate > 0) || !(is_trend || area[n] <= 1e-6 * area[0])) return {};
  return t[n] + area[n] / rate;
}

double latest_end_of_mean_curvature_flow(const Series& series) {
  const std::vector<double>&t = series.at("t"), &area = series.at("area");
  double latest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < t.size(); ++n) latest = std::min(latest, t[n] + area[n] / (16 * pi));
  return latest;
}

std::optional<double> pinch_time(const Series& series) {
  const std::vector<double>&t = series.at("t"), &r = series.at("neck_radius");
  if (r.empty() || r.back() > r[0] / 2) return {};
  int n = static_cast<int>(r.size()) - 1;
  while (r[n] < r[0] / 5) --n;
  if (n < 2) return {};
  const auto w = [&](int i) { return r[i] * r[i]; };
  // Newton's form around the last step: w(t_n + s) = w_n + slope s + bend s (s + t_n - t_{n-1}).
  const double slope = (w(n) - w(n - 1)) / (t[n] - t[n - 1]);
  const double before = (w(n - 1) - w(n - 2)) / (t[n - 1] - t[n - 2]);
  const double bend = std::min((slope - before) / (t[n] - t[n - 2]), 0.0);
  const double b = slope + bend * (t[n] - t[n - 1]);
  if (!(b < 0)) return {};
  return t[n] + 2 * w(n) / (-b + std::sqrt(b * b - 4 * bend * w(n)));
}

}  // namespace esfem
