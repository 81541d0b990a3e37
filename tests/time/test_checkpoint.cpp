// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "solver/time/integrate.hpp"
#include "solver/write_file.hpp"
#include "tests/time/linear_ode.hpp"

namespace esfem::test_checkpoint {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

struct Stopped : std::exception {};

/// What one process sees of a run: the states from `first` on.
struct Seen {
  int first = 0;
  std::vector<LinearOde::State> states;
  StepCount adaptive;
  std::string said;
};

struct CheckpointedRun : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_checkpoint_" + std::to_string(getpid()));
  std::string file = (folder / "run.checkpoint").string();
  json description = {{"experiment", "linear_ode"}, {"parameters", {1, 2.5}}};
  double seconds = 0;
  bool starts_afresh = false;
  UniformSteps grid = {4, 0.02, 50, {Start::substeps, 4}};
  AdaptiveSteps adaptive_grid = {"u", 2, 1, 1e-3, 1e-3, 0};

  CheckpointedRun() { fs::create_directories(folder); }
  ~CheckpointedRun() override { fs::remove_all(folder); }

  static constexpr int never = -1;
  /// Runs to the end, or until step `stop` has been observed. A run that is not stopped is saved at its end
  /// alone: each time takes a while.
  template <class Run>
  Seen observed(int stop, Run&& run) {
    Seen seen;
    Checkpoint checkpoint(file, description, stop == never ? 3600 : seconds,
                          [&](const std::string& text) { seen.said += text; });
    if (starts_afresh) checkpoint.start_afresh_when_unusable();
    try {
      run(
          checkpoint,
          [&](int n, const LinearOde::State& state) {
            if (seen.states.empty()) seen.first = n;
            EXPECT_EQ(n, seen.first + int(seen.states.size()));
            if (n == stop) throw Stopped();
            seen.states.push_back(state);
          },
          seen);
      EXPECT_TRUE(fs::exists(file)) << "a finished run can be prolonged";
    } catch (const Stopped&) {
    }
    return seen;
  }
  Seen uniform(int stop = never) {
    return observed(stop, [&](Checkpoint& checkpoint, auto&& observe, Seen&) {
      LinearOde ode;
      integrate(ode, grid, LinearOde::exact(0), &checkpoint, observe);
    });
  }
  Seen adaptive(int stop = never) {
    return observed(stop, [&](Checkpoint& checkpoint, auto&& observe, Seen& seen) {
      LinearOde ode;
      seen.adaptive = integrate(ode, adaptive_grid, LinearOde::exact(0), &checkpoint, observe);
    });
  }

  std::string bytes() const {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  /// The file is refused and left unchanged; a run that may start afresh does so and reports why.
  void expect_unusable(const std::string& why) {
    const std::string before = bytes();
    try {
      uniform();
      ADD_FAILURE() << "no error: " << why;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::AllOf(HasSubstr("run.checkpoint: this checkpoint cannot be used: "),
                                               HasSubstr(why), HasSubstr("remove it")));
    }
    EXPECT_EQ(bytes(), before);
    starts_afresh = true;
    const Seen seen = uniform();
    starts_afresh = false;
    EXPECT_EQ(seen.first, 0);
    EXPECT_EQ(seen.states.size(), 51u);
    EXPECT_THAT(seen.said, testing::AllOf(HasSubstr(why), HasSubstr("starts at t = 0")));
    fs::remove(file);
  }
};

void expect_same(const Seen& resumed, const Seen& whole) {
  ASSERT_EQ(resumed.first + resumed.states.size(), whole.states.size());
  for (std::size_t i = 0; i < resumed.states.size(); ++i) {
    const LinearOde::State &found = resumed.states[i], &expected = whole.states[resumed.first + i];
    ASSERT_EQ(found.t, expected.t);
    ASSERT_EQ(found.x, expected.x);
    ASSERT_EQ(found.v, expected.v);
    ASSERT_EQ(found.u, expected.u);
  }
}

TEST(Packed, FieldsComeBackToTheLastBit) {
  using Limits = std::numeric_limits<double>;
  Field field(3, 2);
  field << 1.0 / 3, -0.0, Limits::denorm_min(), Limits::max(), std::nextafter(1.0, 2.0), -1e-300;
  const Field back = unpacked(unseal(seal(packed(field))));
  ASSERT_EQ(back.rows(), 3);
  EXPECT_EQ(std::memcmp(back.data(), field.data(), 6 * sizeof(double)), 0);
  EXPECT_EQ(unpacked(packed(Field(0, 3))).cols(), 3);
  json wrong = packed(field);
  wrong["rows"] = 4;
  EXPECT_THROW(unpacked(wrong), InputError);
}

TEST(Seal, ShowsEveryDamage) {
  const std::string good = seal({{"n", 7}, {"field", packed(Field::Ones(2, 2))}});
  EXPECT_TRUE(unseal(good).is_object());
  for (std::size_t length = 0; length < good.size(); ++length)
    EXPECT_TRUE(unseal(good.substr(0, length)).is_discarded()) << length;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] ^= 1;
    EXPECT_TRUE(unseal(bad).is_discarded()) << i;
  }
}

TEST_F(CheckpointedRun, GoesOnBitForBit) {
  const Seen whole = uniform();
  ASSERT_EQ(whole.states.size(), 51u);
  EXPECT_EQ(whole.said, "");
  for (const int stop : {4, 5, 17, 50}) {
    fs::remove(file);
    uniform(stop);
    ASSERT_TRUE(fs::exists(file));
    const Seen resumed = uniform();
    EXPECT_EQ(resumed.first, stop);
    EXPECT_THAT(resumed.said, HasSubstr(format("resumes from this checkpoint, step %d", stop - 1)));
    expect_same(resumed, whole);
  }
}

TEST_F(CheckpointedRun, GoesOnBitForBitWithAdaptiveSteps) {
  const Seen whole = adaptive();
  const int steps = whole.adaptive.steps;
  EXPECT_GT(steps, 30);
  for (const int stop : {2, 3, 20, steps - 2}) {
    fs::remove(file);
    adaptive(stop);
    ASSERT_TRUE(fs::exists(file));
    const Seen resumed = adaptive();
    EXPECT_EQ(resumed.first, stop);
    expect_same(resumed, whole);
    EXPECT_EQ(resumed.adaptive.steps, steps);
    EXPECT_EQ(resumed.adaptive.rejected, whole.adaptive.rejected);
  }
}

TEST_F(CheckpointedRun, StartingStepsAreRepeated) {
  for (const int stop : {0, 2, 3}) {
    uniform(stop);
    EXPECT_FALSE(fs::exists(file));
  }
  uniform(4);
  EXPECT_TRUE(fs::exists(file));
}

TEST_F(CheckpointedRun, IsNotMixedWithAnotherOne) {
  const auto stop_here = [&] {
    uniform(17);
    ASSERT_TRUE(fs::exists(file));
  };
  stop_here();
  description["parameters"][1] = 2.75;
  expect_unusable("another parameters");
  stop_here();
  description["degree"] = 2;
  expect_unusable("another degree (it has none, 2 is asked for)");
  stop_here();
  grid.tau = 0.015625;
  grid.start.substeps_per_step = 2;
  expect_unusable(
      "another start (it has \"substeps:4\", \"substeps:2\" is asked for), another tau (it has 0.02, "
      "0.015625");
  adaptive(17);
  expect_unusable("another first_step");
}

TEST_F(CheckpointedRun, IsNotOfAnotherInitialState) {
  const auto run = [&](double u, int stop) {
    return observed(stop, [&](Checkpoint& checkpoint, auto&& observe, Seen&) {
      LinearOde ode;
      LinearOde::State initial = LinearOde::exact(0);
      initial.u(0, 1) = u;
      integrate(ode, grid, initial, &checkpoint, observe);
    });
  };
  run(0, 17);
  starts_afresh = true;
  const Seen other = run(1e-300, never);
  EXPECT_EQ(other.first, 0);
  EXPECT_THAT(other.said, HasSubstr("another initial state"));
}

TEST_F(CheckpointedRun, ADamagedFileIsNotUsed) {
  uniform(17);
  const std::string good = bytes();
  write_file(file, good.substr(0, good.size() / 2));
  expect_unusable("damaged");
  write_file(file, "");
  expect_unusable("damaged");
  write_file(file, good);
  EXPECT_EQ(uniform().first, 17);
}

TEST_F(CheckpointedRun, AHistoryThatLostAStateIsNotUsed) {
  uniform(17);
  json content = unseal(bytes());
  content["run"]["states"].erase(3);
  write_file(file, seal(content));
  expect_unusable("3 states, expected 4");
  uniform(17);
  content = unseal(bytes());
  content["run"]["states"][2].erase("u");
  write_file(file, seal(content));
  expect_unusable("'u' not found");
}

TEST_F(CheckpointedRun, AWrongStateInTheHistoryIsSeenByTheComparison) {
  const Seen whole = uniform();
  fs::remove(file);
  uniform(17);
  json content = unseal(bytes());
  content["run"]["states"][3] = content["run"]["states"][2];
  write_file(file, seal(content));
  const Seen resumed = uniform();
  ASSERT_EQ(resumed.first, 17);
  EXPECT_NE(resumed.states.back().u, whole.states.back().u);
}

TEST_F(CheckpointedRun, AdaptiveStepSizeMatters) {
  const Seen whole = adaptive();
  fs::remove(file);
  adaptive(20);
  json content = unseal(bytes());
  content["run"]["tau"] = content["run"]["tau"].get<double>() / 2;
  write_file(file, seal(content));
  const Seen resumed = adaptive();
  ASSERT_EQ(resumed.first, 20);
  EXPECT_NE(resumed.states.front().t, whole.states[20].t);
}

TEST_F(CheckpointedRun, AFinishedRunHasNothingLeftToDo) {
  uniform();
  EXPECT_TRUE(uniform().states.empty());
}

TEST_F(CheckpointedRun, IsSavedNowAndThen) {
  seconds = 3600;
  uniform(17);
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(CheckpointedRun, HasAFolderOrIsAnError) {
  file = (folder / "new/folder/run.checkpoint").string();
  uniform(17);
  EXPECT_TRUE(fs::exists(file));
  EXPECT_THROW(Checkpoint(file + "/run.checkpoint", description), InputError) << "in a file";
  EXPECT_THROW(Checkpoint(file, description, -1), InputError);
  EXPECT_THROW(Checkpoint(file, description, std::nan("")), InputError);
}

TEST_F(CheckpointedRun, StaysWhenTheNumericsFail) {
  LinearOde ode;
  Checkpoint checkpoint(file, description, 0);
  const auto fail = [&](int n, const LinearOde::State&) {
    if (n == 17) throw NumericsError("");
  };
  EXPECT_THROW(integrate(ode, grid, LinearOde::exact(0), &checkpoint, fail), NumericsError);
  EXPECT_EQ(uniform().first, 17);
}

/// Two counters beside the flow, the second of which may refuse.
struct Companions {
  int a = 0, b = 0;
  bool refuses = false;
  void attach_to(Checkpoint& checkpoint) {
    checkpoint.attach([this] { return json(a); }, [this](const json& saved) { a = saved; });
    checkpoint.attach([this] { return json(b); },
                      [this](const json& saved) {
                        if (refuses && saved != 0) throw InputError("refused");
                        b = saved;
                      });
  }
};

TEST_F(CheckpointedRun, RestoresWhatIsAttached) {
  const auto run = [&](Companions& companions, int stop) {
    LinearOde ode;
    Checkpoint checkpoint(file, description, 0);
    companions.attach_to(checkpoint);
    try {
      integrate(ode, grid, LinearOde::exact(0), &checkpoint, [&](int n, const LinearOde::State&) {
        if (n == stop) throw Stopped();
        companions.a += 1;
        companions.b += n;
      });
    } catch (const Stopped&) {
    }
  };
  Companions stopped, resumed;
  run(stopped, 17);
  const std::string good = bytes();
  run(resumed, never);
  EXPECT_EQ(resumed.a, 51);
  EXPECT_EQ(resumed.b, 50 * 51 / 2);

  write_file(file, good);
  Companions refusing;
  refusing.refuses = true;
  EXPECT_THROW(run(refusing, never), InputError);
  EXPECT_EQ(refusing.a, 0) << "nothing is restored by halves";
  EXPECT_EQ(bytes(), good);
  expect_unusable("2 parts beside the flow, expected 0");
}

}  // namespace
}  // namespace esfem::test_checkpoint
