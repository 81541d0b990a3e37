// SPDX-License-Identifier: GPL-3.0-or-later
// A run that was stopped goes on as if it had not been: states, series and snapshots to the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/analysis/run_recorder.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/time/adaptive.hpp"

namespace esfem {
namespace {

namespace fs = std::filesystem;
using State = MeanCurvatureFlow::State;

struct Stopped : std::exception {};

struct Outcome {
  int observed = 0;
  State last;
  Series series;
  RunRecorder::Surface newest;
  std::vector<std::pair<double, std::string>> snapshots;
  std::map<std::string, std::string> files;  ///< with their bytes
};

struct ResumedRun : testing::TestWithParam<bool> {
  static constexpr int never = -1;
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_resumed_" + std::to_string(getpid()));
  fs::path results = folder / "results";
  Mesh mesh = lagrange_mesh(icosphere(1, 1), 2);

  ResumedRun() {
    project_nodes(mesh, ellipsoid(1, 1, 0.8));
    fs::create_directories(folder);
  }
  ~ResumedRun() override { fs::remove_all(folder); }

  Outcome run(int stop) const {
    const SurfaceSpace space(mesh);
    MeanCurvatureFlow flow(space, {});
    RunRecorder recorder(space, {(results / "run.pvd").string(), {0.011, 0.05, 0.07}, 7});
    Checkpoint checkpoint((folder / "run.checkpoint").string(), {{"flow", "mean_curvature"}}, 0);
    attach(checkpoint, recorder);
    Outcome outcome;
    const auto observe = [&](int n, const State& state) {
      recorder.record(n, state.t, state.x, point_fields(state));
      if (n == stop) throw Stopped();
      outcome.last = state;
      ++outcome.observed;
    };
    const State initial = mean_curvature_state_on(ellipsoid(1, 1, 0.8), mesh.nodes);
    try {
      if (GetParam())
        integrate_adaptive(flow, {2, 0.1, 1e-3, 1e-4, 0}, initial, &State::x, observe, &checkpoint);
      else
        integrate(flow, {3, 0.004, 25, {Start::substeps, 4}}, initial, {}, observe, &checkpoint);
    } catch (const Stopped&) {
      return outcome;
    }
    recorder.finish();
    outcome.series = recorder.series();
    outcome.newest = recorder.newest();
    for (const RunRecorder::Snapshot& snapshot : recorder.snapshots())
      outcome.snapshots.emplace_back(snapshot.t, snapshot.file);
    for (const auto& entry : fs::directory_iterator(results)) {
      std::ostringstream bytes;
      bytes << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      outcome.files[entry.path().filename()] = bytes.str();
    }
    return outcome;
  }
};

TEST_P(ResumedRun, EqualsTheOneThatWasNotStopped) {
  const Outcome whole = run(never);
  EXPECT_GE(whole.snapshots.size(), 5u);
  fs::remove_all(results);
  const int steps = whole.observed - 1;
  ASSERT_GT(steps, 15);
  run(14);  // its snapshot is written, and not in the checkpoint
  run(steps - 1);
  ASSERT_TRUE(fs::exists(folder / "run.checkpoint"));
  const Outcome resumed = run(never);
  EXPECT_EQ(resumed.observed, 2);
  EXPECT_FALSE(fs::exists(folder / "run.checkpoint"));
  for (const NamedField<State>& field : State::fields)
    EXPECT_EQ(resumed.last.*field.member, whole.last.*field.member) << field.name;
  EXPECT_EQ(resumed.series, whole.series);
  EXPECT_EQ(resumed.snapshots, whole.snapshots);
  EXPECT_EQ(resumed.files, whole.files);
}

TEST_P(ResumedRun, StartsAfreshWhenASnapshotIsGone) {
  const Outcome whole = run(never);
  run(9);
  fs::remove(results / "run_0001.vtu");
  const Outcome again = run(never);
  EXPECT_EQ(again.observed, whole.observed);
  EXPECT_EQ(again.series, whole.series);
  EXPECT_EQ(again.files, whole.files);
}

INSTANTIATE_TEST_SUITE_P(Steps, ResumedRun, testing::Values(false, true),
                         [](const auto& steps) { return steps.param ? "adaptive" : "equal"; });

}  // namespace
}  // namespace esfem
