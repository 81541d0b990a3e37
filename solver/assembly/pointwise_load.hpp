// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"

namespace esfem {

/// SurfaceSpace::assemble_load for integrands without gradients whose numbers of inputs and outputs are known
/// only at run time: out (N x outputs) = integral of values[l] phi_j over Gamma_h[x], where
/// function(const Pack* point, Pack* values) fills the values; point has x (3), the unit normal (3) and the
/// columns of u.
template <class Function>
void assemble_pointwise_load(const SurfaceSpace& space, const Field& x, const Field& u, int outputs,
                             const Function& function, Field& out) {
  if (x.rows() != space.dofs() || x.cols() != 3 || u.rows() != space.dofs())
    throw InputError(format("nodal fields are %td x %td and %td x %td, expected %d x 3 and %d rows", x.rows(),
                            x.cols(), u.rows(), u.cols(), space.dofs(), space.dofs()));
  const ElementBatches& batches = space.batches();
  const int nodes = batches.nodes(), inputs = static_cast<int>(u.cols());
  std::vector<Pack> nodal(nodes * inputs), point(6 + inputs), values(outputs), load(nodes * outputs);
  out.setZero(space.dofs(), outputs);
  Batch batch;
  BatchPoint geometry;
  for (int b = 0; b < batches.count(); ++b) {
    batches.load(b, x, batch);
    for (int c = 0; c < inputs; ++c) batches.gather(batch, u, c, &nodal[c * nodes]);
    std::fill(load.begin(), load.end(), Pack{});
    for (int q = 0; q < batches.points(); ++q) {
      batches.require_regular(batches.evaluate(batch, q, geometry), batch);
      const ElementBatches::Shape* shape = batches.shapes(q);
      std::fill(point.begin(), point.end(), Pack{});
      for (int i = 0; i < 3; ++i) point[3 + i] = geometry.normal[i] * geometry.inverse_jacobian;
      for (int a = 0; a < nodes; ++a) {
        for (int i = 0; i < 3; ++i) point[i] += shape[a].value * batch.x[a][i];
        for (int c = 0; c < inputs; ++c) point[6 + c] += shape[a].value * nodal[c * nodes + a];
      }
      function(point.data(), values.data());
      const Pack weight = batches.weight(q) * geometry.jacobian * batch.one;
      for (int l = 0; l < outputs; ++l) {
        const Pack value = weight * values[l];
        for (int a = 0; a < nodes; ++a) load[l * nodes + a] += shape[a].value * value;
      }
    }
    for (int l = 0; l < outputs; ++l)
      for (int a = 0; a < nodes; ++a)
        for (int lane = 0; lane < pack_size; ++lane)
          out(batch.node[pack_size * a + lane], l) += load[l * nodes + a][lane];
  }
}

}  // namespace esfem
