// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/assembly/surface_space.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

/// One quadrature point of a batch of elements, lifted to the exact surface (kll19 §3.4).
struct LiftedPoints {
  int q;                     ///< its number in the rule
  SurfacePoints on_surface;  ///< the closest points
  Pack dA;                   ///< weight of the rule times the lifted element's area; 0 in lanes that fill up
  DualTangents dual;         ///< of the lifted elements: gradients of lifted functions from reference ones
};

/// The quadrature point q of a batch at nodes of Gamma_h[x], lifted to `surface` by its closest point.
///
/// With x = y + s nu(y) the tangents of the lifted element are dy = (I + s A(y))^{-1} P dx. By
/// Cayley-Hamilton in the tangent plane, where A has the trace H and the determinant K,
///   (I + s A)^{-1} P = ((1 + s H) P - s A)/(1 + s H + s² K).
inline LiftedPoints lift(const ElementBatches& batches, const Batch& batch, int q, const Surface& surface) {
  Pack x[3] = {}, dx[2][3] = {};
  const ElementBatches::Shape* shape = batches.shapes(q);
  for (int a = 0; a < batches.nodes(); ++a) {
    for (int i = 0; i < 3; ++i) {
      x[i] += shape[a].value * batch.x[a][i];
      dx[0][i] += shape[a].dxi * batch.x[a][i];
      dx[1][i] += shape[a].deta * batch.x[a][i];
    }
  }
  const SurfacePoints points = surface.closest_points(x);
  const Pack(&A)[3][3] = points.weingarten;
  const Pack offset[3] = {x[0] - points.y[0], x[1] - points.y[1], x[2] - points.y[2]};
  const Pack s = dot(points.normal, offset);
  const Pack H = A[0][0] + A[1][1] + A[2][2];
  const Pack K = 0.5 * (H * H - dot(A[0], A[0]) - dot(A[1], A[1]) - dot(A[2], A[2]));
  const Pack inverse_determinant = 1.0 / (1.0 + s * (H + s * K));

  BatchPoint lifted;
  Pack(*dy[2])[3] = {&lifted.tangent_xi, &lifted.tangent_eta};
  for (int k = 0; k < 2; ++k) {
    const Pack along_normal = dot(points.normal, dx[k]);
    for (int i = 0; i < 3; ++i) {
      const Pack P_dx = dx[k][i] - along_normal * points.normal[i];
      (*dy[k])[i] = inverse_determinant * ((1.0 + s * H) * P_dx - s * dot(A[i], dx[k]));
    }
  }
  lifted.set_normal();
  return {q, points, batch.one * batches.weight(q) * lifted.jacobian, DualTangents(lifted)};
}

/// The quadrature point q of Gamma_h[x] itself: what lift has on the exact surface, without a Weingarten map.
inline LiftedPoints unlifted(const ElementBatches& batches, const Batch& batch, int q) {
  SurfacePoints points = {};
  const ElementBatches::Shape* shape = batches.shapes(q);
  for (int a = 0; a < batches.nodes(); ++a)
    for (int i = 0; i < 3; ++i) points.y[i] += shape[a].value * batch.x[a][i];
  BatchPoint geometry;
  batches.require_regular(batches.evaluate(batch, q, geometry), batch);
  for (int i = 0; i < 3; ++i) points.normal[i] = geometry.normal[i] * geometry.inverse_jacobian;
  return {q, points, batch.one * batches.weight(q) * geometry.jacobian, DualTangents(geometry)};
}

/// Calls visit(const Batch&, const LiftedPoints&) for the quadrature points of Gamma_h[x], lifted to
/// `surface`; batch by batch, in each in the order of the rule's points.
template <class Visit>
void visit_lifted_points(const SurfaceSpace& space, const Field& x, const Surface& surface, Visit&& visit) {
  const ElementBatches& batches = space.batches();
  Batch batch;
  for (int b = 0; b < batches.count(); ++b) {
    batches.load(b, x, batch);
    for (int q = 0; q < batches.points(); ++q) visit(batch, lift(batches, batch, q, surface));
  }
}

}  // namespace esfem
