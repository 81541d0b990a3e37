// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/assembly/element_batches.hpp"

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"

namespace esfem {

ElementBatches::ElementBatches(const Connectivity& elements, int degree, const Quadrature& rule)
    : element_count_(static_cast<int>(elements.rows())),
      nodes_(nodes_per_element(degree)),
      weights_(rule.weights.data(), rule.weights.data() + rule.weights.size()) {
  const ShapeTable table = shape_functions(degree, rule.points);
  for (int q = 0; q < points(); ++q)
    for (int a = 0; a < nodes_; ++a)
      shapes_.push_back({table.value(q, a), table.dxi(q, a), table.deta(q, a)});
  for (int batch = 0; batch < count(); ++batch)
    for (int a = 0; a < nodes_; ++a)
      for (int lane = 0; lane < pack_size; ++lane) node_.push_back(elements(element(batch, lane), a));
}

void ElementBatches::load(int number, const Field& x, Batch& batch) const {
  batch.number = number;
  batch.node = &node_[number * nodes_ * pack_size];
  for (int lane = 0; lane < pack_size; ++lane)
    batch.one[lane] = number * pack_size + lane < element_count_ ? 1.0 : 0.0;
  gather(batch, x, 3, batch.x);

  Pack edge[3][3];
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) edge[k][i] = batch.x[(k + 1) % 3][i] - batch.x[k][i];
  batch.size = dot(edge[0], edge[0]);
  for (int k = 1; k < 3; ++k) {
    const Pack length = dot(edge[k], edge[k]);
    batch.size = length > batch.size ? length : batch.size;
  }
  cross(edge[0], edge[1], batch.direction);
  const Pack scale = 1.0 / sqrt(dot(batch.direction, batch.direction));
  for (Pack& component : batch.direction) component *= scale;
}

void ElementBatches::report_degenerate(const Batch& batch) const {
  for (int lane = 0; lane < pack_size; ++lane) {
    for (int q = 0; q < points(); ++q) {
      BatchPoint point;
      if (evaluate(batch, q, point)[lane]) continue;
      const double ratio = dot(point.normal, batch.direction)[lane] / batch.size[lane];
      throw NumericsError(
          format("element %d (counted from 1, near (%g, %g, %g)) is degenerate: Jacobian at quadrature point "
                 "%d is %.3g of the square of its longest edge, expected %.0e to %.0e",
                 element(batch.number, lane) + 1, batch.x[0][0][lane], batch.x[0][1][lane],
                 batch.x[0][2][lane], q, ratio, smallest_jacobian, largest_jacobian));
    }
  }
  throw NumericsError("an element is degenerate");
}

}  // namespace esfem
