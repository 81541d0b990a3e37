// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/flows/dziuk_willmore_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/surfaces/surface.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_dziuk_willmore_flow {
namespace {

using testing::HasSubstr;
using State = DziukWillmoreFlow::State;

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
  return x + 0.05 * smooth_direction(1.3 * x);
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
  const auto D_term = [](const PointData<3>& p, Integrand<3, 3>& load) {
    load = {};
    for (int l = 0; l < 3; ++l)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
          const Pack tangential = (k == l ? 1.0 : 0.0) - p.normal[k] * p.normal[l];
          load.flux[l][i] -= (k == i ? 1.0 : 0.0) * p.grad[k][l] + tangential * p.grad[k][i];
        }
  };
  const auto square = [](const PointData<3>& p, Integrand<3, 3>& load) {
    load = {};
    for (int l = 0; l < 3; ++l) load.flux[l][l] = 0.5 * dot(p.u, p.u);
  };
  EXPECT_GT(std::abs(actual - load_in_direction(div_div) - expected), 1e4 * tolerance);
  EXPECT_GT(std::abs(actual - load_in_direction(D_term) - expected), 1e4 * tolerance);
  EXPECT_GT(std::abs(actual - load_in_direction(square) - expected), 1e4 * tolerance);
}

// The force is q(w) + B w with a quadratic q: the step takes q at the old w, B at the new one.
TEST_P(FirstVariation, AStepSolvesBothEquations) {
  const double tau = 1e-5;
  const State initial = dziuk_willmore_state_on(space, x);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  const auto force = [&](const Field& w) {
    Field load;
    assemble_willmore_force(space, x, w, load);
    return load;
  };
  const auto B = [&](const Field& w) -> Field { return (force(w) - force(-w)) / 2; };
  const Field q = (force(initial.w) + force(-initial.w)) / 2, Ax = A * x;
  for (const auto curvature : {DziukWillmoreFlow::dziuk, DziukWillmoreFlow::linearised}) {
    DziukWillmoreFlow flow(space, curvature);
    const State end = last_state(flow, {1, tau, 1, {}}, initial);
    const Field dx = end.x - x, change = curvature == DziukWillmoreFlow::dziuk ? A * dx : B(dx);
    EXPECT_LT((dx - tau * end.v).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((M * end.v - q - B(end.w)).norm(), 1e-9 * q.norm());
    EXPECT_LT((M * end.w + Ax + change).norm(), 1e-10 * Ax.norm());
    const Field other_change = curvature == DziukWillmoreFlow::dziuk ? B(dx) : A * dx;
    EXPECT_GT((M * end.w + Ax + other_change).norm(), 1e-4 * Ax.norm()) << "the variants differ";
    EXPECT_GT((M * end.v - force(initial.w)).norm(), 1e-3 * q.norm()) << "the explicit scheme is another one";
  }
}

// B is the second variation of the area: the derivative of A(x) x.
TEST_P(FirstVariation, TheLinearPartOfTheForceIsTheDerivativeOfTheCurvatureLoad) {
  const auto curvature_load = [&](const Field& nodes) -> Field {
    SymmetricMatrix M = space.matrix(), A = space.matrix();
    space.assemble(nodes, M, A);
    return A * nodes;
  };
  const double step = 1e-4;
  const Field expected = (curvature_load(x + step * phi) - curvature_load(x - step * phi)) / (2 * step);
  Field plus, minus;
  assemble_willmore_force(space, x, phi, plus);
  assemble_willmore_force(space, x, -phi, minus);
  EXPECT_LT(((plus - minus) / 2 - expected).norm(), 1e-6 * expected.norm());
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  EXPECT_GT((A * phi - expected).norm(), 0.1 * expected.norm()) << "A(x) alone is not the derivative";
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
                         testing::Values(Shape{"TorusP1", torus_mesh(1, 0.5, 1, 24, 12)},
                                         Shape{"TorusP2", torus_mesh(1, 0.5, 2, 14, 8)},
                                         Shape{"EllipsoidP2", ellipsoid_mesh({1, 0.8, 0.6}, 2, 1)},
                                         Shape{"EllipsoidP3", ellipsoid_mesh({1, 0.8, 0.6}, 3, 1)}),
                         [](const auto& info) { return info.param.name; });

TEST(DziukWillmoreFlow, OnlyTheFirstOrderIsThere) {
  const Mesh mesh = sphere_mesh(1, 1, 1);
  const SurfaceSpace space(mesh);
  DziukWillmoreFlow flow(space);
  try {
    last_state(flow, {2, 1e-3, 2, parse_start("cascade")}, dziuk_willmore_state_on(space, mesh.nodes));
    FAIL() << "BDF2 was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("BDF order 2: expected 1"));
  }
}

State run(const Mesh& mesh, DziukWillmoreFlow::Curvature curvature, double tau, int steps) {
  const SurfaceSpace space(mesh);
  DziukWillmoreFlow flow(space, curvature);
  return last_state(flow, {1, tau, steps, {}}, dziuk_willmore_state_on(space, mesh.nodes));
}

double radius_error(const State& state) {
  return (state.x.rowwise().norm().array() - 1).abs().maxCoeff();
}

// The nodes move at once, by about h^4, to where the discrete energy has its minimum.
TEST(DziukWillmoreFlow, SphereStaysUpToTheErrorInSpace) {
  const auto end = [](int subdivisions) {
    return run(sphere_mesh(1, 2, subdivisions), DziukWillmoreFlow::linearised, 0.01, 10);
  };
  const State coarse = end(0), fine = end(1);
  EXPECT_LT(radius_error(fine), 2e-3);
  EXPECT_GE(order(radius_error(coarse), radius_error(fine)), 3.5);
  EXPECT_LT((fine.w.rowwise().norm().array() - 2).abs().maxCoeff(), 1e-2);
}

TEST(DziukWillmoreFlow, CliffordTorusStaysUpToTheErrorInSpace) {
  const Mesh mesh = torus_mesh(1, std::sqrt(0.5), 2, 14, 10);
  const State end = run(mesh, DziukWillmoreFlow::dziuk, 5e-5, 10);
  const SurfaceSpace space(mesh);
  EXPECT_NEAR(energy(space, end.x), 4 * pi * pi, 0.1);
  EXPECT_GT(std::abs(energy(space, mesh.nodes) - 4 * pi * pi), 0.1) << "the nodes have rough curvature";
  EXPECT_NEAR(space.volume(end.x), space.volume(mesh.nodes), 1e-3);
  // Another torus does not stay.
  const Mesh other = torus_mesh(1, 0.5, 2, 14, 8);
  const SurfaceSpace other_space(other);
  const State moved = run(other, DziukWillmoreFlow::dziuk, 5e-5, 10);
  EXPECT_GT(std::abs(other_space.volume(moved.x) - other_space.volume(other.nodes)), 3e-3);
}

// The eigenvalues of M^-1 B M^-1 A go down to -278 on this sphere.
TEST(DziukWillmoreFlow, LargeStepsDestroyTheMeshButNotWithTheLinearisedCurvature) {
  const Mesh mesh = sphere_mesh(1, 2, 1);
  EXPECT_LT(radius_error(run(mesh, DziukWillmoreFlow::dziuk, 2e-4, 20)), 2e-3);
  EXPECT_THROW(run(mesh, DziukWillmoreFlow::dziuk, 0.01, 50), SingularityError);
  EXPECT_LT(radius_error(run(mesh, DziukWillmoreFlow::linearised, 0.01, 20)), 2e-3);
}

TEST(DziukWillmoreFlow, EnergyOfAnEllipsoidDecreasesByWhatIsDissipated) {
  const Mesh mesh = ellipsoid_mesh({1, 1, 0.6}, 2, 1);
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  const double tau = 5e-5;
  for (const auto curvature : {DziukWillmoreFlow::dziuk, DziukWillmoreFlow::linearised}) {
    DziukWillmoreFlow flow(space, curvature);
    double old_energy = 0;
    integrate(flow, {1, tau, 30, {}}, dziuk_willmore_state_on(space, mesh.nodes),
              [&](int n, const State& now) {
                const double new_energy = energy(space, now.x);
                space.assemble(now.x, M, A);
                if (n > 0) {
                  EXPECT_LT(new_energy, old_energy);
                }
                if (n > 20) {  // the rough part of the initial curvature has gone
                  EXPECT_NEAR((old_energy - new_energy) / (tau * M.energy(now.v)), 1, 0.1);
                }
                old_energy = new_energy;
              });
    EXPECT_LT(old_energy, 0.98 * energy(space, mesh.nodes));
  }
}

// The velocity of the discrete surface is rough: it converges weakly, here tested by x_l e_l.
TEST(DziukWillmoreFlow, VelocityIsThatOfWillmoreFlowOnTheEllipsoid) {
  const std::string folder = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/";
  const nlohmann::json reference = read_json(folder + "willmore_assembly.json");
  const Mesh mesh = read_mesh(folder + reference["mesh"].get<std::string>()).mesh;
  Field V_nu(mesh.nodes.rows(), 3);
  for (int j = 0; j < V_nu.rows(); ++j)
    for (int l = 0; l < 3; ++l) {
      V_nu(j, l) =
          reference["exact_w_willmore"][j][0].get<double>() * reference["exact_u"][j][1 + l].get<double>();
    }
  const SurfaceSpace space(mesh);
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  const Field expected = M * V_nu, actual = M * dziuk_willmore_state_on(space, mesh.nodes).v;
  for (int l = 0; l < 3; ++l) {
    const double exact = mesh.nodes.col(l).dot(expected.col(l));
    EXPECT_NEAR(mesh.nodes.col(l).dot(actual.col(l)), exact, 0.05 * std::abs(exact)) << "x" << l + 1;
  }
}

/// 1/2 int H² over the ellipsoid with semi-axes 1, 0.8, c.
double energy_of_ellipsoid(double c) {
  const Surface surface = ellipsoid(1, 0.8, c);
  const Mesh mesh = ellipsoid_mesh({1, 0.8, c}, 4, 2);
  const SurfaceSpace space(mesh);
  Field H(mesh.nodes.rows(), 1);
  for (int j = 0; j < H.rows(); ++j) H(j, 0) = surface.mean_curvature(mesh.nodes.row(j));
  SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(mesh.nodes, M, A);
  return M.energy(H) / 2;
}

TEST(DziukWillmoreFlow, ForceConvergesToTheFirstVariation) {
  const double step = 1e-3;
  const double derivative = (energy_of_ellipsoid(0.6 + step) - energy_of_ellipsoid(0.6 - step)) / (2 * step);
  const auto error = [&](int subdivisions) {
    const Mesh mesh = ellipsoid_mesh({1, 0.8, 0.6}, 2, subdivisions);
    const SurfaceSpace space(mesh);
    Field force;
    assemble_willmore_force(space, mesh.nodes, discrete_w(space, mesh.nodes), force);
    return force.col(2).dot(mesh.nodes.col(2)) / 0.6 + derivative;
  };
  const double coarse = error(2), fine = error(3);
  EXPECT_LT(std::abs(fine), 0.02 * std::abs(derivative));
  EXPECT_GE(order(coarse, fine), 1.8);
}

}  // namespace
}  // namespace esfem::test_dziuk_willmore_flow
