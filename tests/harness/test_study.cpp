// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "experiments/evolve/mesh.hpp"
#include "experiments/evolve/refinement.hpp"
#include "solver/assembly/surface_space.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_study {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(Refinement, HalvesWhatTheConfigurationHas) {
  const auto mesh_at = [](int level, const json& mesh) {
    return refined_configuration({{"mesh", mesh}, {"tau", 0.1}, {"steps", 3}}, level, 0, "file").at("mesh");
  };
  EXPECT_EQ(mesh_at(2, {{"edge_length", 0.4}}), (json{{"edge_length", 0.1}}));
  EXPECT_EQ(mesh_at(1, {{"edge_length", 0.4}, {"grading", 0.5}}),
            (json{{"edge_length", 0.2}, {"grading", 0.25}}));
  EXPECT_EQ(mesh_at(3, {{"subdivisions", 1}}), (json{{"subdivisions", 4}}));
  EXPECT_EQ(mesh_at(1, {{"file", "a.msh"}, {"remesh", 0.2}}), (json{{"file", "a.msh"}, {"remesh", 0.1}}));
  EXPECT_EQ(mesh_at(1, {{"file", "a.msh"}, {"refine", 1}}), (json{{"file", "a.msh"}, {"refine", 2}}));
  EXPECT_THROW(mesh_at(1, {{"file", "a.msh"}}), InputError);
  const json finer = refined_configuration(
      {{"mesh", {{"file", "a.msh"}}}, {"tau", 0.1}, {"steps", 3}, {"output", {{"vtu", "a"}, {"every", 2}}}},
      0, 2, "file");
  EXPECT_EQ(finer.at("tau"), 0.025);
  EXPECT_EQ(finer.at("steps"), 12);
  EXPECT_EQ(finer.at("output").at("every"), 8);
  EXPECT_THROW(refined_configuration({{"adaptive", json::object()}}, 0, 1, "file"), InputError);
  EXPECT_THROW(refined_configuration({{"initial", {{"file", "end.json"}}}}, 1, 0, "file"), InputError);
}

TEST(Refinement, OfAFileIsOnItsElementsOrOnTheSmoothSurface) {
  const std::string file = testing::TempDir() + "refinement_" + std::to_string(getpid()) + ".msh";
  write_msh(icosphere(1, 2), file);
  const auto area = [&](const json& treatment, int degree) {
    json description = {{"file", file}};
    description.update(treatment);
    const Mesh mesh = evolve_mesh(JsonReader(description, "mesh"), degree, {}).start.mesh;
    return SurfaceSpace(mesh).area(mesh.nodes);
  };
  const double flat = area(json::object(), 1), refined = area({{"refine", 2}}, 1);
  EXPECT_NEAR(refined, flat, 1e-12);
  EXPECT_LT(flat, 4 * M_PI - 0.1);
  // All levels approximate one smooth surface, which is nearly the sphere of the corners.
  const double coarse = area({{"curve", true}}, 2), finer = area({{"curve", true}, {"refine", 1}}, 2),
               finest = area({{"curve", true}, {"refine", 2}}, 2);
  EXPECT_NEAR(finest, 4 * M_PI, 2e-3);
  EXPECT_LT(std::abs(finest - finer), 0.25 * std::abs(finer - coarse));
  std::filesystem::remove(file);
}

class StudyProgram : public EvolveProgram {
 protected:
  const std::string output = (folder / "out").string();

  int study(const std::string& options, const json& configuration) {
    const std::string file = (folder / "config.json").string(), errors = (folder / "errors.txt").string();
    write_file(file, configuration.dump());
    std::filesystem::remove_all(output);
    const int status = run_command(ESFEM_BINARY_DIR "/bin/study " + file + " " + options + " --output " +
                                   output + " >" + (folder / "out.txt").string() + " 2>" + errors);
    std::ifstream stream(errors);
    message.assign(std::istreambuf_iterator<char>(stream), {});
    return status;
  }

  Table table() const { return table_from_json(read_json(output + "/table.json"), output); }

  /// The fitted order; 0 when there is none.
  double order(const std::string& quantity, const std::string& norm, const std::string& variable) const {
    for (const Fit& fit : table().fits)
      if (fit.quantity == quantity && fit.norm == norm && fit.variable == variable) return fit.order;
    return 0;
  }

  /// The heat equation on the unit sphere with the solution x y exp(-6t): x y is an eigenfunction of the
  /// Laplace-Beltrami operator with the eigenvalue -6.
  static json heat(int degree, int bdf, double diffusion = 1) {
    return {{"flow", "coupled_diffusion"},
            {"problem", "kinetics"},
            {"surface", {{"name", "sphere"}}},
            {"mesh", {{"subdivisions", 1}}},
            {"degree", degree},
            {"bdf", bdf},
            {"tau", 0.005},
            {"steps", 10},
            {"kinetics", {{"f", {"0"}}, {"diffusion", {diffusion}}}},
            {"initial", {{"u", "x*y"}}},
            {"exact", {{"u", "x*y*exp(-6*t)"}}}};
  }
};

TEST_F(StudyProgram, TheHeatEquationHasTheOrdersOfItsElements) {
  for (int degree : {1, 2}) {
    ASSERT_EQ(study("--levels 0-2", heat(degree, 3)), 0) << message;
    EXPECT_NEAR(order("u", "lifted_L2", "h"), degree + 1, 0.2) << degree;
    EXPECT_NEAR(order("u", "lifted_H1_semi", "h"), degree, 0.2) << degree;
  }
  // The wrong equation: the error does not decrease.
  ASSERT_EQ(study("--levels 0-2", heat(2, 3, 1.1)), 0) << message;
  EXPECT_LT(order("u", "lifted_L2", "h"), 1);
}

TEST_F(StudyProgram, TheHeatEquationHasTheOrdersOfItsSteps) {
  // Against the smallest step, so that errors in space cancel. Exact starting values differ from those in
  // space by its error, which would be seen with elements of lower degree.
  for (int bdf = 1; bdf <= 5; ++bdf) {
    json configuration = heat(4, bdf);
    configuration["tau"] = 0.06;
    if (bdf == 5) configuration["mesh"] = {{"subdivisions", 2}};
    ASSERT_EQ(study("--levels 0 --steps 0-3 --against finest", configuration), 0) << message;
    EXPECT_NEAR(order("u", "closest_L2", "tau"), bdf, 0.2) << bdf;
  }
}

TEST_F(StudyProgram, GradientsOnMeshesThatAreNotNestedHaveTheirOrderAgainstTheFinestMesh) {
  // The errors of gradients are orthogonal there: taken as aligned they have an order of 0.4.
  json configuration = heat(1, 2);
  configuration["mesh"] = {{"edge_length", 0.5}};
  configuration["tau"] = 0.0005;
  ASSERT_EQ(study("--levels 0-3 --against finest", configuration), 0) << message;
  EXPECT_NEAR(order("u", "closest_H1_semi", "h"), 1, 0.1);
  EXPECT_NEAR(order("u", "closest_L2", "h"), 2, 0.2);
  const Table all = table();
  for (const Fit& fit : all.fits) EXPECT_EQ(fit.rows_used, 3) << fit.quantity << ' ' << fit.norm;
}

TEST_F(StudyProgram, OrdersInLevelAndStepComeFromNeighbours) {
  json configuration = heat(2, 1);
  configuration["tau"] = 0.02;
  configuration["steps"] = 3;
  ASSERT_EQ(study("--levels 0-3 --steps 0-3 --against finest", configuration), 0) << message;
  EXPECT_NEAR(order("u", "closest_L2", "tau"), 1, 0.1);
  EXPECT_NEAR(order("u", "closest_H1_semi", "h"), 2, 0.2);
}

TEST_F(StudyProgram, AnEllipsoidAgainstTheFinestMesh) {
  json configuration = read_json(ESFEM_SOURCE_DIR "/reference/examples/study_ellipsoid.json");
  configuration["steps"] = 2;
  ASSERT_EQ(study("--levels 0-3", configuration), 0) << message;
  for (const char* quantity : {"x", "v", "nu", "H"}) {
    EXPECT_GT(order(quantity, "closest_H1", "h"), 1.8) << quantity;
    EXPECT_GT(order(quantity, "closest_L2", "h"), 1.8) << quantity;
  }
  const Table found = table();
  EXPECT_EQ(found.rows.size(), 4u);
  EXPECT_TRUE(found.rows.back().errors.empty());
  EXPECT_THAT(found.parameters.at("against"), HasSubstr("h3_tau0"));
}

TEST_F(StudyProgram, WhatIsNotThereIsSaid) {
  json configuration = heat(1, 1);
  configuration.erase("exact");
  EXPECT_EQ(study("--levels 0-1 --against formula", configuration), 1);
  EXPECT_THAT(message, HasSubstr("expected the key exact"));
  EXPECT_EQ(study("--levels 0-1 --against exact", configuration), 1);
  EXPECT_THAT(message, HasSubstr("--against finest"));
  EXPECT_EQ(study("--levels 0-1 --against nothing", configuration), 1);
  EXPECT_THAT(message, HasSubstr("expected exact, formula or finest"));
  configuration["mesh"] = {{"file", "a.msh"}};
  EXPECT_EQ(study("--levels 0-1", configuration), 1);
  EXPECT_THAT(message, HasSubstr("refine"));
}

}  // namespace
}  // namespace esfem::test_study
