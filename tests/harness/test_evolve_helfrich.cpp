// SPDX-License-Identifier: GPL-3.0-or-later
// Helfrich flow by evolve.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/flows/area_and_volume.hpp"
#include "solver/tables/json_reader.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_helfrich {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct EvolveHelfrich : EvolveProgram {
  json flow(const json& parameters = json::object(), const json& changes = json::object()) const {
    json result = config({{"flow", "helfrich"},
                          {"surface", {{"name", "ellipsoid"}, {"radius", nullptr}, {"axes", {1.2, 1, 0.8}}}},
                          {"mesh", {{"subdivisions", 2}}},
                          {"tau", 1e-3},
                          {"parameters", parameters}});
    result.merge_patch(changes);
    return result;
  }
  std::vector<double> column(const std::string& name) const { return read_json(series).at(name); }
  const json as_willmore = {{"project", true}, {"theta", true}, {"relaxation", 0}};
  double change(const std::string& name) const { return column(name).back() / column(name).front() - 1; }
};

TEST_F(EvolveHelfrich, KeepsWhatItIsToldTo) {
  ASSERT_EQ(run(flow()), exit_done) << message;
  EXPECT_LT(std::abs(change("area")), 1e-12);
  EXPECT_LT(std::abs(change("volume")), 1e-12);
  EXPECT_LT(change("helfrich_energy"), -1e-3);
  EXPECT_NEAR(column("lambda_A")[0], -7.18034, 0.05);
  EXPECT_NEAR(column("lambda_V")[0], 14.86498, 0.1);
  ASSERT_EQ(run(flow({{"constraints", {"volume"}}, {"spontaneous_curvature", 0.5}})), exit_done) << message;
  EXPECT_GT(std::abs(change("area")), 1e-4);
  EXPECT_LT(std::abs(change("volume")), 1e-12);
  EXPECT_EQ(column("lambda_A").back(), 0);
  ASSERT_EQ(run(flow({{"constraints", json::array()}}, {{"variant", as_willmore}})), exit_done) << message;
  EXPECT_EQ(column("lambda_V").back(), 0);
  const std::vector<double> helfrich = column("willmore_energy");
  json willmore = flow({}, {{"flow", "willmore"}});
  willmore.erase("parameters");
  ASSERT_EQ(run(willmore), exit_done) << message;
  EXPECT_EQ(column("willmore_energy"), helfrich) << "without constraints and H_0 it is Willmore flow";
}

TEST_F(EvolveHelfrich, BecomesStationaryByDefault) {
  const json flat = {{"surface", {{"axes", {1.4, 1.2, 0.3355}}}},
                     {"bdf", nullptr},
                     {"tau", nullptr},
                     {"steps", nullptr},
                     {"adaptive", {{"end_time", 0.6}}}};
  ASSERT_EQ(run(flow({}, flat)), exit_done) << message;
  EXPECT_EQ(message.find("differ"), std::string::npos) << message;
  EXPECT_NEAR(column("helfrich_energy").back() / column("kappa_energy").back(), 1, 0.02);
  json without = flat;
  without["variant"] = as_willmore;
  EXPECT_EQ(run(flow({}, without)), exit_numerics) << message;
  // In the unit of time of the surface, and as far as the steps admit.
  ASSERT_EQ(run(flow()), exit_done) << message;
  const double area = column("area")[0], energy = column("helfrich_energy").back(), pi = std::acos(-1);
  const auto energy_with = [&](double relaxation, double tau) {
    EXPECT_EQ(run(flow({}, {{"variant", {{"relaxation", relaxation}}}, {"tau", tau}})), exit_done) << message;
    return column("helfrich_energy").back();
  };
  EXPECT_NEAR(energy_with(100 * std::pow(4 * pi / area, 2), 1e-3), energy, 1e-12);
  EXPECT_GT(std::abs(energy_with(50, 1e-3) - energy), 1e-6);
  ASSERT_EQ(run(flow({}, {{"tau", 4e-3}})), exit_done) << message;
  const double in_large_steps = column("helfrich_energy").back();
  EXPECT_NEAR(energy_with(50, 4e-3), in_large_steps, 1e-12);
}

TEST_F(EvolveHelfrich, WarnsOfStepsThatAreUnstable) {
  const json flat = {{"surface", {{"axes", {1.4, 1.2, 0.5}}}}, {"tau", 1e-3}, {"steps", 6}};
  ASSERT_EQ(run(flow({}, flat)), exit_done) << message;
  EXPECT_EQ(message.find("unstable"), std::string::npos) << message;
  json high_order = flat;
  high_order["bdf"] = 5;
  run(flow({}, high_order));
  EXPECT_THAT(message, HasSubstr("steps of 0.001 with BDF5 can be unstable where |A|² is "));
  EXPECT_THAT(message, HasSubstr(" with \"bdf\": 2, or \"adaptive\""));
  high_order["bdf"] = nullptr;
  high_order["variant"] = {{"F", "implicit"}};
  run(flow({}, high_order));
  EXPECT_EQ(message.find("unstable"), std::string::npos) << message;
}

TEST_F(EvolveHelfrich, AdaptiveStepsThatAreNotAccurateEnoughSayWhatToChange) {
  const json adaptive = {{"bdf", nullptr},
                         {"tau", nullptr},
                         {"steps", nullptr},
                         {"adaptive", {{"end_time", 1e-3}, {"tolerance", 1e-9}, {"first_step", 1e-4}}}};
  EXPECT_EQ(run(flow({}, adaptive)), exit_numerics);
  EXPECT_THAT(message, HasSubstr("try a larger tolerance, or a smaller first_step, such as 1e-06"));
}

TEST_F(EvolveHelfrich, ReachesAReducedVolume) {
  ASSERT_EQ(run(flow({{"reduced_volume", 0.94}, {"reduction_time", 3e-3}})), exit_done) << message;
  EXPECT_LT(std::abs(change("area")), 1e-12);
  EXPECT_NEAR(reduced_volume(column("area").back(), column("volume").back()), 0.94, 1e-12);
}

TEST_F(EvolveHelfrich, TakesAFormulaForTheSpontaneousCurvature) {
  ASSERT_EQ(run(flow({{"spontaneous_curvature", 0.5}})), exit_done) << message;
  const std::vector<double> energy = column("helfrich_energy");
  json by_formula = flow({{"spontaneous_curvature", "c/2"}});
  by_formula["definitions"] = {{"c", "1 + 0*x"}};
  ASSERT_EQ(run(by_formula), exit_done) << message;
  for (std::size_t n = 0; n < energy.size(); ++n)
    EXPECT_NEAR(column("helfrich_energy")[n], energy[n], 1e-9 * energy[n]);
  ASSERT_EQ(run(flow({{"spontaneous_curvature", "z"}})), exit_done) << message;
  EXPECT_GT(std::abs(column("helfrich_energy").back() - energy.back()), 0.1);
}

TEST_F(EvolveHelfrich, SaysWhatItDoesNotTake) {
  const std::vector<std::pair<json, const char*>> bad = {
      {{{"constraints", {"area", "length"}}}, "constraints: found \"length\"; expected one of area, volume"},
      {{{"spontaneous_curvature", "x + q"}}, "spontaneous_curvature"},
      {{{"reduced_volume", 1.2}}, "found reduced_volume = 1.2; expected at most 1"},
      {{{"reduced_volume", 0.9}, {"constraints", {"volume"}}}, "without both constraints"},
      {{{"curvature", 1}}, "known are constraints, reduced_volume, reduction_time, spontaneous_curvature"}};
  for (const auto& [parameters, expected] : bad) {
    EXPECT_EQ(run(flow(parameters)), exit_usage) << parameters;
    EXPECT_THAT(message, HasSubstr(expected)) << parameters;
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  }
  EXPECT_EQ(run(flow({}, {{"surface", {{"axes", {1, 1, 1}}}}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("as on a sphere"));
}

}  // namespace
}  // namespace esfem::test_evolve_helfrich
