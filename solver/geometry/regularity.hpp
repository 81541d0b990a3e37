// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>

#include "solver/assembly/surface_space.hpp"

namespace esfem {

/// Bounds beyond which an evolving surface, or a field on it, is singular or no longer resolved.
struct RegularityLimits {
  double curvature_size = 5;   ///< of |H| times the longest edge of an element
  double radius_ratio = 1e-2;  ///< of an element, 2 (inradius)/(circumradius)
  double normal_length = 4;    ///< of |nu_h| and 1/|nu_h| in the nodes
  double field_size = std::numeric_limits<double>::infinity();  ///< of |u|, u what diffuses on the surface
};

/// The limits of a run that starts from Gamma_h[x]: a singularity is a change, so features of the initial
/// surface are none. A cube has |H| h = 5.5 at its corners on every mesh, and becomes smooth immediately.
/// These are the defaults, or 4 times the largest |kappa| h of the surface if that is more
/// (DiscreteCurvature), and the square of its smallest radius ratio r if that is less; no limit on the radius
/// ratio if r itself is beyond the default.
RegularityLimits limits_from_start(const SurfaceSpace& space, const Field& x);

/// Throws SingularityError with the element's number (from 1) and place when, in some element of Gamma_h[x],
/// |H| times the longest edge or the radius ratio is beyond its limit, or the curved element is degenerate.
/// H: N x 1, of either sign, or N x 3: then the length of each row counts (the velocity of mean curvature
/// flow has length |H|).
void require_regular(const SurfaceSpace& space, const Field& x, const Field& H,
                     const RegularityLimits& limits = {});

/// The same for a flow that has no curvature: only the elements are checked.
void require_regular(const SurfaceSpace& space, const Field& x, const RegularityLimits& limits);

/// Throws SingularityError with the node's number (from 1) and place when |nu_h| or 1/|nu_h| is beyond its
/// limit: the surface then moves at a speed that has nothing to do with its curvature. nu: N x 3, a flow's
/// own normal in the nodes x.
void require_normal(const Field& x, const Field& nu, const RegularityLimits& limits);

/// Throws SingularityError with name, value, node (from 1) and place when a value of u (N x m) in the nodes x
/// is beyond its limit or not finite. Called before u moves the surface; otherwise the error would name an
/// element.
void require_bounded(const char* name, const Field& x, const Field& u, const RegularityLimits& limits);

/// M(x~) and A(x~) on the extrapolated surface, which can be degenerate before the computed one is:
/// SingularityError there, too.
void assemble_regular(const SurfaceSpace& space, const Field& x_tilde, SymmetricMatrix& M,
                      SymmetricMatrix& A);

}  // namespace esfem
