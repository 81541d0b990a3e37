// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "solver/assembly/surface_space.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// The ellipsoid (1, 1, 0.8) scaled by 2 and its P2 mesh of 162 nodes, on which orders in time are measured.
inline Surface flattened_sphere() {
  return ellipsoid(2, 2, 1.6);
}
inline Mesh flattened_sphere_mesh() {
  Mesh mesh = icosphere(1, 1);
  mesh.nodes *= Vec3(2, 2, 1.6).asDiagonal();
  mesh = lagrange_mesh(mesh, 2);
  project_nodes(mesh, flattened_sphere());
  return mesh;
}

/// What a flow computes on [0, 0.4] with very small steps on one mesh, by BDF5: the solution without error in
/// time.
template <class Flow>
class SemiDiscreteSolution {
 public:
  using State = typename Flow::State;

  /// Space and initial state of the runs; `variant` is what the flow's constructor takes after the space.
  template <class... Variant>
  SemiDiscreteSolution(const SurfaceSpace& space, State initial, Variant... variant)
      : space_(space), initial_(std::move(initial)), flow_(space, variant...) {
    integrate(flow_, {5, end_time / fine_steps, fine_steps, parse_start("substeps:128")}, initial_,
              [this](int n, const State& state) { states_[n] = state; });
  }

  /// Largest nodal L2 error of a field over the steps n >= q of a run with the given number of
  /// steps.
  double error(int q, int steps, const Start& start, Field State::*field) {
    SymmetricMatrix M = space_.matrix(), A = space_.matrix();
    const auto starting_values = [&](double t) { return states_.at(std::lround(t / end_time * fine_steps)); };
    double largest = 0;
    integrate(flow_, {q, end_time / steps, steps, start},
              {initial_, std::function<State(double)>(starting_values)}, [&](int n, const State& state) {
                if (n < q) return;
                const State& fine = states_.at(n * fine_steps / steps);
                space_.assemble(fine.x, M, A);
                largest = std::max(largest, std::sqrt(M.energy(state.*field - fine.*field)));
              });
    return largest;
  }

  /// From `steps` and twice as many.
  double order(int q, int steps, const Start& start = {}, Field State::*field = &State::v) {
    return std::log2(error(q, steps, start, field) / error(q, 2 * steps, start, field));
  }

 private:
  static constexpr int fine_steps = 1024;
  static constexpr double end_time = 0.4;

  const SurfaceSpace& space_;
  State initial_;
  Flow flow_;
  std::map<int, State> states_;
};

}  // namespace esfem
