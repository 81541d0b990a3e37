// SPDX-License-Identifier: GPL-3.0-or-later
// evolve with formulas: level sets, initial values, kinetics, velocities and exact solutions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "experiments/evolve/config.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/constants.hpp"
#include "solver/problems/evolving_ellipsoid.hpp"
#include "solver/problems/growing_sphere.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_formulas {
namespace {

using nlohmann::json;
using testing::AllOf, testing::HasSubstr;

class EvolveFormulas : public EvolveProgram {
 protected:
  json on_the_sphere(const json& changes) const {
    json result = config({{"flow", "coupled_diffusion"}, {"problem", "kinetics"}});
    result.merge_patch(changes);
    return result;
  }
};

Field fields_of(const json& nodal, const std::vector<std::string>& names) {
  Field result(nodal.at("x").size(), 0);
  for (const std::string& name : names)
    for (int l = 0, components = int(nodal.at(name)[0].size()); l < components; ++l) {
      result.conservativeResize(Eigen::NoChange, result.cols() + 1);
      for (int j = 0; j < result.rows(); ++j) {
        const json& row = nodal.at(name)[j];
        result(j, result.cols() - 1) = row.is_array() ? row[l] : row;
      }
    }
  return result;
}

/// The mesh {"subdivisions": n} of the unit sphere, of degree 2.
struct SphereMesh {
  explicit SphereMesh(int subdivisions)
      : mesh(lagrange_mesh(icosphere(1, subdivisions), 2)),
        x((project_nodes(mesh, sphere(1)), mesh.nodes)),
        space(mesh) {}
  Mesh mesh;
  Field x;
  SurfaceSpace space;
};

/// All norms of a built-in solution, at one time, are the last ones of a series.
void expect_same_errors(const ErrorRecorder& expected, const json& series, int count) {
  int compared = 0;
  for (const auto& [name, values] : expected.series()) {
    if (name == "t") continue;
    ASSERT_TRUE(series.contains(name)) << name;
    EXPECT_NEAR(series.at(name).back().get<double>(), values.back(), 1e-10) << name;
    EXPECT_GT(values.back(), 1e-6) << name;
    ++compared;
  }
  EXPECT_EQ(compared, count);
}

const json dumbbell_formula = {{"level_set", "x^2+y^2+2*z^2*(z^2-199/200)-0.04"},
                               {"box", {{-1, -1, -1.2}, {1, 1, 1.2}}}};

TEST_F(EvolveFormulas, ADumbbellByFormulaIsTheNamedOne) {
  const json mesh = {{"file", ESFEM_SOURCE_DIR "/reference/independent/dumbbell_450.msh"}};
  json named = config({{"degree", 2}, {"tau", 1e-4}, {"start", "substeps:4"}});
  named["mesh"] = mesh;
  json formula = named;
  named["surface"] = {{"name", "dumbbell"}};
  formula["surface"] = dumbbell_formula;
  for (const char* flow : {"mean_curvature", "willmore"}) {
    named["flow"] = formula["flow"] = flow;
    if (flow == std::string("willmore")) named["tau"] = formula["tau"] = 1e-8;
    const json expected = end_of(named), found = end_of(formula);
    for (const char* field : {"x", "nu"})
      EXPECT_LT(largest_difference(found.at(field), expected.at(field)), 1e-12) << flow << ", " << field;
    EXPECT_LT(largest_difference(found.at("H"), expected.at("H")), 1e-11) << flow;
  }
}

TEST_F(EvolveFormulas, RunsTwiceAlikeToTheBit) {
  json configuration = config({{"mesh", {{"edge_length", 0.1}}}, {"steps", 2}, {"tau", 1e-4}});
  configuration["surface"] = dumbbell_formula;
  configuration["mesh"] = {{"edge_length", 0.1}};
  const json first = end_of(configuration), second = end_of(configuration);
  EXPECT_EQ(first.at("x"), second.at("x"));
  EXPECT_EQ(first.at("H"), second.at("H"));
}

TEST_F(EvolveFormulas, MeshesAreGradedByCurvature) {
  json configuration = config({{"steps", 0}});
  configuration["surface"] = {{"name", "dumbbell"}};
  configuration["mesh"] = {{"edge_length", 0.2}};
  EXPECT_THAT(refusal(configuration), HasSubstr("graded by curvature (\"grading\")"));
  configuration["mesh"]["grading"] = 0.5;
  EXPECT_GT(series_of(configuration).at("worst_angle")[0], 20);
  configuration["mesh"]["grading"] = 2;
  EXPECT_THAT(refusal(configuration), HasSubstr("grading 2, expected a number greater than 0 and at most 1"));
}

TEST_F(EvolveFormulas, HeatOnTheSphereConverges) {
  double errors[2];
  for (int level : {1, 2}) {
    const json series = series_of(on_the_sphere({{"mesh", {{"subdivisions", level}}},
                                                 {"bdf", 4},
                                                 {"tau", 0.005},
                                                 {"steps", 40},
                                                 {"kinetics", {{"f", {"0"}}, {"diffusion", {1}}}},
                                                 {"initial", {{"u", "x*y"}}},
                                                 {"exact", {{"u", "x*y*exp(-6*t)"}}}}));
    errors[level - 1] = series.at("u_nodal_L2").back();
    EXPECT_EQ(series.at("u_nodal_H1").size(), 41u);
  }
  EXPECT_LT(errors[0], 2e-3);
  EXPECT_GT(errors[0] / errors[1], 8);
  // Broken: another rate of decay.
  const json series = series_of(on_the_sphere({{"kinetics", {{"f", {"-0.1*u"}}, {"diffusion", {1}}}},
                                               {"steps", 20},
                                               {"initial", {{"u", "x*y"}}},
                                               {"exact", {{"u", "x*y*exp(-6*t)"}}}}));
  EXPECT_GT(series.at("u_nodal_L2").back(), 3e-3);
}

TEST_F(EvolveFormulas, ASpeciesThatDoesNotDiffuseReactsOnly) {
  const auto last_error = [&](const json& diffusion) {
    return series_of(on_the_sphere({{"kinetics", {{"f", {"-6*u"}}, {"diffusion", diffusion}}},
                                    {"tau", 0.005},
                                    {"steps", 40},
                                    {"initial", {{"u", "x*y"}}},
                                    {"exact", {{"u", "x*y*exp(-6*t)"}}}}))
        .at("u_nodal_L2")
        .back()
        .get<double>();
  };
  EXPECT_LT(last_error({0}), 2e-3);
  EXPECT_GT(last_error({1}), 2e-2);  // broken: it diffuses, too
}

TEST_F(EvolveFormulas, TheManufacturedSolutionOfNick18IsTheBuiltInOne) {
  // f and G of solver/problems/growing_sphere.hpp, r = 1 + sin(pi t)/2, a = exp(-t²), D = alpha = beta = 1.
  const std::string r = "(1+sin(pi*t)/2)", dr = "(pi*cos(pi*t)/2)";
  const std::string f = "(5*" + dr + "/" + r + "-2*t+12/" + r + "^2)*u";
  const std::string g = dr + "+2*" + dr + "/" + r + "^2+2/" + r + "+(u-exp(-t^2)*x*y*z)";
  const json common = {
      {"mesh", {{"subdivisions", 2}}}, {"bdf", 3}, {"tau", 0.01}, {"steps", 20}, {"start", "substeps:4"}};
  json built_in = common, formula = common;
  built_in.update({{"problem", "growing_sphere"}});
  formula.update({{"kinetics", {{"f", {f}}, {"diffusion", {1}}, {"g", g}}},
                  {"parameters", {{"alpha", 1}, {"beta", 1}}},
                  {"initial", {{"u", "x*y*z"}}},
                  {"exact",
                   {{"x", {"x*" + r, "y*" + r, "z*" + r}},
                    {"v", {"x*" + dr + "/" + r, "y*" + dr + "/" + r, "z*" + dr + "/" + r}},
                    {"u", "exp(-t^2)*x*y*z"},
                    {"level_set", "x^2+y^2+z^2-" + r + "^2"}}}});
  json expected_run = on_the_sphere(built_in);
  const json expected = end_of(expected_run), found = end_of(on_the_sphere(formula));
  for (const char* field : {"x", "u"})
    EXPECT_LT(largest_difference(found.at(field), expected.at(field)), 1e-10) << field;
  const SphereMesh mesh(2);
  const ExactEvolution exact = growing_sphere();
  ErrorRecorder errors(mesh.space, exact, mesh.x);
  errors.record(0.2, fields_of(found, {"x", "v", "u"}));
  expect_same_errors(errors, read_json(series), 18);
}

TEST_F(EvolveFormulas, TheManufacturedSolutionOfBk22IsTheBuiltInOne) {
  // bk22 §9 as it is defined: u on the ellipsoid d = 0, w from the second equation, b from the first one,
  // where Delta_Gamma f = Delta f - n . (Hess f) n - H n . grad f, n = grad d/sqrt(s).
  const json definitions = {
      {"a", "1+sin(2*pi*t)/4"},
      {"d", "x^2/a+y^2+z^2-1"},
      {"dx", "diff(d, x)"},
      {"dy", "diff(d, y)"},
      {"dz", "diff(d, z)"},
      {"s", "dx^2+dy^2+dz^2"},
      {"H", "(2/a+4-(2/a*dx^2+2*dy^2+2*dz^2)/s)/sqrt(s)"},
      {"V", "-diff(d, t)/sqrt(s)"},
      {"E", "exp(-6*t)"},
      {"solution", "E*x*y"},
      {"Lu", "-2*dx*dy*E/s-H*(dx*y+dy*x)*E/sqrt(s)"},
      {"potential", "-epsilon*Lu+(solution^3-solution)/epsilon"},
      {"wx", "diff(potential, x)"},
      {"wy", "diff(potential, y)"},
      {"wz", "diff(potential, z)"},
      {"wnn",
       "(dx^2*diff(wx, x)+dy^2*diff(wy, y)+dz^2*diff(wz, z)+2*dx*dy*diff(wx, y)+2*dx*dz*diff(wx, z)"
       "+2*dy*dz*diff(wy, z))/s"},
      {"Lw", "diff(wx, x)+diff(wy, y)+diff(wz, z)-wnn-H*(dx*wx+dy*wy+dz*wz)/sqrt(s)"},
      {"dissolved", "diff(solution, t)+V*(dx*diff(solution, x)+dy*diff(solution, y))/sqrt(s)+solution*V*H"}};
  const json common = {{"flow", "cahn_hilliard"}, {"bdf", 3}, {"tau", 0.005}, {"steps", 20}};
  json built_in = config(common), formula = config(common);
  built_in["problem"] = "ellipsoid";
  formula.update({{"problem", "mixture"},
                  {"definitions", definitions},
                  {"velocity", {{"level_set", "d"}}},
                  {"source", "dissolved-Lw"},
                  {"initial", {{"u", "x*y"}, {"w", "6*epsilon*x*y+((x*y)^3-x*y)/epsilon"}}},
                  {"exact", {{"u", "solution"}, {"w", "potential"}}}});
  const json expected = end_of(built_in);
  const json found = end_of(formula);
  for (const char* field : {"x", "u", "w"})
    EXPECT_LT(largest_difference(found.at(field), expected.at(field)), 1e-10) << field;
  const json errors = read_json(series);
  EXPECT_LT(errors.at("u_nodal_L2").back(), 0.02);
  const SphereMesh mesh(1);
  const ManufacturedCahnHilliard manufactured(EvolvingEllipsoid(), 0.5);
  MovingNodes nodes(EvolvingEllipsoid().velocity(), mesh.x, 0.005);
  const ExactEvolution exact = exact_evolution(manufactured, nodes);
  ErrorRecorder recorder(mesh.space, exact, mesh.x);
  recorder.record(0.1, fields_of(found, {"u", "w"}));
  expect_same_errors(recorder, errors, 12);
  // GiNaC orders terms and signs by addresses, which are others in each process.
  for (int repetition = 0; repetition < 3; ++repetition) EXPECT_EQ(end_of(formula).at("w"), found.at("w"));
}

TEST_F(EvolveFormulas, AMixtureByFormulasSeparatesAsTheBuiltInOne) {
  // Near equilibrium the linear scheme and the implicit one agree up to the error in time.
  json built_in = config({{"flow", "cahn_hilliard"},
                          {"problem", "phase_separation"},
                          {"bdf", 2},
                          {"tau", 1e-4},
                          {"steps", 20},
                          {"parameters", {{"epsilon", 0.5}}},
                          {"initial", {{"u", "0.3*tanh(z)+0.1*x*y"}}}});
  json formula = built_in;
  formula["problem"] = "mixture";
  formula["potential"] = "(1-u^2)^2/4";
  const json expected = series_of(built_in), found = series_of(formula);
  EXPECT_NEAR(found.at("energy").back().get<double>(), expected.at("energy").back().get<double>(), 1e-6);
  EXPECT_NEAR(found.at("energy")[0].get<double>(), expected.at("energy")[0].get<double>(), 1e-12);
  EXPECT_GT(expected.at("energy")[0].get<double>() - expected.at("energy").back().get<double>(), 1e-4);
  EXPECT_NEAR(found.at("mass").back().get<double>(), found.at("mass")[0].get<double>(), 1e-12);
}

TEST_F(EvolveFormulas, NodesMayMoveAgainstTheMaterial) {
  // The nodes turn around the x axis, the material rests. Without a potential u_t = -epsilon Delta² u.
  const json turning = {"0", "-z", "y"};
  json configuration =
      config({{"flow", "cahn_hilliard"},
              {"problem", "mixture"},
              {"mesh", {{"subdivisions", 2}}},
              {"bdf", 3},
              {"steps", 20},
              {"potential", "0"},
              {"velocity", turning},
              {"tangential", turning},
              {"initial", {{"u", "y"}}},
              {"exact", {{"u", "y*exp(-4*epsilon*t)"}, {"w", "2*epsilon*y*exp(-4*epsilon*t)"}}}});
  EXPECT_LT(series_of(configuration).at("u_nodal_L2").back(), 1e-3);
  configuration.erase("tangential");
  EXPECT_GT(series_of(configuration).at("u_nodal_L2").back(), 0.1);
}

TEST_F(EvolveFormulas, TumourGrowthByFormulasIsTheBuiltInOne) {
  const json initial = {{"u1", "1+0.1*x*y"}, {"u2", "0.9+0.1*z"}};
  const json common = {{"initial", initial}, {"tau", 0.005}, {"steps", 20}};
  json built_in = common, formula = common;
  built_in.update({{"problem", "tumour_growth"}});
  formula.update(
      {{"kinetics",
        {{"f", {"gamma*(a-u1+u1^2*u2)", "gamma*(b-u1^2*u2)"}}, {"diffusion", {1, 10}}, {"g", "delta*u1"}}},
       {"parameters",
        {{"alpha", 1}, {"beta", 0.01}, {"gamma", 30}, {"a", 0.1}, {"b", 0.9}, {"delta", 0.4}}}});
  const json expected = end_of(on_the_sphere(built_in)), found = end_of(on_the_sphere(formula));
  for (const char* field : {"x", "u1", "u2"})
    EXPECT_LT(largest_difference(found.at(field), expected.at(field)), 1e-10) << field;
}

TEST_F(EvolveFormulas, SpeciesAreDilutedOnASurfaceWithAGivenVelocity) {
  // R = 1 + t: u R² is constant, for both ways to say it.
  for (const json& velocity : {json{"x/(1+t)", "y/(1+t)", "z/(1+t)"},
                               json{{"level_set", "x^2+y^2+z^2-(1+t)^2"}}, json{{"normal", "1"}}}) {
    const bool by_discrete_normals = velocity.contains("normal");
    const json series =
        series_of(on_the_sphere({{"velocity", velocity},
                                 {"bdf", 4},
                                 {"steps", 40},
                                 {"kinetics", {{"f", {"0"}}, {"diffusion", {1}}}},
                                 {"initial", {{"u", "1"}}},
                                 {"exact", {{"u", "1/(1+t)^2"}, {"v", {"x/(1+t)", "y/(1+t)", "z/(1+t)"}}}}}));
    EXPECT_LT(series.at("u_nodal_L2").back(), by_discrete_normals ? 1e-2 : 1e-6) << velocity;
    EXPECT_LT(series.at("v_nodal_L2").back(), by_discrete_normals ? 1e-2 : 1e-8) << velocity;
    EXPECT_NEAR(std::sqrt(series.at("area").back().get<double>() / series.at("area")[0].get<double>()), 1.4,
                by_discrete_normals ? 5e-3 : 1e-7);
  }
}

TEST_F(EvolveFormulas, AnyFlowIsComparedWithAnExactSolution) {
  const json series = series_of(config({{"exact", {{"H", "2/R"}, {"nu", {"x/R", "y/R", "z/R"}}}},
                                        {"definitions", {{"R", "sqrt(1-4*t)"}}},
                                        {"start", "exact"}}));
  EXPECT_LT(series.at("H_nodal_L2").back(), 5e-3);
  EXPECT_LT(series.at("nu_nodal_L2").back(), 5e-3);
  EXPECT_THAT(refusal(config({{"exact", {{"H", "2/"}}}})),
              HasSubstr("exact: H: \"2/\": column 3: found the end"));
  EXPECT_THAT(refusal(config({{"exact", "x"}})), HasSubstr("exact"));
}

TEST_F(EvolveFormulas, InitialValuesOfAMixture) {
  json configuration = config({{"flow", "cahn_hilliard"},
                               {"problem", "phase_separation"},
                               {"steps", 0},
                               {"parameters", {{"epsilon", 0.3}}},
                               {"initial", {{"u", "tanh(z/epsilon)"}}}});
  const json end = end_of(configuration);
  EXPECT_DOUBLE_EQ(end.at("u")[5].get<double>(), std::tanh(end.at("x")[5][2].get<double>() / 0.3));
  configuration["initial"] = {{"v", "x"}};
  EXPECT_THAT(refusal(configuration), HasSubstr("initial: found v; expected u"));
  configuration["initial"] = {{"u", "log(z)"}};
  EXPECT_THAT(refusal(configuration), AllOf(HasSubstr("initial: u: \"log(z)\" is"), HasSubstr("at x = ")));
}

TEST_F(EvolveFormulas, ErrorsNameTheFormulaAndThePlace) {
  const json good =
      on_the_sphere({{"kinetics", {{"f", {"1-u"}}, {"diffusion", {1}}}}, {"initial", {{"u", "1"}}}});
  const auto with = [&](const json& changes) {
    json result = good;
    result.merge_patch(changes);
    return result;
  };
  EXPECT_THAT(refusal(with({{"kinetics", {{"f", {"1-u+*x"}}}}})),
              HasSubstr("kinetics: f[0]: \"1-u+*x\": column 5: found \"*\""));
  EXPECT_THAT(refusal(with({{"kinetics", {{"f", {"1-w"}}}}})),
              HasSubstr("column 3: unknown name \"w\"; known: x, y, z, t, u, alpha, beta, pi"));
  EXPECT_THAT(refusal(with({{"kinetics", {{"f", {"1-u1", "u2"}}}}})),
              HasSubstr("found 2 formulas f and 1 diffusion coefficients"));
  EXPECT_THAT(refusal(with({{"kinetics", {{"diffusion", {-1}}}}})),
              HasSubstr("expected numbers that are not negative"));
  EXPECT_THAT(refusal(with({{"kinetics", {{"h", "1"}}}})), HasSubstr("kinetics"));
  EXPECT_THAT(refusal(with({{"kinetics", nullptr}})), HasSubstr("problem kinetics needs the key kinetics"));
  EXPECT_THAT(refusal(with({{"initial", nullptr}})), HasSubstr("u has no initial values"));
  EXPECT_THAT(refusal(with({{"velocity", {"x", "y"}}})),
              HasSubstr("velocity: found 2 components; expected 3"));
  EXPECT_THAT(refusal(with({{"velocity", {"x", "y", "z"}}, {"kinetics", {{"g", "u"}}}})),
              HasSubstr("expected one of them"));
  EXPECT_THAT(refusal(with({{"parameters", {{"k", "a"}}}})), HasSubstr("k"));
  EXPECT_THAT(refusal(with({{"parameters", {{"u", 1}}}})), HasSubstr("the name \"u\" is taken"));
  EXPECT_THAT(refusal(with({{"exact", {{"w", "1"}}}})),
              HasSubstr("exact: found w; expected level_set or one of x, v, u"));
  EXPECT_THAT(refusal(config({{"initial", {{"u", "1"}}}})),
              HasSubstr("flow mean_curvature takes no initial"));
  EXPECT_EQ(run(with({{"kinetics", {{"f", {"sqrt(0.03-t)"}}}}})), exit_numerics);
  EXPECT_THAT(message, AllOf(HasSubstr("kinetics: f[0]: \"sqrt(0.03-t)\" is nan at x = "),
                             HasSubstr("t = 0.0"), HasSubstr("u = ")));
}

TEST_F(EvolveFormulas, SurfacesOfGenusTwoAndThreeInOneTry) {
  std::ifstream file(ESFEM_SOURCE_DIR "/reference/examples/genus2.json");
  json configuration = json::parse(file);
  configuration["steps"] = 2;
  configuration["output"] = {{"nodal", nodal}, {"series", series}};
  const auto torus_at = [](const std::string& x) {
    return "exp(-8*((sqrt((x-" + x + ")^2+y^2)-0.7)^2+z^2))";
  };
  const json genus3 = {
      {"level_set", "-log(" + torus_at("1.8") + "+" + torus_at("0") + "+" + torus_at("(-1.8)") + ")/8-0.07"},
      {"box", {{-3, -1.2, -0.5}, {3, 1.2, 0.5}}}};
  for (int genus : {2, 3}) {
    if (genus == 3) configuration["surface"] = genus3;
    const json nodal_values = end_of(configuration), history = read_json(series);
    EXPECT_GT(history.at("worst_angle")[0], 20) << genus;
    std::set<std::pair<int, int>> edges;
    std::set<int> corners;
    for (const json& element : nodal_values.at("elements"))
      for (int i = 0; i < 3; ++i) {
        edges.insert(std::minmax(element[i].get<int>(), element[(i + 1) % 3].get<int>()));
        corners.insert(element[i].get<int>());
      }
    EXPECT_EQ(int(corners.size() - edges.size() + nodal_values.at("elements").size()), 2 - 2 * genus);
  }
}

}  // namespace
}  // namespace esfem::test_evolve_formulas
