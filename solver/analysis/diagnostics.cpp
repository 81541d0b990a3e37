// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/diagnostics.hpp"

namespace esfem {

void record_geometry(const SurfaceSpace& space, double t, const Field& x, Series& series) {
  const MeshQuality quality = mesh_quality(space.elements(), x);
  series["t"].push_back(t);
  series["area"].push_back(space.area(x));
  series["volume"].push_back(space.volume(x));
  series["h"].push_back(quality.h);
  series["worst_angle"].push_back(quality.min_angle);
  series["worst_radius_ratio"].push_back(quality.min_radius_ratio);
}

void record_curvature(const SurfaceSpace& space, const Field& x, const Field& nu, const Field& H,
                      Series& series) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  const Eigen::VectorXd length = nu.rowwise().norm();
  series["willmore_energy"].push_back(0.5 * M.energy(H));
  series["max_H"].push_back(H.cwiseAbs().maxCoeff());
  series["min_nu"].push_back(length.minCoeff());
  series["max_nu"].push_back(length.maxCoeff());
}

}  // namespace esfem
