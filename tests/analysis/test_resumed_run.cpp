// SPDX-License-Identifier: GPL-3.0-or-later
// A run that was stopped continues as if it had not been: states, series and snapshots to the last bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/analysis/run_recorder.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/time/integrate.hpp"

namespace esfem::test_resumed_run {
namespace {

namespace fs = std::filesystem;

struct Stopped : std::exception {};

MeanCurvatureFlow make_flow(const SurfaceSpace& space, const MeanCurvatureFlow*) {
  return {space, MeanCurvatureFlow::Variant()};
}
MeanCurvatureFlow::State start_of(const SurfaceSpace&, const Surface& surface, const Field& x,
                                  const MeanCurvatureFlow*) {
  return mean_curvature_state_on(surface, x);
}
WillmoreFlow make_flow(const SurfaceSpace& space, const WillmoreFlow*) {
  WillmoreFlow::Variant variant;
  variant.relaxation = 20;
  return {space, variant};
}
WillmoreFlow::State start_of(const SurfaceSpace& space, const Surface& surface, const Field& x,
                             const WillmoreFlow*) {
  return willmore_start_on(space, surface, x, willmore_law(), false).state;
}

/// Its factorisations serve several steps; which, a resumed run must know.
struct ForgetfulWillmoreFlow {
  using State = WillmoreFlow::State;
  WillmoreFlow flow;
  void step(const BdfStep<State>& step, State& next) { flow.step(step, next); }
};
ForgetfulWillmoreFlow make_flow(const SurfaceSpace& space, const ForgetfulWillmoreFlow*) {
  return {make_flow(space, static_cast<const WillmoreFlow*>(nullptr))};
}
WillmoreFlow::State start_of(const SurfaceSpace& space, const Surface& surface, const Field& x,
                             const ForgetfulWillmoreFlow*) {
  return start_of(space, surface, x, static_cast<const WillmoreFlow*>(nullptr));
}

template <class State>
struct Outcome {
  int observed = 0;
  State last;
  Series series;
  RunRecorder::Surface newest;
  std::vector<std::pair<double, std::string>> snapshots;
  std::map<std::string, std::string> files;  ///< with their bytes
};

template <class Flow>
struct ResumedRun : testing::Test {
  using State = typename Flow::State;
  using Outcome = test_resumed_run::Outcome<State>;
  static constexpr int never = -1;
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_resumed_" + std::to_string(getpid()));
  fs::path results = folder / "results";
  std::string file = (folder / "run.checkpoint").string();
  Mesh mesh = lagrange_mesh(icosphere(1, 1), 2);

  ResumedRun() {
    project_nodes(mesh, ellipsoid(1, 1, 0.95));
    fs::create_directories(folder);
  }
  ~ResumedRun() override { fs::remove_all(folder); }

  Outcome run(int stop, bool adaptive) const {
    const SurfaceSpace space(mesh);
    Flow flow = make_flow(space, static_cast<const Flow*>(nullptr));
    RunRecorder recorder(space, {(results / "run.pvd").string(), {0.011, 0.05, 0.07}, 7});
    Checkpoint checkpoint(file, {{"run", "of a test"}}, stop == never ? 3600 : 0);
    attach(checkpoint, recorder);
    Outcome outcome;
    const auto observe = [&](int n, const State& state) {
      recorder.record(n, state.t, state.x, nodal_fields(state));
      if (n == stop) throw Stopped();
      outcome.last = state;
      ++outcome.observed;
    };
    const State initial =
        start_of(space, ellipsoid(1, 1, 0.95), mesh.nodes, static_cast<const Flow*>(nullptr));
    try {
      if (adaptive)
        integrate(flow, AdaptiveSteps{"x", 2, 0.1, 1e-3, 1e-4, 0.003}, initial, &checkpoint, observe);
      else
        integrate(flow, {3, 0.004, 25, {Start::substeps, 4}}, initial, &checkpoint, observe);
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

using Flows = testing::Types<MeanCurvatureFlow, WillmoreFlow>;
TYPED_TEST_SUITE(ResumedRun, Flows);

TYPED_TEST(ResumedRun, EqualsTheOneThatWasNotStopped) {
  for (const bool adaptive : {false, true}) {
    fs::remove_all(this->folder);
    const auto whole = this->run(this->never, adaptive);
    EXPECT_GE(whole.snapshots.size(), 5u);
    fs::remove_all(this->folder);
    const int steps = whole.observed - 1;
    ASSERT_GT(steps, 15);
    this->run(14, adaptive);  // its snapshot is written, and not in the checkpoint
    this->run(steps - 3, adaptive);
    const auto resumed = this->run(this->never, adaptive);
    EXPECT_EQ(resumed.observed, 4);
    for (const auto& field : TypeParam::State::fields)
      EXPECT_EQ(resumed.last.*field.member, whole.last.*field.member) << field.name;
    EXPECT_EQ(resumed.series, whole.series);
    EXPECT_EQ(resumed.snapshots, whole.snapshots);
    EXPECT_EQ(resumed.files, whole.files);
  }
}

using ForgetfulRun = ResumedRun<ForgetfulWillmoreFlow>;

// Not wherever it is stopped: not where the next step would have been factorised anyway.
TEST_F(ForgetfulRun, DiffersFromTheOneThatWasNotStopped) {
  for (const bool adaptive : {false, true}) {
    fs::remove(file);
    const auto whole = run(never, adaptive);
    bool differs = false;
    for (int left = 8; left > 4; --left) {
      fs::remove(file);
      run(whole.observed - left, adaptive);
      const auto resumed = run(never, adaptive);
      EXPECT_EQ(resumed.observed, left);
      const Field &found = resumed.last.w, &expected = whole.last.w;
      differs = differs || found != expected;
      EXPECT_LT((found - expected).norm(), 1e-11 * expected.norm());
    }
    EXPECT_TRUE(differs) << "adaptive: " << adaptive;
  }
}

TYPED_TEST(ResumedRun, IsRefusedWhenASnapshotIsGone) {
  this->run(9, false);
  fs::remove(this->results / "run_0001.vtu");
  try {
    this->run(this->never, false);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("run_0001.vtu, the snapshot at t = "), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace esfem::test_resumed_run
