// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/analysis/table.hpp"
#include "solver/flows/willmore_flow.hpp"
#include "solver/flows/willmore_terms.hpp"
#include "solver/mesh/read.hpp"
#include "tests/flows/reference_case.hpp"

namespace esfem {
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
      term(willmore_point(p, false), p.u + 4, out.value, out.flux);
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
  TimeGrid grid;

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
  variant.project = false;
  EXPECT_LT(run.deviation(run.end(variant)), 1e-8);
  variant.project = true;
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

}  // namespace
}  // namespace esfem
