// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// An axisymmetric critical point of E = 1/2 int (H - H_0)² among surfaces of area 4 pi with a given reduced
/// volume, symmetric about the equator, and the spheroid of the same area and volume; the axis is x3. Values
/// of reference/independent/helfrich.json, to 13 digits.
struct VesicleShape {
  std::string branch;       ///< "prolate" or "oblate"
  double reduced_volume;    ///< 6 sqrt(pi) Vol/A^(3/2)
  double H_0;               ///< spontaneous curvature, at area 4 pi
  double energy;            ///< E/(8 pi)
  double lambda_A;          ///< multiplier of the area: E + lambda_A A + lambda_V Vol is stationary
  double lambda_V;          ///< multiplier of the volume
  double spheroid_equator;  ///< half axis of the spheroid across x3
  double spheroid_pole;     ///< half axis of the spheroid along x3
  double meridian_length;   ///< from pole to pole

  /// The angle of the tangent is psi(s) = s + sum b_k sin(2 k s), k = 1, .., at arclength meridian_length
  /// s/pi from the north pole: r' = cos psi, x3' = -sin psi.
  std::vector<double> b;

  /// Points (r, x3) of the profile from pole to pole at equal distances.
  std::vector<Eigen::Vector2d> profile(int intervals) const;
};

/// All shapes that are known.
const std::vector<VesicleShape>& vesicle_shapes();

/// One of them. Throws InputError when there is none with these numbers.
const VesicleShape& vesicle_shape(const std::string& branch, double reduced_volume, double H_0);

/// The root mean square distance of the nodes x of Gamma_h[x] from the shape, which is scaled to the area of
/// the surface, moved to its centre of mass, and turned to its axis: that about which the second moments are
/// equal. Relative to sqrt(area/(4 pi)).
double distance_from(const VesicleShape& shape, const SurfaceSpace& space, const Field& x);

}  // namespace esfem
