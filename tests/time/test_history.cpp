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
  Field out;
  history.extrapolate(3, &State::x, out);
  EXPECT_TRUE(out.isApprox(Field::Constant(3, 2, value(4 * tau)), 1e-13));
  history.extrapolate(2, &State::x, out);
  EXPECT_FALSE(out.isApprox(Field::Constant(3, 2, value(4 * tau)), 1e-3)) << "order 2 is not exact here";
  history.bdf_sum(3, &State::x, out);
  const double derivative = (history.delta(3)[0] * value(4 * tau) + out(0, 0)) / tau;
  EXPECT_NEAR(derivative, -1 + 6 * 4 * tau, 1e-12);
}

TEST(History, AimedAtATimeItIsExactOnUnequalSteps) {
  const auto value = [](double t) { return 2 - t + 3 * t * t; };
  const double times[] = {0, 0.1, 0.13, 0.3}, t = 0.37;
  History<State> history(3);
  for (const double s : times) {
    State next = constant(value(s));
    next.t = s;
    history.push(next);
  }
  const auto derivative = [&] {
    Field out;
    history.bdf_sum(2, &State::x, out);
    return (history.delta(2)[0] * value(t) + out(0, 0)) / (t - 0.3);
  };
  EXPECT_GT(std::abs(derivative() - (-1 + 6 * t)), 0.03) << "the weights of equal steps";
  history.aim(2, t);
  EXPECT_NEAR(derivative(), -1 + 6 * t, 1e-12);
  history.aim(3, t);
  Field out;
  history.extrapolate(3, &State::x, out);
  EXPECT_TRUE(out.isApprox(Field::Constant(3, 2, value(t)), 1e-13));
  EXPECT_THROW(history.aim(2, 0.3), InputError);
  EXPECT_THROW(history.aim(4, t), InputError);
}

/// The error at t = 1 of BDF2 on steps that are by turns short and long.
double error_on_unequal_steps(int pairs, bool aims) {
  LinearOde ode;
  History<LinearOde::State> history(2);
  const double tau = 0.4 / pairs;
  LinearOde::State next;
  for (const double t : {-1.5 * tau, 0.0}) {
    next = LinearOde::exact(t);
    history.push(next);
  }
  for (int n = 0; n < 2 * pairs; ++n) {
    const double step = n % 2 == 0 ? tau : 1.5 * tau;
    next.t = history.back(0).t + step;
    if (aims) history.aim(2, next.t);
    ode.step(history, 2, step, next);
    history.push(next);
  }
  EXPECT_NEAR(history.back(0).t, 1, 1e-12);
  return (history.back(0).u - LinearOde::exact(1).u).norm();
}

TEST(History, AimingKeepsTheOrderOnUnequalSteps) {
  const auto order = [](bool aims) {
    return std::log2(error_on_unequal_steps(64, aims) / error_on_unequal_steps(256, aims)) / 2;
  };
  EXPECT_NEAR(order(true), 2, 0.1);
  EXPECT_LT(order(false), 1.5);
}

TEST(History, TooFewStatesAreAnError) {
  History<State> history(3);
  State next = constant(1);
  history.push(next);
  Field out;
  EXPECT_THROW(history.extrapolate(2, &State::x, out), InputError);
  EXPECT_THROW(history.bdf_sum(2, &State::x, out), InputError);
  EXPECT_THROW(history.delta(4), InputError);
  EXPECT_THROW(History<State>(0), InputError);
  EXPECT_THROW(History<State>(6), InputError);
}

TEST(History, ARestartedRunEqualsTheUninterruptedOne) {
  const int q = 4, steps = 40, stop = 17;
  const double tau = 1.0 / steps;
  std::vector<LinearOde::State> states;
  LinearOde ode;
  integrate(ode, {q, tau, steps, {}}, LinearOde::exact(0), LinearOde::exact,
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
      restarted.step(history, std::min(q, history.size()), tau, next);
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
