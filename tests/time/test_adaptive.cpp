// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/time/integrate.hpp"
#include "tests/time/linear_ode.hpp"

namespace esfem::test_adaptive {
namespace {

/// The broken variant: the weights of equal steps whatever the steps are.
struct EqualStepWeights : LinearOde {
  using State = LinearOde::State;
  void step(const BdfStep<State>& step, State& next) {
    std::array<const State*, max_bdf_order> past = {};
    for (int j = 0; j < step.order; ++j) past[j] = &step.past(j);
    LinearOde::step({step.t, step.tau, step.order, bdf_weights(step.order), past}, next);
  }
};

struct Result {
  double error = 0, end = 0;
  StepCount run;
};

template <class Flow = LinearOde>
Result run(const AdaptiveSteps& grid) {
  Flow ode;
  Result result;
  int expected = 0;
  result.run = integrate(ode, grid, LinearOde::exact(0), [&](int n, const LinearOde::State& state) {
    EXPECT_EQ(n, expected++);
    const LinearOde::State exact = LinearOde::exact(state.t);
    result.error = std::max({result.error, (state.x - exact.x).norm(), (state.u - exact.u).norm()});
    result.end = state.t;
  });
  EXPECT_EQ(result.run.steps, expected - 1);
  return result;
}

/// The exponent p of error = C tolerance^p; 0 when no step satisfies the controller.
template <class Flow = LinearOde>
double order_in_tolerance(int order) {
  const auto error = [&](double tolerance) { return run<Flow>({"u", order, 2, tolerance, 1e-6, 0}).error; };
  try {
    return std::log(error(1e-4) / error(1e-7)) / std::log(1e3);
  } catch (const NumericsError&) {
    return 0;
  }
}

// The estimate is of second order in the step size, so that tolerance^(1/2) is the step size.
TEST(Adaptive, ErrorFollowsTheTolerance) {
  EXPECT_NEAR(order_in_tolerance(2), 1, 0.1);
  EXPECT_NEAR(order_in_tolerance(1), 0.5, 0.05);
}

TEST(Adaptive, WeightsOfEqualStepsLoseTheOrder) {
  EXPECT_LT(order_in_tolerance<EqualStepWeights>(2), 0.8);
}

TEST(Adaptive, ToleranceIsInUnitsOfTheControlledField) {
  AdaptiveSteps grid = {"u", 2, 2, 1e-5, 1e-6, 0};
  grid.units.assign(LinearOde::exact(0).u.cols(), 16);
  const Result in_units = run(grid), plain = run({"u", 2, 2, 16e-5, 1e-6, 0});
  EXPECT_EQ(in_units.run.steps, plain.run.steps);
  EXPECT_NEAR(in_units.error, plain.error, 1e-10);
  grid.units.push_back(1);
  EXPECT_THROW(run(grid), InputError);
}

TEST(Adaptive, EndsAtTheEndTime) {
  for (const double end : {1e-7, 1e-6, 1.5e-6, 0.1, 1.0 / 3, 2.0})
    for (const double tolerance : {1e-2, 1e-5}) EXPECT_EQ(run({"u", 2, end, tolerance, 1e-6, 0}).end, end);
  EXPECT_EQ(run({"u", 2, 0, 1e-3, 1e-6, 0}).run.steps, 0);
  EXPECT_EQ(run({"u", 2, 1, 1, 0.1, 0.1}).run.steps, 10) << "no sliver at the end";
}

TEST(Adaptive, StepsStayWithinTheirBounds) {
  const AdaptiveSteps grid = {"u", 2, 1, 1e-2, 1e-4, 0.02};
  std::vector<double> times;
  LinearOde ode;
  integrate(ode, grid, LinearOde::exact(0),
            [&](int, const LinearOde::State& state) { times.push_back(state.t); });
  EXPECT_DOUBLE_EQ(times[1], 1e-4);
  double largest = 0;
  for (std::size_t n = 1; n < times.size(); ++n) largest = std::max(largest, times[n] - times[n - 1]);
  EXPECT_NEAR(largest, 0.02, 1e-12);
  for (std::size_t n = 2; n < times.size(); ++n)
    EXPECT_LE(times[n] - times[n - 1], 1.5 * (times[n - 1] - times[n - 2]) * (1 + 1e-9));
}

TEST(Adaptive, TooLargeStepsAreRejected) {
  const Result large = run({"u", 2, 1, 1e-5, 0.01, 0}), small = run({"u", 2, 1, 1e-5, 1e-6, 0});
  EXPECT_GE(large.run.rejected, 3);
  EXPECT_EQ(small.run.rejected, 0);
  EXPECT_LT(large.error, 1e-3) << "of the first step, which is not controlled";
  EXPECT_THROW(run({"u", 2, 1, 1e-5, 0.1, 0}), NumericsError)
      << "after such a first step no step is small enough";
}

/// epsilon u' = cos t - u with u(0) = 2: a layer of width epsilon, then u near cos t.
struct Layer {
  struct State {
    double t = 0;
    Field u;
    static constexpr NamedField<State> fields[] = {{"u", &State::u}};
  };
  double epsilon = 1e-4;
  Field known;

  double exact(double t) const {
    const double e2 = epsilon * epsilon, start = 2 - 1 / (1 + e2);
    return (std::cos(t) + epsilon * std::sin(t)) / (1 + e2) + start * std::exp(-t / epsilon);
  }
  void step(const BdfStep<State>& step, State& next) {
    step.known_sum(&State::u, known);
    next.u = (step.tau / epsilon * Field::Constant(1, 1, std::cos(next.t)) - known) /
             (step.delta[0] + step.tau / epsilon);
  }
};

TEST(Adaptive, ResolvesAnInitialLayer) {
  const auto solve = [](double tolerance) {
    Layer layer;
    std::vector<double> times;
    double error = 0;
    integrate(layer, AdaptiveSteps{"u", 2, 1, tolerance, 1e-7, 0}, Layer::State{0, Field::Constant(1, 1, 2)},
              [&](int, const Layer::State& state) {
                times.push_back(state.t);
                error = std::max(error, std::abs(state.u(0, 0) - layer.exact(state.t)));
              });
    return std::make_pair(times, error);
  };
  const auto [times, error] = solve(1e-4);
  EXPECT_LT(error, 1e-4);
  EXPECT_LT(times.size(), 400u) << "equal steps as small as the layer's first would be ten million";
  const auto in_layer = std::lower_bound(times.begin(), times.end(), 1e-3) - times.begin();
  EXPECT_GT(in_layer, int(times.size()) / 2);
  EXPECT_NEAR(std::log10(solve(1e-3).second / solve(1e-5).second) / 2, 1, 0.1);
}

struct FailsBeyond : LinearOde {
  using State = LinearOde::State;
  double from = 0.5, smallest_step = 0;
  int failures = 0;
  void step(const BdfStep<State>& step, State& next) {
    LinearOde::step(step, next);
    if (next.t < from || step.tau < smallest_step) return;
    ++failures;
    throw SingularityError("element 3 is too thin");
  }
};

TEST(Adaptive, AFailedStepIsRepeatedWithHalfItsSize) {
  FailsBeyond flow;
  flow.smallest_step = 0.01;
  double end = 0;
  const StepCount run = integrate(flow, AdaptiveSteps{"u", 2, 0.6, 1, 0.1, 0}, LinearOde::exact(0),
                                  [&](int, const LinearOde::State& state) { end = state.t; });
  EXPECT_EQ(end, 0.6);
  EXPECT_GT(flow.failures, 0);
  EXPECT_EQ(run.rejected, flow.failures);
}

TEST(Adaptive, AStepThatFailsHoweverSmallItIsEndsTheRun) {
  using testing::AllOf, testing::HasSubstr;
  FailsBeyond flow;
  double last = 0;
  try {
    integrate(flow, AdaptiveSteps{"u", 2, 1, 1, 0.01, 0}, LinearOde::exact(0),
              [&](int, const LinearOde::State& state) { last = state.t; });
    ADD_FAILURE() << "no error";
  } catch (const SingularityError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("singular at t = 0.5"), HasSubstr("element 3 is too thin")));
  }
  EXPECT_GT(last, 0.499);
  EXPECT_LT(last, 0.5);
}

/// u jumps at t = 0.5, which no step size resolves.
struct Jumps : LinearOde {
  using State = LinearOde::State;
  void step(const BdfStep<State>& step, State& next) {
    LinearOde::step(step, next);
    if (next.t > 0.5) next.u.array() += 10;
  }
};

TEST(Adaptive, AnEstimateThatStaysTooLargeIsAnError) {
  using testing::AllOf, testing::HasSubstr;
  Jumps flow;
  try {
    integrate(flow, AdaptiveSteps{"u", 2, 1, 1e-2, 0.01, 0}, LinearOde::exact(0),
              [](int, const LinearOde::State&) {});
    ADD_FAILURE() << "no error";
  } catch (const NumericsError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("t = 0.5"), HasSubstr("estimated error 14.1"),
                                    HasSubstr("at most 0.04 expected")));
  }
}

TEST(Adaptive, FactorsAreBounded) {
  EXPECT_EQ(step_factor(1e-3, 0), 1.5);
  EXPECT_EQ(step_factor(1e-3, 1e-9), 1.5);
  EXPECT_EQ(step_factor(1e-3, 1), 0.5);
  EXPECT_NEAR(step_factor(1e-3, 1e-3), 0.9, 1e-15);
  Field rows(2, 3);
  rows << 3, 0, 4, 0, 5, 0;
  EXPECT_NEAR(root_mean_square(rows), 5, 1e-15) << "the mean is over the rows";
}

TEST(Adaptive, BadGridsAreErrors) {
  for (const AdaptiveSteps& grid : {AdaptiveSteps{"u", 3, 1, 1e-3, 1e-6, 0},
                                    {"u", 0, 1, 1e-3, 1e-6, 0},
                                    {"u", 2, -1, 1e-3, 1e-6, 0},
                                    {"u", 2, INFINITY, 1e-3, 1e-6, 0},
                                    {"u", 2, 1, 0, 1e-6, 0},
                                    {"u", 2, 1, NAN, 1e-6, 0},
                                    {"u", 2, 1, 1e-3, 0, 0},
                                    {"u", 2, 1, 1e-3, 1e-14, 0},
                                    {"u", 2, 1, 1e-3, 1e-6, 1e-7},
                                    {"u", 2, 1, 1e-3, 1e-6, NAN},
                                    {"u", 2, 1, 1e-3, 1e-6, 0, {1, 0}}})
    EXPECT_THROW(check_steps(grid), InputError);
  EXPECT_NO_THROW(check_steps(AdaptiveSteps{"u", 1, 0, 1e-3, 1e-6, 1e-6}));
}

}  // namespace
}  // namespace esfem::test_adaptive
