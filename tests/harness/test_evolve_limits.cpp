// SPDX-License-Identifier: GPL-3.0-or-later
// What evolve treats as a singularity, an extinction or a blow-up, and what it reports when nu and H are not
// the surface's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <map>
#include <vector>

#include "experiments/evolve/advice.hpp"
#include "solver/constants.hpp"
#include "solver/mesh/read.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_limits {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// The unit cube with n x n squares a side, each cut into two triangles.
Mesh cube(int n) {
  Mesh mesh;
  std::vector<Vec3> nodes;
  std::map<std::array<int, 3>, int> number;
  const auto node = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = number.try_emplace(at, static_cast<int>(nodes.size()));
    if (is_new) nodes.push_back(Vec3(at[0], at[1], at[2]) / n);
    return place->second;
  };
  std::vector<std::array<int, 3>> triangles;
  for (int axis = 0; axis < 3; ++axis)
    for (int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int a, int b) {
            std::array<int, 3> position;
            position[axis] = side;
            position[(axis + 1) % 3] = a;
            position[(axis + 2) % 3] = b;
            return node(position);
          };
          int corner[4] = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side == 0) std::swap(corner[1], corner[3]);
          triangles.push_back({corner[0], corner[1], corner[2]});
          triangles.push_back({corner[0], corner[2], corner[3]});
        }
  mesh.nodes.resize(nodes.size(), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) mesh.nodes.row(i) = nodes[i];
  mesh.elements.resize(triangles.size(), 3);
  for (std::size_t e = 0; e < triangles.size(); ++e)
    for (int i = 0; i < 3; ++i) mesh.elements(e, i) = triangles[e][i];
  return mesh;
}

/// An icosahedron whose faces are cut into 4^s triangles each, and stay flat.
Mesh flat_icosahedron(int s) {
  Mesh mesh = icosphere(1, 0);
  for (int i = 0; i < s; ++i) mesh = subdivide(mesh);
  return mesh;
}

struct EvolveLimits : EvolveProgram {
  const std::string mesh_file = (folder / "mesh.msh").string();

  json config(const json& changes) const {
    json result = {
        {"mesh", {{"file", mesh_file}}}, {"degree", 1}, {"bdf", 1}, {"output", {{"series", series}}}};
    result.merge_patch(changes);
    return result;
  }
  double last(const char* name) const { return read_json(series).at(name).back(); }
  std::string status() const { return read_json(series).at("status"); }
};

// Area and volume of an independent code: Dziuk's scheme, linear elements, backward Euler, the same mesh and
// steps.
TEST_F(EvolveLimits, ACubeIsNotSingular) {
  write_msh(cube(8), mesh_file);
  json dziuk = config({{"flow", "dziuk"}, {"tau", 2e-5}, {"steps", 100}});
  ASSERT_EQ(run(dziuk), exit_done) << message;
  EXPECT_NEAR(last("area"), 5.47214157912242, 1e-10);
  EXPECT_NEAR(last("volume"), 0.970844701241061, 1e-10);
  EXPECT_EQ(status(), "ok");
  const double area = last("area");
  dziuk["limits"] = json::object();
  ASSERT_EQ(run(dziuk), exit_done) << message;
  EXPECT_EQ(last("area"), area) << "no limits are the default ones";

  dziuk["limits"] = {{"curvature_size", 5}};
  EXPECT_EQ(run(dziuk), exit_numerics);
  EXPECT_THAT(status(), StartsWith("singular at t = 2e-05 (step 1): in element "));
  for (const char* text : {"counted from 1", "expected at most 5", "smaller steps", "remesh"})
    EXPECT_THAT(message, HasSubstr(text));
}

TEST_F(EvolveLimits, EveryFlowRunsFromACube) {
  write_msh(cube(4), mesh_file);
  const json adaptive = {{"end_time", 1e-4}, {"first_step", 1e-7}};
  for (const json& flow :
       {json{{"flow", "mean_curvature"}, {"tau", 2e-5}, {"steps", 3}},
        json{{"flow", "mean_curvature"}, {"degree", 2}, {"tau", 2e-5}, {"steps", 3}},
        json{{"flow", "mean_curvature"}, {"bdf", 3}, {"tau", 2e-5}, {"steps", 4}},
        json{{"flow", "dziuk"}, {"bdf", 3}, {"tau", 2e-5}, {"steps", 4}},
        json{{"flow", "bgn"}, {"tau", 2e-5}, {"steps", 3}},
        json{{"flow", "bgn"}, {"degree", 2}, {"tau", 2e-5}, {"steps", 3}},
        json{{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}, {"tau", 2e-5}, {"steps", 3}},
        json{{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}, {"tau", 2e-5}, {"steps", 3}}}) {
    EXPECT_EQ(run(config(flow)), exit_done) << flow << message;
  }
}

/// MSH 2.2, where element e has the number 1000 + e.
void write_numbered(const Mesh& mesh, const std::string& file) {
  std::ofstream stream(file);
  stream.precision(17);
  stream << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << mesh.nodes.rows() << "\n";
  for (int i = 0; i < mesh.nodes.rows(); ++i) stream << i + 1 << " " << mesh.nodes.row(i) << "\n";
  stream << "$EndNodes\n$Elements\n" << mesh.elements.rows() << "\n";
  for (int e = 0; e < mesh.elements.rows(); ++e)
    stream << 1000 + e << " 2 0 " << mesh.elements.row(e).array() + 1 << "\n";
  stream << "$EndElements\n";
}

TEST_F(EvolveLimits, AThinElementOfTheFileIsNamedAsThereAndRuns) {
  Mesh mesh = icosphere(1, 1);
  const int from = mesh.elements(17, 0), onto = mesh.elements(17, 1);
  mesh.nodes.row(from) = 0.998 * mesh.nodes.row(onto) + 0.002 * mesh.nodes.row(from);
  write_numbered(mesh, mesh_file);
  const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
  ASSERT_LT(quality.min_radius_ratio, 0.01);
  for (const char* flow : {"mean_curvature", "dziuk"}) {
    EXPECT_EQ(run(config({{"flow", flow}, {"tau", 1e-4}, {"steps", 2}})), exit_done) << message;
    const int line = 9 + static_cast<int>(mesh.nodes.rows()) + quality.worst_element;
    EXPECT_THAT(message, HasSubstr(format("mesh.msh: element %d (line %d): radius ratio %.2g, at least 0.01",
                                          1000 + quality.worst_element, line, quality.min_radius_ratio)));
    EXPECT_THAT(message, HasSubstr("remesh"));
  }
}

TEST_F(EvolveLimits, ARefusalNamesTheFlowThatRuns) {
  Mesh mesh = icosphere(1, 2);
  mesh.nodes.row(0) *= 2;
  write_msh(mesh, mesh_file);
  const auto run_flow = [&](const char* flow) {
    return run(config({{"flow", flow}, {"bdf", 1}, {"tau", 1e-4}, {"steps", 5}}));
  };
  EXPECT_EQ(run_flow("bgn"), exit_numerics);
  EXPECT_THAT(message, HasSubstr("; try \"flow\": \"dziuk\"; on some meshes"));
  EXPECT_EQ(run_flow("dziuk"), exit_done) << message;
}

TEST_F(EvolveLimits, ACureIsNamedForEveryFlow) {
  EvolveConfig config;
  const auto expect = [&config](int degree, const char* flow, const char* expected) {
    config.mesh.degree = degree;
    config.entry = &entry_named(flow, "", "test");
    EXPECT_THAT(config.entry->cure(config), StartsWith(expected));
  };
  expect(1, "mean_curvature", "try \"flow\": \"dziuk\" or \"bgn\"; on some meshes even elements (");
  expect(2, "mean_curvature", "try \"flow\": \"dziuk\" or \"bgn\" with \"degree\": 1; on some meshes even");
  EXPECT_THAT(config.entry->cure(config), Not(HasSubstr("normalise"))) << "which helps flat elements only";
  config.variant = Settings(json::object(), entry_named("mean_curvature", "", "test").variant, "test");
  expect(2, "mean_curvature",
         "try \"variant\": {\"tangential\": \"minimal_deformation\"}, \"flow\": \"dziuk\"");
  config.variant = {};
  expect(2, "bgn", "try \"flow\": \"dziuk\" with \"degree\": 1; on some meshes even elements (");
  expect(1, "dziuk", "try \"flow\": \"bgn\"; on some meshes even elements (");
  config.mesh = icosphere(2, 2);
  config.variant = Settings(json::object(), entry_named("willmore", "", "test").variant, "test");
  expect(2, "willmore", "try smaller steps, \"variant\": {\"relaxation\": 6.5}, or even");
  config.grid.tau = 0.1;
  expect(2, "willmore", "try smaller steps, \"variant\": {\"relaxation\": 2}, or even");
  EXPECT_THAT(config.entry->curvature_cure(config), StartsWith("try \"variant\": {\"relaxation\": 2} or {"));
  config.variant = Settings({{"relaxation", 1.5}}, entry_named("willmore", "", "test").variant, "test");
  expect(2, "willmore", "try smaller steps, or even");
  EXPECT_THAT(config.entry->curvature_cure(config), StartsWith("try \"variant\": {\"reinitialise\""));
  expect(1, "cahn_hilliard", "try smaller steps, or even elements");
}

TEST_F(EvolveLimits, SmallerStepsComeFirstWhereOneHasChangedMuch) {
  json ellipsoid = config({{"flow", "mean_curvature"},
                           {"surface", {{"name", "ellipsoid"}, {"axes", {2, 1, 1}}}},
                           {"mesh", {{"file", nullptr}, {"edge_length", 0.3}}},
                           {"degree", 2},
                           {"bdf", 2},
                           {"tau", 0.2},
                           {"steps", 5}});
  ASSERT_EQ(run(ellipsoid), exit_numerics) << message;
  EXPECT_THAT(
      status(),
      HasSubstr("; the surface exists for 0.19 at most, and tau is 0.2: take smaller steps; if they do not "
                "help, try \"variant\""));
  ellipsoid.merge_patch({{"flow", "generalised_mean_curvature"}, {"tau", 0.05}});
  ASSERT_EQ(run(ellipsoid), exit_numerics) << message;
  EXPECT_THAT(status(), HasSubstr("; the last step has changed the area by "));
  EXPECT_THAT(status(), HasSubstr("%: take smaller ones; if they do not help, try smaller steps"));
}

TEST_F(EvolveLimits, AMeshThatFailsBeforeTheCurvatureGrowsIsSaidToBeOne) {
  // A dumbbell that pinches, and a mesh of which one element is folded by the flow.
  json dumbbell = config({{"flow", "dziuk"},
                          {"surface", {{"name", "dumbbell"}}},
                          {"mesh", {{"file", nullptr}, {"edge_length", 0.2}, {"grading", 1}}},
                          {"tau", 5e-4},
                          {"steps", 400}});
  EXPECT_EQ(run(dumbbell), exit_numerics);
  EXPECT_THAT(status(), AllOf(HasSubstr("singular"), Not(HasSubstr("failure of the mesh")))) << message;
  dumbbell.merge_patch({{"degree", 2}, {"bdf", 2}, {"tau", 3e-3}, {"start", "substeps:16"}});
  EXPECT_EQ(run(dumbbell), exit_numerics);
  EXPECT_THAT(status(), HasSubstr("failure of the mesh")) << message;
}

TEST_F(EvolveLimits, ASphereThatShrinksToNothingIsExtinct) {
  for (const json& flow :
       {json{{"flow", "dziuk"}}, json{{"flow", "bgn"}}, json{{"flow", "mean_curvature"}},
        json{{"flow", "mean_curvature"}, {"bdf", 3}}, json{{"flow", "dziuk"}, {"bdf", 2}}}) {
    json sphere = config({{"surface", {{"name", "sphere"}, {"radius", 2}}},
                          {"mesh", {{"file", nullptr}, {"subdivisions", 2}}},
                          {"start", "cascade"},
                          {"tau", 0.01},
                          {"steps", 200}});
    sphere.merge_patch(flow);
    ASSERT_EQ(run(sphere), exit_numerics) << flow << message;
    EXPECT_THAT(message, HasSubstr(status())) << flow;
    ASSERT_THAT(status(), StartsWith("extinct at t = ")) << flow;
    EXPECT_NEAR(std::stod(status().substr(15)), 1, 0.05) << flow;
    EXPECT_NEAR(last("t"), 1, 0.06) << flow;
  }
}

TEST_F(EvolveLimits, WhatBlowsUpIsNamedBeforeTheElementsItMoves) {
  json tumour = config({{"flow", "coupled_diffusion"},
                        {"problem", "tumour_growth"},
                        {"surface", {{"name", "sphere"}}},
                        {"mesh", {{"file", nullptr}, {"subdivisions", 2}}},
                        {"parameters", {{"gamma", 300}}},
                        {"tau", 0.01},
                        {"steps", 500}});
  EXPECT_EQ(run(tumour), exit_numerics);
  for (const char* text :
       {"u1 = ", "at node ", "counted from 1", "rate times the step size is 3", "smaller steps"})
    EXPECT_THAT(status(), HasSubstr(text));
  EXPECT_THAT(status(), Not(HasSubstr("element 1")));
}

TEST_F(EvolveLimits, SaysWhenNuAndHAreNotThoseOfTheSurface) {
  write_msh(flat_icosahedron(2), mesh_file);
  json willmore = {{"flow", "willmore"}, {"bdf", 2}, {"adaptive", {{"end_time", 0.02}}}};
  ASSERT_EQ(run(config(willmore)), exit_done) << message;
  EXPECT_LT(last("willmore_energy"), 0.97 * 8 * pi) << "forbidden by Willmore's inequality";
  EXPECT_THAT(status(), StartsWith("ok, but nu and H"));
  EXPECT_THAT(message,
              HasSubstr("nu and H, which the flow evolves, differ from those of the surface at t = "));
  EXPECT_THAT(message, HasSubstr("reinitialise"));

  willmore["variant"] = {{"reinitialise", 0.05}};
  ASSERT_EQ(run(config(willmore)), exit_done) << message;
  EXPECT_EQ(status(), "ok");
  const json found = read_json(series);
  const std::vector<double> own = found.at("willmore_energy"), surface = found.at("kappa_energy");
  for (std::size_t n = 0; n < own.size(); ++n) {
    EXPECT_GT(own[n], 0.99 * 8 * pi) << n;
    EXPECT_NEAR(own[n] / surface[n], 1, 0.25) << n;
  }
}

TEST_F(EvolveLimits, ACubeLosesItsAreaTooSlowlyAndIsToldSo) {
  write_msh(cube(8), mesh_file);
  json flow = config({{"flow", "mean_curvature"}, {"tau", 2e-5}, {"steps", 100}});
  ASSERT_EQ(run(flow), exit_done) << message;
  EXPECT_GT(last("area"), 5.6) << "5.47 is right";
  EXPECT_THAT(status(), StartsWith("ok, but nu and H"));
  flow["variant"] = {{"reinitialise", 0.05}};
  ASSERT_EQ(run(flow), exit_done) << message;
  EXPECT_NEAR(last("area"), 5.47, 0.05);
}

TEST_F(EvolveLimits, SaysThatNodesHaveSlidOffEdges) {
  write_msh(cube(1), mesh_file);
  ASSERT_EQ(run(config({{"flow", "bgn"}, {"tau", 1e-6}, {"steps", 1}})), exit_done) << message;
  EXPECT_LT(last("area"), 5.9) << "whatever tau is";
  EXPECT_THAT(status(), HasSubstr("nodes have slid off edges of the surface; try \"flow\": \"dziuk\""));
  write_msh(icosphere(1, 2), mesh_file);
  ASSERT_EQ(run(config({{"flow", "bgn"}, {"tau", 1e-3}, {"steps", 1}})), exit_done) << message;
  EXPECT_EQ(status(), "ok");
}

TEST_F(EvolveLimits, IsSilentWhereTheMeshResolvesTheCurvature) {
  write_msh(icosphere(1, 2), mesh_file);
  for (const json& flow : {json{{"flow", "mean_curvature"}, {"tau", 1e-3}, {"steps", 10}},
                           json{{"flow", "willmore"}, {"tau", 1e-4}, {"steps", 10}},
                           json{{"flow", "surface_diffusion"}, {"tau", 1e-4}, {"steps", 10}}}) {
    ASSERT_EQ(run(config(flow)), exit_done) << flow << message;
    EXPECT_EQ(status(), "ok") << flow;
    EXPECT_THAT(message, Not(HasSubstr("differ")));
  }
}

TEST_F(EvolveLimits, RefusesLimitsThatAreNone) {
  write_msh(icosphere(1, 1), mesh_file);
  const auto refused = [&](const json& limits) {
    return run(config({{"flow", "dziuk"}, {"tau", 0.01}, {"limits", limits}})) == exit_usage;
  };
  EXPECT_TRUE(refused({{"curvature", 5}}));
  EXPECT_THAT(message, HasSubstr("known are curvature_size, normal_length, radius_ratio"));
  EXPECT_TRUE(refused({{"curvature_size", 0}}));
  EXPECT_THAT(message, HasSubstr("limits: found curvature_size = 0"));
  EXPECT_TRUE(refused({{"normal_length", 1}}));
  EXPECT_FALSE(refused({{"radius_ratio", 0}})) << message;
}

}  // namespace
}  // namespace esfem::test_evolve_limits
