// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/flows/helfrich_law.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/problems/formula_data.hpp"
#include "solver/problems/spontaneous_curvature.hpp"
#include "solver/tables/table.hpp"
#include "solver/time/last_state.hpp"
#include "tests/assembly/meshes.hpp"

namespace esfem::test_helfrich {
namespace {

using Variant = WillmoreFlow::Variant;
using State = WillmoreFlow::State;
using nlohmann::json;

/// Values of the ellipsoid with half axes 1.2, 1, 0.8, for H_0 = 0 (case 0) and 1/2 (case 1).
struct Reference {
  json ellipsoid = read_json(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/helfrich.json")
                       .at("ellipsoid_non_equilibrium");
  json values;
  double H_0, lambda_A, lambda_V;

  explicit Reference(int which)
      : values(ellipsoid["cases"][which]),
        H_0(values["H0"]),
        lambda_A(values["lambda_A"]),
        lambda_V(values["lambda_V"]) {}
};

/// The P2 mesh of that ellipsoid, and runs of the flow on it.
struct OnEllipsoid {
  Vec3 axes{1.2, 1.0, 0.8};
  Surface surface = ellipsoid(axes[0], axes[1], axes[2]);
  Mesh mesh;
  SurfaceSpace space;

  explicit OnEllipsoid(int subdivisions = 2, int degree = 2)
      : mesh(ellipsoid_mesh(axes, degree, subdivisions)), space(mesh) {}

  AreaAndVolume keep(bool area, bool volume) const {
    AreaAndVolume prescribed;
    if (area) prescribed.area = constant_target(space.area(mesh.nodes));
    if (volume) prescribed.volume = constant_target(space.volume(mesh.nodes));
    return prescribed;
  }
  Variant variant(const WillmoreLaw& law, const AreaAndVolume& prescribed) const {
    Variant variant;
    variant.law = law;
    variant.prescribed = prescribed;
    variant.projection = Variant::in_coefficients;
    return variant;
  }
  State start(const WillmoreLaw& law, const AreaAndVolume& prescribed) const {
    return willmore_start_on(space, surface, mesh.nodes, law, false, prescribed).state;
  }
  /// Calls observe(n, state) after each of `steps` steps.
  template <class Observe>
  void run(Variant variant, int bdf, double tau, int steps, const Observe& observe) const {
    WillmoreFlow flow(space, variant);
    integrate(flow, UniformSteps{bdf, tau, steps, parse_start("cascade")},
              start(variant.law, variant.prescribed), observe);
  }
};

/// The largest error of V = Delta H + Q - lambda_A H - lambda_V in the points of the reference.
double error_of_V(const Reference& reference, const WillmoreLaw& law, double sign_of_lambda_A = 1) {
  double error = 0;
  for (const json& point : reference.values["points"]) {
    const double H = point["H"], K = point["K"];
    WillmorePoint at = {};
    at.H = pack(H);
    at.A_squared = pack(H * H - 2 * K);
    Pack Q;
    law(at, Q);
    const double V = point["laplace_H"].get<double>() + Q[0] - sign_of_lambda_A * reference.lambda_A * H -
                     reference.lambda_V;
    error = std::max(error, std::abs(V - point["V"].get<double>()));
  }
  return error;
}

TEST(Helfrich, TheNormalVelocityOfAnEllipsoidIsThatOfTheReference) {
  for (int which : {0, 1}) {
    const Reference reference(which);
    EXPECT_LT(error_of_V(reference, helfrich_law(reference.H_0)), 1e-11) << "H_0 = " << reference.H_0;
  }
}

TEST(Helfrich, EachTermOfTheVelocityMatters) {
  const Reference reference(1);
  const double H_0 = reference.H_0;
  EXPECT_GT(error_of_V(reference, helfrich_law(H_0), -1), 1) << "sign of lambda_A";
  EXPECT_GT(error_of_V(reference, helfrich_law(-H_0)), 1) << "sign of H_0";
  EXPECT_GT(error_of_V(reference, willmore_law()), 0.1) << "without H_0";
  EXPECT_GT(
      error_of_V(reference, [H_0](const WillmorePoint& at, Pack& Q) { Q = at.A_squared * (at.H - H_0); }),
      0.1)
      << "without H (H - H_0)²/2";
  EXPECT_GT(error_of_V(reference, [H_0](const WillmorePoint& at,
                                        Pack& Q) { Q = -0.5 * at.H * (at.H - H_0) * (at.H - H_0); }),
            0.1)
      << "without |A|² (H - H_0)";
  EXPECT_LT(error_of_V(Reference(0), willmore_law()), 1e-11) << "H_0 = 0 is Willmore flow";
}

TEST(Helfrich, MultipliersAtTheStartConvergeWithOrderFour) {
  // nu and H are exact, the surface is of degree 2: area and volume have order 4.
  for (int which : {0, 1}) {
    const Reference reference(which);
    const auto errors = [&](int subdivisions) {
      const OnEllipsoid on(subdivisions);
      const Field lambda = on.start(helfrich_law(reference.H_0), on.keep(true, true)).lambda;
      return std::pair(lambda(0, Multipliers::area) - reference.lambda_A,
                       lambda(0, Multipliers::volume) - reference.lambda_V);
    };
    const auto coarse = errors(2), fine = errors(3);
    EXPECT_GT(order(coarse.first, fine.first), 3) << coarse.first << " " << fine.first;
    EXPECT_GT(order(coarse.second, fine.second), 3) << coarse.second << " " << fine.second;
    EXPECT_LT(std::abs(fine.first), 2e-3 * std::abs(reference.lambda_A));
    EXPECT_LT(std::abs(fine.second), 2e-3 * reference.lambda_V);
  }
}

/// lambda after a small step, and dE/dt of H_h in it.
struct FirstStep {
  double lambda_A, lambda_V, dE_dt;
};
FirstStep first_step(const OnEllipsoid& on, const Reference& reference, const WillmoreLaw& law,
                     const AreaAndVolume& prescribed) {
  const Field H_0 = Field::Constant(on.space.dofs(), 1, reference.H_0);
  const double tau = 1e-6;
  FirstStep found;
  double E = 0;
  on.run(on.variant(law, prescribed), 1, tau, 1, [&](int, const State& state) {
    const double next = helfrich_energy(on.space, state.x, state.u.col(0), H_0);
    found = {state.lambda(0, 0), state.lambda(0, 1), (next - E) / tau};
    E = next;
  });
  return found;
}

TEST(Helfrich, AStepHasTheMultipliersAndTheDissipationOfTheReference) {
  const OnEllipsoid on(3);
  for (int which : {0, 1}) {
    const Reference reference(which);
    const WillmoreLaw law = helfrich_law(reference.H_0);
    const FirstStep kept = first_step(on, reference, law, on.keep(true, true));
    EXPECT_NEAR(kept.lambda_A, reference.lambda_A, 0.02 * std::abs(reference.lambda_A));
    EXPECT_NEAR(kept.lambda_V, reference.lambda_V, 0.02 * reference.lambda_V);
    const double expected = reference.values["dE_dt"], free = reference.values["dE_dt_unconstrained"];
    EXPECT_NEAR(kept.dE_dt, expected, 0.02 * std::abs(expected));
    EXPECT_NEAR(first_step(on, reference, law, {}).dE_dt, free, 0.02 * std::abs(free));
    // A term that is missing in Q changes both.
    const auto without = [&](const WillmorePoint& at, Pack& Q) { Q = at.A_squared * (at.H - reference.H_0); };
    const FirstStep wrong = first_step(on, reference, without, on.keep(true, true));
    EXPECT_GT(std::abs(wrong.lambda_A - reference.lambda_A), 0.2 * std::abs(reference.lambda_A));
  }
}

/// The largest relative changes of area and volume during a run.
struct Changes {
  double area = 0, volume = 0, largest_rise = -1e300;
};
Changes changes(const OnEllipsoid& on, Variant variant, int bdf, double tau, int steps, double H_0 = 0.5) {
  Changes found;
  const Field spontaneous = Field::Constant(on.space.dofs(), 1, H_0);
  const double area = on.space.area(on.mesh.nodes), volume = on.space.volume(on.mesh.nodes);
  double E = 1e300;
  on.run(variant, bdf, tau, steps, [&](int, const State& state) {
    found.area = std::max(found.area, std::abs(on.space.area(state.x) / area - 1));
    found.volume = std::max(found.volume, std::abs(on.space.volume(state.x) / volume - 1));
    const double next = helfrich_energy(on.space, state.x, state.u.col(0), spontaneous);
    found.largest_rise = std::max(found.largest_rise, next - E);
    E = next;
  });
  return found;
}

TEST(Helfrich, AreaAndVolumeOfTheDiscreteSurfaceAreKeptTogetherAndEachAlone) {
  const OnEllipsoid on;
  for (Variant::Coupling F : {Variant::extrapolated, Variant::implicit})
    for (Variant::Projection projection : {Variant::none, Variant::in_coefficients, Variant::after_steps})
      for (int kept : {1, 2, 3}) {
        Variant variant = on.variant(helfrich_law(0.5), on.keep(kept & 1, kept & 2));
        variant.F = F;
        variant.projection = projection;
        const Changes found = changes(on, variant, 2, 1e-3, 5);
        const std::string which = format("F %d, projection %d, kept %d", F, projection, kept);
        EXPECT_EQ(found.area < 1e-12, bool(kept & 1)) << which << ": " << found.area;
        EXPECT_EQ(found.volume < 1e-12, bool(kept & 2)) << which << ": " << found.volume;
      }
}

TEST(Helfrich, TheEnergyFalls) {
  const OnEllipsoid on;
  const Variant variant = on.variant(helfrich_law(0.5), on.keep(true, true));
  EXPECT_LT(changes(on, variant, 1, 5e-4, 100).largest_rise, 0);
  EXPECT_LT(changes(on, variant, 2, 5e-4, 100).largest_rise, 0);
}

TEST(Helfrich, AStepIsOfTheOrderOfBDF) {
  // Against small steps, from a surface whose fast modes have died out.
  const OnEllipsoid on(1);
  const WillmoreLaw law = helfrich_law(0.5);
  const Variant variant = on.variant(law, on.keep(true, true));
  const auto end = [&](const State& start, int bdf, double tau, int steps) {
    WillmoreFlow flow(on.space, variant);
    return last_state(flow, UniformSteps{bdf, tau, steps, parse_start("substeps:16")}, start);
  };
  const State start = end(on.start(law, variant.prescribed), 1, 1e-4, 200);
  const double T = 0.04;
  const State exact = end(start, 3, T / 200, 200);
  for (int bdf : {1, 2}) {
    const State coarse = end(start, bdf, T / 25, 25), fine = end(start, bdf, T / 50, 50);
    EXPECT_NEAR(order((coarse.x - exact.x).norm(), (fine.x - exact.x).norm()), bdf, 0.3) << bdf;
    EXPECT_NEAR(order((coarse.lambda - exact.lambda).norm(), (fine.lambda - exact.lambda).norm()), bdf, 0.3)
        << bdf;
  }
}

TEST(Helfrich, TheVolumeFollowsItsTarget) {
  const OnEllipsoid on;
  const double area = on.space.area(on.mesh.nodes), volume = on.space.volume(on.mesh.nodes);
  const double begin = reduced_volume(area, volume), last = begin - 0.02, T = 0.02;
  AreaAndVolume prescribed = on.keep(true, false);
  prescribed.volume = smooth_target(volume, volume_of(area, last), 0, T);
  std::vector<double> found;
  on.run(on.variant(helfrich_law(0), prescribed), 2, 1e-3, 22, [&](int, const State& state) {
    found.push_back(reduced_volume(on.space.area(state.x), on.space.volume(state.x)));
  });
  EXPECT_NEAR(found[10], (begin + last) / 2, 1e-12);
  EXPECT_NEAR(found[20], last, 1e-12);
  EXPECT_NEAR(found[22], last, 1e-12);
}

TEST(Helfrich, ASphereIsStationaryWithItsMultiplier) {
  // V = 0 with |A|² = 2, H = 2: lambda = 2 (2 - H_0) - (2 - H_0)² for the volume, half of it for the area.
  Mesh mesh = sphere_mesh(1, 2, 1);
  const SurfaceSpace space(mesh);
  const double H_0 = 0.5, expected = 2 * (2 - H_0) - (2 - H_0) * (2 - H_0);
  for (Multipliers::Quantity quantity : {Multipliers::area, Multipliers::volume}) {
    Variant variant;
    variant.law = helfrich_law(H_0);
    (quantity == Multipliers::area ? variant.prescribed.area : variant.prescribed.volume) =
        constant_target(quantity == Multipliers::area ? space.area(mesh.nodes) : space.volume(mesh.nodes));
    const WillmoreStart start =
        willmore_start_on(space, sphere(1), mesh.nodes, variant.law, true, variant.prescribed);
    const double lambda = quantity == Multipliers::area ? expected / 2 : expected;
    EXPECT_NEAR(start.state.lambda(0, quantity), lambda, 1e-10);
    WillmoreFlow flow(space, variant, start.theta);
    const State end = last_state(flow, {1, 0.01, 20, {}}, start.state);
    EXPECT_NEAR(end.lambda(0, quantity), lambda, 1e-8);
    EXPECT_LT((end.x - mesh.nodes).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Helfrich, TheCliffordTorusIsStationaryWithSpontaneousCurvature) {
  // |A|² = H² - 2 K, and K = H/r - 1/r² with the minor radius r, so what H_0 adds to Q is 2 H_0 K - H_0² H/2
  // = lambda_A H + lambda_V.
  const double r = std::sqrt(0.5), H_0 = 1;
  const Surface surface = torus(1, r);
  const Mesh mesh = torus_mesh(1, r, 2, 16, 12);
  const SurfaceSpace space(mesh);
  Variant variant;
  variant.law = helfrich_law(H_0);
  variant.projection = Variant::none;
  variant.prescribed = {constant_target(space.area(mesh.nodes)), constant_target(space.volume(mesh.nodes))};
  const auto start = [&](const WillmoreLaw& law) {
    return willmore_start_on(space, surface, mesh.nodes, law, true, variant.prescribed);
  };
  const WillmoreStart right = start(variant.law);
  EXPECT_LT(right.state.w.col(0).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_NEAR(right.state.lambda(0, Multipliers::area), 2 * H_0 / r - H_0 * H_0 / 2, 1e-9);
  EXPECT_NEAR(right.state.lambda(0, Multipliers::volume), -2 * H_0 / (r * r), 1e-9);
  const WillmoreStart wrong = start(
      [H_0](const WillmorePoint& at, Pack& Q) { Q = (at.H - H_0) * (at.A_squared - 0.5 * at.H * at.H); });
  EXPECT_GT(wrong.state.w.col(0).cwiseAbs().maxCoeff(), 0.1);
  // The errors of (3.5a) move the nodes.
  WillmoreFlow flow(space, variant, right.theta);
  const State end = last_state(flow, {1, 1e-3, 5, {}}, right.state);
  EXPECT_LT((end.x - mesh.nodes).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Helfrich, OnASphereAreaAndVolumeCannotBothBePrescribed) {
  const Mesh mesh = sphere_mesh(1, 2, 2);
  const SurfaceSpace space(mesh);
  const AreaAndVolume both = {constant_target(space.area(mesh.nodes)),
                              constant_target(space.volume(mesh.nodes))};
  const auto message = testing::ThrowsMessage<InputError>(testing::HasSubstr("prescribe one of them"));
  EXPECT_THAT([&] { willmore_start_on(space, sphere(1), mesh.nodes, willmore_law(), false, both); }, message);
  EXPECT_THAT([&] { discrete_willmore_start(space, mesh.nodes, willmore_law(), both); }, message);
}

/// dE/dt in a small step, and -int V², for a spontaneous curvature by a formula.
std::pair<double, double> dissipation(const OnEllipsoid& on, const std::string& text,
                                      const WillmoreLaw& law) {
  const Formula H_0(text, names_in_space_time({}), "H_0");
  const CompiledFormulas compiled({H_0});
  const double tau = 1e-6;
  double E = 0, rate = 0, square = 0;
  on.run(on.variant(law, {}), 1, tau, 1, [&](int, const State& state) {
    const double next =
        helfrich_energy(on.space, state.x, state.u.col(0), nodal_values(compiled, state.x, 0));
    rate = (next - E) / tau;
    E = next;
    SymmetricMatrix M = on.space.matrix(), A = on.space.matrix();
    on.space.assemble(state.x, M, A);
    square = M.energy(state.w.col(0));
  });
  return {rate, -square};
}

TEST(Helfrich, ASpontaneousCurvatureByAFormulaHasItsGradientFlow) {
  const OnEllipsoid on(3);
  const std::string text = "sin(3*x) + y";
  const Formula H_0(text, names_in_space_time({}), "H_0");
  const auto [rate, expected] = dissipation(on, text, helfrich_law(H_0));
  EXPECT_NEAR(rate, expected, 0.02 * std::abs(expected));
  // As if H_0 were constant in each point.
  const CompiledFormulas compiled({H_0});
  const auto without_gradients = [compiled](const WillmorePoint& at, Pack& Q) {
    const Pack in[] = {at.x[0], at.x[1], at.x[2], pack(at.t)};
    Pack value;
    compiled.evaluate(in, &value);
    Q = (at.H - value) * (at.A_squared - 0.5 * at.H * (at.H - value));
  };
  const auto [wrong, other] = dissipation(on, text, without_gradients);
  EXPECT_GT(std::abs(wrong - other), 0.1 * std::abs(other));
  // A number is a formula, too.
  const Reference reference(1);
  EXPECT_LT(error_of_V(reference, helfrich_law(Formula("1/2", names_in_space_time({}), "H_0"))), 1e-11);
}

}  // namespace
}  // namespace esfem::test_helfrich
