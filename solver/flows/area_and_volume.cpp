// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/area_and_volume.hpp"

#include <cmath>
#include <utility>

#include "solver/constants.hpp"
#include "solver/error.hpp"

namespace esfem {
namespace {

/// The sine of the smallest angle between H and 1 in L2, or between their discrete counterparts, with which
/// both multipliers are determined. On discrete spheres it is the error of H_h.
constexpr double smallest_sine = 1e-2;

/// Solves the 2 x 2 system G lambda = r by Cramer's rule; G_kl is a product of something of quantity k and of
/// unknown l. Returns false when the columns are parallel.
bool solve(const Eigen::Matrix2d& G, const Eigen::Vector2d& r, Eigen::Vector2d& lambda) {
  const double determinant = G.determinant();
  if (!(std::abs(determinant) > smallest_sine * smallest_sine * G.col(0).norm() * G.col(1).norm()))
    return false;
  lambda << (r[0] * G(1, 1) - r[1] * G(0, 1)) / determinant, (r[1] * G(0, 0) - r[0] * G(1, 0)) / determinant;
  return true;
}

/// Relative residuals of area and volume. Divided by tau they are errors of lambda, and so of V: so the
/// iteration goes on until round-off ends it: below the first of these numbers, or, as sums over many
/// elements are less accurate, where the residual falls no more below the second.
constexpr double tolerance = 1e-15, largest_round_off = 1e-13;

const char* const dependent =
    "area and volume cannot both be prescribed: where H is constant, as on a sphere, a change of one is a "
    "change of the other; prescribe one of them";

}  // namespace

std::function<double(double)> constant_target(double value) {
  return [value](double) { return value; };
}

std::function<double(double)> smooth_target(double first, double last, double begin, double end) {
  return [=](double t) {
    if (t >= end) return last;
    const double s = std::max(0.0, (t - begin) / (end - begin));
    return first + (last - first) * s * s * (3 - 2 * s);
  };
}

double reduced_volume(double area, double volume) {
  return 6 * std::sqrt(pi) * volume / std::pow(area, 1.5);
}

double volume_of(double area, double reduced_volume) {
  return reduced_volume * std::pow(area, 1.5) / (6 * std::sqrt(pi));
}

Multipliers::Multipliers(const SurfaceSpace& space, AreaAndVolume prescribed)
    : space_(space), prescribed_(std::move(prescribed)) {
  if (prescribed_.area) unknowns_.push_back(area);
  if (prescribed_.volume) unknowns_.push_back(volume);
}

Field Multipliers::at_start(const SymmetricMatrix& M, const Field& H, const Field& W) const {
  Field lambda = Field::Zero(1, 2);
  if (unknowns_.empty()) return lambda;
  // The L2 products of H/|H| and 1/|1| with each other and with W.
  Field directions(H.rows(), 2);
  directions << H, Field::Ones(H.rows(), 1);
  Field M_directions = M * directions;
  Eigen::Vector2d norm;
  for (int l = 0; l < 2; ++l) {
    norm[l] = std::sqrt(directions.col(l).dot(M_directions.col(l)));
    directions.col(l) /= norm[l];
    M_directions.col(l) /= norm[l];
  }
  const Eigen::Matrix2d products = directions.transpose() * M_directions;
  Eigen::Vector2d solution = M_directions.transpose() * W.col(0);
  if (unknowns_.size() == 2 && !solve(products, Eigen::Vector2d(solution), solution))
    throw InputError(dependent);
  for (const Quantity quantity : unknowns_) lambda(0, quantity) = solution[quantity] / norm[quantity];
  return lambda;
}

double Multipliers::relative_residual(Quantity quantity, double t, const Field& x) const {
  return quantity == area ? space_.area(x) / prescribed_.area(t) - 1
                          : space_.volume(x) / prescribed_.volume(t) - 1;
}

bool Multipliers::correct(double t, const Field& x, const std::array<Field, 2>& x_rates, Field& lambda) {
  const int count = static_cast<int>(unknowns_.size());
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  for (int k = 0; k < count; ++k) residual[k] = relative_residual(unknowns_[k], t, x);
  const double size = residual.cwiseAbs().maxCoeff(),
               previous = std::exchange(previous_residual_, std::numeric_limits<double>::infinity());
  if (size <= tolerance || (size <= largest_round_off && size > 0.1 * previous)) return false;

  // The derivatives of area and volume in direction phi are int div phi and int n . phi.
  const auto gradients = [](const PointData<0>& p, Integrand<6, 3>& load) {
    load = {};
    for (int l = 0; l < 3; ++l) {
      load.value[3 + l] = p.normal[l];
      load.flux[l][l] = pack(1);
    }
  };
  space_.assemble_load<0, 6, 3>(x, Field(x.rows(), 0), gradients, gradients_);
  Eigen::Matrix2d J = Eigen::Matrix2d::Identity();
  Eigen::Vector2d scale = Eigen::Vector2d::Ones(), correction;
  for (int k = 0; k < count; ++k) {
    const auto gradient = gradients_.middleCols(3 * unknowns_[k], 3);
    const double target = unknowns_[k] == area ? prescribed_.area(t) : prescribed_.volume(t);
    for (int l = 0; l < count; ++l) J(k, l) = gradient.cwiseProduct(x_rates[l]).sum() / target;
  }
  for (int l = 0; l < count; ++l) {
    scale[l] = J.col(l).norm();
    J.col(l) /= scale[l];
  }
  if (!solve(J, residual, correction)) throw NumericsError(dependent);
  for (int l = 0; l < count; ++l) lambda(0, unknowns_[l]) -= correction[l] / scale[l];
  previous_residual_ = size;
  return true;
}

}  // namespace esfem
