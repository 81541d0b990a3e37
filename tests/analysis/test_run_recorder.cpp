// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "solver/analysis/run_recorder.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"

namespace esfem::test_run_recorder {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

struct RunRecorderOnASphere : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_recorder_" + std::to_string(getpid()));
  std::string pvd = (folder / "run.pvd").string();
  Mesh mesh = lagrange_mesh(icosphere(1, 2), 2);
  RunRecorderOnASphere() { project_nodes(mesh, sphere(1)); }
  ~RunRecorderOnASphere() override { fs::remove_all(folder); }

  static std::vector<double> times(const RunRecorder& recorder) {
    std::vector<double> list;
    for (const RunRecorder::Snapshot& snapshot : recorder.snapshots()) list.push_back(snapshot.t);
    return list;
  }
};

TEST_F(RunRecorderOnASphere, RecordsWhatTheFlowHasAndComputesTheRest) {
  const SurfaceSpace space(mesh);
  RunRecorder recorder(space, {});
  EXPECT_TRUE(recorder.empty());
  recorder.record(0, 0, mesh.nodes, {{"v", mesh.nodes}});
  EXPECT_NEAR(recorder.series()["max_H"][0], 2, 0.15) << "of the discrete surface";
  EXPECT_EQ(recorder.series().count("min_nu"), 0u);
  EXPECT_EQ(recorder.newest().fields.size(), 1u);

  RunRecorder with_own(space, {});
  const Field H = Field::Constant(space.dofs(), 1, 3);
  with_own.record(0, 0, mesh.nodes, {{"nu", 0.9 * mesh.nodes}, {"H", H}});
  EXPECT_EQ(with_own.series()["max_H"][0], 3) << "the flow's own";
  EXPECT_NEAR(with_own.series()["willmore_energy"][0], 0.5 * 9 * 4 * pi, 1e-2);
  EXPECT_NEAR(with_own.series()["min_nu"][0], 0.9, 1e-12);
  EXPECT_TRUE(with_own.snapshots().empty());
}

TEST_F(RunRecorderOnASphere, TheEnergyOfTheSurfaceIsNotThatOfTheFlowsOwnCurvature) {
  const SurfaceSpace space(mesh);
  RunRecorder recorder(space, {}, RunRecorder::of_flow_and_surface);
  const Field H = Field::Constant(space.dofs(), 1, 3);
  recorder.record(0, 0, mesh.nodes, {{"nu", mesh.nodes}, {"H", H}});
  EXPECT_NEAR(recorder.series()["willmore_energy"][0], 18 * pi, 1e-2);
  EXPECT_NEAR(recorder.series()["kappa_energy"][0], 8 * pi, 0.1);
}

TEST_F(RunRecorderOnASphere, ComparesTheFlowsOwnCurvatureWithThatOfTheSurface) {
  const SurfaceSpace space(mesh);
  const Field &x = mesh.nodes, H = Field::Constant(space.dofs(), 1, 2);
  const auto compared = [&](double length, double factor) {
    RunRecorder recorder(space, {});
    recorder.record(0, 0, x, {{"v", -2 * x}, {"nu", length * x}, {"H", factor * H}});
    return *recorder.compare_curvature();
  };
  const auto right = compared(1, 1);
  EXPECT_LT(right.deviation, 0.01);
  EXPECT_LT(right.rate_difference(), 0.01);
  EXPECT_LT(right.energy_difference(), 0.01);
  EXPECT_NEAR(right.energy, 8 * pi, 0.05);
  EXPECT_NEAR(right.kappa_energy, 8 * pi, 0.1);
  EXPECT_NEAR(right.rates.of_surface, -16 * pi, 0.1);
  EXPECT_NEAR(right.rates.of_fields, -16 * pi, 0.1);
  EXPECT_NEAR(right.rates.scale, 16 * pi, 0.1);
  // H too small, or nu too short, by a third.
  for (const auto& found : {compared(1, 2. / 3), compared(2. / 3, 1)}) {
    EXPECT_NEAR(found.deviation, 1. / 3, 0.01);
    EXPECT_NEAR(found.rate_difference(), 0.5, 0.01) << "relative to that of the fields";
  }
  EXPECT_NEAR(compared(1, 2. / 3).energy_difference(), 5. / 9, 0.01);

  RunRecorder without(space, {});
  without.record(0, 0, x, {{"v", -2 * x}});
  EXPECT_FALSE(without.compare_curvature());
}

TEST_F(RunRecorderOnASphere, WritesSnapshotsAsPlanned) {
  const SurfaceSpace space(mesh);
  const auto run = [&](SnapshotPlan plan) {
    RunRecorder recorder(space, std::move(plan));
    for (int n = 0; n <= 7; ++n) recorder.record(n, 0.1 * n, mesh.nodes, {});
    recorder.finish();
    recorder.finish();
    return times(recorder);
  };
  EXPECT_THAT(run({pvd, {}, 0}), ElementsAre(0, 0.1 * 7));
  EXPECT_THAT(run({pvd, {}, 3}), ElementsAre(0, 0.1 * 3, 0.1 * 6, 0.1 * 7));
  EXPECT_THAT(run({pvd, {0.2, 0.41, 5}, 0}), ElementsAre(0, 0.1 * 2, 0.1 * 5, 0.1 * 7));
  EXPECT_THAT(run({pvd, {0.3, 0.31, 0.32}, 0}), ElementsAre(0, 0.1 * 3, 0.1 * 4, 0.1 * 7)) << "once a step";
  EXPECT_THAT(run({"", {0.3}, 2}), ElementsAre());
  EXPECT_THROW(run({pvd, {0.3, 0.3}, 0}), InputError);
  EXPECT_TRUE(fs::exists(folder / "run_0003.vtu"));
}

TEST_F(RunRecorderOnASphere, AStepThatCannotBeRecordedLeavesNoTrace) {
  const SurfaceSpace space(mesh);
  RunRecorder recorder(space, {pvd, {}, 1});
  recorder.record(0, 0, mesh.nodes, {});
  Field folded = mesh.nodes;
  folded.row(mesh.elements(5, 3)) = 10 * folded.row(mesh.elements(5, 1));
  EXPECT_THROW(recorder.record(1, 0.1, folded, {}), NumericsError);
  for (const auto& [name, values] : recorder.series()) EXPECT_EQ(values.size(), 1u) << name;
  EXPECT_EQ(recorder.newest().t, 0);
  recorder.finish();
  EXPECT_THAT(times(recorder), ElementsAre(0));
}

TEST_F(RunRecorderOnASphere, GoesOnFromItsProgress) {
  const SurfaceSpace space(mesh);
  RunRecorder first(space, {pvd, {}, 2});
  for (int n = 0; n <= 3; ++n) first.record(n, 0.1 * n, (1 + 0.1 * n) * mesh.nodes, {{"v", mesh.nodes}});
  RunRecorder second(space, {pvd, {}, 2});
  second.resume(nlohmann::json::from_cbor(nlohmann::json::to_cbor(first.progress())));
  EXPECT_EQ(second.series(), first.series());
  EXPECT_EQ(second.newest().step, 3);
  EXPECT_EQ(second.newest().t, first.newest().t);
  EXPECT_EQ(second.newest().x, first.newest().x);
  ASSERT_EQ(second.newest().fields.size(), 1u);
  EXPECT_EQ(second.newest().fields[0].values, mesh.nodes);
  second.finish();
  ASSERT_EQ(second.snapshots().size(), 3u) << "the newest surface of the first is the last snapshot";
  EXPECT_EQ(second.snapshots()[2].t, first.newest().t);

  second.resume(RunRecorder(space, {pvd, {}, 2}).progress());
  EXPECT_TRUE(second.empty());
  EXPECT_TRUE(second.snapshots().empty());
}

}  // namespace
}  // namespace esfem::test_run_recorder
