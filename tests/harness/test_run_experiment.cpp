// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the fake experiment as a user does: command lines in, exit codes, text and tables out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/tables/table.hpp"

namespace esfem::test_run_experiment {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

struct Outcome {
  int exit_code;
  std::string out, err;
};

std::string content(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class RunExperiment : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::path(testing::TempDir()) /
             ("run_experiment_" + std::to_string(getpid()) + "_" +
              std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  Outcome run(const std::string& arguments, const std::string& environment = "") const {
    const fs::path out = folder / "stdout", err = folder / "stderr";
    const std::string command = "cd " + folder.string() + " && exec env " + environment +
                                " " ESFEM_BINARY_DIR "/bin/fake_experiment " + arguments + " >" +
                                out.string() + " 2>" + err.string();
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(out), content(err)};
    fs::remove(out);
    fs::remove(err);
    return outcome;
  }
  Table table(const std::string& file) const {
    return table_from_json(read_json((folder / file).string()), file);
  }
  void run_all_cells() const {
    for (const char* name : {"h0_tau0", "h0_tau1", "h1_tau0", "h1_tau1"})
      ASSERT_EQ(run(std::string("--cell ") + name + " --output " + name + ".json").exit_code, 0) << name;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  fs::path folder;
};

TEST_F(RunExperiment, HelpGoesToStandardOutputAndSaysEverything) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const char* part :
       {"Sample run", "--preset", "=paper", "--cell", "--start", "--exponent", "Exit codes"})
    EXPECT_THAT(help.out, HasSubstr(part));
}

TEST_F(RunExperiment, BadCommandLinesGetOneLineWithWhatIsAcceptedAndExit1) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"--no-such-option", "--preset"},
      {"extra", "--preset"},
      {"--preset coarse", "check,paper"},
      {"--degree 5", "1 to 4"},
      {"--bdf x", "1 to 5"},
      {"--bdf 2", "the formula has no steps"},
      {"--exponent soon", "--exponent"},
      {"--exponent 1,2", "expected one: no label"},
      {"--levels 3-1", "0-4"},
      {"--levels 1,,2", "0,1,2"},
      {"--steps=-1", "0-4"},
      {"--start soon", "substeps:K"},
      {"--mesh no.msh", "no.msh"},
      {"--cell h9_tau9", "h0_tau0"},
      {"--list --cell h0_tau0", "excludes"},
      {"--threads 0", "1 to 1024"},
      {"--collect . --cell h0_tau0", "excludes"},
      {"--cell h0_tau0 --output /proc/no/a.json", "/proc/no"}};
  for (const auto& [arguments, accepted] : cases) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 1) << arguments;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_THAT(outcome.err, StartsWith("fake_experiment: ")) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(accepted)) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST_F(RunExperiment, ListsTheMostExpensiveCellFirst) {
  const Outcome list = run("--list --preset check");
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_EQ(list.out, "h1_tau1 8.00\nh1_tau0 4.00\nh0_tau1 2.00\nh0_tau0 1.00\n");
}

TEST_F(RunExperiment, LevelsAndStepsSelectCells) {
  EXPECT_EQ(run("--list --levels 2 --steps 0,2-3").out, "h2_tau3 128.00\nh2_tau2 64.00\nh2_tau0 16.00\n");
}

TEST_F(RunExperiment, AnOptionOfItsOwnReachesTheRunsAndTheParameters) {
  ASSERT_EQ(run("--exponent 4 --output all.json").exit_code, 0);
  const Table all = table("all.json");
  ASSERT_EQ(all.rows.size(), 4u);
  EXPECT_NEAR(all.rows[2].errors.at("u").at("nodal_L2"), 0.0625 + 1e-3, 1e-12);
  EXPECT_EQ(all.parameters.at("exponent"), 4);
  EXPECT_EQ(all.parameters.at("degree"), 2);
  EXPECT_EQ(all.parameters.at("preset"), "paper");
}

TEST_F(RunExperiment, CellWritesATableOfOneRowAndNothingElse) {
  const Outcome outcome = run("--cell h1_tau0 --output cell.json");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(files(), std::vector<std::string>{"cell.json"});
  const Table cell = table("cell.json");
  EXPECT_EQ(cell.experiment, "fake_experiment");
  ASSERT_EQ(cell.rows.size(), 1u);
  EXPECT_EQ(cell.rows[0].cell, "h1_tau0");
  EXPECT_EQ(cell.rows[0].status, "ok");
  EXPECT_NEAR(cell.rows[0].errors.at("u").at("nodal_L2"), 0.25 + 1e-3, 1e-12);
  EXPECT_GT(cell.rows[0].peak_memory_mb, 0);
}

TEST_F(RunExperiment, ProvenanceSaysWhereTheNumbersComeFrom) {
  run("--cell h0_tau0 --output cell.json");
  const nlohmann::json provenance = table("cell.json").provenance;
  for (const char* key :
       {"version", "git", "dirty", "compiler", "flags", "cpu", "threads", "date", "command"})
    EXPECT_TRUE(provenance.contains(key)) << key;
  EXPECT_EQ(provenance["command"], "fake_experiment --cell h0_tau0 --output cell.json");
  EXPECT_EQ(provenance["threads"], 1);
  EXPECT_NE(provenance["compiler"], "unknown");
  EXPECT_THAT(provenance["date"].get<std::string>(), testing::MatchesRegex("....-..-..T..:..:..Z"));
}

// The sanitizer's own memory is larger than what this looks for.
#ifndef __SANITIZE_ADDRESS__
TEST_F(RunExperiment, PeakMemoryIsNotThatOfTheProgramThatStartedIt) {
  std::vector<char> large(200 << 20, 1);  // resident in this process while the child starts
  run("--cell h0_tau0 --output cell.json");
  EXPECT_EQ(large[large.size() / 2], 1);
  EXPECT_LT(table("cell.json").rows[0].peak_memory_mb, 150);
}
#endif

TEST_F(RunExperiment, AFailedCellIsARowWithItsStatus) {
  const Outcome outcome = run("--cell h1_tau0 --output cell.json", "FAILING_CELL=h1_tau0");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "fake_experiment: cell h1_tau0: failed: step 3, t = 0.3: element 7 is degenerate\n");
  const Row row = table("cell.json").rows.at(0);
  EXPECT_EQ(row.status, "failed: step 3, t = 0.3: element 7 is degenerate");
  EXPECT_EQ(row.tau, 0.1) << "what is known beforehand stays in the row";
  EXPECT_EQ(row.h, 0.5) << "and its mesh";
  EXPECT_TRUE(row.errors.empty());
}

TEST_F(RunExperiment, AnEndThatIsKnownIsMarkedAsExpected) {
  const Outcome outcome = run("--cell h0_tau0 --output cell.json", "FAILING_CELL=h0_tau0");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err,
              testing::EndsWith("element 7 is degenerate; as expected: level 0 is too coarse\n"));
  EXPECT_EQ(table("cell.json").rows.at(0).status, "failed: step 3, t = 0.3: element 7 is degenerate");
}

TEST_F(RunExperiment, AFailureThatIsNotTheMethodsLeavesNoRow) {
  const Outcome outcome = run("--cell h1_tau0 --output cell.json", "MEMORY_CELL=h1_tau0");
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err, "fake_experiment: out of memory\n");
  EXPECT_TRUE(files().empty());
}

TEST_F(RunExperiment, SecondsAreThoseOfAllProcesses) {
  run("--cell h0_tau0 --output cell.json", "EARLIER_SECONDS=1000 MILLISECONDS=50");
  EXPECT_GT(table("cell.json").rows.at(0).seconds, 1000.05);
}

TEST_F(RunExperiment, MakesTheFolderOfItsOutputOrRefusesItBeforehand) {
  EXPECT_EQ(run("--output new/folder/all.json").exit_code, 0);
  EXPECT_EQ(table("new/folder/all.json").rows.size(), 4u);
  const Outcome outcome = run("--output new", "MILLISECONDS=60000");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("new: cannot be written: it is a folder"));
  fs::create_directory(folder / "a.csv");
  EXPECT_THAT(run("--output a.json", "MILLISECONDS=60000").err, HasSubstr("a.csv: cannot be written"));
}

TEST_F(RunExperiment, TheCheckpointGoesWhenTheRowIsWritten) {
  fs::create_directory(folder / "h0_tau0");
  std::ofstream(folder / "h0_tau0/checkpoint") << "of this cell";
  EXPECT_EQ(run("--cell h0_tau0 --output h0_tau0.json", "MEMORY_CELL=h0_tau0").exit_code, 2);
  EXPECT_TRUE(fs::exists(folder / "h0_tau0/checkpoint"));
  EXPECT_EQ(run("--cell h0_tau0 --output h0_tau0.json").exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "h0_tau0/checkpoint"));
}

TEST_F(RunExperiment, CollectsAllCellsInTheOrderOfTheGrid) {
  run_all_cells();
  const Outcome outcome = run("--collect . --output all.json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const Table all = table("all.json");
  ASSERT_EQ(all.rows.size(), 4u);
  EXPECT_EQ(all.rows[0].cell, "h0_tau0");
  EXPECT_EQ(all.rows[3].cell, "h1_tau1");
  EXPECT_TRUE(fs::exists(folder / "all.csv") && fs::exists(folder / "all.tex"));
  EXPECT_EQ(files().size(), 4u + 3u) << "nothing temporary is left";
}

TEST_F(RunExperiment, CollectingNamesTheMissingCell) {
  run_all_cells();
  fs::remove(folder / "h1_tau0.json");
  const Outcome outcome = run("--collect . --output all.json");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("h1_tau0"));
  EXPECT_FALSE(fs::exists(folder / "all.json"));
}

TEST_F(RunExperiment, CollectingRefusesCellsOfOtherParametersAndOtherCells) {
  run_all_cells();
  EXPECT_THAT(run("--collect . --degree 3").err, HasSubstr("parameters"));
  fs::copy_file(folder / "h0_tau0.json", folder / "h1_tau0.json", fs::copy_options::overwrite_existing);
  EXPECT_THAT(run("--collect .").err, HasSubstr("h1_tau0.json: expected a table with one row"));
}

TEST_F(RunExperiment, CollectingKeepsTheProvenanceOfTheCells) {
  run_all_cells();
  nlohmann::json other = read_json((folder / "h0_tau0.json").string());
  other["provenance"]["git"] = "another commit";
  other["provenance"]["cpu"] = "another machine";
  write_file((folder / "h0_tau0.json").string(), other.dump());
  ASSERT_EQ(run("--collect . --output all.json").exit_code, 0);
  const nlohmann::json provenance = table("all.json").provenance;
  EXPECT_EQ(provenance["git"].size(), 2u) << provenance["git"];
  EXPECT_EQ(provenance["cpu"].size(), 2u);
  EXPECT_EQ(provenance["threads"], 1);
}

TEST_F(RunExperiment, RunsAndCollectsAllWithoutCell) {
  const Outcome outcome = run("--output all.json", "FAILING_CELL=h0_tau1");
  EXPECT_EQ(outcome.exit_code, 0);
  const Table all = table("all.json");
  ASSERT_EQ(all.rows.size(), 4u) << "a failed run is a row, never a missing one";
  EXPECT_THAT(all.rows[1].status, StartsWith("failed: "));
  EXPECT_EQ(all.rows[2].status, "ok");
}

TEST_F(RunExperiment, FilesOfARunAreBesideItsTable) {
  run("--cell h0_tau1 --output h0_tau1.json", "WRITING_CELL=h0_tau1");
  EXPECT_TRUE(fs::exists(folder / "h0_tau1/snapshot"));
  run("--output all.json", "WRITING_CELL=h0_tau1");
  EXPECT_TRUE(fs::exists(folder / "cells/fake_experiment/h0_tau1/snapshot"));
  // Without a table there is no place for them.
  const auto before = files().size();
  run("--cell h0_tau1", "WRITING_CELL=h0_tau1");
  EXPECT_EQ(files().size(), before);
}

TEST_F(RunExperiment, WritesToStandardOutputWithoutOutput) {
  const nlohmann::json json = nlohmann::json::parse(run("--levels 0 --steps 0").out);
  EXPECT_EQ(table_from_json(json, "stdout").rows.size(), 1u);
}

TEST_F(RunExperiment, ThreadsAreThoseAskedFor) {
  const auto row_of = [&](const std::string& options) {
    run("--cell h0_tau0 --output cell.json" + options);
    return read_json((folder / "cell.json").string());
  };
  EXPECT_EQ(row_of("")["rows"][0]["threads_of_a_factor"], 1);
  for (const char* option : {" --threads 2", " --threads=2"}) {
    const nlohmann::json table = row_of(option);
    EXPECT_EQ(table["provenance"]["threads"], 2);
    EXPECT_EQ(table["rows"][0]["threads_of_a_factor"], 2);
    EXPECT_EQ(table["rows"][0]["threads_started"], 0) << "by a BLAS";
  }
}

}  // namespace
}  // namespace esfem::test_run_experiment
