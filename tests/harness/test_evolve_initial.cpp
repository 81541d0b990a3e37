// SPDX-License-Identifier: GPL-3.0-or-later
// A run of evolve that goes on from the files of an earlier one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_initial {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct EvolveInitial : EvolveProgram {
  std::string path(const std::string& name) const { return (folder / name).string(); }

  /// The same run from a file, without mesh and surface.
  static json from(json configuration, const std::string& file, int steps) {
    for (const char* key : {"mesh", "surface", "degree"}) configuration.erase(key);
    configuration["initial"] = {{"file", file}};
    configuration["steps"] = steps;
    return configuration;
  }
  /// Nodal values without what says which run it was.
  json values_at_end() const {
    json values = read_json(nodal);
    for (const char* key : {"provenance", "config"}) values.erase(key);
    return values;
  }
  /// A run of mean curvature flow whose nodal values are kept as `name`.
  std::string kept(const std::string& name, const json& changes = json::object()) {
    EXPECT_EQ(run(config(changes)), exit_done) << message;
    std::filesystem::copy_file(nodal, path(name), std::filesystem::copy_options::overwrite_existing);
    return path(name);
  }
};

TEST_F(EvolveInitial, InTheMiddleOfARunGivesTheSameBits) {
  const json ellipsoid = {{"name", "ellipsoid"}, {"radius", nullptr}};
  const json mixture = {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}};
  const json tumour = {{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}, {"tau", 1e-3}};
  std::vector<json> runs = {mixture,
                            tumour,
                            {{"flow", "cahn_hilliard"}, {"degree", 1}, {"variant", {{"theta", true}}}},
                            {{"flow", "coupled_diffusion"}},
                            {{"flow", "mean_curvature"}, {"variant", {{"reinitialise", 1e-3}}}},
                            {{"flow", "dziuk"}, {"bdf", 3}},
                            {{"flow", "bgn"}, {"bdf", 1}},
                            {{"flow", "dziuk_willmore"}, {"bdf", 1}, {"tau", 1e-5}},
                            {{"flow", "generalised_mean_curvature"}, {"surface", {{"radius", 1.5}}}}};
  // With small steps a factorisation of Willmore flow serves several of them.
  for (int q = 1; q <= 5; ++q)
    for (const char* flow : {"mean_curvature", "willmore"})
      runs.push_back(
          {{"flow", flow}, {"bdf", q}, {"surface", ellipsoid}, {"start", "cascade"}, {"tau", 1e-6}});
  for (const json& changes : runs) {
    json whole = config(changes);
    whole["steps"] = 12;
    ASSERT_EQ(run(whole), exit_done) << changes << message;
    const json expected = values_at_end();
    whole["steps"] = 7;
    ASSERT_EQ(run(whole), exit_done) << changes << message;
    std::filesystem::rename(nodal, path("middle.json"));
    json rest = from(whole, path("middle.json"), 5);
    rest.erase("bdf");
    ASSERT_EQ(run(rest), exit_done) << changes << message;
    EXPECT_THAT(message, HasSubstr("the run goes on from step 7"));
    EXPECT_TRUE(values_at_end() == expected) << changes;
  }
}

TEST_F(EvolveInitial, WithoutAPartOfTheHistoryTheBitsAreOthers) {
  json whole = config(
      {{"flow", "willmore"}, {"surface", {{"name", "ellipsoid"}, {"radius", nullptr}}}, {"tau", 1e-6}});
  whole["steps"] = 9;
  ASSERT_EQ(run(whole), exit_done) << message;
  const json expected = values_at_end().at("x");
  whole["steps"] = 5;
  ASSERT_EQ(run(whole), exit_done) << message;
  const json middle = read_json(nodal);
  const auto ends_as = [&](const json& file) {
    write_file(path("middle.json"), file.dump());
    EXPECT_EQ(run(from(whole, path("middle.json"), 4)), exit_done) << message;
    return values_at_end().at("x");
  };
  EXPECT_TRUE(ends_as(middle) == expected);
  json other = middle;
  double& u = *other["history"]["states"][1]["u"]["numbers"][7].get_ptr<double*>();
  u = std::nextafter(u, 10);
  EXPECT_TRUE(ends_as(other) != expected) << "the state before";
  other = middle;
  other["history"]["flow"]["u_change"]["numbers"][7] = 1;
  EXPECT_TRUE(ends_as(other) != expected) << "what the flow keeps";
  other = middle;
  other.erase("history");
  EXPECT_TRUE(ends_as(other) != expected);
}

TEST_F(EvolveInitial, GoesOnFromOneThatWentOnAndFarFromTheOrigin) {
  {
    json there = config({{"steps", 0}});
    ASSERT_EQ(run(there), exit_done) << message;
    const json start = read_json(nodal);
    std::string off = format("OFF\n%zu %zu 0\n", start.at("x").size(), start.at("elements").size());
    for (const json& x : start.at("x"))
      off +=
          format("%.17g %.17g %.17g\n", 1000.1 + x[0].get<double>(), x[1].get<double>(), x[2].get<double>());
    for (const json& e : start.at("elements"))
      off += format("3 %d %d %d\n", e[0].get<int>(), e[1].get<int>(), e[2].get<int>());
    write_file(path("far.off"), off);
  }
  json whole =
      config({{"mesh", {{"file", path("far.off")}, {"subdivisions", nullptr}}}, {"bdf", 3}, {"steps", 9}});
  whole.erase("surface");
  ASSERT_EQ(run(whole), exit_done) << message;
  const json expected = values_at_end();
  whole["steps"] = 4;
  ASSERT_EQ(run(whole), exit_done) << message;
  std::filesystem::rename(nodal, path("4.json"));
  ASSERT_EQ(run(from(whole, path("4.json"), 2)), exit_done) << message;
  std::filesystem::rename(nodal, path("6.json"));
  ASSERT_EQ(run(from(whole, path("6.json"), 3)), exit_done) << message;
  EXPECT_TRUE(values_at_end() == expected);
}

TEST_F(EvolveInitial, WithOtherStepsStartsFromTheStateAlone) {
  const std::string middle = kept("middle.json", {{"surface", {{"name", "ellipsoid"}, {"radius", nullptr}}}});
  for (const auto& [changes, why] :
       {std::pair(json{{"tau", 0.005}}, "its history is of another tau (0.01)"),
        std::pair(json{{"bdf", 3}}, "another bdf (2)"),
        std::pair(json{{"variant", {{"normalise", true}}}}, "another variant")}) {
    json other = from(config(), middle, 2);
    other.merge_patch(changes);
    ASSERT_EQ(run(other), exit_done) << message;
    EXPECT_THAT(message, AllOf(HasSubstr("starts from its state at t = 0.04 alone"), HasSubstr(why),
                               HasSubstr("H, nu from " + middle)));
    const std::vector<double> t = read_json(series).at("t");
    EXPECT_DOUBLE_EQ(t.front(), 0.04);
    EXPECT_DOUBLE_EQ(t.back(), 0.04 + 2 * other.at("tau").get<double>());
  }
  json adaptive = from(config(), middle, 0);
  for (const char* key : {"tau", "steps"}) adaptive.erase(key);
  adaptive["adaptive"] = {{"end_time", 0.05}, {"first_step", 1e-4}};
  ASSERT_EQ(run(adaptive), exit_done) << message;
  EXPECT_DOUBLE_EQ(read_json(series).at("t").front().get<double>(), 0.04);
  EXPECT_DOUBLE_EQ(read_json(nodal).at("t").get<double>(), 0.05);
}

TEST_F(EvolveInitial, TheHistoryMayBeLeftOut) {
  const std::string whole = kept("whole.json"),
                    plain = kept("plain.json", {{"output", {{"history", false}}}});
  json with = read_json(whole), without = read_json(plain);
  EXPECT_TRUE(with.contains("history"));
  EXPECT_FALSE(without.contains("history"));
  for (json* file : {&with, &without})
    for (const char* key : {"history", "config", "provenance"}) file->erase(key);
  EXPECT_TRUE(with == without);
  EXPECT_EQ(with.at("degree"), 2);
  EXPECT_EQ(with.at("flow"), "mean_curvature");
  ASSERT_EQ(run(from(config(), plain, 1)), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("it has no \"history\""));
  EXPECT_EQ(run(config({{"adaptive", {{"end_time", 1}}},
                        {"tau", nullptr},
                        {"steps", nullptr},
                        {"output", {{"history", true}}}})),
            exit_usage);
  EXPECT_THAT(message, HasSubstr("expected equal steps"));
}

TEST_F(EvolveInitial, TakesSnapshotsWithTheirTimeAndMeshFilesWithAGivenOne) {
  ASSERT_EQ(run(config({{"output", {{"vtu", path("run.pvd")}}}})), exit_done) << message;
  const json end = values_at_end();
  json again = from(config(), path("run_0001.vtu"), 0);
  ASSERT_EQ(run(again), exit_done) << message;
  const json start = values_at_end();
  for (const char* key : {"t", "x", "nu", "H", "elements", "degree"})
    EXPECT_EQ(start.at(key), end.at(key)) << key;
  // A flat mesh as PLY with nodal values.
  json linear = config({{"degree", 1}});
  ASSERT_EQ(run(linear), exit_done) << message;
  const json flat = values_at_end();
  const std::size_t nodes = flat.at("x").size(), faces = flat.at("elements").size();
  std::string ply = format("ply\nformat ascii 1.0\nelement vertex %zu\n", nodes);
  for (const char* name : {"x", "y", "z", "nu_x", "nu_y", "nu_z", "H"})
    ply += format("property double %s\n", name);
  ply += format("element face %zu\nproperty list uchar int vertex_indices\nend_header\n", faces);
  for (std::size_t i = 0; i < nodes; ++i) {
    for (const char* name : {"x", "nu"})
      for (const json& value : flat.at(name)[i]) ply += format("%.17g ", value.get<double>());
    ply += format("%.17g\n", flat.at("H")[i].get<double>());
  }
  for (const json& e : flat.at("elements"))
    ply += format("3 %d %d %d\n", e[0].get<int>(), e[1].get<int>(), e[2].get<int>());
  write_file(path("flat.ply"), ply);
  json from_ply = from(linear, path("flat.ply"), 0);
  from_ply["initial"]["time"] = 0.04;
  ASSERT_EQ(run(from_ply), exit_done) << message;
  const json read = values_at_end();
  for (const char* key : {"t", "x", "nu", "H", "elements"}) EXPECT_EQ(read.at(key), flat.at(key)) << key;

  again["initial"]["time"] = 3;
  EXPECT_EQ(run(again), exit_usage);
  EXPECT_THAT(message, HasSubstr("found time, but"));
}

TEST_F(EvolveInitial, RefusesFilesThatDoNotFit) {
  const std::string good = kept("good.json"), dziuk = kept("dziuk.json", {{"flow", "dziuk"}});
  int count = 0;
  const auto damaged = [&](const json& patch) {
    json file = read_json(good);
    file.merge_patch(patch);
    const std::string name = path(format("damaged_%d.json", count++));
    write_file(name, file.dump());
    return name;
  };
  const json tau = {{"tau", 0.02}}, none = json::object();
  const std::vector<std::tuple<std::string, json, std::string>> bad = {
      {path("none.json"), none, "cannot be read"},
      {dziuk, none,
       "flow mean_curvature starts from nu, H; found v in " + dziuk + ", which flow dziuk has written"},
      {good, {{"degree", 3}}, "have degree 2"},
      {good, {{"mesh", {{"subdivisions", 1}}}}, "found initial and mesh"},
      {good, {{"surface", {{"name", "sphere"}, {"radius", 2}}}}, "another surface"},
      {good, {{"flow", "coupled_diffusion"}, {"problem", "growing_sphere"}}, "unit sphere"},
      {good, {{"output", {{"nodal", good}}}}, "which is the initial state"},
      {damaged({{"x", nullptr}}), none, "key 'x' is missing"},
      {damaged({{"x", {1, 2}}}), none, "expected three coordinates"},
      {damaged({{"elements", {{0, 1, 2, 3, 4, 99999}}}}), none, "expected nodes from 0 to 161"},
      {damaged({{"elements", {{0, 1, 2, 3}}}}), none, "found 4 nodes"},
      {damaged({{"H", {1, 2}}}), none, "expected a row per node"},
      {damaged({{"history", {{"states", json::array()}}}}), none, "0 states; expected 2"},
      {damaged({{"history", {{"states", {{{"t", "now"}}}}}}}), none, "history: "},
      {damaged({{"history", {{"step", 5}}}}), none, "its newest state is of t = 0.04"},
      {damaged({{"history", {{"start", {{"rows", 3}}}}}}), none, "history: "},
      {damaged({{"history", {{"tau", "a"}}}}), none, "tau"},
      {damaged({{"history", {{"step", 5}}}}), tau, ""}};
  for (const auto& [file, changes, why] : bad) {
    json asked = from(config(), file, 1);
    asked.merge_patch(changes);
    EXPECT_EQ(run(asked), why.empty() ? exit_done : exit_usage) << file << changes << message;
    EXPECT_THAT(message, HasSubstr(why));
    const auto lines = std::count(message.begin(), message.end(), '\n');
    const bool goes_on = message.find("the run goes on") != std::string::npos;
    EXPECT_TRUE(why.empty() || lines == 1 + goes_on) << message;
  }
}

TEST_F(EvolveInitial, AStoppedRunWithACheckpointResumesFromThat) {
  const json whole = config({{"steps", 12}});
  ASSERT_EQ(run(whole), exit_done) << message;
  const json expected = values_at_end();
  const std::string middle = kept("middle.json");
  json rest = from(whole, middle, 4);
  rest["output"]["checkpoint"] = path("run.checkpoint");
  ASSERT_EQ(run(rest), exit_done) << message;
  rest["steps"] = 8;
  ASSERT_EQ(run(rest), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("resumes from this checkpoint, step 4"));
  EXPECT_TRUE(values_at_end() == expected);
}

}  // namespace
}  // namespace esfem::test_evolve_initial
