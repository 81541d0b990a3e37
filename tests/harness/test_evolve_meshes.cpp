// SPDX-License-Identifier: GPL-3.0-or-later
// The meshes that people bring to evolve: degree, curving and remeshing of flat triangles.
#include <gmock/gmock.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/mesh/read.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_meshes {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class EvolveMeshes : public EvolveProgram {
 protected:
  const std::string flat = (folder / "flat.msh").string();  ///< the unit sphere, 320 triangles

  void SetUp() override {
    EvolveProgram::SetUp();
    write_msh(icosphere(1, 2), flat);
  }

  json config(const json& mesh, const json& changes = json::object()) const {
    json result = {{"flow", "mean_curvature"},
                   {"mesh", mesh},
                   {"bdf", 2},
                   {"tau", 0.005},
                   {"steps", 20},
                   {"output", {{"nodal", nodal}, {"series", series}}}};
    result.merge_patch(changes);
    return result;
  }

  double value(const char* key, int step) const {
    const json list = read_json(series).at(key);
    return list[step < 0 ? list.size() - 1 : step];
  }
  double nodes() const { return double(read_json(nodal).at("x").size()); }
  double radius() const { return std::cbrt(value("volume", -1) * 3 / (4 * pi)); }
};

TEST_F(EvolveMeshes, OfFlatTrianglesHasDegreeOneUnlessItIsCurved) {
  ASSERT_EQ(run(config({{"file", flat}})), exit_done) << message;
  EXPECT_THAT(message, AllOf(HasSubstr("flat triangles, so degree 1"), HasSubstr("\"curve\": true")));
  EXPECT_EQ(nodes(), 162);
  EXPECT_NEAR(value("max_H", 0), 2, 0.15);
  EXPECT_NEAR(value("willmore_energy", 0), 8 * pi, 0.05 * 8 * pi);

  ASSERT_EQ(run(config({{"file", flat}}, {{"degree", 2}})), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("do not converge; \"curve\": true"));
  EXPECT_GT(value("max_H", 0), 2.3) << "what the warning is about";

  ASSERT_EQ(run(config({{"file", flat}, {"curve", true}})), exit_done) << message;
  EXPECT_THAT(message, AllOf(HasSubstr("curved; 0 of 480 edges"), Not(HasSubstr("converge"))));
  EXPECT_EQ(nodes(), 642);
  EXPECT_NEAR(value("max_H", 0), 2, 0.02);
  EXPECT_NEAR(value("willmore_energy", 0), 8 * pi, 0.002 * 8 * pi);
  EXPECT_NEAR(radius(), std::sqrt(0.6), 5e-4);

  ASSERT_EQ(run(config({{"file", flat}, {"curve", true}}, {{"degree", 3}, {"steps", 0}})), exit_done);
  EXPECT_EQ(nodes(), 1442);
}

TEST_F(EvolveMeshes, StandsStillUnderWillmoreFlowWhenCurved) {
  const json changes = {{"flow", "willmore"},
                        {"tau", nullptr},
                        {"steps", nullptr},
                        {"bdf", nullptr},
                        {"adaptive", {{"end_time", 0.1}}}};
  ASSERT_EQ(run(config({{"file", flat}, {"curve", true}}, changes)), exit_done) << message;
  EXPECT_NEAR(value("kappa_energy", 0), 8 * pi, 0.02 * 8 * pi);
  EXPECT_NEAR(value("kappa_energy", -1), 8 * pi, 0.02 * 8 * pi);
  EXPECT_NEAR(radius(), 1, 1.5e-3);
}

TEST_F(EvolveMeshes, OfCurvedElementsHasTheirDegree) {
  Mesh mesh = lagrange_mesh(icosphere(1, 1), 2);
  mesh.nodes.rowwise().normalize();
  write_msh(mesh, flat);
  ASSERT_EQ(run(config({{"file", flat}}, {{"steps", 0}})), exit_done) << message;
  EXPECT_EQ(nodes(), 162);
  EXPECT_THAT(message, Not(HasSubstr("flat")));
  EXPECT_EQ(run(config({{"file", flat}, {"curve", true}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("the elements are curved"));
  // On an exact surface nodes are projected, and the default stays 2.
  write_msh(icosphere(1, 1), flat);
  const json sphere = {{"steps", 0}, {"surface", {{"name", "sphere"}, {"radius", 1}}}};
  ASSERT_EQ(run(config({{"file", flat}}, sphere)), exit_done) << message;
  EXPECT_EQ(nodes(), 162);
  EXPECT_NEAR(value("max_H", 0), 2, 1e-12);
}

TEST_F(EvolveMeshes, IsRemeshed) {
  ASSERT_EQ(run(config({{"file", flat}, {"remesh", 0.2}}, {{"steps", 2}, {"tau", 1e-4}})), exit_done)
      << message;
  EXPECT_THAT(message, AllOf(HasSubstr("162 nodes before"), HasSubstr("degree 1")));
  EXPECT_GT(value("worst_radius_ratio", 0), 0.5);
  EXPECT_NEAR(value("area", 0), 4 * pi, 0.5);
  // With curve the new nodes are on the smooth surface, too.
  ASSERT_EQ(run(config({{"file", flat}, {"remesh", 0.2}, {"curve", true}}, {{"steps", 0}})), exit_done)
      << message;
  EXPECT_NEAR(value("max_H", 0), 2, 0.06);
  EXPECT_NEAR(value("willmore_energy", 0), 8 * pi, 0.002 * 8 * pi);
  EXPECT_NEAR(value("area", 0), 4 * pi, 0.01);
}

TEST_F(EvolveMeshes, RefusesWhatMakesNoSense) {
  const json sphere = {{"surface", {{"name", "sphere"}, {"radius", 1}}}}, none = json::object();
  const std::vector<std::tuple<json, json, std::string>> bad = {
      {{{"file", flat}, {"curve", true}}, {{"degree", 1}}, "expected degree 2 to 4"},
      {{{"file", flat}, {"curve", true}}, sphere, "expected one of them"},
      {{{"file", flat}, {"curve", 1}}, none, "true or false"},
      {{{"file", flat}, {"curve", {{"angle", 30}}}}, none, "known are feature_angle"},
      {{{"file", flat}, {"curve", {{"feature_angle", 0}}}}, none, "feature_angle = 0"},
      {{{"file", flat}, {"remesh", 0}}, none, "flat.msh: edge length 0"},
      {{{"file", flat}, {"remesh", 1e-9}}, none, "ten million"},
      {{{"edge_length", 0.3}, {"remesh", 0.1}}, sphere, "remesh"},
      {{{"file", flat}, {"subdivisions", 1}}, sphere, "expected edge_length (with it grading), file (with"},
  };
  for (const auto& [mesh, changes, expected] : bad) {
    EXPECT_EQ(run(config(mesh, changes)), exit_usage) << mesh;
    EXPECT_THAT(message, HasSubstr(expected));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  }
}

}  // namespace
}  // namespace esfem::test_evolve_meshes
