// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/flows/discrete_curvature.hpp"
#include "solver/flows/dziuk_willmore_flow.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem {
namespace {

using testing::HasSubstr;
using State = DziukWillmoreFlow::State;

const double pi = std::acos(-1.0);

/// -M(x)^-1 A(x) x
Field discrete_w(const SurfaceSpace& space, const Field& x) {
  DiscreteCurvature curvature(space);
  curvature.compute(x);
  return -curvature.kappa();
}

/// 1/2 w^T M(x) w with w = -M(x)^-1 A(x) x
double energy(const SurfaceSpace& space, const Field& x) {
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  return M.energy(discrete_w(space, x)) / 2;
}

Field smooth_direction(const Field& x) {
  Field phi(x.rows(), 3);
  phi << (x.col(0) + 2 * x.col(1)).array().sin(), (x.col(1) - x.col(2)).array().cos(),
      (2 * x.col(2) + x.col(0)).array().sin();
  return phi;
}

/// A torus or an ellipsoid bent so that it has no symmetry.
Field bent(const Field& x) {
  return x + 0.1 * smooth_direction(1.3 * x);
}

struct Shape {
  const char* name;
  Mesh mesh;
};

class FirstVariation : public testing::TestWithParam<Shape> {
 protected:
  const SurfaceSpace space{GetParam().mesh};
  const Field x = bent(GetParam().mesh.nodes), phi = smooth_direction(x), w = discrete_w(space, x);

  /// Central difference of fourth order of the energy in direction phi.
  double energy_derivative() const {
    const double step = 1e-3;
    const auto difference = [&](double s) {
      return (energy(space, x + s * phi) - energy(space, x - s * phi)) / (2 * s);
    };
    return (4 * difference(step) - difference(2 * step)) / 3;
  }
  template <class Function>
  double load_in_direction(const Function& integrand) const {
    Field load;
    space.assemble_load<3, 3, 3>(x, w, integrand, load);
    return load.cwiseProduct(phi).sum();
  }
};

TEST_P(FirstVariation, ForceIsMinusTheDerivativeOfTheDiscreteEnergy) {
  Field force;
  assemble_willmore_force(space, x, w, force);
  const double expected = -energy_derivative(), actual = force.cwiseProduct(phi).sum();
  const double tolerance = 1e-7 * std::abs(expected);
  EXPECT_GT(std::abs(expected), 1);
  EXPECT_NEAR(actual, expected, tolerance);

  // It needs every one of its terms.
  const auto div_div = [](const PointData<3>& p, Integrand<3, 3>& load) {
    load = {};
    for (int l = 0; l < 3; ++l) load.flux[l][l] = p.grad[0][0] + p.grad[1][1] + p.grad[2][2];
  };
  const auto transposed_gradient = [](const PointData<3>& p, Integrand<3, 3>& load) {
    load = {};
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i) load.flux[l][i] = p.grad[i][l];
  };
  const auto square = [](const PointData<3>& p, Integrand<3, 3>& load) {
    load = {};
    for (int l = 0; l < 3; ++l) load.flux[l][l] = 0.5 * dot(p.u, p.u);
  };
  EXPECT_GT(std::abs(load_in_direction(div_div)), 1e4 * tolerance);
  EXPECT_GT(std::abs(load_in_direction(transposed_gradient)), 1e4 * tolerance);
  EXPECT_GT(std::abs(load_in_direction(square)), 1e4 * tolerance);
}

// The force is q(w) + B w with a quadratic q: the step takes q at the old w, B at the new one.
TEST_P(FirstVariation, AStepSolvesBothEquations) {
  const double tau = 1e-4;
  const State initial = dziuk_willmore_state_on(space, x);
  DziukWillmoreFlow flow(space);
  const State end = last_state(flow, {1, tau, 1, {}}, initial);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  const auto force = [&](const Field& w) {
    Field load;
    assemble_willmore_force(space, x, w, load);
    return load;
  };
  const Field q = (force(initial.w) + force(-initial.w)) / 2, Bw = (force(end.w) - force(-end.w)) / 2;
  const Field velocity = M * end.v - q - Bw, curvature = M * end.w + A * end.x;
  EXPECT_LT(velocity.norm(), 1e-9 * Bw.norm());
  EXPECT_LT(curvature.norm(), 1e-10 * Field(A * end.x).norm());
  EXPECT_LT((end.x - x - tau * end.v).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT((end.w - initial.w).norm(), 1e-3 * initial.w.norm());
  const Field explicit_velocity = M * end.v - force(initial.w);
  EXPECT_GT(explicit_velocity.norm(), 1e-3 * Bw.norm()) << "the explicit scheme is another one";
}

TEST_P(FirstVariation, InitialStateHasTheVelocityOfTheDiscreteEnergy) {
  const State state = dziuk_willmore_state_on(space, x);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  Field force;
  assemble_willmore_force(space, x, w, force);
  EXPECT_EQ(state.x, x);
  EXPECT_EQ(state.w, w);
  EXPECT_LT((M * state.v - force).norm(), 1e-12 * force.norm());
}

INSTANTIATE_TEST_SUITE_P(Shapes, FirstVariation,
                         testing::Values(Shape{"TorusP1", torus_mesh(1, 0.4, 1, 20, 10)},
                                         Shape{"TorusP2", torus_mesh(1, 0.4, 2, 10, 6)},
                                         Shape{"EllipsoidP2", ellipsoid_mesh({1, 0.8, 0.6}, 2, 1)},
                                         Shape{"EllipsoidP3", ellipsoid_mesh({1, 0.8, 0.6}, 3, 1)}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace esfem
