// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/mesh/features.hpp"

namespace esfem {

/// A point of a mesh of degree 1.
struct MeshPoint {
  int element;   ///< 0-based
  Vec3 weights;  ///< barycentric coordinates; exactly 0 on an edge
};

/// What `remesh` makes of a mesh.
struct RemeshedSurface {
  Mesh mesh;                        ///< of degree 1
  std::vector<MeshPoint> on_input;  ///< where on the given mesh each node lies
  int sharp_edges;                  ///< how many the given mesh has
  int kept;                         ///< how many of these the new edges follow
  double relative_volume_change;    ///< new volume/old volume - 1
};

/// A closed mesh of degree 1 remeshed with edges of about `edge_length` and triangles close to equilateral,
/// by CGAL's isotropic remeshing (Botsch & Kobbelt, SGP 2004). Its nodes lie on the triangles of the given
/// mesh, along its sharp edges on these, and corners of features stay. If this gives triangles of a radius
/// ratio below 0.05, because features are closer than the edge length, these features are given up, unless
/// that changes the volume by more than a hundredth. The same arguments give the same bits. Throws InputError
/// unless edge_length is at most a quarter of the diagonal of the bounding box and makes no more than ten
/// million triangles, and when the remeshing fails.
RemeshedSurface remesh(const Mesh& mesh, double edge_length, double feature_angle = default_feature_angle);

}  // namespace esfem
