// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// Bounds beyond which a surface is singular or no longer resolved.
constexpr double largest_curvature_size = 5;    ///< of |H| times the longest edge of an element
constexpr double smallest_radius_ratio = 1e-3;  ///< of an element, 2 (inradius)/(circumradius)

/// Throws SingularityError with the element's number when, in some element of Gamma_h[x], |H| times the
/// longest edge or the radius ratio is beyond these bounds, or the curved element is degenerate. H: N x 1, of
/// either sign, or N x 3: then the length of each row counts (the velocity of mean curvature flow has length
/// |H|).
void require_regular(const SurfaceSpace& space, const Field& x, const Field& H);

/// M(x~) and A(x~) on the extrapolated surface, which can be degenerate before the computed one is:
/// SingularityError there, too.
void assemble_regular(const SurfaceSpace& space, const Field& x_tilde, SymmetricMatrix& M,
                      SymmetricMatrix& A);

}  // namespace esfem
