// SPDX-License-Identifier: GPL-3.0-or-later
// What the experiments on surfaces that Willmore flow leaves as they are have in common, and their programs
// on coarse meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "experiments/harness/stationary_willmore.hpp"
#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/problems/exact_evolution.hpp"

namespace esfem::test_willmore_experiments {
namespace {

namespace fs = std::filesystem;
using testing::StartsWith;

const double energy_of_spheres = 8 * pi;

struct StationarySphere : testing::Test {
  Mesh mesh = [] {
    Mesh quadratic = lagrange_mesh(icosphere(1, 1), 2);
    project_nodes(quadratic, sphere(1));
    return quadratic;
  }();
  SurfaceSpace space{mesh};
  StationaryWillmore setting;

  StationarySphere() { setting.grid = {2, 0.1, 5, Start{}}; }
  Row run(const WillmoreObserver& observe = {}) const {
    Row row;
    run_stationary_willmore(space, mesh, stationary_sphere(1), setting, energy_of_spheres, observe, row);
    return row;
  }
};

TEST_F(StationarySphere, StaysAsItIsWithThetaAlone) {
  setting.theta = true;
  const Row with_theta = run();
  setting.theta = false;
  const Row without = run();
  for (const char* quantity : {"x", "nu", "H", "v", "V", "z"}) {
    EXPECT_LT(with_theta.errors.at(quantity).at("nodal_H1"), 1e-11) << quantity;
    EXPECT_GT(without.errors.at(quantity).at("nodal_H1"), 1e-6) << quantity;
  }
  EXPECT_EQ(with_theta.status, "ok");
  EXPECT_DOUBLE_EQ(with_theta.values.at("end_time"), 0.5);
}

// What (3.5b) gives at the start is off z = 0 without theta; V = 0 it meets, since H is constant.
TEST_F(StationarySphere, SaysHowFarTheInitialVelocityIsOff) {
  const Errors errors = run().errors;
  EXPECT_LT(errors.at("V_initial").at("nodal_H1"), 1e-10);
  const std::map<std::string, double>& z = errors.at("z_initial");
  const Surface exact = sphere(1);
  const Field without = willmore_start_on(space, exact, mesh.nodes, setting.variant.law, false).state.w;
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  const Field of_z = without.rightCols(3), M_z = M * of_z, A_z = A * of_z;
  const double L2 = of_z.cwiseProduct(M_z).sum(), H1_semi = of_z.cwiseProduct(A_z).sum();
  EXPECT_NEAR(z.at("nodal_L2"), std::sqrt(L2), 1e-10 * std::sqrt(L2));
  EXPECT_NEAR(z.at("nodal_H1"), std::sqrt(L2 + H1_semi), 1e-10 * std::sqrt(H1_semi));
  // Cauchy-Schwarz: |e|² <= |e|_dual |e|_H1, and the dual norm is the smallest.
  EXPECT_GE(z.at("nodal_dual") * z.at("nodal_H1"), L2 * (1 - 1e-10));
  EXPECT_LT(z.at("nodal_dual"), z.at("nodal_L2"));
}

TEST_F(StationarySphere, HasTheErrorOfItsEnergy) {
  const Row row = run();
  EXPECT_DOUBLE_EQ(row.errors.at("energy").at("excess"), std::abs(row.values.at("willmore_excess")));
}

// H and with it V do not depend on nu_h then.
TEST_F(StationarySphere, StaysUnderSurfaceDiffusionWhileTheNormalIsOff) {
  setting.variant.law = surface_diffusion_law();
  const Errors errors = run().errors;
  for (const char* quantity : {"x", "H", "v", "V"})
    EXPECT_LT(errors.at(quantity).at("nodal_H1"), 1e-11) << quantity;
  for (const char* quantity : {"nu", "z"}) EXPECT_GT(errors.at(quantity).at("nodal_H1"), 1e-6) << quantity;
}

TEST_F(StationarySphere, IsObservedInEachStep) {
  std::vector<double> times;
  const Row row = run([&](const WillmoreFlow::State& state) { times.push_back(state.t); });
  EXPECT_THAT(times, testing::Pointwise(testing::DoubleEq(), row.series.at("t")));
  EXPECT_EQ(times.size(), 6u);
}

TEST_F(StationarySphere, HasTheEnergyOfItsNodes) {
  WillmoreFlow::State state;
  state.x = mesh.nodes;
  state.u = Field::Zero(mesh.nodes.rows(), 4);
  state.u.col(0).setConstant(2);
  Row row;
  record_energies(space, state, energy_of_spheres, row);
  EXPECT_NEAR(row.values.at("willmore_energy"), 2 * space.area(mesh.nodes), 1e-12);
  EXPECT_NEAR(row.values.at("willmore_excess"), 2 * space.area(mesh.nodes) - energy_of_spheres, 1e-12);
  EXPECT_NEAR(row.values.at("kappa_energy"), energy_of_spheres, 0.1) << "another discretisation";
  EXPECT_GT(std::abs(row.values.at("kappa_energy") - row.values.at("willmore_energy")), 1e-6);
}

/// The table of a program's run.
Table table_of(const std::string& arguments) {
  const fs::path folder = fs::path(ESFEM_BINARY_DIR) / "test_willmore" / std::to_string(getpid());
  fs::create_directories(folder);
  const std::string file = (folder / "table.json").string();
  const std::string command =
      std::string(ESFEM_BINARY_DIR) + "/bin/" + arguments + " --output " + file + " 2>/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), exit_done) << command;
  const Table table = table_from_json(read_json(file), "table.json");
  fs::remove_all(folder);
  return table;
}

TEST(WillmoreSphere, SaysHowNormalsAndRadiiDevelop) {
  const Table table =
      table_of("willmore_sphere --run normals --steps 2 --mesh " + std::string(ESFEM_SOURCE_DIR) +
               "/reference/independent/sphere_radius1_162.msh");
  ASSERT_EQ(table.rows.size(), 2u);
  for (const Row& row : table.rows) {
    SCOPED_TRACE(row.cell);
    for (const char* name : {"min_nu", "max_nu", "min_radius", "max_radius", "willmore_energy"}) {
      EXPECT_EQ(row.series.at(name).size(), row.series.at("t").size()) << name;
    }
    const bool projected = row.labels.at("projection") == "projected";
    EXPECT_EQ(row.values.at("largest_deviation_of_nu") < 1e-12, projected);
    EXPECT_EQ(row.values.at("largest_deviation_of_radius") < 1e-3, projected);
  }
}

TEST(WillmoreCliffordTorus, ImplicitCouplingEndsBeforeItsTime) {
  const Table table =
      table_of("willmore_clifford_torus --run stability --F extrapolated,implicit --levels 1 --steps 2");
  ASSERT_EQ(table.rows.size(), 2u);
  for (const Row& row : table.rows) {
    SCOPED_TRACE(row.cell);
    const bool implicit = row.labels.at("F") == "implicit";
    EXPECT_THAT(row.status, StartsWith(implicit ? "singular at t = " : "ok"));
    EXPECT_EQ(row.values.at("end_time") < 1, implicit);
  }
}

}  // namespace
}  // namespace esfem::test_willmore_experiments
