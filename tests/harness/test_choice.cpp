// SPDX-License-Identifier: GPL-3.0-or-later
// Which runs a grid has, and what they are called.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/harness/choice.hpp"
#include "solver/error.hpp"

namespace esfem::test_choice {
namespace {

using testing::ElementsAre, testing::HasSubstr;
using Json = nlohmann::json;

/// Two schemes on some levels; a preset of three runs.
Grid sample() {
  Grid grid;
  grid.axes = {{"flow", {"one", "other"}, "help"}, {"gamma", {}, "help"}};
  grid.labels = {"flow", "bdf"};
  grid.otherwise = [](bool paper) -> Block {
    return {{"flow", "one"}, {"gamma", 0.5},     {"degree", 2},
            {"bdf", 3},      {"start", "exact"}, {"level", paper ? range(0, 2) : range(0, 0)},
            {"step", {1, 2}}};
  };
  grid.preset = [](bool paper) -> std::vector<Block> {
    if (!paper) return {{}};
    return {{{"flow", {"one", "other"}}, {"level", 0}, {"step", 1}}, {{"bdf", 4}, {"level", 1}, {"step", 2}}};
  };
  return grid;
}

GridRequest given(Block values) {
  GridRequest request;
  request.given = std::move(values);
  return request;
}

std::vector<std::string> names(const Grid& grid, const GridRequest& request) {
  std::vector<std::string> names;
  for (const Choice& choice : choices(grid, request)) names.push_back(cell_name(grid, choice));
  return names;
}

/// The message of the InputError; "" without one.
std::string refusal(const Grid& grid, const GridRequest& request) {
  try {
    choices(grid, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Choices, ThePresetIsItsBlocksWithWhatTheyDoNotSay) {
  EXPECT_THAT(names(sample(), {}), ElementsAre("one_bdf3_h0_tau1", "other_bdf3_h0_tau1", "one_bdf4_h1_tau2"));
  GridRequest check;
  check.paper = false;
  EXPECT_THAT(names(sample(), check), ElementsAre("one_bdf3_h0_tau1", "one_bdf3_h0_tau2"));
}

TEST(Choices, WithoutPresetTheyAreAllCombinations) {
  Grid grid = sample();
  grid.preset = nullptr;
  EXPECT_EQ(names(grid, {}).size(), 6u);
}

TEST(Choices, AGivenValueLeavesThePreset) {
  EXPECT_THAT(
      names(sample(), given({{"flow", {"one", "other"}}, {"level", 2}})),
      ElementsAre("one_bdf3_h2_tau1", "one_bdf3_h2_tau2", "other_bdf3_h2_tau1", "other_bdf3_h2_tau2"));
  // Of every axis, also one that is no label.
  const std::vector<Choice> runs = choices(sample(), given({{"gamma", 2.0}}));
  ASSERT_EQ(runs.size(), 6u);
  for (const Choice& choice : runs) {
    EXPECT_EQ(choice.number("gamma"), 2);
    EXPECT_EQ(choice["flow"], "one");
    EXPECT_EQ(choice.degree(), 2);
    EXPECT_EQ(choice.start().kind, Start::exact);
  }
}

TEST(Choices, HaveAllNamesOfAnAxisThatNothingIsSaidOf) {
  Grid grid = sample();
  grid.axes.push_back({"theta", {"no", "yes"}, "help"});
  grid.labels.push_back("theta");
  EXPECT_THAT(names(grid, given({{"level", 1}, {"step", 0}})),
              ElementsAre("one_bdf3_h1_tau0", "one_bdf3_theta_h1_tau0"));
}

TEST(Choices, MeshFilesAreTheLevels) {
  GridRequest request;
  request.meshes = {"a.msh", "b.msh"};
  EXPECT_THAT(names(sample(), request),
              ElementsAre("one_bdf3_h0_tau1", "one_bdf3_h0_tau2", "one_bdf3_h1_tau1", "one_bdf3_h1_tau2"));
  EXPECT_THAT(choices(sample(), request)[0].meshes(), ElementsAre("a.msh", "b.msh"));
  request.given = {{"level", {0, 2}}};
  EXPECT_EQ(refusal(sample(), request),
            "--levels: found 2, expected less than 2, the number of --mesh files");
}

TEST(Choices, OptionsThatTheExperimentDoesNotTakeAreRefused) {
  Grid grid = sample();
  for (const char* option : {"mesh", "start", "step", "quadrature"}) grid.refused[option] = "because";
  EXPECT_EQ(refusal(grid, given({{"start", "cascade"}})), "--start: because");
  EXPECT_EQ(refusal(grid, given({{"step", 3}})), "--steps: because");
  GridRequest request;
  request.meshes = {"a.msh"};
  EXPECT_EQ(refusal(grid, request), "--mesh: because");
  request.meshes.clear();
  request.rule = "conical:3";
  EXPECT_EQ(refusal(grid, request), "--quadrature: because");
  EXPECT_EQ(refusal(grid, given({{"level", 0}})), "");
}

TEST(Choices, ARunOfTwoBlocksIsOneRun) {
  Grid grid = sample();
  grid.preset = [](bool) -> std::vector<Block> { return {{{"level", {0, 1}}}, {{"level", {1, 2}}}}; };
  EXPECT_EQ(names(grid, {}).size(), 6u);
}

TEST(Choices, RunsThatNoLabelTellsApartAreRefused) {
  EXPECT_EQ(refusal(sample(), given({{"gamma", {2.0, 3.0}}, {"level", 0}, {"step", 1}})),
            "--gamma: found several values for the run one_bdf3_h0_tau1, expected one: no label "
            "distinguishes its rows");
}

TEST(Choices, TheGridSaysWhichCombinationsAreRuns) {
  Grid grid = sample();
  grid.admits = [](const Choice& choice) {
    if (choice.bdf() == 5) throw InputError("--bdf: no");
    return choice["flow"] == "other" || choice.level() == 0;
  };
  EXPECT_THAT(
      names(grid, given({{"flow", {"one", "other"}}, {"step", 0}})),
      ElementsAre("one_bdf3_h0_tau0", "other_bdf3_h0_tau0", "other_bdf3_h1_tau0", "other_bdf3_h2_tau0"));
  EXPECT_EQ(refusal(grid, given({{"bdf", 5}})), "--bdf: no");
}

TEST(Choices, WhatFollowsFromOtherValuesReplacesThem) {
  Grid grid = sample();
  grid.implied = [](const Choice& choice) { return choice["flow"] == "other" ? Block{{"bdf", 1}} : Block(); };
  EXPECT_THAT(names(grid, given({{"flow", {"one", "other"}}, {"bdf", {2, 4}}, {"step", 1}, {"level", 0}})),
              ElementsAre("one_bdf2_h0_tau1", "other_bdf1_h0_tau1", "one_bdf4_h0_tau1"))
      << "and what is then the same is one run";
}

TEST(Choices, QuadratureIsThatOfTheDegreeUnlessGiven) {
  GridRequest request;
  EXPECT_EQ(choices(sample(), request)[0].quadrature().name, default_quadrature(2).name);
  request.rule = "conical:5";
  EXPECT_EQ(choices(sample(), request)[0].quadrature().name, conical_quadrature(5).name);
  request.rule = "soon";
  EXPECT_THROW(choices(sample(), request)[0].quadrature(), InputError);
}

TEST(Choices, AnAxisThatThereIsNotIsAMistakeOfTheProgram) {
  const Choice choice = choices(sample(), {})[0];
  EXPECT_THROW(choice.number("delta"), std::logic_error);
  EXPECT_FALSE(choice.has("delta"));
  EXPECT_TRUE(choice.has("gamma"));
}

TEST(Labels, AreNamesAndNumbers) {
  const Json expected = {{"flow", "other"}, {"bdf", 3}};
  EXPECT_EQ(labels(sample(), choices(sample(), {})[1]), expected);
}

TEST(Labels, NamesOfRunsHaveNoOtherCharactersThanFilesMayHave) {
  Grid grid = sample();
  grid.labels = {"start", "degree", "gamma"};
  EXPECT_THAT(names(grid, given({{"start", "substeps:16"}, {"level", 0}, {"step", 1}})),
              ElementsAre("substeps16_p2_gamma0.5_h0_tau1"));
  grid.otherwise = [](bool) -> Block {
    return {{"flow", "one"}, {"start", "exact"}, {"degree", 1}, {"gamma", 1}};
  };
  EXPECT_THAT(names(grid, given({{"degree", 3}})), ElementsAre("exact_p3_gamma1")) << "neither mesh nor step";
}

TEST(Labels, NamesOfAMapAreItsKeys) {
  EXPECT_THAT(names_of(std::map<std::string, int>{{"b", 1}, {"a", 2}}), ElementsAre("a", "b"));
}

TEST(CommonValues, AreThoseOfAllRunsThatAreNoLabels) {
  const auto common = [](const Grid& grid, const GridRequest& request) {
    return common_values(grid, choices(grid, request));
  };
  const Json all = {{"degree", 2}, {"start", "exact"}, {"gamma", 0.5}};
  EXPECT_EQ(common(sample(), {}), all);
  Grid grid = sample();
  grid.labels.push_back("gamma");
  const Json without_gamma = {{"degree", 2}, {"start", "exact"}};
  EXPECT_EQ(common(grid, {}), without_gamma);
  grid.preset = [](bool) -> std::vector<Block> {
    return {{{"level", 0}}, {{"level", 1}, {"start", "cascade"}}};
  };
  EXPECT_EQ(common(grid, {}), Json({{"degree", 2}}));
  EXPECT_EQ(common_values(grid, {}), Json::object());
}

}  // namespace
}  // namespace esfem::test_choice
