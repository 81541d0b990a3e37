// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// Bounds beyond which a surface is singular or no longer resolved.
constexpr double largest_curvature_size = 5;    ///< of |H| times the longest edge of an element
constexpr double smallest_radius_ratio = 1e-2;  ///< of an element, 2 (inradius)/(circumradius)
constexpr double largest_normal_length = 4;     ///< of |nu_h| and 1/|nu_h| in the nodes

/// Throws SingularityError with the element's number when, in some element of Gamma_h[x], |H| times the
/// longest edge or the radius ratio is beyond these bounds, or the curved element is degenerate. H: N x 1, of
/// either sign, or N x 3: then the length of each row counts (the velocity of mean curvature flow has length
/// |H|).
void require_regular(const SurfaceSpace& space, const Field& x, const Field& H);

/// The same for a flow that has no curvature: elements alone are looked at.
void require_regular(const SurfaceSpace& space, const Field& x);

/// Throws SingularityError with the node's number when |nu_h| or 1/|nu_h| is beyond its bound: the surface
/// then moves at a speed that has nothing to do with its curvature. nu: N x 3, a flow's own normal.
void require_normal(const Field& nu);

/// M(x~) and A(x~) on the extrapolated surface, which can be degenerate before the computed one is:
/// SingularityError there, too.
void assemble_regular(const SurfaceSpace& space, const Field& x_tilde, SymmetricMatrix& M,
                      SymmetricMatrix& A);

}  // namespace esfem
