// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "solver/time/history.hpp"
#include "tests/time/linear_ode.hpp"

namespace esfem::test_history {
namespace {

struct State {
  double t = 0;
  Field x;
  static constexpr NamedField<State> fields[] = {{"x", &State::x}};
};

State constant(double value) {
  return {value, Field::Constant(3, 2, value)};
}

TEST(History, KeepsTheNewestStates) {
  History<State> history(3);
  for (int n = 0; n < 5; ++n) {
    State next = constant(n);
    history.push(next);
    EXPECT_EQ(history.size(), std::min(n + 1, 3));
    for (int j = 0; j < history.size(); ++j) {
      EXPECT_EQ(history.back(j).t, n - j);
      EXPECT_EQ(history.back(j).x(2, 1), n - j);
    }
  }
  EXPECT_THROW(history.back(3), InputError);
  EXPECT_THROW(history.back(-1), InputError);
}

TEST(History, ReusesTheStorageOfTheOldestState) {
  History<State> history(2);
  State next = constant(0);
  history.push(next);
  ASSERT_EQ(next.x.size(), 6);
  history.push(next);
  const double* oldest = history.back(1).x.data();
  const double* newest = next.x.data();
  history.push(next);
  EXPECT_EQ(next.x.data(), oldest);
  EXPECT_EQ(history.back(0).x.data(), newest);
}

TEST(History, ExtrapolatesAndSumsAQuadratic) {
  History<State> history(3);
  const double tau = 0.1;
  const auto value = [](double t) { return 2 - t + 3 * t * t; };
  for (int n = 0; n < 4; ++n) {
    State next = constant(value(n * tau));
    history.push(next);
  }
  const BdfStep<State> step = history.equal_step(3, tau, 4 * tau);
  Field out;
  step.extrapolate(&State::x, out);
  EXPECT_TRUE(out.isApprox(Field::Constant(3, 2, value(4 * tau)), 1e-13));
  step.known_sum(&State::x, out);
  const double derivative = (step.delta[0] * value(4 * tau) + out(0, 0)) / tau;
  EXPECT_NEAR(derivative, -1 + 6 * 4 * tau, 1e-12);
  history.equal_step(2, tau, 4 * tau).extrapolate(&State::x, out);
  EXPECT_FALSE(out.isApprox(Field::Constant(3, 2, value(4 * tau)), 1e-3)) << "order 2 is not exact here";
}

TEST(History, AStepToATimeIsExactOnUnequalSteps) {
  const auto value = [](double t) { return 2 - t + 3 * t * t; };
  const double times[] = {0, 0.1, 0.13, 0.3}, t = 0.37;
  History<State> history(3);
  for (const double s : times) {
    State next = constant(value(s));
    next.t = s;
    history.push(next);
  }
  const auto derivative = [&](const BdfStep<State>& step) {
    Field out;
    step.known_sum(&State::x, out);
    return (step.delta[0] * value(t) + out(0, 0)) / (t - 0.3);
  };
  EXPECT_GT(std::abs(derivative(history.equal_step(2, t - 0.3, t)) - (-1 + 6 * t)), 0.03)
      << "the weights of equal steps";
  EXPECT_NEAR(derivative(history.step_to(t, 2)), -1 + 6 * t, 1e-12);
  EXPECT_EQ(history.step_to(t, 2).tau, t - 0.3);
  EXPECT_EQ(&history.step_to(t, 2).past(1), &history.back(1));
  Field out;
  history.step_to(t, 3).extrapolate(&State::x, out);
  EXPECT_TRUE(out.isApprox(Field::Constant(3, 2, value(t)), 1e-13));
  EXPECT_THROW(history.step_to(0.3, 2), InputError);
  EXPECT_THROW(history.step_to(t, 4), InputError);
}

/// The error at t = 1 of BDF2 on steps that are alternately short and long.
double error_on_unequal_steps(int pairs, bool takes_note) {
  LinearOde ode;
  History<LinearOde::State> history(2);
  const double tau = 0.4 / pairs;
  LinearOde::State next;
  for (const double t : {-1.5 * tau, 0.0}) {
    next = LinearOde::exact(t);
    history.push(next);
  }
  for (int n = 0; n < 2 * pairs; ++n) {
    const double size = n % 2 == 0 ? tau : 1.5 * tau;
    next.t = history.back(0).t + size;
    ode.step(takes_note ? history.step_to(next.t, 2) : history.equal_step(2, size, next.t), next);
    history.push(next);
  }
  EXPECT_NEAR(history.back(0).t, 1, 1e-12);
  return (history.back(0).u - LinearOde::exact(1).u).norm();
}

TEST(History, AStepToATimeKeepsTheOrderOnUnequalSteps) {
  const auto order = [](bool takes_note) {
    return std::log2(error_on_unequal_steps(64, takes_note) / error_on_unequal_steps(256, takes_note)) / 2;
  };
  EXPECT_NEAR(order(true), 2, 0.1);
  EXPECT_LT(order(false), 1.5);
}

TEST(History, TooFewStatesAreAnError) {
  History<State> history(3);
  State next = constant(1);
  history.push(next);
  EXPECT_NO_THROW(history.equal_step(1, 0.1, 2));
  EXPECT_THROW(history.equal_step(2, 0.1, 2), InputError);
  EXPECT_THROW(history.equal_step(0, 0.1, 2), InputError);
  EXPECT_THROW(history.step_to(2, 2), InputError);
  EXPECT_THROW(History<State>(0), InputError);
  EXPECT_THROW(History<State>(6), InputError);
}

TEST(History, ARestartedRunEqualsTheUninterruptedOne) {
  const int q = 4, steps = 40, stop = 17;
  const double tau = 1.0 / steps;
  std::vector<LinearOde::State> states;
  LinearOde ode;
  integrate(ode, {q, tau, steps, {}}, {LinearOde::exact(0), LinearOde::exact},
            [&](int, const LinearOde::State& state) { states.push_back(state); });

  const auto continued = [&](int states_kept) {
    History<LinearOde::State> history(q);
    for (int n = stop - states_kept + 1; n <= stop; ++n) {
      LinearOde::State saved = states[n];
      history.push(saved);
    }
    LinearOde restarted;
    LinearOde::State next = states[stop];
    for (int n = stop + 1; n <= steps; ++n) {
      next.t = n * tau;
      restarted.step(history.equal_step(std::min(q, history.size()), tau, next.t), next);
      history.push(next);
    }
    return history.back(0);
  };
  EXPECT_EQ(continued(q).x, states.back().x);
  EXPECT_EQ(continued(q).u, states.back().u);
  EXPECT_NE(continued(q - 1).u, states.back().u) << "a history that lost a state must show";
}

}  // namespace
}  // namespace esfem::test_history
