// SPDX-License-Identifier: GPL-3.0-or-later
// Which runs a grid has, and what they are called.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/harness/choice.hpp"
#include "solver/error.hpp"

namespace esfem::test_choice {
namespace {

using testing::ElementsAre, testing::HasSubstr;

Grid grid() {
  Grid grid;
  grid.axes = {{"flow", {"willmore", "bgn"}, "schemes"}, {"theta", {"no", "yes"}, "with or without"}};
  grid.labels = {"flow", "theta", "bdf"};
  grid.otherwise = [](bool) { return Block{{"theta", "no"}, {"degree", 2}, {"bdf", 1}, {"step", {0, 1}}}; };
  grid.preset = [](bool paper) {
    return std::vector<Block>{{{"flow", "bgn"}, {"step", paper ? 3 : 2}}, {{"theta", "yes"}, {"step", 2}}};
  };
  grid.refused = {{"step", "has its own"}, {"mesh", "has its own"}};
  return grid;
}

std::vector<std::string> cells(const GridRequest& request) {
  std::vector<std::string> names;
  for (const Choice& choice : choices(grid(), request)) names.push_back(cell_name(grid(), choice));
  return names;
}

/// A request of preset paper with some values given.
GridRequest given(const Block& values) {
  GridRequest request;
  request.given = values;
  return request;
}

TEST(Choices, AreThoseOfThePresetUnlessAnAxisIsGiven) {
  GridRequest request;
  EXPECT_THAT(cells(request),
              ElementsAre("bgn_bdf1_tau3", "willmore_theta_bdf1_tau2", "bgn_theta_bdf1_tau2"));
  request.paper = false;
  EXPECT_EQ(cells(request).front(), "bgn_bdf1_tau2");
  EXPECT_THAT(cells(given({{"flow", "bgn"}})), ElementsAre("bgn_bdf1_tau0", "bgn_bdf1_tau1"));
}

TEST(Choices, HaveAllNamesOfAnAxisThatNothingIsSaidOf) {
  EXPECT_THAT(cells(given({{"bdf", 2}})),
              ElementsAre("willmore_bdf2_tau0", "willmore_bdf2_tau1", "bgn_bdf2_tau0", "bgn_bdf2_tau1"));
}

TEST(Choices, RefuseWhatTheExperimentDoesNotTakeByTheNameOfTheOption) {
  const auto message = [](const GridRequest& request) -> std::string {
    try {
      choices(grid(), request);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message(given({{"step", 1}})), HasSubstr("--steps: has its own"));
  GridRequest with_mesh;
  with_mesh.meshes = {"a.msh"};
  EXPECT_THAT(message(with_mesh), HasSubstr("--mesh: has its own"));
  EXPECT_EQ(message(given({{"bdf", 2}})), "");
}

TEST(Choices, NamesOfAMapAreItsKeys) {
  EXPECT_THAT(names_of(std::map<std::string, int>{{"b", 1}, {"a", 2}}), ElementsAre("a", "b"));
}

}  // namespace
}  // namespace esfem::test_choice
