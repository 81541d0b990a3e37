// SPDX-License-Identifier: GPL-3.0-or-later
// `make` with GROUP: the cells of the fake experiment in groups, each of which is one launched process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/harness/evolve_program.hpp"

namespace esfem::test_cell_groups {
namespace {

using testing::HasSubstr;
using testing::Not;

/// The project's Makefile in a folder of its own, where the fake experiment is the only one. Its cells cost 8
/// (h1_tau1), 4, 2 and 1 s.
struct CellGroups : EvolveProgram {
  const std::filesystem::path cells = folder / "results/check/cells/fake_experiment";
  std::string said;

  void SetUp() override {
    EvolveProgram::SetUp();
    for (const char* part : {"Makefile", "experiments", "plots"})
      std::filesystem::create_symlink(std::filesystem::path(ESFEM_SOURCE_DIR) / part, folder / part);
    std::filesystem::create_directory_symlink(ESFEM_BINARY_DIR, folder / "build");
  }
  int make(const std::string& options, const std::string& environment = "") {
    const std::string out = (folder / "out.txt").string();
    const int code = run_command("cd " + folder.string() + " && env -u MAKEFLAGS MAKELEVEL=1 " + environment +
                                 " make -j2 tables-check stems=fake_experiment PYTHON=false " + options +
                                 " >" + out + " 2>&1");
    said = content(out);
    return code;
  }
  static std::string content(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  bool has_table() const { return std::filesystem::exists(folder / "results/check/fake_experiment.json"); }
};

TEST_F(CellGroups, ArePackedByCostAndGiveTheTable) {
  EXPECT_EQ(make("GROUP=4"), 0) << said;
  EXPECT_THAT(said, HasSubstr("== 3 groups of about 4 s, the longest of about 8 s"));
  EXPECT_EQ(content(cells / "../.groups/1"), "fake_experiment h1_tau1 8.00\n");
  EXPECT_EQ(content(cells / "../.groups/2"), "fake_experiment h1_tau0 4.00\n");
  EXPECT_EQ(content(cells / "../.groups/3"), "fake_experiment h0_tau1 2.00\nfake_experiment h0_tau0 1.00\n");
  EXPECT_THAT(said, HasSubstr("group 3: 2 of 2 runs are done"));
  EXPECT_THAT(said, HasSubstr("4 of 4 runs (100%)"));
  EXPECT_TRUE(has_table());
}

TEST_F(CellGroups, AFailedCellIsTriedTwiceAndListedAndStopsNoOther) {
  EXPECT_EQ(make("GROUP=100", "MEMORY_CELL=h1_tau0"), 2) << said;
  EXPECT_THAT(said, HasSubstr("group 1: 3 of 4 runs are done"));
  EXPECT_THAT(said, HasSubstr("\nfake_experiment/h1_tau0: attempt 2 of 2 failed: exit code 2\n"));
  EXPECT_THAT(said, HasSubstr("== 1 runs FAILED"));
  EXPECT_THAT(said, HasSubstr("\nfake_experiment/h1_tau0: exit code 2: fake_experiment: out of memory\n"));
  EXPECT_EQ(content(cells / "h1_tau0.failed"),
            "exit code 2: fake_experiment: out of memory\nexit code 2: fake_experiment: out of memory\n");
  EXPECT_FALSE(has_table());

  const std::string earlier = content(cells / "h1_tau1.json");
  EXPECT_EQ(make("GROUP=100"), 0) << said;
  EXPECT_EQ(content(cells / "../.groups/1"), "fake_experiment h1_tau0 4.00\n") << "finished cells are kept";
  EXPECT_EQ(content(cells / "h1_tau1.json"), earlier);
  EXPECT_FALSE(std::filesystem::exists(cells / "h1_tau0.failed"));
  EXPECT_TRUE(has_table());
}

TEST_F(CellGroups, ACellThatEndsItsWholeGroupComesLastTheSecondTime) {
  EXPECT_EQ(make("GROUP=100 LAUNCH='setsid -w'", "KILLING_CELL=h1_tau0"), 2) << said;
  EXPECT_THAT(said, HasSubstr("\nfake_experiment/h1_tau0: its process was ended with the whole group"));
  for (const char* cell : {"h0_tau0.json", "h0_tau1.json", "h1_tau1.json"})
    EXPECT_TRUE(std::filesystem::exists(cells / cell)) << cell;
}

TEST_F(CellGroups, ALauncherThatDoesNotStartIsTheReason) {
  EXPECT_EQ(make("GROUP=100 LAUNCH=false"), 2) << said;
  EXPECT_THAT(said,
              HasSubstr("fake_experiment/h0_tau0: not begun in 3 launches; the last one ended with exit "
                        "code 1: false\n"));
}

TEST_F(CellGroups, RefusesAGroupThatIsNoTime) {
  EXPECT_EQ(make("GROUP=1min"), 2);
  EXPECT_THAT(said, HasSubstr("GROUP is \"1min\": expected the seconds of a group, such as GROUP=60\n"));
}

TEST_F(CellGroups, WithoutGroupEachCellIsLaunched) {
  EXPECT_EQ(make("LAUNCH='echo launched;'"), 0) << said;
  EXPECT_FALSE(std::filesystem::exists(cells / "../.groups"));
  EXPECT_THAT(said, Not(HasSubstr("group")));
  EXPECT_THAT(said, HasSubstr("launched"));
  EXPECT_TRUE(has_table());
}

}  // namespace
}  // namespace esfem::test_cell_groups
