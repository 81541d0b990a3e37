// SPDX-License-Identifier: GPL-3.0-or-later
// The systems of all flows, solved by two routes: by SymmetricFactor, and by CHOLMOD, MUMPS or UMFPACK. Where
// the matrix is all but singular (very large steps) solutions differ however they are computed, and the
// residuals count.
#include <gtest/gtest.h>

#include "solver/assembly/surface_space.hpp"
#include "solver/linalg/block_solver.hpp"
#include "solver/linalg/node_block_lu.hpp"
#include "solver/linalg/spd_solver.hpp"
#include "solver/linalg/symmetric_block_solver.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/peers/cholmod_solver.hpp"
#include "tests/peers/mumps_block_solver.hpp"

namespace esfem::test_against_peers {
namespace {

double difference(const Field& found, const Field& expected) {
  return (found - expected).norm() / expected.norm();
}

/// Meshes of degrees 1 and 2, with their matrices and the integrals N_a of nu_a phi_i phi_j.
struct Matrices {
  Mesh mesh;
  SurfaceSpace space;
  SymmetricMatrix M, A, N[3];
  explicit Matrices(Mesh of) : mesh(std::move(of)), space(mesh), M(space.matrix()), A(M), N{M, M, M} {
    space.assemble(mesh.nodes, M, A);
    for (int a = 0; a < 3; ++a) {
      const auto normal = [a](const PointData<0>& p) { return p.normal[a]; };
      space.assemble_weighted_mass<0>(mesh.nodes, mesh.nodes, normal, N[a]);
    }
  }
};

class Peers : public testing::TestWithParam<int> {
 protected:
  const Matrices of{ellipsoid_mesh({2, 1, 0.7}, GetParam(), 5 - GetParam())};
  const int n = of.space.dofs();
};
INSTANTIATE_TEST_SUITE_P(Degrees, Peers, testing::Values(1, 2));

TEST_P(Peers, SpdSystems) {
  SpdSolver solver(of.space.pattern());
  CholmodSolver cholmod(of.space.pattern());
  const Field right = Field::Random(n, 7);
  // Up to A + 1e-12 M, in which the constants are all but lost.
  for (const double a : {1e6, 150.0, 1.0, 1e-3, 1e-6, 1e-12}) {
    solver.factorise(a, of.M, 1, of.A);
    cholmod.factorise(a, of.M, 1, of.A);
    Field y = right, expected = right;
    solver.solve(y);
    cholmod.solve(expected);
    const double residual = (a * (of.M * y) + of.A * y - right).norm();
    EXPECT_LT(residual, 1e-13 * (right.norm() + y.norm())) << a;
    if (a >= 1e-3) {
      EXPECT_LT(difference(y, expected), 1e-11) << a;
    }
  }
}

// kll21 (3.5) and bk22 (8.3): the growth of the pivots is bounded for all step sizes.
TEST_P(Peers, BlockSystems) {
  BlockSolver solver(of.space.pattern());
  MumpsBlockSolver mumps(of.space.pattern());
  const Field r = Field::Random(n, 4), s = Field::Random(n, 4);
  for (double tau = 1e-12; tau < 2e6; tau *= 1e3) {
    solver.factorise(1.5 / tau, 1, 1, of.M, of.A);
    mumps.factorise(1.5 / tau, 1, 1, of.M, of.A);
    Field u = r, w = s, u_expected = r, w_expected = s;
    solver.solve(u, w);
    mumps.solve(u_expected, w_expected);
    const double kappa = std::sqrt(tau / 1.5);
    const Field re = 1.5 / tau * (of.M * u) - of.A * w - r, im = of.A * u + of.M * w - s;
    const double matrix = 1 + 10 * kappa, y = std::hypot(u.norm() / kappa, w.norm());
    EXPECT_LT(std::hypot(kappa * re.norm(), im.norm()),
              1e-14 * (std::hypot(kappa * r.norm(), s.norm()) + matrix * y))
        << tau;
    if (tau < 2e3) {
      EXPECT_LT(difference(u, u_expected), 1e-11) << tau;
      EXPECT_LT(difference(w, w_expected), 1e-11) << tau;
    }
  }
}

/// The system of BgnSystem with S = tau M or tau A, without units.
Eigen::Matrix4d bgn_block(const Matrices& of, const SymmetricMatrix& S, double tau, int k) {
  Eigen::Matrix4d block =
      Eigen::Vector4d(-of.A.values[k], -of.A.values[k], -of.A.values[k], tau * S.values[k]).asDiagonal();
  for (int a = 0; a < 3; ++a) block(a, 3) = block(3, a) = of.N[a].values[k];
  return block;
}

TEST_P(Peers, BgnSystems) {
  SymmetricFactor<double, 4> factor(*of.space.pattern(), {-1, -1, -1, 1});
  NodeBlockLu umfpack(*of.space.pattern(), {{0, 3}, {1, 3}, {2, 3}, {0, 1, 2, 3}});
  const Field right = Field::Random(4 * n, 1);
  for (const SymmetricMatrix* S : {&of.M, &of.A}) {
    for (double tau = 1e-12; tau < 2e6; tau *= 1e3) {
      const auto block = [&](int k) { return bgn_block(of, *S, tau, k); };
      factor.factorise(block);
      umfpack.factorise([&](int k, bool, int a, int b) { return block(k)(a, b); });
      Field y = right;
      Eigen::VectorXd expected(4 * n);
      factor.solve(y);
      umfpack.solve(right, expected);
      Field Ky = Field::Zero(4 * n, 1);
      const SparsityPattern& pattern = *of.space.pattern();
      for (int j = 0; j < n; ++j)
        for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
          const int i = pattern.row[k];
          Ky.middleRows<4>(4 * i) += block(k) * y.middleRows<4>(4 * j);
          if (i != j) Ky.middleRows<4>(4 * j) += block(k) * y.middleRows<4>(4 * i);
        }
      EXPECT_LT((Ky - right).norm(), 1e-14 * (right.norm() + y.norm())) << tau;
      if (tau < 2) {
        EXPECT_LT(difference(y, expected), 1e-11) << tau;
      }
    }
  }
}

/// Steps of LinearisedCahnHilliard of all sizes, u between -1 and 1: g' = 3u² - 1 has both signs.
TEST_P(Peers, LinearisedCahnHilliardSystems) {
  SymmetricBlockSolver solver(of.space.pattern());
  MumpsSymmetricBlockSolver mumps(of.space.pattern());
  SymmetricMatrix W = of.M, kappa_M = of.M, B = of.M;
  const Field r = Field::Random(n, 1), s = Field::Random(n, 1), u0 = Field::Random(n, 1);
  for (const double epsilon : {0.02, 0.1, 1.0}) {
    const auto dg = [](const PointData<1>& p) { return 3 * p.u[0] * p.u[0] - 1; };
    of.space.assemble_weighted_mass<1>(of.mesh.nodes, u0, dg, W);
    for (double tau = 1e-12; tau < 2e6; tau *= 100) {
      const double kappa = std::sqrt(1.5 / (tau * epsilon));
      kappa_M.values = kappa * of.M.values;
      B.values = -of.A.values - W.values / (epsilon * epsilon);
      solver.factorise(of.A, kappa_M, B);
      mumps.factorise(of.A, kappa_M, B);
      Field w = r, u = s, w_expected = r, u_expected = s;
      solver.solve(w, u);
      mumps.solve(w_expected, u_expected);
      const double size = (10 + kappa + 1 / (epsilon * epsilon)) * std::hypot(w.norm(), u.norm());
      EXPECT_LT((of.A * w + kappa_M * u - r).norm() + (kappa_M * w + B * u - s).norm(), 1e-13 * size) << tau;
      if (tau < 2) {
        EXPECT_LT(difference(w, w_expected), 1e-9) << tau << " " << epsilon;
        EXPECT_LT(difference(u, u_expected), 1e-9) << tau << " " << epsilon;
      }
    }
  }
}

}  // namespace
}  // namespace esfem::test_against_peers
