// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/surfaces/periodic_table.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

/// Profile of the self-shrinking torus (Angenent, Prog. Nonlinear Differ. Equ. Appl. 7, 1992) around the x3
/// axis: the closed curve (r, z)(s), by arclength s, with H = <y, nu>/2 on its surface of revolution, that is
///   r' = sin a,   z' = cos a,   a' = (1/r - r/2) cos a + (z/2) sin a,
/// which starts on the inner equator, a = 0, and is symmetric to z = 0. Accurate to 1e-12.
class AngenentProfile {
 public:
  /// Integrates the curve; angenent_profile() does so once.
  AngenentProfile();

  /// A point of the profile; vectors are in the half plane of (r, z).
  struct Point {
    Eigen::Vector2d position;   ///< (r, z)
    Eigen::Vector2d tangent;    ///< of length 1, in the direction of increasing s
    Eigen::Vector2d normal;     ///< of length 1, out of the torus
    double meridian_curvature;  ///< a', along the profile; H is the sum of both
    double parallel_curvature;  ///< -cos(a)/r, around the axis
  };
  /// The point at arclength s from the inner equator; s may be any number, the curve is periodic.
  Point at(double s) const;
  /// Arclength of the whole profile.
  double length() const { return curve_.period(); }
  /// How far the integrated curve (r, z, a) is from closing.
  double gap() const { return gap_; }

  /// The profile is a graph over the angle around (centre, 0), counted from the inner equator: arclength of
  /// the point in the direction of (r, z).
  double radial_arclength(double r, double z) const;
  /// Positive outside: the difference of the distances that (r, z) and the profile have from (centre, 0) in
  /// this direction.
  double radial_level(double r, double z) const;
  /// Arclength of the closest point to (r, z), by Newton's method from the radial one; NaN where that fails.
  double closest_arclength(double r, double z) const;

  /// The particles of the normal flow slide along the profile by ds/dsigma = <y, tangent>/2, where
  /// y = x/sqrt(1 - t), sigma = -log(1 - t): a particle that starts at s is at s + displacement(s).
  PeriodicTable<1> displacement(double sigma) const;

 private:
  PeriodicTable<3> curve_;   ///< r, z, and a less its mean rise
  PeriodicTable<1> speed_;   ///< <y, tangent>/2
  PeriodicTable<1> radial_;  ///< arclength less its mean rise, over the angle around the centre
  double centre_, gap_;
};

/// The profile, integrated at the first call.
const AngenentProfile& angenent_profile();

/// The self-shrinking torus times scale: H = <y, nu>/(2 scale²). Mean curvature flow takes it from scale 1
/// at t = 0 to sqrt(1 - t). The level set function is the signed distance; `level` is another one, with the
/// same sign, and mean_curvature_jet belongs to points of the surface (H is continued constantly along
/// normals). Throws InputError unless scale is positive.
Surface angenent_torus(double scale = 1);

}  // namespace esfem
