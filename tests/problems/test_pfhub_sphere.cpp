// SPDX-License-Identifier: GPL-3.0-or-later
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "solver/constants.hpp"
#include "solver/problems/pfhub_sphere.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_pfhub_sphere {
namespace {

TEST(PfhubSphere, DerivativesOfThePotential) {
  using Jet = ceres::Jet<double, 1>;
  for (const double c : {0.25, 0.3, 0.41, 0.5, 0.66, 0.7, 0.8}) {
    EXPECT_NEAR(PfhubSphere::df(c), PfhubSphere::f(Jet(c, 0)).v[0], 1e-14);
    EXPECT_NEAR(PfhubSphere::d2f(c), PfhubSphere::df(Jet(c, 0)).v[0], 1e-14);
  }
  EXPECT_NEAR(PfhubSphere::d2f(0.5), -0.8, 1e-14);
}

// 1500 x 3000 points of a Gauss-Legendre product rule on the sphere give 1002.04857, and the mass
// 63236.96972.
TEST(PfhubSphere, InitialEnergyAndMassAreThoseOnTheExactSphere) {
  const auto errors = [](int subdivisions) {
    const Mesh mesh = sphere_mesh(PfhubSphere::radius, 2, subdivisions);
    const SurfaceSpace space(mesh);
    const CahnHilliardState start = pfhub_state(space, mesh.nodes, pfhub_initial_values(mesh.nodes));
    return std::pair(std::abs(pfhub_energy(space, start.x, start.u) - 1002.0485695794),
                     std::abs(start.Mu.sum() - 63236.9697204757));
  };
  const auto [coarse_energy, coarse_mass] = errors(4);
  const auto [energy, mass] = errors(5);
  EXPECT_LT(energy, 2e-3);
  EXPECT_GT(order(coarse_energy, energy), 3.5);
  EXPECT_LT(mass, 0.02);
}

// The tanh profile of a flat interface, c = 0.5 + 0.2 tanh(s/sqrt 5), solves f'(c) = kappa c''; its energy
// per length is sqrt(2 kappa 5) 0.4³/6 = 0.0477.
TEST(PfhubSphere, EnergyOfAGreatCircle) {
  const Mesh mesh = sphere_mesh(PfhubSphere::radius, 2, 5);
  const SurfaceSpace space(mesh);
  Field c(mesh.nodes.rows(), 1);
  for (int j = 0; j < c.rows(); ++j) {
    const double s = PfhubSphere::radius * std::asin(mesh.nodes(j, 2) / PfhubSphere::radius);
    c(j) = 0.5 + 0.2 * std::tanh(s / std::sqrt(5));
  }
  const double sigma = std::sqrt(2 * PfhubSphere::kappa * 5) * std::pow(0.4, 3) / 6;
  EXPECT_NEAR(pfhub_energy(space, mesh.nodes, c) / (turn * PfhubSphere::radius * sigma), 1, 0.01);
}

}  // namespace
}  // namespace esfem::test_pfhub_sphere
