// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "solver/time/integrate.hpp"
#include "tests/time/linear_ode.hpp"

namespace esfem::test_integrate {
namespace {

double max_error(int q, Start start, int steps, int orders_dropped = 0) {
  LinearOde ode;
  ode.orders_dropped = orders_dropped;
  double error = 0;
  integrate(ode, {q, 1.0 / steps, steps, start}, {LinearOde::exact(0), LinearOde::exact},
            [&](int, const LinearOde::State& state) {
              const LinearOde::State exact = LinearOde::exact(state.t);
              error = std::max({error, (state.x - exact.x).norm(), (state.u - exact.u).norm()});
            });
  return error;
}

/// Halves the step size until round-off shows; the mean of the last two slopes.
double observed_order(int q, Start start, int orders_dropped = 0) {
  std::vector<double> errors;
  for (int steps = 16; steps <= 1024; steps *= 2) {
    const double error = max_error(q, start, steps, orders_dropped);
    if (error < 1e-11) break;
    errors.push_back(error);
  }
  if (errors.size() < 3) return 0;
  return std::log2(errors[errors.size() - 3] / errors.back()) / 2;
}

bool shows_order(int q, double observed) {
  return observed + 0.1 > q;
}

const Start exact{Start::exact, 1}, cascade{Start::cascade, 1}, substeps16{Start::substeps, 16};

TEST(Integrate, ShowsItsOrderFromExactStartingValues) {
  for (int q = 1; q <= max_bdf_order; ++q) {
    const double order = observed_order(q, exact);
    EXPECT_TRUE(shows_order(q, order)) << "q = " << q << ": " << order;
  }
}

TEST(Integrate, GoesOnFromTheStatesOfAnEarlierRunBitForBit) {
  for (int q = 1; q <= max_bdf_order; ++q) {
    LinearOde ode;
    const auto until = [&](UniformSteps steps, const StartingValues<LinearOde::State>& start,
                           History<LinearOde::State>& past) {
      integrate_keeping(past, ode, steps, start, nullptr, [](int, const LinearOde::State&) {});
    };
    const UniformSteps whole = {q, 0.1, 12, substeps16, 0, 0.3};
    History<LinearOde::State> expected(q), middle(q), end(q), alone(q);
    until(whole, {LinearOde::exact(0)}, expected);
    UniformSteps part = whole;
    part.steps = 7;
    until(part, {LinearOde::exact(0)}, middle);
    EXPECT_EQ(middle.back(0).t, whole.time(7));
    StartingValues<LinearOde::State> start(middle.back(0));
    part = {q, 0.1, 5, exact, 7, 0.3};
    if (q > 1) {
      EXPECT_THROW(until(part, start, alone), InputError) << "the states before are not known";
    }
    for (int j = 1; j < q; ++j) start.before.push_back(middle.back(j));
    until(part, start, end);
    EXPECT_EQ(end.back(0).t, expected.back(0).t);
    EXPECT_EQ(end.back(0).x, expected.back(0).x) << q;
    EXPECT_EQ(end.back(0).u, expected.back(0).u) << q;
  }
}

TEST(Integrate, ShowsTheSubstepsOfTheStart) {
  LinearOde ode;
  StartingValues<LinearOde::State> start(LinearOde::exact(0));
  std::vector<double> times;
  start.after_substep = [&](double t) { times.push_back(t); };
  integrate(ode, UniformSteps{3, 0.5, 4, {Start::substeps, 2}, 0, 1}, start,
            [](int, const LinearOde::State&) {});
  EXPECT_THAT(times, testing::ElementsAre(1.25, 1.5, 1.75, 2));
}

TEST(Integrate, ExtrapolationOfALowerOrderShows) {
  for (int q = 2; q <= max_bdf_order; ++q) {
    const double order = observed_order(q, exact, 1);
    EXPECT_FALSE(shows_order(q, order)) << "q = " << q << ": " << order;
  }
}

TEST(Integrate, CascadeGivesOrderTwoAtMost) {
  EXPECT_TRUE(shows_order(2, observed_order(2, cascade)));
  for (int q = 3; q <= max_bdf_order; ++q) {
    const double order = observed_order(q, cascade);
    EXPECT_FALSE(shows_order(q, order)) << "q = " << q << ": " << order;
    EXPECT_NEAR(order, 2, 0.2) << "q = " << q;
  }
}

TEST(Integrate, SubstepsRestoreTheOrder) {
  // The first substep leaves an error (tau/16)^2: order 3 shows until tau^3 is of that size.
  const auto order = [](Start start) {
    return std::log2(max_error(3, start, 16) / max_error(3, start, 64)) / 2;
  };
  EXPECT_TRUE(shows_order(3, order(substeps16))) << order(substeps16);
  EXPECT_FALSE(shows_order(3, order(cascade))) << order(cascade);
  for (int q = 3; q <= max_bdf_order; ++q)
    EXPECT_LT(max_error(q, substeps16, 32), max_error(q, cascade, 32) / 10) << "q = " << q;
}

TEST(Integrate, ObservesEveryStateAtItsTime) {
  for (const Start& start : {exact, cascade, substeps16})
    for (int steps : {0, 1, 2, 3, 10}) {
      LinearOde ode;
      int expected = 0;
      LinearOde::State initial = LinearOde::exact(0);
      initial.t = 7;
      integrate(ode, {3, 0.1, steps, start}, {initial, LinearOde::exact},
                [&](int n, const LinearOde::State& state) {
                  EXPECT_EQ(n, expected++);
                  EXPECT_EQ(state.t, n * 0.1);
                  EXPECT_LT((state.u - LinearOde::exact(state.t).u).norm(), 0.1);
                });
      EXPECT_EQ(expected, steps + 1);
    }
}

TEST(Integrate, OneSubstepIsTheCascade) {
  EXPECT_EQ(max_error(4, {Start::substeps, 1}, 20), max_error(4, cascade, 20));
}

TEST(Integrate, TakesGivenTimes) {
  const auto largest_error = [](int order, int steps) {
    std::vector<double> times = {0};
    while (static_cast<int>(times.size()) <= steps)
      times.push_back(times.back() + (times.size() % 2 ? 1.2 : 0.8) / steps);
    LinearOde ode;
    double largest = 0;
    int expected = 0;
    const StepCount done = integrate(
        ode, GivenTimes{order, times}, LinearOde::exact(0), [&](int n, const LinearOde::State& state) {
          EXPECT_EQ(n, expected++);
          EXPECT_EQ(state.t, times[n]);
          largest = std::max(largest, (state.u - LinearOde::exact(state.t).u).norm());
        });
    EXPECT_EQ(done.steps, steps);
    return largest;
  };
  for (int order : {1, 2})
    EXPECT_NEAR(std::log2(largest_error(order, 100) / largest_error(order, 200)), order, 0.1);
  for (const std::vector<double>& bad : {std::vector<double>{}, {0, 1, 1}})
    EXPECT_THROW(check_steps(GivenTimes{1, bad}), InputError);
}

TEST(Integrate, CanStartLaterAndAsksEachObserver) {
  LinearOde ode;
  std::vector<int> first, second;
  const auto note = [](std::vector<int>& steps) {
    return [&steps](int n, const LinearOde::State& state) {
      EXPECT_DOUBLE_EQ(state.t, 0.1 * (4 + n));
      EXPECT_LT((state.u - LinearOde::exact(state.t).u).norm(), 0.1);
      steps.push_back(n);
    };
  };
  integrate(ode, {2, 0.1, 3, {}, 4}, {LinearOde::exact(0.4), LinearOde::exact}, note(first), note(second));
  EXPECT_EQ(first, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(second, first);
}

/// The error message of a run that is expected to fail; empty when it does not.
template <class Flow, class Error = NumericsError>
std::string failure(Flow flow, const UniformSteps& grid,
                    const std::function<LinearOde::State(double)>& exact_state = LinearOde::exact) {
  try {
    integrate(flow, grid, {LinearOde::exact(0), exact_state}, [](int, const auto&) {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

struct BecomesNonFinite : LinearOde {
  using State = LinearOde::State;
  double from = 0;
  void step(const BdfStep<State>& step, State& next) {
    LinearOde::step(step, next);
    if (next.t >= from) next.v(0, 1) = std::numeric_limits<double>::quiet_NaN();
  }
};

TEST(Integrate, NonFiniteValuesAreErrorsWithStepAndTime) {
  using testing::AllOf, testing::HasSubstr;
  BecomesNonFinite flow;
  flow.from = 0.55;
  EXPECT_THAT(failure(flow, {2, 0.1, 10, exact}),
              AllOf(HasSubstr("step 6"), HasSubstr("t = 0.6"),
                    HasSubstr("non-finite value of v at node 1 (counted from 1)")));
  flow.from = 0.15;
  EXPECT_THAT(failure(flow, {3, 0.1, 10, {Start::substeps, 4}}),
              AllOf(HasSubstr("step 2"), HasSubstr("substep 2 of 4"), HasSubstr("non-finite")));
  flow.from = 0.15;
  EXPECT_THAT(failure(flow, {3, 0.1, 10, cascade}), HasSubstr("step 2"));
  flow.from = 2;
  EXPECT_EQ(failure(flow, {3, 0.1, 10, cascade}), "");
}

struct BecomesSingular : LinearOde {
  using State = LinearOde::State;
  double from = 0;
  void step(const BdfStep<State>& step, State& next) {
    LinearOde::step(step, next);
    if (next.t >= from) throw SingularityError("element 3 is too thin");
  }
};

TEST(Integrate, SingularitiesKeepTheirTypeAndSayWhen) {
  BecomesSingular flow;
  flow.from = 0.55;
  EXPECT_EQ((failure<BecomesSingular, SingularityError>(flow, {2, 0.1, 10, exact})),
            "singular at t = 0.6 (step 6): element 3 is too thin");
  flow.from = 0.15;
  EXPECT_EQ((failure<BecomesSingular, SingularityError>(flow, {3, 0.1, 10, {Start::substeps, 4}})),
            "singular at t = 0.2 (step 2): element 3 is too thin");
}

TEST(Integrate, ExactStartNeedsAnExactSolution) {
  const auto says = [](int q, Start start) {
    return failure<LinearOde, InputError>({}, {q, 0.1, 5, start}, nullptr);
  };
  EXPECT_THAT(says(2, exact), testing::HasSubstr("cascade or substeps:K"));
  EXPECT_EQ(says(1, exact), "");
  EXPECT_EQ(says(2, cascade), "");
}

TEST(Integrate, BadGridsAreErrors) {
  for (const UniformSteps& grid : {UniformSteps{6, 0.1, 5, {}},
                                   {0, 0.1, 5, {}},
                                   {2, 0, 5, {}},
                                   {2, -1, 5, {}},
                                   {2, std::nan(""), 5, {}},
                                   {2, 0.1, -1, {}},
                                   {2, 0.1, 5, {Start::substeps, 0}}})
    EXPECT_THROW(check_steps(grid), InputError);
  EXPECT_NO_THROW(check_steps(UniformSteps{5, 0.1, 0, {}}));
}

TEST(Start, ParsesWhatItPrints) {
  for (const char* text : {"exact", "cascade", "substeps:1", "substeps:16"})
    EXPECT_EQ(to_string(parse_start(text)), text);
  for (const char* text : {"", "Exact", "substeps", "substeps:", "substeps:0", "substeps:-2", "substeps:4x",
                           "substeps: 4", "substeps:99999999999", "exact "}) {
    try {
      parse_start(text);
      ADD_FAILURE() << "'" << text << "' was accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("expected exact, cascade or substeps:K"));
    }
  }
}

}  // namespace
}  // namespace esfem::test_integrate
