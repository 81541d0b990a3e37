// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/flows/factor_service.hpp"

namespace esfem::test_factor_service {
namespace {

/// Steps that factors serve when step n takes iterations(n).
template <class Iterations>
int steps_served(double cost, const Iterations& iterations) {
  FactorService service(cost);
  EXPECT_TRUE(service.is_over()) << "there are no factors yet";
  service.start();
  int steps = 0;
  while (!service.is_over()) service.add_step(iterations(++steps));
  return steps;
}

/// Iterations a step, with the factorisation, for factors that serve n steps.
double cost_of_a_step(double cost, int n) {
  for (int step = 1; step <= n; ++step) cost += 5 + step / 3;
  return cost / (n > 0 ? n : 1);
}

TEST(FactorService, IsLongWhereIterationsStayAsTheyAre) {
  EXPECT_EQ(steps_served(2, [](int) { return 5; }), 50);
  EXPECT_EQ(steps_served(2, [](int n) { return n < 10 ? 15 - n : 5; }), 50);
}

TEST(FactorService, EndsWhereAStepIsCheapest) {
  const int served = steps_served(4, [](int n) { return 5 + n / 3; });
  for (int other = 1; other <= 50; ++other)
    EXPECT_LE(cost_of_a_step(4, served), 1.05 * cost_of_a_step(4, other)) << other;
}

TEST(FactorService, RunsOnFromItsProgress) {
  FactorService service(2), resumed(2);
  service.start();
  for (const int iterations : {3, 3, 4}) service.add_step(iterations);
  resumed.start();
  resumed.resume(service.progress());
  EXPECT_EQ(resumed.progress(), service.progress());
  service.end();
  EXPECT_TRUE(service.is_over());
  EXPECT_FALSE(service.serves());
}

}  // namespace
}  // namespace esfem::test_factor_service
