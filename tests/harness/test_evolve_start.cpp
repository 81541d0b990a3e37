// SPDX-License-Identifier: GPL-3.0-or-later
// What a run of evolve takes from its mesh file: nodes, their order and numbers, and nodal values.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/mesh/mesh.hpp"
#include "solver/mesh/read.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_start {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct EvolveStart : EvolveProgram {
  std::string path(const std::string& name) const { return (folder / name).string(); }

  /// A run of no steps from a mesh file, without a surface.
  json from_file(const std::string& file, const json& changes = json::object()) const {
    json result =
        config({{"mesh", {{"file", file}, {"subdivisions", nullptr}}}, {"steps", 0}, {"degree", 2}});
    result.erase("surface");
    result.merge_patch(changes);
    return result;
  }

  /// An octahedron as MSH 2.2 whose nodes have the numbers 10, 30, 50, .., with more sections behind.
  std::string octahedron(const std::string& more = "") const {
    const Mesh mesh = octasphere(1, 0);
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n";
    for (int i = 0; i < 6; ++i)
      text += format("%d %g %g %g\n", 10 + 20 * i, mesh.nodes(i, 0), mesh.nodes(i, 1), mesh.nodes(i, 2));
    text += "$EndNodes\n$Elements\n8\n";
    for (int e = 0; e < 8; ++e)
      text += format("%d 2 0 %d %d %d\n", e + 1, 10 + 20 * mesh.elements(e, 0), 10 + 20 * mesh.elements(e, 1),
                     10 + 20 * mesh.elements(e, 2));
    const std::string file = path("octahedron.msh");
    write_file(file, text + "$EndElements\n" + more);
    return file;
  }

  /// $NodeData of the octahedron with values[i] (one or three words) at node i.
  static std::string node_data(const std::string& name, int components,
                               const std::vector<std::string>& values) {
    std::string text =
        format("$NodeData\n1\n\"%s\"\n1\n0\n3\n0\n%d\n%zu\n", name.c_str(), components, values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      text += format("%zu %s\n", 10 + 20 * i, values[i].c_str());
    return text + "$EndNodeData\n";
  }
};

TEST_F(EvolveStart, FromItsOwnSnapshotIsTheSameSurfaceToTheLastBit) {
  const json mixture = {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}};
  const json tumour = {{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}};
  for (const auto& [changes, remark] :
       {std::pair(json{{"flow", "mean_curvature"}},
                  "H, nu from the mesh file; kappa, v of the mesh file not used"),
        std::pair(json{{"flow", "willmore"}, {"degree", 3}}, "H, V, nu, z from the mesh file"),
        std::pair(mixture, "u, w from the mesh file"), std::pair(tumour, "u1, u2, v from the mesh file"),
        std::pair(json{{"flow", "dziuk"}}, "H, kappa, nu, v of the mesh file not used")}) {
    json first = config({{"surface", {{"name", "ellipsoid"}, {"radius", nullptr}}},
                         {"steps", 2},
                         {"degree", 2},
                         {"start", "cascade"},
                         {"output", {{"vtu", path("run.pvd")}}}});
    first.merge_patch(changes);
    ASSERT_EQ(run(first), exit_done) << message;
    json end = read_json(nodal);
    ASSERT_EQ(run(from_file(path("run_0001.vtu"), changes)), exit_done) << message;
    EXPECT_THAT(message, AllOf(HasSubstr(remark), Not(HasSubstr("dropped"))));
    json start = read_json(nodal);
    for (json* values : {&end, &start})
      for (const char* key : {"t", "config", "provenance", "history"}) values->erase(key);
    // v of these is no unknown: the nodal values of -H nu, or that of the first step.
    if (changes["flow"] == "mean_curvature" || changes["flow"] == "dziuk")
      for (json* values : {&end, &start}) values->erase("v");
    EXPECT_EQ(start, end) << changes;
    EXPECT_GT(end.size(), 1u);
  }
}

TEST_F(EvolveStart, TheSnapshotOfTheStartIsNotRemoved) {
  const std::string snapshot = path("run_0000.vtu");
  ASSERT_EQ(run(config({{"steps", 0}, {"output", {{"vtu", path("run.pvd")}}}})), exit_done) << message;
  EXPECT_EQ(run(from_file(snapshot, {{"output", {{"vtu", path("./run.pvd")}}}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("one of its snapshots"));
  EXPECT_TRUE(std::filesystem::exists(snapshot));
  EXPECT_EQ(run(from_file(snapshot, {{"output", {{"vtu", path("more.pvd")}}}})), exit_done) << message;
}

TEST_F(EvolveStart, NodesKeepTheOrderAndTheNumbersOfTheFile) {
  const Mesh mesh = octasphere(1, 0);
  for (const int degree : {1, 2, 4}) {
    ASSERT_EQ(run(from_file(octahedron(), {{"flow", "bgn"}, {"bdf", 1}, {"degree", degree}})), exit_done)
        << message;
    const json end = read_json(nodal);
    EXPECT_EQ(end.at("node_numbers"), json({10, 30, 50, 70, 90, 110}));
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(end.at("x")[i], json({mesh.nodes(i, 0), mesh.nodes(i, 1), mesh.nodes(i, 2)}));
    ASSERT_EQ(end.at("elements").size(), 8u);
    for (int e = 0; e < 8; ++e) {
      EXPECT_EQ(int(end.at("elements")[e].size()), (degree + 1) * (degree + 2) / 2);
      for (int i = 0; i < 3; ++i) EXPECT_EQ(end.at("elements")[e][i], mesh.elements(e, i));
    }
  }
}

TEST_F(EvolveStart, TakesNodalValuesOfMshFiles) {
  const json mixture = {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}};
  ASSERT_EQ(run(from_file(octahedron(node_data("u", 1, {"1", "-1", "0.5", "0.25", "0", "1"})), mixture)),
            exit_done)
      << message;
  EXPECT_THAT(message, HasSubstr("u from the mesh file"));
  const json u = read_json(nodal).at("u");
  EXPECT_EQ(json({u[0], u[1], u[2], u[3], u[4], u[5]}), json({1.0, -1.0, 0.5, 0.25, 0.0, 1.0}));
  // The node on the edge of the first element's corners is their mean.
  const json first = read_json(nodal).at("elements")[0];
  EXPECT_DOUBLE_EQ(u[int(first[3])], 0.5 * (u[int(first[0])].get<double>() + u[int(first[1])].get<double>()));
}

TEST_F(EvolveStart, RefusesNodalValuesThatCannotBeRight) {
  const json mixture = {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}};
  EXPECT_EQ(run(from_file(octahedron(node_data("u", 1, {"1", "1", "1", "1", "1"})), mixture)), exit_usage);
  EXPECT_THAT(message, HasSubstr(": u has no finite value at node 110,"));
  const std::vector<std::string> vectors(6, "1 0 0");
  EXPECT_EQ(run(from_file(octahedron(node_data("u", 3, vectors)), mixture)), exit_usage);
  EXPECT_THAT(message, HasSubstr(": u has 3 components, 1 expected"));

  const std::string H = node_data("H", 1, {"2", "2", "2", "2", "2", "2"});
  const Mesh mesh = octasphere(1, 0);
  for (const double length : {1.0, -1.0, 0.2}) {
    std::vector<std::string> nu;
    for (int i = 0; i < 6; ++i)
      nu.push_back(format("%g %g %g", length * mesh.nodes(i, 0), length * mesh.nodes(i, 1),
                          length * mesh.nodes(i, 2)));
    EXPECT_EQ(run(from_file(octahedron(H + node_data("nu", 3, nu)), {{"degree", 1}})),
              length == 1 ? exit_done : exit_usage)
        << message;
    EXPECT_THAT(message, HasSubstr(length == 1  ? "H, nu from the mesh file"
                                   : length < 0 ? ": nu is not the outward normal"
                                                : ": nu has length 0.2 at node 10,"));
  }
}

TEST_F(EvolveStart, OtherFilesAreForTheScript) {
  for (const char* name : {"a.vtk", "a.xdmf"}) {
    EXPECT_EQ(run(from_file(path(name))), exit_usage);
    EXPECT_THAT(message, HasSubstr("plots/convert_mesh.py"));
  }
}

TEST_F(EvolveStart, OfATumourMayBeNothing) {
  const std::vector<std::string> nothing(6, "0");
  const json tumour = {{"flow", "coupled_diffusion"},
                       {"problem", "tumour_growth"},
                       {"degree", 1},
                       {"tau", 1e-3},
                       {"steps", 3}};
  ASSERT_EQ(run(from_file(octahedron(node_data("u1", 1, nothing) + node_data("u2", 1, nothing)), tumour)),
            exit_done)
      << message;
  EXPECT_GT(read_json(nodal).at("u1")[0].get<double>(), 0);
}

}  // namespace
}  // namespace esfem::test_evolve_start
