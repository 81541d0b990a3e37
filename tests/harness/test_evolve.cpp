// SPDX-License-Identifier: GPL-3.0-or-later
// The program evolve, as a user meets it: configurations in, files and exit codes out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "solver/constants.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Evolve = EvolveProgram;

TEST_F(Evolve, WritesNodalValuesAndSeries) {
  ASSERT_EQ(run(config()), exit_done) << message;
  const json end = read_json(nodal), history = read_json(series);
  EXPECT_DOUBLE_EQ(end.at("t").get<double>(), 0.04);
  EXPECT_EQ(end.at("x").size(), 162u);
  for (const char* key : {"v", "nu", "H"}) EXPECT_EQ(end.at(key).size(), end.at("x").size());
  const double radius = std::sqrt(1 - 4 * 0.04);
  EXPECT_NEAR(end.at("H")[7].get<double>(), 2 / radius, 2e-3);
  for (const char* key :
       {"t", "area", "volume", "willmore_energy", "max_H", "min_nu", "max_nu", "worst_angle"}) {
    EXPECT_EQ(history.at(key).size(), 5u) << key;
  }
  EXPECT_NEAR(history.at("area")[4].get<double>(), 4 * pi * radius * radius, 2e-2);
  EXPECT_TRUE(end.contains("provenance"));
}

TEST_F(Evolve, OfNoStepsIsTheInitialSurface) {
  ASSERT_EQ(run(config({{"steps", 0}})), exit_done) << message;
  const json start = read_json(nodal);
  for (const json& x : start.at("x")) {
    EXPECT_NEAR(std::hypot(x[0].get<double>(), x[1].get<double>(), x[2].get<double>()), 1, 1e-15);
  }
  EXPECT_EQ(start.at("H")[0].get<double>(), 2);
}

TEST_F(Evolve, VariantsChangeTheResult) {
  ASSERT_EQ(run(config()), exit_done) << message;
  const json plain = read_json(nodal).at("x");
  for (const json& variant :
       {json{{"velocity", "interpolation"}}, json{{"normalise", true}}, json{{"stabilise", 1}}}) {
    ASSERT_EQ(run(config({{"variant", variant}})), exit_done) << message;
    EXPECT_NE(read_json(nodal).at("x"), plain) << variant;
  }
  ASSERT_EQ(run(config({{"variant", {{"velocity", "ritz"}, {"normalise", false}, {"stabilise", 0}}}})),
            exit_done);
  EXPECT_EQ(read_json(nodal).at("x"), plain);
}

TEST_F(Evolve, StopsAtTheEndOfTheSurfaceAndKeepsWhatItHas) {
  // The unit sphere shrinks to a point at t = 0.25.
  EXPECT_EQ(run(config({{"steps", 60}, {"start", "cascade"}})), exit_numerics);
  EXPECT_THAT(message, HasSubstr("extinct at t = 0.2"));
  EXPECT_THAT(message, HasSubstr("step "));
  const json history = read_json(series);
  const double last = history.at("t").back().get<double>();
  EXPECT_GT(last, 0.2);
  EXPECT_LT(last, 0.28);
  EXPECT_DOUBLE_EQ(read_json(nodal).at("t").get<double>(), last);
  EXPECT_LT(history.at("area").back().get<double>(), 2);
}

TEST_F(Evolve, RunsAllFlowsOfMeanCurvature) {
  const double radius = std::sqrt(1 - 4 * 0.04);
  for (const auto& [flow, bdf] : {std::pair("mean_curvature", 2), {"dziuk", 2}, {"bgn", 1}}) {
    ASSERT_EQ(run(config({{"flow", flow}, {"bdf", bdf}})), exit_done) << message;
    const json end = read_json(nodal), history = read_json(series);
    EXPECT_NEAR(history.at("max_H")[4].get<double>(), 2 / radius, 0.15) << flow;
    EXPECT_NEAR(history.at("area")[4].get<double>(), 4 * pi * radius * radius, 0.1) << flow;
    EXPECT_EQ(end.contains("nu"), std::string(flow) == "mean_curvature");
    EXPECT_EQ(end.contains("H"), std::string(flow) != "dziuk");
    EXPECT_EQ(history.at("status"), "ok");
  }
  ASSERT_EQ(run(config({{"flow", "dziuk"}, {"bdf", 4}})), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("unstable with BDF4"));
}

TEST_F(Evolve, RunsTheCoupledFlow) {
  ASSERT_EQ(run(config({{"flow", "coupled_diffusion"}})), exit_done) << message;
  const json end = read_json(nodal);
  const double radius = 1 + 0.5 * std::sin(pi * 0.04);
  EXPECT_NEAR(std::sqrt(read_json(series).at("area")[4].get<double>() / (4 * pi)), radius, 1e-3);
  EXPECT_EQ(end.at("u").size(), end.at("x").size());
  ASSERT_EQ(run(config({{"flow", "coupled_diffusion"}, {"variant", {{"mass", "reassembled"}}}})), exit_done)
      << message;
  EXPECT_NE(read_json(nodal).at("u"), end.at("u"));
}

TEST_F(Evolve, GrowsATumourOnAnySurface) {
  const json tumour = {{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}, {"steps", 3}};
  ASSERT_EQ(run(config(tumour)), exit_done) << message;
  const json end = read_json(nodal);
  for (const char* key : {"u1", "u2", "v"}) EXPECT_EQ(end.at(key).size(), end.at("x").size());
  EXPECT_GT(read_json(series).at("area")[3], read_json(series).at("area")[0]);
  json other = config(tumour);
  other["surface"] = {{"name", "torus"}};
  other["mesh"] = {{"edge_length", 0.3}};
  ASSERT_EQ(run(other), exit_done) << message;
  other["parameters"] = {{"beta", 1}};
  EXPECT_EQ(run(other), exit_usage);
  EXPECT_THAT(message, HasSubstr("known are D, a, alpha"));
}

TEST_F(Evolve, RunsFlowsOfFourthOrder) {
  json willmore = config({{"flow", "willmore"}, {"start", "cascade"}});
  ASSERT_EQ(run(willmore), exit_done) << message;
  const json end = read_json(nodal), history = read_json(series);
  EXPECT_NEAR(history.at("willmore_energy")[4].get<double>(), 8 * pi, 0.05);
  EXPECT_EQ(history.at("kappa_energy").size(), 5u);
  for (const char* key : {"v", "nu", "H", "V", "z"}) EXPECT_EQ(end.at(key).size(), end.at("x").size());
  EXPECT_NEAR(end.at("H")[0].get<double>(), 2, 1e-12) << "with theta the sphere is stationary";
  willmore["variant"] = {{"theta", false}};
  ASSERT_EQ(run(willmore), exit_done) << message;
  EXPECT_GT(std::abs(read_json(nodal).at("H")[0].get<double>() - 2), 1e-9);

  json diffusion = willmore;
  diffusion["flow"] = "surface_diffusion";
  diffusion["surface"] = {{"name", "ellipsoid"}};
  diffusion["mesh"] = {{"subdivisions", 2}};
  diffusion["tau"] = 1e-4;
  ASSERT_EQ(run(diffusion), exit_done) << message;
  const json volume = read_json(series).at("volume"), area = read_json(series).at("area");
  EXPECT_NEAR(volume[4].get<double>() / volume[0].get<double>(), 1, 1e-4);
  EXPECT_LT(area[4].get<double>(), area[0].get<double>());
}

TEST_F(Evolve, SolvesCahnHilliardOnAMovingEllipsoid) {
  json ellipsoid = config({{"flow", "cahn_hilliard"}, {"degree", 1}, {"start", "exact"}, {"tau", 0.005}});
  ellipsoid["mesh"] = {{"subdivisions", 2}};
  ASSERT_EQ(run(ellipsoid), exit_done) << message;
  const json end = read_json(nodal);
  const double t = end.at("t");
  for (int j = 0; j < static_cast<int>(end.at("x").size()); ++j) {
    const json& x = end.at("x")[j];
    EXPECT_NEAR(end.at("u")[j].get<double>(), std::exp(-6 * t) * x[0].get<double>() * x[1].get<double>(),
                0.02);
  }
  ellipsoid["variant"] = {{"theta", true}, {"initial", "ritz"}};
  ASSERT_EQ(run(ellipsoid), exit_done) << message;
  EXPECT_NE(read_json(nodal).at("w"), end.at("w"));
  ellipsoid["surface"]["radius"] = 2;
  EXPECT_EQ(run(ellipsoid), exit_usage);
  EXPECT_THAT(message, HasSubstr("unit sphere"));
}

TEST_F(Evolve, SeparatesPhasesOnAnySurfaceAtRest) {
  json separation = config({{"flow", "cahn_hilliard"},
                            {"problem", "phase_separation"},
                            {"parameters", {{"epsilon", 0.2}, {"mean", 0.1}}},
                            {"tau", nullptr},
                            {"steps", nullptr},
                            {"bdf", 2},
                            {"adaptive", {{"end_time", 3}, {"first_step", 1e-3}, {"tolerance", 1e-3}}}});
  separation["surface"] = {{"name", "ellipsoid"}};
  separation["mesh"] = {{"subdivisions", 2}};
  ASSERT_EQ(run(separation), exit_done) << message;
  const json found = read_json(series);
  const std::vector<double> energy = found.at("energy"), mass = found.at("mass"), area = found.at("area");
  EXPECT_EQ(energy.size(), area.size());
  EXPECT_TRUE(std::is_sorted(energy.rbegin(), energy.rend()));
  EXPECT_LT(energy.back(), 0.5 * energy.front());
  EXPECT_NEAR(mass.back(), mass.front(), 1e-11);
  EXPECT_NEAR(mass.back() / area.back(), 0.1, 1e-12);
}

TEST_F(Evolve, ThetaNeedsASurface) {
  const std::string file = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/ellipsoid_362.msh";
  json willmore =
      config({{"flow", "willmore"}, {"tau", 1e-4}, {"mesh", {{"subdivisions", nullptr}, {"file", file}}}});
  willmore.erase("surface");
  ASSERT_EQ(run(willmore), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("computed on the discrete surface"));
  willmore["variant"] = {{"theta", true}};
  EXPECT_EQ(run(willmore), exit_usage);
  EXPECT_THAT(message, HasSubstr("theta needs exact initial data"));
}

TEST_F(Evolve, TakesAdaptiveStepsWithEveryFlow) {
  for (const char* flow : {"mean_curvature", "dziuk", "bgn", "willmore", "coupled_diffusion"}) {
    json adaptive = config({{"flow", flow}, {"adaptive", {{"end_time", 0.02}, {"first_step", 1e-4}}}});
    for (const char* key : {"tau", "steps", "bdf"}) adaptive.erase(key);
    ASSERT_EQ(run(adaptive), exit_done) << flow << ": " << message;
    const json t = read_json(series).at("t");
    EXPECT_EQ(t.back().get<double>(), 0.02) << flow;
    ASSERT_GT(t.size(), 4u);
    EXPECT_GT(t[3].get<double>() - t[2].get<double>(), t[1].get<double>()) << flow << ": steps grow";
  }
}

TEST_F(Evolve, IsTheSameWithACheckpoint) {
  ASSERT_EQ(run(config()), exit_done) << message;
  const json plain = read_json(nodal).at("x");
  const std::string checkpoint = (folder / "run.checkpoint").string();
  ASSERT_EQ(run(config({{"output", {{"checkpoint", checkpoint}}}})), exit_done) << message;
  EXPECT_EQ(read_json(nodal).at("x"), plain);
}

TEST_F(Evolve, WritesSnapshotsAtTheTimesAskedFor) {
  const std::string pvd = (folder / "snapshots/run.pvd").string();
  const json output = {{"vtu", pvd}, {"times", {0.015, 1000}}};
  ASSERT_EQ(run(config({{"output", output}})), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("times: found 1000, after the end of the run at t = "));
  // At the start, at t = 0.02 (the first step after 0.015), and at the end.
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "snapshots")) {
    EXPECT_GT(entry.file_size(), 100u);
    count += entry.path().extension() == ".vtu";
  }
  EXPECT_EQ(count, 3);
  std::ifstream stream(pvd);
  const std::string collection(std::istreambuf_iterator<char>(stream), {});
  for (const char* text : {"run_0000.vtu", "run_0002.vtu", "0.02"}) EXPECT_THAT(collection, HasSubstr(text));
}

TEST_F(Evolve, SnapshotsAreThoseOfTheLastRunAndSayWhichItWas) {
  using std::filesystem::directory_iterator;
  const std::filesystem::path snapshots = folder / "snapshots";
  const auto count = [&] { return std::distance(directory_iterator(snapshots), directory_iterator()); };
  json output = {{"vtu", (snapshots / "run.pvd").string()}, {"every", 1}};
  ASSERT_EQ(run(config({{"output", output}})), exit_done) << message;
  const auto longer = count();
  output.erase("every");
  const json asked = config({{"output", output}});
  ASSERT_EQ(run(asked), exit_done) << message;
  EXPECT_EQ(count(), 3) << "the collection, the start and the end, of " << longer;
  EXPECT_GT(longer, 3);
  std::ifstream stream(snapshots / "run_0001.vtu", std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(stream), {});
  EXPECT_THAT(bytes, HasSubstr(asked.dump()));
}

TEST_F(Evolve, RefusesBadConfigurationsInOneLine) {
  const std::vector<std::pair<json, std::string>> bad = {
      {{{"flow", "mean"}}, "expected one of bgn, bgn_willmore, cahn_hilliard, coupled_diffusion"},
      {{{"flow", "bgn"}, {"bdf", 2}}, "bdf = 2; expected 1 to 1"},
      {{{"flow", "dziuk"}, {"variant", {{"normalise", true}}}}, "no variants"},
      {{{"problem", "growing_sphere"}}, "expected no key problem"},
      {{{"flow", "coupled_diffusion"}, {"problem", "tumour"}},
       "expected one of growing_sphere, kinetics, tumour_growth"},
      {{{"flow", "coupled_diffusion"}, {"surface", {{"radius", 2}}}}, "unit sphere"},
      {{{"flow", "coupled_diffusion"}, {"parameters", {{"alpha", 0}}}}, "alpha = 0"},
      {{{"flow", "coupled_diffusion"}, {"variant", {{"coupling", "strong"}}}}, "additive, none, quotient"},
      {{{"output", {{"every", 5}}}}, "expected the key vtu"},
      {{{"output", {{"vtu", "snapshots"}}}}, ".pvd"},
      {{{"output", {{"vtu", "a.pvd"}, {"times", {0.02, 0.01}}}}}, "increasing"},
      {{{"output", {{"vtu", "a.pvd"}, {"times", json::array()}}}}, "times: found none"},
      {{{"output", {{"vtu", "a.pvd"}, {"times", {-1}}}}},
       "times: found -1, before the run; expected times from 0 on"},
      {{{"mesh", "a.off"}},
       "expected an object like {\"edge_length\": 0.2} or {\"file\": \"NAME\"}, found string"},
      {{{"surface", "sphere"}}, "expected an object like {\"name\": \"sphere\"}, found string"},
      {{{"taw", 1}}, "unknown key 'taw'; known are"},
      {{{"step", 3}}, "did you mean \"steps\"?"},
      {{{"edge_length", 0.2}}, "found edge_length, which belongs in \"mesh\""},
      {{{"end_time", 1}}, "found end_time, which belongs in \"adaptive\""},
      {{{"constraints", {"area"}}}, "found constraints, which belongs in \"parameters\""},
      {{{"tangential", "minimal_deformation"}}, "expected no key tangential here: \"variant\" has one"},
      {{{"variant", {{"tangential", true}}}}, "expected one of minimal_deformation, none, found boolean"},
      {{{"parameters", {{"tangential", "none"}}}},
       "parameters: found tangential, which belongs in \"variant\""},
      {{{"output", {{"vtu", "a.vtu"}}}}, "found vtu = \"a.vtu\"; expected a name that ends in .pvd"},
      {{{"taw", 1}}, "tau, variant, velocity; did you mean \"tau\"?"},
      {{{"flow", "Willmore"}}, "did you mean \"willmore\"?"},
      {{{"flow", "tumour_growth"}},
       "expected \"flow\": \"coupled_diffusion\", \"problem\": \"tumour_growth\""},
      {{{"flow", "coupled_diffusion"}, {"problem", "kinetic"}}, "did you mean \"kinetics\"?"},
      {{{"variant", {{"normalize", true}}}}, "did you mean \"normalise\"?"},
      {{{"variant", {{"velocity", "rits"}}}}, "did you mean \"ritz\"?"},
      {{{"surface", {{"name", "spere"}}}}, "config.json: surface: "},
      {{{"surface", {{"name", "spere"}}}}, "did you mean \"sphere\"?"},
      {{{"surface", {{"radus", 1}}}}, "did you mean \"radius\"?"},
      {{{"mesh", {{"grading", 0.5}}}}, "found {\"grading\":0.5,\"subdivisions\":1}; expected edge_length"},
      {{{"mesh", {{"edge_lenght", 0.5}}}}, "did you mean \"edge_length\"?"},
      {{{"tau", -1}}, "positive step size"},
      {{{"bdf", 6}}, "expected 1 to 5"},
      {{{"degree", 5}}, "expected 1 to 4"},
      {{{"steps", "many"}}, "steps"},
      {{{"steps", 4294967297}}, "found 4294967297, expected an integer of size 2147483647 at most"},
      {{{"start", "warm"}}, "config.json: start 'warm': expected exact, cascade"},
      {{{"mesh", {{"edge_length", 0.5}}}},
       "expected edge_length (with it grading), file (with it curve, refine, remesh) or subdivisions"},
      {{{"mesh", {{"subdivisions", nullptr}, {"file", "missing.off"}}}}, "missing.off"},
      {{{"mesh", {{"subdivisions", nullptr}, {"edge_length", 2}}}}, "edge length 2"},
      {{{"mesh", {{"subdivisions", nullptr}, {"edge_length", 1e-9}}}}, "makes about 1e+19 nodes"},
      {{{"surface", {{"name", "cube"}}}}, "sphere, ellipsoid, torus, dumbbell"},
      {{{"quadrature", {{"gauss", 3}}}}, "known are conical, degree"},
      {{{"variant", {{"velocity", "exact"}}}}, "expected one of interpolation, ritz"},
      {{{"variant", {{"normalise", 1}}}}, "true or false"},
      {{{"adaptive", {{"end_time", 1}}}}, "found adaptive and tau"},
      {{{"adaptive", {{"end_time", 1}, {"tol", 1}}}, {"tau", nullptr}, {"steps", nullptr}}, "'tol'"},
      {{{"adaptive", {{"end_time", 1}, {"tolerance", 0}}}, {"tau", nullptr}, {"steps", nullptr}},
       "tolerance = 0"},
      {{{"adaptive", {{"end_time", 1e-7}, {"first_step", 1e-6}}}, {"tau", nullptr}, {"steps", nullptr}},
       "expected first_step < end_time"},
      {{{"adaptive", {{"end_time", 1}}}, {"tau", nullptr}, {"steps", nullptr}, {"bdf", 3}},
       "bdf = 3; expected 1 to 2"},
      {{{"flow", "willmore"}, {"variant", {{"F", "explicit"}}}}, "extrapolated, implicit"},
      {{{"flow", "willmore"}, {"variant", {{"relaxation", -1}}}}, "relaxation = -1"},
      {{{"flow", "surface_diffusion"}, {"variant", {{"normalise", true}}}},
       "known are F, project, reinitialise, relaxation, tangential, theta"},
      {{{"flow", "cahn_hilliard"}, {"parameters", {{"epsilon", 0}}}}, "epsilon = 0"},
      {{{"flow", "cahn_hilliard"}, {"variant", {{"initial", "exact"}}}}, "interpolation, ritz"},
      {{{"flow", "cahn_hilliard"}, {"problem", "sphere"}}, "ellipsoid, mixture, phase_separation"},
      {{{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}, {"variant", {{"theta", true}}}},
       "has no variants"},
      {{{"flow", "cahn_hilliard"}, {"parameters", {{"mean", 0.1}}}}, "known are epsilon"},
      {{{"output", {{"vtk", "a"}}}},
       "known are checkpoint, every, every_time, history, nodal, series, times, vtu"},
  };
  for (const auto& [changes, expected] : bad) {
    EXPECT_EQ(run(config(changes)), exit_usage) << changes;
    EXPECT_THAT(message, HasSubstr(expected)) << changes;
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
    EXPECT_FALSE(std::filesystem::exists(nodal)) << changes;
  }
}

TEST_F(Evolve, RunsAMeshOfWhichNoExactSurfaceIsKnown) {
  const std::string file = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/sphere_radius2_162.msh";
  json configuration = config({{"mesh", {{"subdivisions", nullptr}, {"file", file}}}, {"steps", 2}});
  configuration.erase("surface");
  ASSERT_EQ(run(configuration), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("computed on the discrete surface"));
  const json history = read_json(series);
  EXPECT_NEAR(history.at("area")[2].get<double>(), 4 * pi * (4 - 4 * 0.02), 0.2);
}

}  // namespace
}  // namespace esfem::test_evolve
