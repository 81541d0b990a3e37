// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "solver/assembly/surface_space.hpp"
#include "solver/error.hpp"
#include "solver/linalg/block_solver.hpp"
#include "solver/linalg/symmetric_block_solver.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_symmetric_block_solver {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// P = A, Q = a M and an R that is neither positive nor negative, with right-hand sides.
struct Blocks {
  Mesh mesh;
  SurfaceSpace space;
  SymmetricMatrix M, P, Q, R;
  Field r, s;
  Blocks(int subdivisions, double a)
      : mesh(ellipsoid_mesh({2, 1, 0.7}, 2, subdivisions)),
        space(mesh),
        M(space.matrix()),
        P(space.matrix()),
        Q(space.matrix()),
        R(space.matrix()) {
    space.assemble(mesh.nodes, M, P);
    Q.values = a * M.values;
    const auto weight = [](const PointData<0>& p) { return 100 * p.x[0]; };
    space.assemble_weighted_mass<0>(mesh.nodes, mesh.nodes, weight, R);
    R.values = -a * (P.values + R.values);
    r = mesh.nodes.col(0).array().sin();
    s = (2 * mesh.nodes.col(1)).array().cos();
  }

  double residual(const Field& u, const Field& w) const {
    return std::max((P * u + Q * w - r).norm() / r.norm(), (Q * u + R * w - s).norm() / s.norm());
  }
};

TEST(SymmetricBlockSolver, SolvesIndefiniteSystems) {
  for (const double a : {1e4, 1.0, 1e-4}) {
    const Blocks of(3, a);
    SymmetricBlockSolver solver(of.space.pattern());
    for (int repetition = 0; repetition < 2; ++repetition) {
      solver.factorise(of.P, of.Q, of.R);
      Field u = of.r, w = of.s;
      solver.solve(u, w);
      EXPECT_LT(of.residual(u, w), 1e-8 * std::max(1.0, 1e-2 / a));
      EXPECT_GT(of.residual(1.001 * u, w), 1e-5) << "the residual sees another solution";
    }
  }
}

// With the second unknown a thousand times smaller hardly a pivot is accepted in its place.
TEST(SymmetricBlockSolver, FindsTheMemoryForPivotsThatAreMoved) {
  Blocks of(3, 100);
  of.Q.values *= 1e3;
  of.R.values *= 1e6;
  SymmetricBlockSolver solver(of.space.pattern());
  solver.factorise(of.P, of.Q, of.R);
  Field u = of.r, w = of.s;
  solver.solve(u, w);
  EXPECT_LT(of.residual(u, w), 1e-6);
}

TEST(SymmetricBlockSolver, AgreesWithTheComplexForm) {
  Blocks of(2, 7);
  of.R.values = -7 * of.P.values;  // P u + 7 M w = r, M u - P w = s/7
  SymmetricBlockSolver solver(of.space.pattern());
  BlockSolver complex_form(of.space.pattern());
  solver.factorise(of.P, of.Q, of.R);
  Field u = of.r, w = of.s, complex_u = -of.s / 7, complex_w = of.r;
  solver.solve(u, w);
  // 7 M w - A (-u) = r,  A w + M (-u) = -s/7
  complex_form.factorise(7, 1, 1, of.M, of.P);
  complex_form.solve(complex_w, complex_u);
  EXPECT_LT((u + complex_u).norm(), 1e-9 * u.norm());
  EXPECT_LT((w - complex_w).norm(), 1e-9 * w.norm());
}

TEST(SymmetricBlockSolver, SaysWhatIsWrong) {
  const Blocks of(1, 1), other(2, 1);
  SymmetricBlockSolver solver(of.space.pattern());
  Field u = of.r, w = of.s;
  EXPECT_THAT([&] { solver.solve(u, w); }, ThrowsMessage<NumericsError>(HasSubstr("call factorise()")));
  EXPECT_THAT([&] { solver.factorise(of.P, other.Q, of.R); },
              ThrowsMessage<InputError>(HasSubstr("pattern")));
  SymmetricMatrix bad = of.R;
  bad.values[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { solver.factorise(of.P, of.Q, bad); },
              ThrowsMessage<NumericsError>(HasSubstr("not finite")));
  SymmetricMatrix zero = of.P;
  zero.values.setZero();
  EXPECT_THAT([&] { solver.factorise(zero, zero, zero); },
              ThrowsMessage<NumericsError>(HasSubstr("is singular")));
  solver.factorise(of.P, of.Q, of.R);
  Field wrong = other.r;
  EXPECT_THAT([&] { solver.solve(wrong, w); }, ThrowsMessage<InputError>(HasSubstr("expected")));
}

}  // namespace
}  // namespace esfem::test_symmetric_block_solver
