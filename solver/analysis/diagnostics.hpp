// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// Quantities of a run by name, each with one value a recorded step; "t" has the times.
using Series = std::map<std::string, std::vector<double>>;

/// Appends the geometry of the discrete surface Gamma_h[x] at time t to the series "t", "area", "volume"
/// (both by quadrature on the curved elements), "h" (largest edge), "worst_angle" (degrees) and
/// "worst_radius_ratio" (of the triangles between the corners).
void record_geometry(const SurfaceSpace& space, double t, const Field& x, Series& series);

/// Appends quantities of the mean curvature H_h (N x 1): "willmore_energy" 1/2 int H_h² over Gamma_h[x] (8 pi
/// on spheres) and "max_H" (of |H_h| in the nodes).
void record_curvature(const SurfaceSpace& space, const Field& x, const Field& H, Series& series);

/// Appends the lengths of a flow's own normal nu_h (N x 3) in the nodes: "min_nu" and "max_nu".
void record_normal_length(const Field& nu, Series& series);

/// Appends the profile of a surface around the x3 axis that has a neck at x3 = 0: "neck_radius" (from the
/// nodes near x3 = 0, by a least-squares fit of their squared distances from the axis by a polynomial in x3),
/// "widest_radius" (largest distance of a node from the axis) and "tip" (largest |x3| of a node).
void record_profile(const Field& x, Series& series);

/// Appends how the nodes have spread: of ten rings of equal height |x3|, from the neck to the tip, the one
/// whose triangles (between the corners) have the smallest mean area. "smallest_elements" is this area over
/// that of all, "smallest_elements_x3" the middle of the ring over |x3| of the widest circle.
void record_node_density(const Connectivity& elements, const Field& x, Series& series);

/// The radius of the sphere that fits the nodes best: least squares of |x|² = 2 c . x + const over centre and
/// radius.
double fitted_sphere_radius(const Field& x);

/// The radii of the torus around the x3 axis (or one parallel to it) that fits the nodes best: least squares
/// of rho² + x3² = 2 major rho + const, distances from the axis through the nodes' mean.
struct TorusRadii {
  double major;  ///< of the circle
  double minor;  ///< of the tube around it
};
/// Fits them to the nodes x (N x 3).
TorusRadii fitted_torus_radii(const Field& x);

/// The time at which a shrinking surface has become a point or a line: when its area, extrapolated linearly
/// from the last two steps, is zero; the area of a sphere under mean curvature flow is linear in time. No
/// value as long as this is more than `steps` steps of the last size away, unless the area is below 1e-6 of
/// its first value.
std::optional<double> extinction_time(const Series& series, int steps = 1);

/// The latest time at which mean curvature flow of the surfaces of a series can end: int H² is at least 16 pi
/// for every closed surface (Willmore), so that a surface of area A exists for A/(16 pi) at most.
double latest_end_of_mean_curvature_flow(const Series& series);

/// The time at which the neck pinches: neck_radius² extrapolated to zero from the last three steps at which
/// the neck still has a fifth of its first radius, by a parabola, or by a line through the last two where the
/// parabola bends upwards. No value when the neck has not shrunk below half of its first radius, or does not
/// shrink in these steps.
std::optional<double> pinch_time(const Series& series);

}  // namespace esfem
