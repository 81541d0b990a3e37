// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "solver/assembly/surface_space.hpp"

namespace esfem {

using Series = std::map<std::string, std::vector<double>>;

/// Appends the geometry of the discrete surface Gamma_h[x] at time t to the series "t", "area", "volume"
/// (both by quadrature on the curved elements), "h" (largest edge), "worst_angle" (degrees) and
/// "worst_radius_ratio" (of the triangles between the corners).
void record_geometry(const SurfaceSpace& space, double t, const Field& x, Series& series);

/// Appends what a flow's own normal nu_h (N x 3) and mean curvature H_h (N x 1) say: "willmore_energy"
/// 1/2 int H_h² over Gamma_h[x] (8 pi on spheres), "max_H" (of |H_h| in the nodes), "min_nu" and "max_nu" (of
/// |nu_h|).
void record_curvature(const SurfaceSpace& space, const Field& x, const Field& nu, const Field& H,
                      Series& series);

}  // namespace esfem
