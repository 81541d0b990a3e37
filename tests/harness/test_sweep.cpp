// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "experiments/evolve/config.hpp"
#include "experiments/evolve/sweep.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_sweep {
namespace {

using nlohmann::json;
using testing::AllOf, testing::ElementsAre, testing::HasSubstr;

template <class Action>
std::string refusal(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Sweep, ValuesAreJsonOrWords) {
  EXPECT_EQ(varied_key("parameters.gamma=10,2e1").key, "parameters.gamma");
  EXPECT_THAT(varied_key("parameters.gamma=10,2e1").values, ElementsAre(10, 20.0));
  EXPECT_THAT(varied_key("kinetics.diffusion=[1,10],[1,20]").values,
              ElementsAre(json({1, 10}), json({1, 20})));
  EXPECT_THAT(varied_key("start=exact,substeps:16").values, ElementsAre("exact", "substeps:16"));
  EXPECT_THAT(varied_key("variant.normalise=true,false").values, ElementsAre(true, false));
  EXPECT_THAT(varied_key("initial.u=min(x,y),\"max(x,y)\"").values, ElementsAre("min(x,y)", "max(x,y)"));
  EXPECT_THAT(varied_key("mesh={\"subdivisions\":1},{\"edge_length\":0.3}").values,
              ElementsAre(json{{"subdivisions", 1}}, json{{"edge_length", 0.3}}));
  for (const char* bad :
       {"gamma", "=1", "gamma=", "gamma=1,", "diffusion=[1,2", "f=\"x", "gamma=1,2,1", "gamma=[a]"})
    EXPECT_THAT(refusal([&] { varied_key(bad); }), HasSubstr(std::string("--set ") + bad)) << bad;
}

TEST(Sweep, ADottedKeyNamesAPlaceOfTheConfiguration) {
  const json configuration = {{"tau", 0.1}, {"kinetics", {{"diffusion", {1, 10}}}}};
  EXPECT_EQ(with_value(configuration, "tau", 0.2)["tau"], 0.2);
  EXPECT_EQ(with_value(configuration, "kinetics.diffusion.1", 20)["kinetics"]["diffusion"], json({1, 20}));
  EXPECT_EQ(with_value(configuration, "parameters.gamma", 3)["parameters"]["gamma"], 3);
  EXPECT_THAT(refusal([&] { with_value(configuration, "kinetics.diffusion.2", 20); }), HasSubstr("0 to 1"));
  EXPECT_THAT(refusal([&] { with_value(configuration, "tau.x", 1); }),
              AllOf(HasSubstr("tau is 0.1"), HasSubstr("expected an object")));
}

TEST(Sweep, CellsHaveNamesAndLabelsOfTheirValues) {
  const auto all = swept({{"tau", 0.1}}, {varied_key("parameters.gamma=10,2.5"), varied_key("tau=0.1,0.05")});
  std::vector<std::string> names;
  for (const SweptConfiguration& one : all) names.push_back(one.cell);
  EXPECT_THAT(names, ElementsAre("gamma10_tau0.1", "gamma10_tau0.05", "gamma2.5_tau0.1", "gamma2.5_tau0.05"));
  EXPECT_EQ(all[1].configuration, (json{{"tau", 0.05}, {"parameters", {{"gamma", 10}}}}));
  EXPECT_EQ(all[1].labels, (json{{"parameters.gamma", 10}}));
  // Values that would have equal or long names have numbers; equal ends of keys are not cut off.
  const auto formulas = swept(json::object(), {varied_key("initial.u=x+y,x*y"), varied_key("exact.u=1,2")});
  EXPECT_EQ(formulas.front().cell, "initial.u-0_exact.u1");
  EXPECT_EQ(swept(json::object(), {varied_key("kinetics.diffusion=[1,10],[1,20]")})[1].cell, "diffusion1-20");
  EXPECT_THAT(refusal([&] { swept({}, {varied_key("tau=1,2"), varied_key("tau=3")}); }), HasSubstr("twice"));
}

/// Sweeps of a small sphere.
class SweepProgram : public EvolveProgram {
 protected:
  const std::string output = (folder / "out").string();

  int sweep(const std::string& options, const json& changes = json::object()) {
    json configuration = config(changes);
    configuration["output"] = {{"series", "series.json"}};
    configuration["steps"] = 2;
    const std::string file = (folder / "config.json").string(), errors = (folder / "errors.txt").string();
    write_file(file, configuration.dump());
    const int status = run_command(ESFEM_BINARY_DIR "/bin/evolve " + file + " " + options + " >" +
                                   (folder / "out.txt").string() + " 2>" + errors);
    std::ifstream stream(errors);
    message.assign(std::istreambuf_iterator<char>(stream), {});
    return status;
  }
  Table table() const { return table_from_json(read_json(output + "/table.json"), output); }
};

TEST_F(SweepProgram, TheTableHasTheValuesOfEachRun) {
  ASSERT_EQ(sweep("--set flow=mean_curvature,dziuk --set tau=0.01,0.005 --output " + output), 0) << message;
  const Table found = table();
  ASSERT_EQ(found.rows.size(), 4u);
  for (const Row& row : found.rows) {
    EXPECT_EQ(row.status, "ok");
    EXPECT_NEAR(row.values.at("t"), 2 * row.tau, 1e-15);
    // The sphere: R² = 1 - 4t, and errors against this solution.
    EXPECT_NEAR(row.values.at("area") / (4 * M_PI * (1 - 8 * row.tau)), 1, 0.02) << row.cell;
    EXPECT_LT(row.errors.at("x").at("lifted_L2"), 0.05);
    EXPECT_GT(row.errors.at("x").at("lifted_L2"), 1e-6);
    EXPECT_NEAR(row.values.at("max_v"), 2 / std::sqrt(1 - 8 * row.tau), 0.3);
    EXPECT_TRUE(std::filesystem::exists(output + "/cells/" + row.cell + "/series.json")) << row.cell;
    EXPECT_FALSE(std::filesystem::exists(output + "/cells/" + row.cell + "/checkpoint"));
  }
  EXPECT_EQ(found.rows[2].labels, (json{{"flow", "dziuk"}}));
  EXPECT_FALSE(found.parameters.at("configuration").at("tau").is_number());  // it varies
  EXPECT_TRUE(std::filesystem::exists(output + "/table.csv") &&
              std::filesystem::exists(output + "/table.tex"));
}

TEST_F(SweepProgram, FinishedCellsAreKeptAndAChangedConfigurationIsRefused) {
  ASSERT_EQ(sweep("--set tau=0.01,0.005 --output " + output), 0) << message;
  const std::string before = read_json(output + "/table.json").at("rows").dump();
  ASSERT_EQ(sweep("--set tau=0.01,0.005 --output " + output), 0);
  EXPECT_THAT(message, HasSubstr("all 2 cells are finished and kept"));
  EXPECT_EQ(read_json(output + "/table.json").at("rows").dump(), before);
  ASSERT_EQ(sweep("--set tau=0.01,0.005,0.0025 --output " + output), 0);
  EXPECT_THAT(message, HasSubstr("2 of 3 cells are finished and kept"));
  EXPECT_EQ(sweep("--set tau=0.01,0.005 --output " + output, {{"degree", 1}}), 1);
  EXPECT_THAT(message,
              AllOf(HasSubstr("configuration/degree = none, expected 1"), HasSubstr("another --output")));
  EXPECT_EQ(table().rows.size(), 3u);
}

TEST_F(SweepProgram, CellsAreProcessesOfTheirOwn) {
  const std::string sets = "--set tau=0.01,0.005 --output " + output;
  ASSERT_EQ(sweep(sets + " --list"), 0) << message;
  std::ifstream list((folder / "out.txt").string());
  std::vector<std::string> names;
  double cost;
  for (std::string name; list >> name >> cost;) names.push_back(name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("tau0.01", "tau0.005"));
  EXPECT_EQ(sweep(sets + " --collect " + output + "/cells"), 1);
  EXPECT_THAT(message, HasSubstr("has not been run"));
  for (const std::string& name : names) EXPECT_EQ(sweep(sets + " --cell " + name), 0) << message;
  EXPECT_EQ(sweep(sets + " --collect " + output + "/cells"), 0) << message;
  EXPECT_EQ(table().rows.size(), 2u);
  EXPECT_EQ(sweep(sets + " --cell tau3"), 1);
  EXPECT_THAT(message, HasSubstr("one of the 2 cells"));
}

TEST_F(SweepProgram, UnknownKeysAndBadValuesAreThoseOfTheConfiguration) {
  EXPECT_EQ(sweep("", {{"variant", {{"normalize", true}}}}), 1);
  const std::string of_configuration = message;
  EXPECT_EQ(sweep("--set variant.normalize=true,false --output " + output), 1);
  EXPECT_EQ(message, of_configuration);
  // Also where only a later cell has it.
  EXPECT_EQ(sweep("--set tau=0.1,-0.1 --output " + output), 1);
  EXPECT_THAT(message, HasSubstr("found tau = -0.1"));
  EXPECT_FALSE(std::filesystem::exists(output));
  EXPECT_EQ(sweep("--set mesh.subdivisons=1 --output " + output), 1);
  EXPECT_THAT(message, HasSubstr("subdivisons"));
  for (const char* without_folder : {"--set tau=0.1", "--cell run", "--collect out"}) {
    EXPECT_EQ(sweep(without_folder), 1);
    EXPECT_THAT(message, HasSubstr("--output is required"));
  }
}

TEST_F(SweepProgram, ARunThatEndsEarlyIsARowWithItsValues) {
  ASSERT_EQ(sweep("--set tau=0.01,0.2 --output " + output), 0) << message;
  const Table found = table();
  EXPECT_EQ(found.rows[0].status, "ok");
  EXPECT_NE(found.rows[1].status, "ok");
}

}  // namespace
}  // namespace esfem::test_sweep
