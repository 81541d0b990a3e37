// SPDX-License-Identifier: GPL-3.0-or-later
// Orders in time on one mesh, against a solution with very small steps on the same mesh.
#include <gtest/gtest.h>

#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "tests/flows/reference_case.hpp"
#include "tests/flows/semi_discrete_solution.hpp"

namespace esfem::test_orders_in_time {
namespace {

const SurfaceSpace& space() {
  static const SurfaceSpace instance(flattened_sphere_mesh());
  return instance;
}

SemiDiscreteSolution<MeanCurvatureFlow>& mean_curvature_solution() {
  static SemiDiscreteSolution<MeanCurvatureFlow> instance(
      space(), mean_curvature_state_on(flattened_sphere(), flattened_sphere_mesh().nodes),
      MeanCurvatureFlow::Variant());
  return instance;
}

SemiDiscreteSolution<DziukFlow>& dziuk_solution() {
  static SemiDiscreteSolution<DziukFlow> instance(space(),
                                                  dziuk_state_on(space(), flattened_sphere_mesh().nodes));
  return instance;
}

// From 256 steps on the orders are asymptotic: from 64 steps BDF3 shows 2.5, BDF4 3.4, BDF5 4.2.
TEST(MeanCurvatureFlowInTime, VelocityHasTheOrderOfTheBdf) {
  const double tolerance = 0.3;
  for (int q : {1, 2, 3, 4, 5})
    EXPECT_GE(mean_curvature_solution().order(q, 256), q - tolerance) << "BDF" << q;
}

TEST(MeanCurvatureFlowInTime, CascadeOfTheSameStepLosesTheOrder) {
  const double tolerance = 0.3;
  EXPECT_LT(mean_curvature_solution().order(3, 256, parse_start("cascade")), 3 - tolerance);
  EXPECT_LT(mean_curvature_solution().order(4, 256, parse_start("cascade")), 4 - tolerance);
  EXPECT_GE(mean_curvature_solution().order(3, 256, parse_start("substeps:64")), 3 - tolerance);
}

// BDF 1 to 5 show 0.99, 1.95, 2.91, 3.79, 4.72. Of BDF 4 and 5 this is the behaviour at small tau/h² alone:
// test_dziuk_flow.cpp shows their instability.
TEST(DziukFlowInTime, VelocityHasTheOrderOfTheBdf) {
  const double tolerance = 0.3;
  for (int q : {1, 2, 3, 4, 5}) EXPECT_GE(dziuk_solution().order(q, 256), q - tolerance) << "BDF" << q;
}

SemiDiscreteSolution<WillmoreFlow>& willmore_solution(WillmoreFlow::Variant::Projection projection) {
  using State = WillmoreFlow::State;
  using Variant = WillmoreFlow::Variant;
  // What interpolation of the exact initial values leaves in the fast modes dies out within 0.1 time units;
  // within that layer no method shows its order.
  const auto make = [](Variant::Projection projection) {
    WillmoreFlow::Variant variant;
    variant.projection = projection;
    const WillmoreStart start =
        willmore_start_on(space(), flattened_sphere(), flattened_sphere_mesh().nodes, variant.law, false);
    WillmoreFlow flow(space(), variant);
    const State behind_the_layer = last_state(flow, {2, 2e-4, 500, parse_start("substeps:16")}, start.state);
    return SemiDiscreteSolution<WillmoreFlow>(space(), behind_the_layer, variant);
  };
  static SemiDiscreteSolution<WillmoreFlow> solutions[] = {
      make(Variant::none), make(Variant::in_coefficients), make(Variant::after_steps)};
  return solutions[projection];
}

// The experiment willmore_projection has all orders and fields.
TEST(WillmoreFlowInTime, PositionsAndCurvatureHaveTheOrderOfTheBdf) {
  using State = WillmoreFlow::State;
  const double tolerance = 0.25;
  for (int q : {2, 3})
    for (Field State::*field : {&State::x, &State::u})
      for (const auto projection : {WillmoreFlow::Variant::none, WillmoreFlow::Variant::in_coefficients})
        EXPECT_GE(willmore_solution(projection).order(q, 64, {}, field), q - tolerance) << "BDF" << q;
}

TEST(WillmoreFlowInTime, ProjectionAfterEachStepSpoilsTheOrder) {
  using State = WillmoreFlow::State;
  for (int q : {2, 3})
    EXPECT_LT(willmore_solution(WillmoreFlow::Variant::after_steps).order(q, 64, {}, &State::u), 1)
        << "BDF" << q;
}

}  // namespace
}  // namespace esfem::test_orders_in_time
