// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/mesh.hpp"

namespace esfem {

/// The area of the triangles between the corners.
double area_of_triangles(const Mesh& mesh);

/// The length L that defaults and scalings are relative to: the power of ten nearest to the radius of the
/// sphere that has the area of the triangles between the corners. So surfaces of size one (radius 0.32
/// to 3.2) have exactly 1; 1 as well where the area is 0 or not finite.
double characteristic_length(const Mesh& mesh);

/// The centre of mass of the triangles between the corners.
Vec3 centroid(const Mesh& mesh);

/// A point about which differences of positions lose no digits: the mean of x, each coordinate rounded to a
/// multiple of `length`, and 0 where it is less than ten lengths from 0. So x - centre is exact for a surface
/// that is far from the origin, and x itself for one that is near.
Vec3 far_centre(const Field& x, double length);

}  // namespace esfem
