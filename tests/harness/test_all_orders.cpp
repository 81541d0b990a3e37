// SPDX-License-Identifier: GPL-3.0-or-later
// Errors against small steps, and what all_orders makes of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/harness/all_orders_problems.hpp"
#include "experiments/harness/richardson.hpp"
#include "experiments/harness/small_steps.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/tables/claims.hpp"
#include "solver/time/last_state.hpp"
#include "tests/time/linear_ode.hpp"

namespace esfem::test_all_orders {
namespace {

/// Of an equation without error in space, against BDF5 with 1,024 steps.
struct OfLinearOde : testing::Test {
  LinearOde flow;
  SmallSteps<LinearOde> small{flow, {5, 1.0 / 1024, 1024, {}}, LinearOde::exact(0), LinearOde::exact, 8};

  /// The largest error of u from the step 8 on.
  double error(int q, double tau) {
    double largest = 0;
    small.compare(q, tau, 8, [&](int, const LinearOde::State& state, const LinearOde::State& exact) {
      EXPECT_DOUBLE_EQ(state.t, exact.t);
      largest = std::max(largest, (state.u - exact.u).norm());
    });
    return largest;
  }
};

TEST_F(OfLinearOde, ErrorsHaveTheOrderOfTheBdf) {
  for (int q = 1; q <= 5; ++q) EXPECT_NEAR(std::log2(error(q, 1.0 / 64) / error(q, 1.0 / 128)), q, 0.2) << q;
}

TEST_F(OfLinearOde, LowerOrderOfExtrapolationShows) {
  flow.orders_dropped = 1;
  EXPECT_NEAR(std::log2(error(3, 1.0 / 64) / error(3, 1.0 / 128)), 2, 0.3);
}

TEST_F(OfLinearOde, EachStepFromTheFirstOnIsObserved) {
  std::vector<int> steps;
  small.compare(3, 1.0 / 16, 5,
                [&](int n, const LinearOde::State&, const LinearOde::State&) { steps.push_back(n); });
  EXPECT_THAT(steps, testing::ElementsAre(5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16));
}

TEST(LargestDifferencesTest, AreTheNormsOfTheColumnsOfAQuantity) {
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  project_nodes(mesh, sphere(1));
  const SurfaceSpace space(mesh);
  LargestDifferences differences(space, {{"c", 1}, {"x", 3}});
  const double area = 4 * pi;
  for (const double factor : {0.5, 2.0, 1.0}) {
    Field columns(mesh.nodes.rows(), 4);
    columns << Field::Constant(mesh.nodes.rows(), 1, 3), factor * mesh.nodes;
    differences.add(mesh.nodes, columns);
  }
  EXPECT_NEAR(differences.errors().at("c").at("nodal_L2"), 3 * std::sqrt(area), 1e-3);
  EXPECT_NEAR(differences.errors().at("c").at("nodal_H1_semi"), 0, 1e-6);
  // |x|² = 1 and |grad x|² = 2; the largest factor is 2.
  EXPECT_NEAR(differences.errors().at("x").at("nodal_L2"), 2 * std::sqrt(area), 1e-3);
  EXPECT_NEAR(differences.errors().at("x").at("nodal_H1"), 2 * std::sqrt(3 * area), 1e-2);
}

OrdersOfFlow flow_named(const std::string& name) {
  for (const OrdersOfFlow& flow : orders_of_flows()) {
    if (flow.flow == name) return flow;
  }
  throw InputError("no flow " + name);
}

/// The coupled problem on 32 linear elements, its small steps 0.1 2^-7.
Row coupled_row(int bdf, int k) {
  const OrdersOfFlow flow = flow_named("coupled_diffusion");
  return run_all_orders({flow, 1, bdf, true, 0, 7}, planned_row(0, flow.time, k));
}

TEST(AllOrders, OneRowOfALowerBdfSpoilsTheOrder) {
  Claim claim;
  claim.variable = "tau";
  claim.quantity = "u";
  claim.norm = "nodal_H1";
  claim.expected = 3;
  claim.tolerance = 0.25;
  Table table;
  for (const int k : {3, 4, 5}) table.rows.push_back(coupled_row(3, k));
  EXPECT_TRUE(check_claim(claim, table).met()) << check_claim(claim, table).reason;
  EXPECT_EQ(table.rows[0].values.at("unstable"), 0);
  // The run with 2 tau is that of the row before.
  EXPECT_NEAR(table.rows[1].values.at("u_nodal_H1_double"), table.rows[0].errors.at("u").at("nodal_H1"),
              1e-12);
  table.rows[2] = coupled_row(2, 5);
  EXPECT_FALSE(check_claim(claim, table).met());
}

/// u at t = 1 with step sizes tau, 2 tau, ..
std::vector<Field> values_of_linear_ode(int q, double tau, int count) {
  LinearOde flow;
  std::vector<Field> values;
  for (int i = 0; i < count; ++i, tau *= 2) {
    const int steps = static_cast<int>(std::lround(1 / tau));
    values.push_back(last_state(flow, {q, tau, steps, {}}, {LinearOde::exact(0), LinearOde::exact}).u);
  }
  return values;
}

/// The order in tau of what is extrapolated from `count` values, taken to be those of a method of order p.
double order_of_extrapolated_values(int q, int count, int p) {
  const auto error = [&](double tau) {
    return (richardson(values_of_linear_ode(q, tau, count), p) - LinearOde::exact(1).u).norm();
  };
  return std::log2(error(1.0 / 256) / error(1.0 / 512));
}

TEST(Richardson, OfBdf1To3IsOfOrder4) {
  for (int q = 1; q <= 3; ++q) EXPECT_NEAR(order_of_extrapolated_values(q, 5 - q, q), 4, 0.3) << q;
}

TEST(Richardson, WithTheOrderOfAnotherMethodGainsNothing) {
  for (int q = 1; q <= 3; ++q) EXPECT_NEAR(order_of_extrapolated_values(q, 5 - q, q + 1), q, 0.3) << q;
}

TEST(Richardson, OneValueStays) {
  EXPECT_EQ(richardson({Field::Constant(2, 3, 7)}, 1), Field::Constant(2, 3, 7));
}

/// One run in space on the coarsest mesh that all degrees have.
Row row_in_space(OrdersOfFlow flow, int degree, int bdf, int k) {
  return run_all_orders({flow, degree, bdf, false, 1, 0}, planned_row(1, flow.space, k));
}

/// BDF1 in space for the growing sphere with P3, extrapolated as if its error in tau began with that power.
Row extrapolated_row(int first_power) {
  const OrdersOfFlow flow = flow_named("coupled_diffusion");
  return run_all_orders({flow, 3, 1, false, 1, 0, first_power}, planned_row(1, flow.space, 6));
}

TEST(AllOrders, ExtrapolatedInTimeTheErrorIsThatInSpace) {
  const Row row = extrapolated_row(1), bdf4 = row_in_space(flow_named("coupled_diffusion"), 3, 4, 5);
  for (const std::string quantity : {"x", "v", "u"}) {
    EXPECT_LT(row.values.at(quantity + "_lifted_L2_share"), largest_share) << quantity;
    EXPECT_EQ(row.values.count(quantity + "_lifted_L2_hidden"), 0u) << quantity;
    EXPECT_NEAR(row.errors.at(quantity).at("lifted_L2") / bdf4.errors.at(quantity).at("lifted_L2"), 1, 0.02)
        << quantity;
  }
}

TEST(AllOrders, WithoutExtrapolationOrWithThatOfAnotherOrderTheErrorIsHidden) {
  for (const int first_power : {2, 3, order_of_extrapolated}) {
    const Row row = extrapolated_row(first_power);
    for (const std::string quantity : {"x", "v", "u"}) {
      EXPECT_GT(row.values.at(quantity + "_lifted_L2_share"), largest_share) << quantity << first_power;
      EXPECT_GT(row.values.at(quantity + "_lifted_L2_hidden"), 0) << quantity << first_power;
      EXPECT_EQ(row.errors.count(quantity) ? row.errors.at(quantity).count("lifted_L2") : 0, 0u);
    }
  }
}

TEST(AllOrders, LargerStepsThatDoNotEndInTimeAreNotTaken) {
  EXPECT_THROW(row_in_space(flow_named("coupled_diffusion"), 1, 1, 2), std::logic_error);
}

TEST(AllOrders, DziuksSchemeIsUnstableWithBdf5) {
  OrdersOfFlow flow = flow_named("dziuk");
  flow.space_h = {0.63, 0.94};
  EXPECT_EQ(row_in_space(flow, 2, 3, 2).values.at("unstable"), 0);
  const Row unstable = row_in_space(flow, 2, 5, 2);
  EXPECT_EQ(unstable.values.at("unstable"), 1);
  EXPECT_TRUE(unstable.errors.empty());
}

TEST(AllOrders, AFlowWithoutProblemRunsNoOther) {
  OrdersOfFlow flow = flow_named("mean_curvature");
  flow.flow = "mean";
  EXPECT_THROW(row_in_space(flow, 2, 2, 1), std::logic_error);
}

TEST(SmallStepsTest, MustGiveAllStartingValues) {
  EXPECT_NO_THROW(require_starting_values(2, 4, 0.1, 0.4));
  try {
    require_starting_values(1, 4, 0.2, 0.4);
    FAIL() << "four steps of 0.2 are no starting values at 0.4";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "--steps: found 1, expected more: BDF4 needs 4 steps of 0.2 before t = 0.4");
  }
}

TEST(LastState, IsThatOfTheLastStep) {
  LinearOde flow;
  EXPECT_DOUBLE_EQ(last_state(flow, {2, 0.25, 4, {}}, {LinearOde::exact(0), LinearOde::exact}).t, 1);
  EXPECT_DOUBLE_EQ(last_state(flow, {2, 0.25, 0, {}}, {LinearOde::exact(0), LinearOde::exact}).t, 0);
}

}  // namespace
}  // namespace esfem::test_all_orders
