// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <vector>

#include "solver/assembly/surface_space.hpp"
#include "solver/flows/willmore_law.hpp"

namespace esfem {

/// The area and the volume that a flow prescribes at time t. One that is not prescribed is empty.
struct AreaAndVolume {
  std::function<double(double t)> area;    ///< positive
  std::function<double(double t)> volume;  ///< enclosed, outward normal: > 0

  /// How many of them are prescribed.
  int count() const { return (area ? 1 : 0) + (volume ? 1 : 0); }
};

/// A prescribed quantity that does not change.
std::function<double(double t)> constant_target(double value);

/// A prescribed quantity that changes from `first` at t = begin to `last` at t = end, and is at rest before
/// and after: first + (last - first) (3 s² - 2 s³), s = (t - begin)/(end - begin).
std::function<double(double t)> smooth_target(double first, double last, double begin, double end);

/// Reduced volume 6 sqrt(pi) Vol/A^(3/2) of a closed surface: 1 of spheres, else less.
double reduced_volume(double area, double volume);

/// The volume of a surface with this area and reduced volume.
double volume_of(double area, double reduced_volume);

/// The Lagrange multipliers lambda_A, lambda_V of a flow V = W - lambda_A H - lambda_V that prescribes area
/// or volume of the discrete surface.
///
/// With normal velocity V the area changes at the rate int H V, the volume at int V, so that V is the
/// gradient flow of E + lambda_A A + lambda_V Vol when W is that of E. In BDF schemes the new nodes depend on
/// the multipliers; these are found such that the area and the volume of the new surface are the prescribed
/// ones (not their rates, which would let both drift).
class Multipliers {
 public:
  /// The quantities; also the entries of lambda.
  enum Quantity { area, volume };

  /// The space must outlive the object.
  Multipliers(const SurfaceSpace& space, AreaAndVolume prescribed);

  /// The prescribed quantities.
  const std::vector<Quantity>& unknowns() const { return unknowns_; }

  /// lambda (1 x 2) at the start, from W and H in the nodes (N x 1) of a surface with mass matrix M: int H V
  /// = 0 where the area is prescribed, int V = 0 where the volume is; the other entries are 0. Throws
  /// InputError when the two are not independent: H is constant on a sphere.
  Field at_start(const SymmetricMatrix& M, const Field& H, const Field& W) const;

  /// One step of Newton's method for the multipliers at time t. x: the nodes for the present ones; x_rates:
  /// their derivatives (N x 3) with respect to each of the unknowns(). Adds the correction to lambda (1 x 2)
  /// and returns true; returns false, and leaves lambda as it is, when area and volume are the prescribed
  /// ones up to round-off. Throws NumericsError when the unknowns are not independent.
  bool correct(double t, const Field& x, const std::array<Field, 2>& x_rates, Field& lambda);

  /// How often a flow calls `correct` in a step before it gives up.
  static constexpr int most_iterations = 20;

 private:
  double relative_residual(Quantity quantity, double t, const Field& x) const;

  const SurfaceSpace& space_;
  AreaAndVolume prescribed_;
  std::vector<Quantity> unknowns_;
  Field gradients_;  ///< N x 6: of area and volume with respect to x
  double previous_residual_ = std::numeric_limits<double>::infinity();  ///< of this Newton iteration
};

/// -H or -1: what the multiplier of a quantity is multiplied by in Q.
[[gnu::always_inline]] inline Pack multiplied_by(Multipliers::Quantity quantity, const WillmorePoint& at) {
  return quantity == Multipliers::area ? -at.H : pack(-1);
}

}  // namespace esfem
