// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/geometry/regularity.hpp"

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"
#include "solver/geometry/discrete_curvature.hpp"

namespace esfem {

namespace {

const double growth_of_curvature = 4;  ///< that a start may have still before it

/// |H| times the longest edge of element e, |H| the largest at its corners.
struct CurvatureSize {
  double H, edge;
  double size() const { return H * edge; }
};

CurvatureSize curvature_size(const Connectivity& elements, int e, const Field& x, const Field& H) {
  CurvatureSize found = {0, 0};
  for (int i = 0; i < 3; ++i) {
    const int a = elements(e, i), b = elements(e, (i + 1) % 3);
    found.edge = std::max(found.edge, (x.row(a) - x.row(b)).norm());
    found.H = std::max(found.H, H.row(a).norm());
  }
  return found;
}

std::string node_at(const Field& x, Eigen::Index j) {
  return format("node %td (counted from 1, at (%g, %g, %g))", j + 1, x(j, 0), x(j, 1), x(j, 2));
}

std::string element_at(const Connectivity& elements, int e, const Field& x) {
  const Vec3 middle = (x.row(elements(e, 0)) + x.row(elements(e, 1)) + x.row(elements(e, 2))) / 3;
  return format("element %d (counted from 1, around (%g, %g, %g))", e + 1, middle[0], middle[1], middle[2]);
}

void require_resolved(const Connectivity& elements, const Field& x, const Field& H, double largest) {
  for (int e = 0; e < elements.rows(); ++e) {
    const CurvatureSize found = curvature_size(elements, e, x, H);
    if (found.size() > largest) {
      throw SingularityError(format("in %s, |H| = %g times the longest edge %g is %g; expected at most %g",
                                    element_at(elements, e, x).c_str(), found.H, found.edge, found.size(),
                                    largest));
    }
  }
}

}  // namespace

RegularityLimits limits_from_start(const SurfaceSpace& space, const Field& x) {
  RegularityLimits limits;
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  for (int e = 0; e < space.element_count(); ++e) {
    const double size = curvature_size(space.elements(), e, x, curvature.kappa()).size();
    limits.curvature_size = std::max(limits.curvature_size, growth_of_curvature * size);
  }
  const double ratio = mesh_quality(space.elements(), x).min_radius_ratio;
  limits.radius_ratio = ratio < limits.radius_ratio ? 0 : std::min(limits.radius_ratio, ratio * ratio);
  return limits;
}

void require_regular(const SurfaceSpace& space, const Field& x, const Field& H,
                     const RegularityLimits& limits) {
  if (!x.allFinite() || !H.allFinite()) return;  // an error that check_finite of the time loop names
  require_resolved(space.elements(), x, H, limits.curvature_size);
  require_regular(space, x, limits);
}

void require_regular(const SurfaceSpace& space, const Field& x, const RegularityLimits& limits) {
  if (!x.allFinite()) return;
  const MeshQuality quality = mesh_quality(space.elements(), x);
  if (quality.min_radius_ratio < limits.radius_ratio) {
    throw SingularityError(format("%s has radius ratio %g; expected at least %g",
                                  element_at(space.elements(), quality.worst_element, x).c_str(),
                                  quality.min_radius_ratio, limits.radius_ratio));
  }
  try {
    space.area(x);
  } catch (const NumericsError& degenerate) {
    throw SingularityError(degenerate.what());
  }
}

void require_normal(const Field& x, const Field& nu, const RegularityLimits& limits) {
  for (int j = 0; j < nu.rows(); ++j) {
    const double length = nu.row(j).norm();
    if (length > limits.normal_length || length < 1 / limits.normal_length) {
      throw SingularityError(format("at %s, nu_h has length %g; expected %g to %g", node_at(x, j).c_str(),
                                    length, 1 / limits.normal_length, limits.normal_length));
    }
  }
}

void require_bounded(const char* name, const Field& x, const Field& u, const RegularityLimits& limits) {
  for (Eigen::Index l = 0; l < u.cols(); ++l) {
    for (Eigen::Index j = 0; j < u.rows(); ++j) {
      if (std::abs(u(j, l)) <= limits.field_size) continue;
      const std::string field = name + (u.cols() == 1 ? "" : std::to_string(l + 1));
      throw SingularityError(format("%s = %g at %s; expected at most %g in size", field.c_str(), u(j, l),
                                    node_at(x, j).c_str(), limits.field_size));
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
