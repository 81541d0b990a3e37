// SPDX-License-Identifier: GPL-3.0-or-later
// A run with a later end resumes from the checkpoint of a shorter one, with the numbers of an undisturbed
// run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/time/integrate.hpp"
#include "tests/time/linear_ode.hpp"

namespace esfem::test_prolonged_run {
namespace {

namespace fs = std::filesystem;
using State = LinearOde::State;
using testing::HasSubstr;

/// The states that one process sees, from step `first` on.
struct Seen {
  int first = -1;
  std::vector<State> states;
};

struct ProlongedRun : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_prolonged_" + std::to_string(getpid()));
  std::string file = (folder / "run.checkpoint").string();
  double seconds_before = 0;

  ~ProlongedRun() override { fs::remove_all(folder); }

  /// Steps 0.. until the end, or until after step `last`; saved there, not on the way.
  template <class Integrate>
  Seen run(int last, Integrate&& integrate) {
    Checkpoint checkpoint(file, {{"run", "of a test"}}, /*seconds=*/3600);
    LinearOde ode;
    Seen seen;
    const auto observe = [&](int n, const State& state) {
      if (seen.first < 0) seen.first = n;
      seen.states.push_back(state);
      return n != last;
    };
    try {
      integrate(ode, observe, &checkpoint);
    } catch (const StoppedError& error) {
      EXPECT_THAT(error.what(), HasSubstr(format("(step %d)", last)));
    }
    seconds_before = checkpoint.seconds_before();
    return seen;
  }
  static constexpr int never = -1;
  Seen uniform(int steps, int last = never) {
    return run(last, [&](LinearOde& ode, auto& observe, Checkpoint* checkpoint) {
      integrate(ode, {3, 0.02, steps, {Start::substeps, 4}}, LinearOde::exact(0), checkpoint, observe);
    });
  }
  Seen adaptive(double end_time, int last = never) {
    return run(last, [&](LinearOde& ode, auto& observe, Checkpoint* checkpoint) {
      integrate(ode, AdaptiveSteps{"u", 2, end_time, 1e-4, 1e-3, 0}, LinearOde::exact(0), checkpoint,
                observe);
    });
  }
  template <class Run>
  std::string refusal(Run&& run) {
    try {
      run();
      return "no error";
    } catch (const InputError& error) {
      return error.what();
    }
  }
};

void expect_end_of(const Seen& whole, const Seen& resumed) {
  ASSERT_GT(resumed.first, 0);
  ASSERT_EQ(resumed.first + resumed.states.size(), whole.states.size());
  for (std::size_t i = 0; i < resumed.states.size(); ++i) {
    const State &found = resumed.states[i], &expected = whole.states[resumed.first + i];
    ASSERT_EQ(found.t, expected.t);
    for (const auto& field : State::fields) ASSERT_EQ(found.*field.member, expected.*field.member);
  }
}

TEST_F(ProlongedRun, EqualsTheLongOne) {
  const Seen whole = uniform(50);
  for (const int steps : {2, 3, 20, 49}) {
    fs::remove(file);
    uniform(steps);
    const Seen prolonged = uniform(50);
    EXPECT_EQ(prolonged.first, steps + 1);
    expect_end_of(whole, prolonged);
  }
}

TEST_F(ProlongedRun, EqualsTheLongOneWithAdaptiveSteps) {
  const Seen whole = adaptive(1);
  for (const double end : {0.1, 0.5, 0.731, 0.99}) {
    fs::remove(file);
    const Seen shorter = adaptive(end);
    EXPECT_EQ(shorter.states.back().t, end);
    const Seen prolonged = adaptive(1);
    EXPECT_LT(prolonged.first, int(shorter.states.size())) << "the steps that led to the earlier end";
    expect_end_of(whole, prolonged);
  }
}

TEST_F(ProlongedRun, TheLastStepsOfAdaptiveOnesLeadToTheirEnd) {
  const Seen whole = adaptive(1), shorter = (fs::remove(file), adaptive(0.5));
  const std::size_t last = shorter.states.size() - 1;
  EXPECT_NE(shorter.states[last].t, whole.states[last].t) << "to go on from the end would give other numbers";
}

TEST_F(ProlongedRun, WithoutStepsToGoOnFromIsAWholeOne) {
  uniform(1);
  EXPECT_FALSE(fs::exists(file)) << "BDF 3 needs three states";
  EXPECT_EQ(uniform(10).first, 0);
}

TEST_F(ProlongedRun, AnEarlierEndIsRefusedAndNothingIsLost) {
  uniform(20);
  EXPECT_THAT(refusal([&] { uniform(19); }), HasSubstr("it is at step 20, 19 steps are asked for"));
  EXPECT_EQ(uniform(30).first, 21);
  fs::remove(file);
  const Seen whole = adaptive(1);
  const double t = whole.states[whole.states.size() - 10].t;
  fs::remove(file);
  adaptive(1);
  EXPECT_THAT(refusal([&] { adaptive(t); }), HasSubstr("lead to an end time of"));
  EXPECT_GT(adaptive(2).first, 0);
}

TEST_F(ProlongedRun, AnEarlierEndThatNoStepHasSeenServes) {
  const Seen whole = adaptive(0.9);
  fs::remove(file);
  adaptive(1, 20);
  expect_end_of(whole, adaptive(0.9));
}

TEST_F(ProlongedRun, StopsAfterTheStepWhenItsObserverSaysSo) {
  const Seen whole = uniform(50), whole_adaptive = (fs::remove(file), adaptive(1));
  for (const int last : {3, 30}) {
    fs::remove(file);
    EXPECT_EQ(int(uniform(50, last).states.size()), last + 1);
    expect_end_of(whole, uniform(50));
    fs::remove(file);
    EXPECT_EQ(int(adaptive(1, last).states.size()), last + 1);
    const Seen resumed = adaptive(1);
    EXPECT_EQ(resumed.first, last + 1);
    expect_end_of(whole_adaptive, resumed);
  }
}

TEST_F(ProlongedRun, AStopAfterTheLastStepIsNone) {
  for (const int steps : {1, 20}) {
    fs::remove(file);
    LinearOde ode;
    EXPECT_NO_THROW(integrate(ode, {3, 0.02, steps, {Start::substeps, 4}}, LinearOde::exact(0),
                              [&](int n, const State&) { return n < steps; }));
  }
}

TEST_F(ProlongedRun, KeepsWhatItHasGoneOnFrom) {
  const auto bytes = [](const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(name, std::ios::binary).rdbuf();
    return text.str();
  };
  uniform(20);
  const std::string before = bytes(file);
  uniform(50);
  EXPECT_NE(bytes(file), before);
  EXPECT_EQ(bytes(file + ".previous"), before);
}

TEST_F(ProlongedRun, SecondsAreThoseOfAllProcesses) {
  uniform(50, 20);
  EXPECT_EQ(seconds_before, 0);
  uniform(50, 30);
  const double first = seconds_before;
  EXPECT_GT(first, 0);
  uniform(50);
  EXPECT_GT(seconds_before, first);
}

}  // namespace
}  // namespace esfem::test_prolonged_run
