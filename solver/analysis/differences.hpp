// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/mesh.hpp"
#include "solver/nodal_field.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// A discrete surface and functions on it.
struct DiscreteFunctions {
  Mesh mesh;           ///< with the positions at the time that is compared
  NodalFields fields;  ///< nodal values of the functions
};

/// How far a discrete solution is from a finer one, on meshes that need not be nested: functions u_h of the
/// coarse surface, and u of the fine one in the closest points y(x) (ClosestPoint), are compared by
/// quadrature on the coarse surface,
///   closest_L2 = ||u_h - u(y(.))||,  closest_H1_semi: of the tangential part of grad u_h - (grad u)(y(.)),
/// and closest_H1 is the full norm. "x" are the surfaces themselves: x - y(x), so the distance, and the angle
/// between their normals; tangential motion of the nodes is not seen.
///
/// y(x) is found to round-off, so that the errors of the comparison are those of the quadrature, and of the
/// fine surface as an interpolant, O(h^(k+1)) of the fine mesh.
///
/// Throws InputError when the fine solution has a field not, or with another number of components.
Errors differences(const DiscreteFunctions& coarse, const DiscreteFunctions& fine);

}  // namespace esfem
