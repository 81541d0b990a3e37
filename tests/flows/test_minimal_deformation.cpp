// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/SparseLU>
#include <cmath>

#include "solver/flows/generalised_mean_curvature_flow.hpp"
#include "solver/flows/mean_curvature_loads.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/geometry/discrete_curvature.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/problems/exact_states.hpp"
#include "solver/time/checkpoint.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_minimal_deformation {
namespace {

using State = MeanCurvatureFlow::State;
using Variant = MeanCurvatureFlow::Variant;

Variant sliding() {
  Variant variant;
  variant.tangential = Variant::minimal_deformation;
  return variant;
}

/// The flows with the velocity of minimal deformation rate and a multiple of its convective term, written
/// once more; 1 is right.
template <class FlowState>
class FlowWithConvection {
 public:
  using State = FlowState;

  FlowWithConvection(const SurfaceSpace& space, double convection, double power = 1)
      : deformation(space), space_(space), convection_(convection), law_(power), spd_(space.pattern()) {}

  void step(const BdfStep<State>& step, State& next) {
    SymmetricMatrix M = space_.matrix(), A = M, D = M;
    Field x, u, sum, f;
    const auto weight = [this](const Pack& V) {
      return apply([this](double value) { return law_.weight(value); }, V);
    };
    step.extrapolate(&State::x, x);
    step.extrapolate(&State::u, u);
    space_.assemble(x, M, A);
    deformation.velocity(x, u, M, A, next.v);
    Field u_v(x.rows(), 7);
    u_v << u, convection_ * next.v;
    space_.assemble_load<7, 4, 0>(x, u_v, MovingCurvatureLoad{0, weight}, f);
    space_.assemble_weighted_mass<1>(
        x, u.col(3), [&](const PointData<1>& p) { return weight(p.u[0]); }, D);
    step.known_sum(&State::u, sum);
    next.u = f - (D * sum) / step.tau;
    spd_.factorise(step.delta[0] / step.tau, D, 1, A);
    spd_.solve(next.u);
    step.known_sum(&State::x, sum);
    next.x = (step.tau * next.v - sum) / step.delta[0];
  }

  MinimalDeformation deformation;

 private:
  const SurfaceSpace& space_;
  double convection_;
  PowerLaw law_;
  SpdSolver spd_;
};

template <class Flow>
State end_of(const ReferenceCase& reference, Flow& flow) {
  if (reference.json["start"] == "cascade")
    return last_state(flow, reference.grid, mean_curvature_state_on(dumbbell(), reference.mesh.nodes));
  const ExactEvolution exact = shrinking_sphere(2);
  const std::function<State(double)> state = [&](double t) {
    return exact_mean_curvature_state(exact, reference.mesh.nodes, t);
  };
  return last_state(flow, reference.grid, {state(0), state});
}

double largest_difference(const Field& a, const Field& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

TEST(MinimalDeformation, AgreesWithTheIndependentImplementation) {
  for (const std::string name : {"mdr_sphere_bdf2", "mdr_dumbbell_bdf2"}) {
    const ReferenceCase reference(name);
    const SurfaceSpace space(reference.mesh, conical_quadrature(12));
    MeanCurvatureFlow flow(space, sliding());
    EXPECT_LT(reference.deviation(end_of(reference, flow)), 1e-8) << name;
    for (const auto& [variant, of] : reference.json["variants"].items())
      EXPECT_GT(of["max_difference_to_nodal"]["u"], 5e-8) << name << ": " << variant << " is told from it";
  }
}

TEST(MinimalDeformation, AgreesWithTheMultiplierAndTheWrongVariantsOfTheIndependentImplementation) {
  const ReferenceCase reference("mdr_dumbbell_bdf2");
  const SurfaceSpace space(reference.mesh, conical_quadrature(12));
  FlowWithConvection<State> right(space, 1), without(space, 0), wrong_sign(space, -1);
  EXPECT_LT(reference.deviation(end_of(reference, right)), 1e-8);
  EXPECT_LT(largest_difference(right.deformation.kappa(), reference.nodal("kappa")), 1e-5);
  const nlohmann::json& expected =
      reference.json["variants"]["no_convection (wrong)"]["max_difference_to_nodal"];
  const State end = end_of(reference, without);
  for (const NamedField<State>& field : State::fields) {
    const double difference = largest_difference(end.*field.member, reference.nodal(field.name));
    EXPECT_NEAR(difference / expected[field.name].get<double>(), 1, 1e-4) << field.name;
  }
  EXPECT_GT(largest_difference(end_of(reference, wrong_sign).u, reference.nodal("u")), 0.38);
}

/// Two ellipsoids side by side, and normals that are not quite theirs.
struct TwoEllipsoids {
  Mesh mesh;
  Field nu_V;

  TwoEllipsoids() {
    const Surface surface = ellipsoid(1.2, 1, 0.8);
    mesh = lagrange_mesh(generate_mesh(surface, 0.5), 2);
    project_nodes(mesh, surface);
    nu_V = mean_curvature_state_on(surface, mesh.nodes).u;
    nu_V.leftCols(3) += 0.05 * mesh.nodes.array().sin().matrix();
    const int nodes = static_cast<int>(mesh.nodes.rows()), elements = static_cast<int>(mesh.elements.rows());
    mesh.nodes = mesh.nodes.replicate(2, 1).eval();
    mesh.nodes.bottomRows(nodes).col(0).array() += 4;
    nu_V = nu_V.replicate(2, 1).eval();
    mesh.elements = mesh.elements.replicate(2, 1).eval();
    mesh.elements.bottomRows(elements).array() += nodes;
  }
};

TEST(MinimalDeformation, SolvesTheWholeSystemOnEachComponent) {
  const TwoEllipsoids on;
  const SurfaceSpace space(on.mesh);
  SymmetricMatrix M = space.matrix(), A = M, B = M;
  space.assemble(on.mesh.nodes, M, A);
  MinimalDeformation deformation(space);
  Field v;
  deformation.velocity(on.mesh.nodes, on.nu_V, M, A, v);

  const int N = space.dofs();
  const SparsityPattern& pattern = *space.pattern();
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int row, int column, const SymmetricMatrix& matrix, double factor) {
    for (int j = 0; j < N; ++j)
      for (int k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k) {
        const int i = pattern.row[k];
        entries.emplace_back(row + i, column + j, factor * matrix.values[k]);
        if (i != j) entries.emplace_back(row + j, column + i, factor * matrix.values[k]);
      }
  };
  for (int a = 0; a < 3; ++a) {
    const auto normal = [a](const PointData<3>& p) { return p.u[a]; };
    space.assemble_weighted_mass<3>(on.mesh.nodes, on.nu_V, normal, B);
    add(a * N, a * N, A, 1);
    add(a * N, 3 * N, B, -1);
    add(3 * N, a * N, B, -1);
  }
  Eigen::SparseMatrix<double> K(4 * N, 4 * N);
  K.setFromTriplets(entries.begin(), entries.end());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(4 * N);
  right.tail(N) = M * Field(on.nu_V.col(3));
  const Eigen::VectorXd solution = Eigen::SparseLU<Eigen::SparseMatrix<double>>(K).solve(right);
  EXPECT_LT((K * solution - right).norm(), 1e-12);
  EXPECT_LT(largest_difference(v, solution.head(3 * N).reshaped(N, 3)), 1e-8);
  EXPECT_LT(largest_difference(deformation.kappa(), solution.tail(N)), 1e-5);
  EXPECT_LT(deformation.iterations(), 25);
}

/// Velocities on a surface that grows differently in different places.
class ChangingSurface : public testing::Test {
 protected:
  void velocity(MinimalDeformation& deformation, double time, Field& v) {
    const Field x = on.mesh.nodes.array() * (1 + time * on.mesh.nodes.array().sin());
    space.assemble(x, M, A);
    deformation.velocity(x, on.nu_V, M, A, v);
  }

  const TwoEllipsoids on;
  const SurfaceSpace space{on.mesh};
  SymmetricMatrix M = space.matrix(), A = M;
  Field v, again;
};

TEST_F(ChangingSurface, FactorsOfAnEarlierOneServe) {
  MinimalDeformation earlier(space);
  velocity(earlier, 0, v);
  const int at_first = earlier.iterations();
  velocity(earlier, 0.1, v);
  EXPECT_LT(earlier.iterations(), at_first + 3) << "without the diagonal scaling it takes more";
  MinimalDeformation own(space);
  velocity(own, 0.1, again);
  EXPECT_LT(largest_difference(v, again), 1e-8);
}

TEST_F(ChangingSurface, RunsOnFromItsProgressToTheLastBit) {
  MinimalDeformation deformation(space);
  for (const double time : {0.0, 0.02, 0.04}) {
    MinimalDeformation resumed(space);
    resumed.resume(deformation.progress());
    velocity(deformation, time, v);
    velocity(resumed, time, again);
    EXPECT_EQ(v, again) << "t = " << time;
  }
  nlohmann::json wrong = deformation.progress();
  wrong["mass_x"] = packed(Field::Ones(3, 3));
  EXPECT_THROW(deformation.resume(wrong), InputError);
}

TEST(MinimalDeformation, TakesFewIterationsOnceItHasVelocitiesToStartFrom) {
  const Surface surface = dumbbell();
  Mesh mesh = lagrange_mesh(generate_mesh(surface, 0.1), 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  FlowWithConvection<State> flow(space, 1);
  std::vector<int> iterations;
  integrate(flow, {2, 0.001, 20, parse_start("substeps:1")}, {mean_curvature_state_on(surface, mesh.nodes)},
            [&](int, const State&) { iterations.push_back(flow.deformation.iterations()); });
  EXPECT_LT(iterations[1], 20) << "without |A|² in the preconditioner it takes more";
  EXPECT_LT(iterations.back(), 10);
}

/// How far a flow's own normals are from those of its surface after a few steps: root mean square.
template <class Flow, class State>
double parting(const SurfaceSpace& space, Flow&& flow, const State& start, State& end) {
  end = last_state(flow, {2, 0.005, 10, parse_start("cascade")}, {start});
  DiscreteCurvature curvature(space);
  curvature.compute(end.x);
  return (curvature.nu() - end.u.leftCols(3)).norm() / std::sqrt(end.x.rows());
}

TEST(MinimalDeformation, NormalsBelongToTheSurfaceOffTheSphereWithTheConvectiveTermAlone) {
  using GeneralisedState = GeneralisedMeanCurvatureFlow::State;
  const Surface surface = ellipsoid(1.5, 1, 0.8);
  Mesh mesh = lagrange_mesh(generate_mesh(surface, 0.35), 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  const State start = mean_curvature_state_on(surface, mesh.nodes);
  for (const double power : {1.0, 2.0, -1.0}) {
    const PowerLaw law(power);
    const GeneralisedState from =
        generalised_mean_curvature_state(law, mesh.nodes, start.u.leftCols(3), start.u.col(3));
    GeneralisedState end, again, wrong;
    GeneralisedMeanCurvatureFlow flow(space, law, Variant::ritz, {}, Variant::minimal_deformation);
    const double right = parting(space, flow, from, end);
    parting(space, FlowWithConvection<GeneralisedState>(space, 1, power), from, again);
    EXPECT_LT(largest_difference(end.u, again.u), 1e-11) << power;
    const double without = parting(space, FlowWithConvection<GeneralisedState>(space, 0, power), from, wrong);
    EXPECT_LT(right, 0.012) << power;
    // In the inverse flow the nodes hardly slide in this time.
    EXPECT_GT(without, (power > 0 ? 5 : 1.05) * right) << power;
  }
}

TEST(MinimalDeformation, TheConvectiveTermOfWillmoreFlowIsThatOfTheSurface) {
  // A tiny step with tangential motion less one without is tau (v . grad) u: A v of the normal, v . grad H.
  const Surface surface = ellipsoid(1.3, 1, 0.8);
  Mesh mesh = lagrange_mesh(generate_mesh(surface, 0.3), 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  for (const WillmoreLaw& law : {willmore_law(), surface_diffusion_law()}) {
    WillmoreFlow::Variant variant;
    variant.law = law;
    variant.projection = WillmoreFlow::Variant::none;
    const WillmoreFlow::State start = willmore_start_on(space, surface, mesh.nodes, law, true).state;
    const double tau = 1e-9;
    const auto after_a_step = [&](auto tangential) {
      variant.tangential = tangential;
      WillmoreFlow flow(space, variant);
      return last_state(flow, {1, tau, 1, {}}, {start});
    };
    const WillmoreFlow::State still = after_a_step(Variant::none),
                              moved = after_a_step(Variant::minimal_deformation);
    Field expected(mesh.nodes.rows(), 4);
    for (int j = 0; j < expected.rows(); ++j) {
      const Vec3 x = mesh.nodes.row(j), v = moved.v.row(j);
      expected.row(j) << v.dot(surface.mean_curvature_gradient(x)),
          (surface.shape_at(x).weingarten * v).transpose();
    }
    const double size = expected.norm(), difference = ((moved.u - still.u) / tau - expected).norm();
    EXPECT_LT(difference, 0.1 * size);
    EXPECT_NEAR((moved.v.cwiseProduct(start.u.rightCols(3)).rowwise().sum() - start.w.col(0)).norm(), 0,
                0.1 * start.w.col(0).norm())
        << "the normal velocity is V";
  }
}

}  // namespace
}  // namespace esfem::test_minimal_deformation
