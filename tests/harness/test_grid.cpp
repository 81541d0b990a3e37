// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/grid.hpp"
#include "solver/error.hpp"

namespace esfem::test_grid {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

const std::string dumbbell_file = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/dumbbell_450.msh";

/// The message of the error that `body` throws; "" without one.
template <class Error, class Body>
std::string message(Body&& body) {
  try {
    body();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Grid, RangeHasBothEnds) {
  EXPECT_THAT(range(2, 4), ElementsAre(2, 3, 4));
  EXPECT_THAT(range(0, 0), ElementsAre(0));
  EXPECT_THAT(range(0, -1), IsEmpty());
}

TEST(Grid, StepsEndAtTheEndTimeAndHalve) {
  const HalvedSteps steps{0.6, 0.2};
  ASSERT_LT(0.6 / 0.2, 3) << "a quotient that is cut off instead of rounded loses the last step";
  for (int k : range(0, 7)) {
    EXPECT_EQ(steps.count(k), 3 << k);
    EXPECT_NEAR(steps.count(k) * steps.tau(k), 0.6, 1e-15);
    EXPECT_EQ(steps.tau(k), 2 * steps.tau(k + 1));
  }
}

TEST(Grid, TwoLevelsHalveTheEdges) {
  EXPECT_EQ(edge_length(0.5, 0), 0.5);
  EXPECT_NEAR(edge_length(0.5, 1) * std::sqrt(2.0), 0.5, 1e-15);
  EXPECT_DOUBLE_EQ(edge_length(0.5, 4), 0.125);
}

TEST(Grid, LevelsWithoutAMeshAreRefused) {
  EXPECT_EQ(message<InputError>([] {
              require_levels({0, 4}, 3, "levels");
            }),
            "--levels: found 4, expected less than 3, the number of levels");
  EXPECT_NO_THROW(require_levels({0, 2}, 3, "levels"));
}

TEST(Grid, GeneratedMeshHasCurvedElementsOfTheDegree) {
  for (int degree : {1, 2, 3}) {
    const auto generate = [] { return icosphere(2, 1); };
    const Mesh mesh = initial_mesh({}, 5, generate, sphere(2), degree);
    EXPECT_EQ(mesh.degree, degree);
    EXPECT_EQ(mesh.nodes.rows(), 40 * degree * degree + 2);
    EXPECT_LT((mesh.nodes.rowwise().norm().array() - 2).abs().maxCoeff(), 1e-14);
  }
}

TEST(Grid, FilesTakeThePlaceOfGeneratedMeshes) {
  const auto generate = []() -> Mesh { throw std::logic_error("a mesh is generated beside the files"); };
  const std::vector<std::string> files = {"none.msh", dumbbell_file};
  const Mesh mesh = initial_mesh(files, 1, generate, dumbbell(), 2);
  EXPECT_EQ(mesh.degree, 2);
  EXPECT_EQ(mesh.nodes.rows(), 2 * mesh.elements.rows() + 2);
  EXPECT_THAT(message<InputError>([&] { initial_mesh(files, 0, generate, dumbbell(), 2); }),
              HasSubstr("none.msh"));
  EXPECT_THAT(message<InputError>([&] { initial_mesh(files, 1, generate, sphere(4), 2); }),
              HasSubstr("away from the sphere"));
}

TEST(Grid, ParametersNameTheFilesOrSayHowMeshesAreMade) {
  EXPECT_EQ(mesh_parameter({}, "generated"), "generated");
  EXPECT_EQ(mesh_parameter({"a.msh"}, "generated").dump(), "[\"a.msh\"]");
}

TEST(Grid, PlannedRowSaysWhatIsKnownBeforehand) {
  const Row row = planned_row(3, {1, 0.1}, 2, {{"flow", "dziuk"}, {"bdf", 4}});
  EXPECT_EQ(row.level, 3);
  EXPECT_EQ(row.tau, 0.025);
  EXPECT_EQ(row.steps, 40);
  EXPECT_EQ(variant(row), "bdf=4, flow=dziuk");
  EXPECT_EQ(row.status, "ok");
  EXPECT_EQ(variant(planned_row(3, {1, 0.1}, 2)), "");
}

TEST(Grid, RowHasTheLargestEdgeAndTheNodesOfItsMesh) {
  Row row;
  describe_mesh(lagrange_mesh(icosphere(1, 0), 2), row);
  EXPECT_EQ(row.nodes, 42);
  EXPECT_NEAR(row.h, 4 / std::sqrt(10 + 2 * std::sqrt(5.0)), 1e-14) << "the edge of the icosahedron";
}

/// A recorder of the unit sphere.
struct Recorded : testing::Test {
  ~Recorded() override { fs::remove_all(folder); }

  void record(int n, double t) { recorder.record(n, t, mesh.nodes, {}); }

  const fs::path folder = fs::path(ESFEM_BINARY_DIR) / "test_grid" / std::to_string(getpid());
  const Mesh mesh = icosphere(1, 1);
  const SurfaceSpace space{mesh};
  RunRecorder recorder{space, snapshot_plan(folder.string(), {0.25}, "none", planned_row(0, {0.4, 0.1}, 0))};
};

TEST_F(Recorded, RowListsTheSeriesAndTheSnapshots) {
  for (int n : range(0, 4)) record(n, 0.1 * n);
  recorder.finish();
  Row row = planned_row(0, {0.4, 0.1}, 0, {{"flow", "none"}});
  describe_run(recorder, row);
  EXPECT_EQ(row.series.at("t").size(), 5u);
  EXPECT_EQ(variant(row), "flow=none");
  const nlohmann::json& snapshots = row.more.at("snapshots");
  ASSERT_EQ(snapshots.size(), 3u);
  EXPECT_EQ(snapshots[1].at("t"), 0.1 * 3) << "the first step at or after 0.25";
  for (const auto& snapshot : snapshots)
    EXPECT_TRUE(fs::exists(folder / snapshot.at("file").get<std::string>()));
  EXPECT_TRUE(fs::exists(folder / "surfaces.pvd"));
}

TEST(Grid, SnapshotsSayWhichRunTheyBelongTo) {
  Row row = planned_row(3, {1, 0.1}, 2, {{"method", "kll"}});
  describe_mesh(icosphere(1, 0), row);
  const RunLabel run = snapshot_plan("folder", {}, "mean_curvature", row).run;
  EXPECT_EQ(run.flow, "mean_curvature");
  const nlohmann::json expected = {{"method", "kll"}, {"level", 3},   {"h", row.h},
                                   {"nodes", 12},     {"tau", 0.025}, {"steps", 40}};
  EXPECT_EQ(nlohmann::json::parse(run.configuration), expected);
}

TEST_F(Recorded, WithoutFolderThereAreNoSnapshots) {
  RunRecorder without(space, snapshot_plan("", {0.25}, "none", Row()));
  without.record(0, 0, mesh.nodes, {});
  without.finish();
  Row row;
  describe_run(without, row);
  EXPECT_EQ(row.series.at("t").size(), 1u);
  EXPECT_FALSE(row.more.contains("snapshots"));
}

TEST_F(Recorded, StatusSaysHowARunEnded) {
  EXPECT_EQ(run_to_end([&] { record(0, 0); }, recorder), "ok");
  EXPECT_EQ(run_to_end([] { throw SingularityError("singular at t = 1: a pinch"); }, recorder),
            "singular at t = 1: a pinch");
  EXPECT_EQ(run_to_end([] { throw NumericsError("not definite"); }, recorder), "failed: not definite");
  EXPECT_THROW(run_to_end([] { throw InputError("usage"); }, recorder), InputError);
}

TEST_F(Recorded, SurfaceBeforeAFailureIsKept) {
  const auto fails_later = [&] {
    record(0, 0);
    record(1, 0.1);
    throw NumericsError("not definite");
  };
  run_to_end(fails_later, recorder);
  ASSERT_EQ(recorder.snapshots().size(), 2u);
  EXPECT_EQ(recorder.snapshots().back().t, 0.1);
}

TEST_F(Recorded, FailureBeforeAnyStepPassesThrough) {
  EXPECT_THROW(run_to_end([] { throw NumericsError("not definite"); }, recorder), NumericsError);
}

/// Parses "--flow a" as the command line of a program.
void parse(CommandLine& line, const std::vector<const char*>& arguments) {
  std::vector<const char*> all = {"program"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  line.parse(int(all.size()), all.data());
}

TEST(CommandLineTest, NamesAreAListOfKnownOnes) {
  const auto names = [](const std::vector<const char*>& arguments) {
    std::vector<std::string> names;
    CommandLine line("help", "program");
    line.names("--flow", {"a", "b", "c"}, names, "help");
    parse(line, arguments);
    return names;
  };
  EXPECT_THAT(names({}), IsEmpty());
  EXPECT_THAT(names({"--flow", "c,a"}), ElementsAre("c", "a"));
  EXPECT_THROW(names({"--flow", "a,d"}), InputError);
}

}  // namespace
}  // namespace esfem::test_grid
