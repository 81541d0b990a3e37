// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/phase_separation.hpp"
#include "solver/problems/disturbed_mixture.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_phase_separation {
namespace {

using State = CahnHilliardState;

const double epsilon = 0.15;

struct Mixture {
  Mesh mesh = sphere_mesh(1, 1, 2);
  SurfaceSpace space{mesh};
  State start = disturbed_mixture(space, mesh.nodes, epsilon, 0, 0.5, 3);

  double energy(const State& state) const {
    return ginzburg_landau_energy(space, mesh.nodes, state.u, epsilon);
  }

  template <class Flow>
  std::vector<double> energies(Flow& flow, int q, double tau, int steps) const {
    std::vector<double> list;
    integrate(flow, {q, tau, steps, parse_start("cascade")}, start, [&](int, const State& state) {
      list.push_back(energy(state));
      EXPECT_NEAR(state.Mu.sum(), 0, 1e-11);
    });
    return list;
  }
};

TEST(PhaseSeparation, LosesEnergyInStepsOfAnySize) {
  const Mixture mixture;
  for (const int q : {1, 3}) {
    PhaseSeparation flow(mixture.space, mixture.mesh.nodes, epsilon);
    const std::vector<double> energy = mixture.energies(flow, q, 100, 5);
    for (std::size_t n = 1; n < energy.size(); ++n) EXPECT_LE(energy[n], energy[n - 1] + 1e-6 * energy[0]);
    // One interface: 2 sqrt(2)/3 times the length of a great circle.
    EXPECT_NEAR(energy.back(), 6, 1) << q;
    EXPECT_GE(flow.replaced_steps(), 1);
  }
}

TEST(PhaseSeparation, WithoutReplacementTheEnergyRises) {
  const Mixture mixture;
  const NodalMotion at_rest = [&](double) -> const Field& { return mixture.mesh.nodes; };
  LinearisedCahnHilliard<DoubleWell> flow(mixture.space, DoubleWell(), at_rest, epsilon, 0.1);
  const std::vector<double> energy = mixture.energies(flow, 1, 100, 1);
  EXPECT_GT(energy[1], energy[0]);
}

TEST(PhaseSeparation, IsTheImplicitSchemeWhereTheEnergyFalls) {
  const Mixture mixture;
  const NodalMotion at_rest = [&](double) -> const Field& { return mixture.mesh.nodes; };
  PhaseSeparation flow(mixture.space, mixture.mesh.nodes, epsilon);
  LinearisedCahnHilliard<DoubleWell> implicit(mixture.space, DoubleWell(), at_rest, epsilon, 0.1);
  const UniformSteps grid{2, 1e-3, 10, parse_start("cascade")};
  // Not to the bit: the compiler contracts the same template differently in the library and here.
  const Field u = last_state(flow, grid, mixture.start).u;
  EXPECT_LT((u - last_state(implicit, grid, mixture.start).u).norm(), 1e-12 * u.norm());
  EXPECT_EQ(flow.replaced_steps(), 0);
}

TEST(PhaseSeparation, StartsWithTheMeanThatIsAskedFor) {
  const Mixture mixture;
  const State start = disturbed_mixture(mixture.space, mixture.mesh.nodes, epsilon, 0.3, 0.2, 1);
  EXPECT_NEAR(start.Mu.sum() / mixture.space.area(mixture.mesh.nodes), 0.3, 1e-14);
  EXPECT_LE((start.u.array() - 0.3).abs().maxCoeff(), 2 * 0.2);
  EXPECT_GT((start.u.array() - 0.3).abs().maxCoeff(), 0.05);
}

}  // namespace
}  // namespace esfem::test_phase_separation
