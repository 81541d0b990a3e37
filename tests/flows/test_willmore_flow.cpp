// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "solver/error.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/flows/willmore_terms.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/read.hpp"
#include "solver/tables/table.hpp"
#include "tests/assembly/meshes.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem::test_willmore_flow {
namespace {

using Variant = WillmoreFlow::Variant;
using State = WillmoreFlow::State;

const std::string independent = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/";

Field field(const nlohmann::json& rows) {
  Field values(rows.size(), rows[0].size());
  for (size_t i = 0; i < rows.size(); ++i)
    for (size_t l = 0; l < rows[i].size(); ++l) values(i, l) = rows[i][l];
  return values;
}

/// The loads of the independent implementation for given u and w on an ellipsoid.
struct WillmoreAssembly : testing::Test {
  nlohmann::json json = read_json(independent + "willmore_assembly.json");
  Mesh mesh = read_mesh(independent + "ellipsoid_362.msh").mesh;
  SurfaceSpace space{mesh, conical_quadrature(8)};
  Field u = field(json["u"]), w = field(json["w"]), u_w;

  WillmoreAssembly() : u_w(u.rows(), 8) { u_w << u, w; }

  /// The load of one term, which term(point, w, value, flux) adds.
  template <class Term>
  Field load(const Term& term) const {
    const auto integrand = [&](const PointData<8>& p, Integrand<4, 4>& out) {
      out = {};
      term(willmore_point(p, willmore_law()), p.u + 4, out.value, out.flux);
    };
    Field result;
    space.assemble_load<8, 4, 4>(mesh.nodes, u_w, integrand, result);
    return result;
  }
  double deviation(const Field& load, const char* name) const {
    return (load - field(json["nq8"][name])).cwiseAbs().maxCoeff();
  }
};

TEST_F(WillmoreAssembly, FAgrees) {
  const auto F = [](const WillmorePoint& at, const Pack* w, Pack* value, Pack(*)[3]) { add_F(at, w, value); };
  EXPECT_LT(deviation(load(F), "F_w"), 1e-12);
}

TEST_F(WillmoreAssembly, fAgrees) {
  const auto f = [](const WillmorePoint& at, const Pack*, Pack* value, Pack(*flux)[3]) {
    add_f(at, value, flux);
  };
  EXPECT_LT(deviation(load(f), "f"), 1e-12);
}

TEST_F(WillmoreAssembly, gAgrees) {
  const auto g = [](const WillmorePoint& at, const Pack*, Pack* value, Pack(*)[3]) { add_g(at, value); };
  EXPECT_LT(deviation(load(g), "g"), 1e-12);
}

TEST_F(WillmoreAssembly, EachTermMatters) {
  const auto without_flux = [](const WillmorePoint& at, const Pack*, Pack* value, Pack(*)[3]) {
    Pack flux[4][3] = {};
    add_f(at, value, flux);
  };
  EXPECT_GT(deviation(load(without_flux), "f"), 1e-3);
  const auto without_Q = [](WillmorePoint at, const Pack*, Pack* value, Pack(*flux)[3]) {
    at.Q = Pack{};
    add_f(at, value, flux);
  };
  EXPECT_GT(deviation(load(without_Q), "f"), 1e-3);
}

/// A run of the independent implementation: its start and its end.
struct WillmoreRun {
  nlohmann::json json;
  Mesh mesh = read_mesh(independent + "ellipsoid_362.msh").mesh;
  SurfaceSpace space{mesh, conical_quadrature(4)};
  UniformSteps grid;

  explicit WillmoreRun(const std::string& name) : json(read_json(independent + name + ".json")) {
    grid = {json["q"], json["tau"], json["steps"], parse_start("cascade")};
  }
  State end(Variant variant) const {
    const WillmoreStart start =
        willmore_start_on(space, ellipsoid(1, 1, 0.6), mesh.nodes, variant.law, false);
    WillmoreFlow flow(space, variant, start.theta);
    return last_state(flow, grid, start.state);
  }
  double deviation(const State& state) const {
    return std::max({(state.x - field(json["x"])).cwiseAbs().maxCoeff(),
                     (state.u - field(json["u"])).cwiseAbs().maxCoeff(),
                     (state.w - field(json["w"])).cwiseAbs().maxCoeff()});
  }
};

TEST(WillmoreFlow, ExtrapolatedCouplingAgreesWithTheIndependentImplementation) {
  const WillmoreRun run("willmore_bdf1_extrapolated");
  Variant variant;
  variant.projection = Variant::none;
  EXPECT_LT(run.deviation(run.end(variant)), 1e-8);
  variant.projection = Variant::after_steps;
  EXPECT_GT(run.deviation(run.end(variant)), 1e-4);
}

TEST(WillmoreFlow, ImplicitCouplingWithProjectionAgreesWithTheIndependentImplementation) {
  const WillmoreRun run("willmore_bdf2_implicit_projected");
  Variant variant;
  variant.F = Variant::implicit;
  EXPECT_LT(run.deviation(run.end(variant)), 1e-8);
  variant.F = Variant::extrapolated;
  EXPECT_GT(run.deviation(run.end(variant)), 1e-4);
}

/// A sphere with exact initial data.
struct StationarySphere {
  double R;
  Mesh mesh;
  SurfaceSpace space;

  StationarySphere(double radius, int degree)
      : R(radius), mesh(lagrange_mesh(icosphere(radius, 1), degree)), space(projected(mesh, radius)) {}
  static const Mesh& projected(Mesh& mesh, double radius) {
    project_nodes(mesh, sphere(radius));
    return mesh;
  }

  /// How far from its start the run is at time T, in the largest nodal value.
  double moved(Variant variant, bool with_theta, int q, double T) const {
    const WillmoreStart start = willmore_start_on(space, sphere(R), mesh.nodes, variant.law, with_theta);
    WillmoreFlow flow(space, variant, start.theta);
    const auto at_rest = [&](double) { return start.state; };
    const State end =
        last_state(flow, {q, 0.05, static_cast<int>(std::lround(T / 0.05)), {}}, {start.state, at_rest});
    return std::max((end.x - start.state.x).cwiseAbs().maxCoeff(),
                    (end.u - start.state.u).cwiseAbs().maxCoeff());
  }
};

TEST(WillmoreFlow, TheSphereWithThetaIsStationary) {
  for (int degree : {2, 3, 4})
    for (int q : {1, 2, 3, 4, 5})
      EXPECT_LT(StationarySphere(1, degree).moved({}, true, q, 1), q <= 3 ? 1e-9 : 1e-7)
          << "P" << degree << " BDF" << q;
}

TEST(WillmoreFlow, ImplicitCouplingAndSurfaceDiffusionLeaveTheSphereToo) {
  const StationarySphere unit(1, 2);
  Variant variant;
  variant.F = Variant::implicit;
  EXPECT_LT(unit.moved(variant, true, 2, 1), 1e-9);
  variant.law = surface_diffusion_law();
  EXPECT_LT(unit.moved(variant, true, 2, 1), 1e-9);
}

TEST(WillmoreFlow, TheSphereWithoutThetaMoves) {
  EXPECT_GT(StationarySphere(1, 2).moved({}, false, 2, 0.2), 1e-5);
}

TEST(WillmoreFlow, WithoutProjectionRoundOffGrows) {
  Variant variant;
  variant.projection = Variant::none;
  const StationarySphere unit(1, 2);
  // exp(8 t) makes 1e-10 of round-off at t = 1 from 1e-13 of the start: still stationary to 1e-9, but not for
  // long.
  const double early = unit.moved(variant, true, 2, 1), late = unit.moved(variant, true, 2, 2);
  EXPECT_NEAR(std::log(late / early), 8, 1);
}

/// The torus with radii 1 and 0.5, pulled out of shape so that no symmetry is left, on its side.
struct BentTorus {
  template <class T>
  T operator()(const T& x1, const T& x2, const T& x3) const {
    const T a = 0.9 * x1 + 0.1 * x2 * x3, b = 1.1 * x2 + 0.15 * x1 * x1,
            c = x3 + 0.1 * x1 * x2 + 0.08 * x1 * x1;
    const T rho2 = a * a + b * b, s = rho2 + c * c + 0.75;
    return 0.25 * (s * s - 4.0 * rho2);
  }
};

/// Nodes, exact u and w, and smooth test functions phi on a torus without symmetry.
struct WeakIdentity {
  Surface surface = make_surface("bent torus", BentTorus(), 2, 0.2, 0);
  Mesh mesh;
  std::unique_ptr<SurfaceSpace> space;
  Field u_w;

  explicit WeakIdentity(double h) : mesh(lagrange_mesh(generate_mesh(surface, h), 2)) {
    project_nodes(mesh, surface);
    space = std::make_unique<SurfaceSpace>(mesh);
    const WillmoreStart start = willmore_start_on(*space, surface, mesh.nodes, willmore_law(), true);
    u_w.resize(space->dofs(), 8);
    u_w << start.state.u, start.state.w;
  }

  /// Test function: sines of linear functions, N x 4, for the rows H and nu.
  Field phi() const {
    const Field& x = mesh.nodes;
    Field values(x.rows(), 4);
    values << (x.col(0) + 0.3 * x.col(2)).array().sin(), (1.3 * x.col(1) - x.col(0)).array().cos(),
        (x.col(2) + 0.5 * x.col(1)).array().sin(), (x.col(0) + x.col(1) + x.col(2)).array().cos();
    return values;
  }

  /// The residual of (2.12c) with d nu = -grad V (2.7), tested with phi: A z + F z + f against the integral
  /// of V (div phi
  /// - H nu . phi), to which -grad V . phi integrates by parts. relative to the largest term.
  double residual(const std::function<void(WillmorePoint&)>& change) const {
    SymmetricMatrix M = space->matrix(), A = space->matrix();
    space->assemble(mesh.nodes, M, A);
    const auto right = [&](const PointData<8>& p, Integrand<4, 4>& out) {
      out = {};
      WillmorePoint at = willmore_point(p, willmore_law());
      change(at);
      add_f(at, out.value, out.flux);
      add_F(at, p.u + 4, out.value);
    };
    const auto left = [&](const PointData<8>& p, Integrand<4, 4>& out) {
      out = {};
      for (int l = 0; l < 3; ++l) {
        out.value[1 + l] = -p.u[4] * p.u[0] * p.u[1 + l];
        out.flux[1 + l][l] = p.u[4];
      }
    };
    Field f, rate;
    space->assemble_load<8, 4, 4>(mesh.nodes, u_w, right, f);
    space->assemble_load<8, 4, 4>(mesh.nodes, u_w, left, rate);
    const Field Aw = A * u_w.rightCols(4);
    const auto tested = [&](const Field& load) {
      return load.rightCols(3).cwiseProduct(phi().rightCols(3)).sum();
    };
    return std::abs(tested(rate) - tested(Aw) - tested(f)) / std::abs(tested(rate));
  }
};

TEST(WillmoreFlow, TheEquationsOfVAndZHoldOnATorusWithoutSymmetry) {
  // (2.12b) V = Delta H + Q and (2.12d) z = grad H = Delta nu + |A|² nu, (2.9), with exact H, nu, V and z.
  const auto residual = [](const WeakIdentity& on, bool with_g) {
    SymmetricMatrix M = on.space->matrix(), A = on.space->matrix();
    on.space->assemble(on.mesh.nodes, M, A);
    const auto g = [&](const PointData<8>& p, Integrand<4, 0>& out) {
      for (Pack& value : out.value) value = Pack{};
      if (with_g) add_g(willmore_point(p, willmore_law()), out.value);
    };
    Field load;
    on.space->assemble_load<8, 4, 0>(on.mesh.nodes, on.u_w, g, load);
    const Field Mw = M * on.u_w.rightCols(4), rest = Mw + A * on.u_w.leftCols(4) - load;
    return std::pair(std::abs(rest.col(0).dot(on.phi().col(0)) / Mw.col(0).dot(on.phi().col(0))),
                     std::abs(rest.rightCols(3).cwiseProduct(on.phi().rightCols(3)).sum() /
                              Mw.rightCols(3).cwiseProduct(on.phi().rightCols(3)).sum()));
  };
  const WeakIdentity coarse(0.2), fine(0.13);
  EXPECT_LT(residual(fine, true).first, 0.5 * residual(coarse, true).first);
  EXPECT_LT(residual(fine, true).second, 0.5 * residual(coarse, true).second);
  EXPECT_LT(residual(fine, true).first, 0.02);
  EXPECT_LT(residual(fine, true).second, 0.02);
  EXPECT_GT(residual(fine, false).first, 0.1) << "without Q";
  EXPECT_GT(residual(fine, false).second, 0.1) << "without |A|² nu";
}

TEST(WillmoreFlow, TheEquationOfTheNormalHoldsOnATorusWithoutSymmetry) {
  const WeakIdentity coarse(0.2), fine(0.13);
  const auto nothing = [](WillmorePoint&) {};
  EXPECT_LT(fine.residual(nothing), 1e-2);
  EXPECT_LT(fine.residual(nothing), 0.5 * coarse.residual(nothing));
  const std::vector<std::pair<const char*, std::function<void(WillmorePoint&)>>> wrong = {
      {"Q", [](WillmorePoint& at) { at.Q = Pack{}; }},
      {"grad H",
       [](WillmorePoint& at) {
         for (Pack& component : at.grad_H) component = Pack{};
       }},
      {"A grad H",
       [](WillmorePoint& at) {
         for (Pack& component : at.A_grad_H) component = Pack{};
       }},
      {"H", [](WillmorePoint& at) { at.H = Pack{}; }},
  };
  for (const auto& [term, change] : wrong)
    EXPECT_GT(fine.residual(change), 10 * fine.residual(nothing)) << "without " << term;
}

TEST(WillmoreFlow, RelaxationBringsTheCurvatureBackToTheSurface) {
  // H_h - 2/R is conserved on a sphere: without relaxation 0.02 too much of it stays.
  const StationarySphere unit(1, 2);
  const auto final_H = [&](double lambda) {
    WillmoreStart start = willmore_start_on(unit.space, sphere(1), unit.mesh.nodes, willmore_law(), false);
    start.state.u.col(0).array() += 0.02;
    Variant variant;
    variant.relaxation = lambda;
    WillmoreFlow flow(unit.space, variant);
    return last_state(flow, {1, 0.005, 40, {}}, start.state).u.col(0).mean();
  };
  EXPECT_GT(final_H(0), 2.015);
  EXPECT_NEAR(final_H(100), 2, 3e-3);
}

TEST(WillmoreFlow, SurfaceDiffusionKeepsTheVolumeAndShrinksTheArea) {
  const Surface surface = ellipsoid(1, 1, 0.6);
  Mesh mesh = ellipsoid_mesh({1, 1, 0.6}, 2, 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  const auto changes = [&](const WillmoreLaw& law) {
    Variant variant;
    variant.law = law;
    const WillmoreStart start = willmore_start_on(space, surface, mesh.nodes, law, true);
    WillmoreFlow flow(space, variant, start.theta);
    const State end = last_state(flow, {2, 1e-4, 100, parse_start("cascade")}, start.state);
    return std::pair(space.volume(end.x) / space.volume(mesh.nodes) - 1,
                     space.area(end.x) / space.area(mesh.nodes) - 1);
  };
  const auto [volume, area] = changes(surface_diffusion_law());
  EXPECT_NEAR(volume, 0, 2e-4);
  EXPECT_LT(area, -0.01);
  EXPECT_GT(std::abs(changes(willmore_law()).first), 2e-3) << "Willmore flow does not keep it";
}

/// The flow without memory: every step factorises.
struct DirectWillmoreFlow {
  using State = WillmoreFlow::State;
  WillmoreFlow flow;
  nlohmann::json nothing = flow.progress();

  void step(const BdfStep<State>& step, State& next) {
    flow.resume(nothing);
    flow.step(step, next);
  }
};

TEST(WillmoreFlow, OneFactorisationServesManyStepsWithTheSameResult) {
  const Surface surface = ellipsoid(1, 1, 0.9);
  Mesh mesh = ellipsoid_mesh({1, 1, 0.9}, 2, 2);
  project_nodes(mesh, surface);
  const SurfaceSpace space(mesh);
  const UniformSteps grid = {2, 5e-4, 100, parse_start("cascade")};
  for (const WillmoreLaw& law : {willmore_law(), surface_diffusion_law()}) {
    Variant variant;
    variant.law = law;
    WillmoreFlow flow(space, variant);
    DirectWillmoreFlow direct{{space, variant}};
    const State start = willmore_start_on(space, surface, mesh.nodes, law, false).state;
    const State found = last_state(flow, grid, start), expected = last_state(direct, grid, start);
    EXPECT_LT(flow.factorisations(), grid.steps / 2);
    EXPECT_GT(flow.factorisations(), 2) << "the surface moves";
    EXPECT_EQ(direct.flow.factorisations(), grid.steps);
    for (const auto& field : State::fields) {
      const Field &some = found.*field.member, &other = expected.*field.member;
      EXPECT_LE((some - other).norm(), 1e-11 * other.norm()) << field.name;
    }
  }
}

TEST(WillmoreFlow, SaysWhatItDoesNotTake) {
  const StationarySphere unit(1, 2);
  Variant variant;
  variant.relaxation = -1;
  EXPECT_THAT([&] { WillmoreFlow(unit.space, variant); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("found -1")));
}

}  // namespace
}  // namespace esfem::test_willmore_flow
