// SPDX-License-Identifier: GPL-3.0-or-later
// Orders in time on one mesh, against a solution with very small steps on the same mesh.
#include <gtest/gtest.h>

#include "solver/flows/dziuk_flow.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "tests/flows/semi_discrete_solution.hpp"

namespace esfem {
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

}  // namespace
}  // namespace esfem
