// SPDX-License-Identifier: GPL-3.0-or-later
// Orders in time of kll19 (5.1) on one mesh, against a solution with very small steps on the same mesh.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {
namespace {

using State = MeanCurvatureFlow::State;

constexpr int fine_steps = 1024;
const double end_time = 0.4;

/// The semi-discrete solution of the ellipsoid (1, 1, 0.8) scaled by 2 at the times of the finest grid, by
/// BDF5.
class SemiDiscreteSolution {
 public:
  SemiDiscreteSolution() : mesh_(mesh()), space_(mesh_) {
    run({5, end_time / fine_steps, fine_steps, parse_start("substeps:128")}, {},
        [this](int n, const State& state) { states_[n] = state; });
  }

  /// Largest nodal L2 error of v over the steps n >= q of a run with the given number of steps.
  double velocity_error(int q, int steps, const Start& start) {
    SymmetricMatrix M = space_.matrix(), A = space_.matrix();
    const auto starting_values = [&](double t) { return states_.at(std::lround(t / end_time * fine_steps)); };
    double largest = 0;
    run({q, end_time / steps, steps, start}, starting_values, [&](int n, const State& state) {
      if (n < q) return;
      const State& fine = states_.at(n * fine_steps / steps);
      space_.assemble(fine.x, M, A);
      largest = std::max(largest, std::sqrt(M.energy(state.v - fine.v)));
    });
    return largest;
  }

  double order(int q, int steps, const Start& start = {}) {
    return std::log2(velocity_error(q, steps, start) / velocity_error(q, 2 * steps, start));
  }

 private:
  static Surface surface() { return ellipsoid(2, 2, 1.6); }
  static Mesh mesh() {
    Mesh mesh = icosphere(1, 1);
    mesh.nodes *= Vec3(2, 2, 1.6).asDiagonal();
    mesh = lagrange_mesh(mesh, 2);
    project_nodes(mesh, surface());
    return mesh;
  }

  template <class Observer>
  void run(const TimeGrid& grid, const std::function<State(double)>& exact, Observer&& observe) {
    MeanCurvatureFlow flow(space_, {});
    integrate(flow, grid, mean_curvature_state_on(surface(), mesh_.nodes), exact, observe);
  }

  Mesh mesh_;
  SurfaceSpace space_;
  std::map<int, State> states_;
};

SemiDiscreteSolution& solution() {
  static SemiDiscreteSolution instance;
  return instance;
}

// From 256 steps on the orders are asymptotic: from 64 steps BDF3 shows 2.5, BDF4 3.4, BDF5 4.2.
TEST(MeanCurvatureFlowInTime, VelocityHasTheOrderOfTheBdf) {
  const double tolerance = 0.3;
  for (int q : {1, 2, 3, 4, 5}) EXPECT_GE(solution().order(q, 256), q - tolerance) << "BDF" << q;
}

TEST(MeanCurvatureFlowInTime, CascadeOfTheSameStepLosesTheOrder) {
  const double tolerance = 0.3;
  EXPECT_LT(solution().order(3, 256, parse_start("cascade")), 3 - tolerance);
  EXPECT_LT(solution().order(4, 256, parse_start("cascade")), 4 - tolerance);
  EXPECT_GE(solution().order(3, 256, parse_start("substeps:64")), 3 - tolerance);
}

}  // namespace
}  // namespace esfem
