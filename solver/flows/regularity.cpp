// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/flows/regularity.hpp"

#include <algorithm>

#include "solver/error.hpp"

namespace esfem {

namespace {

/// |H| times the longest edge, largest over the corners of each element.
void require_resolved(const Connectivity& elements, const Field& x, const Field& H) {
  for (int e = 0; e < elements.rows(); ++e) {
    double edge = 0, curvature = 0;
    for (int i = 0; i < 3; ++i) {
      edge = std::max(edge, (x.row(elements(e, i)) - x.row(elements(e, (i + 1) % 3))).norm());
      curvature = std::max(curvature, H.row(elements(e, i)).norm());
    }
    if (curvature * edge > largest_curvature_size) {
      throw SingularityError(
          format("in element %d, |H| = %g times the longest edge %g is %g; expected at most %g", e, curvature,
                 edge, curvature * edge, largest_curvature_size));
    }
  }
}

}  // namespace

void require_regular(const SurfaceSpace& space, const Field& x, const Field& H) {
  if (!x.allFinite() || !H.allFinite()) return;  // an error that check_finite of the time loop names
  require_resolved(space.elements(), x, H);
  require_regular(space, x);
}

void require_regular(const SurfaceSpace& space, const Field& x) {
  if (!x.allFinite()) return;
  const MeshQuality quality = mesh_quality(space.elements(), x);
  if (quality.min_radius_ratio < smallest_radius_ratio) {
    throw SingularityError(format("element %d has radius ratio %g; expected at least %g",
                                  quality.worst_element, quality.min_radius_ratio, smallest_radius_ratio));
  }
  try {
    space.area(x);
  } catch (const NumericsError& degenerate) {
    throw SingularityError(degenerate.what());
  }
}

void require_normal(const Field& nu) {
  for (int j = 0; j < nu.rows(); ++j) {
    const double length = nu.row(j).norm();
    if (length > largest_normal_length || length < 1 / largest_normal_length) {
      throw SingularityError(format("at node %d, nu_h has length %g; expected %g to %g", j, length,
                                    1 / largest_normal_length, largest_normal_length));
    }
  }
}

void assemble_regular(const SurfaceSpace& space, const Field& x_tilde, SymmetricMatrix& M,
                      SymmetricMatrix& A) {
  try {
    space.assemble(x_tilde, M, A);
  } catch (const NumericsError& degenerate) {
    throw SingularityError(std::string("on the extrapolated surface, ") + degenerate.what());
  }
}

}  // namespace esfem
