// SPDX-License-Identifier: GPL-3.0-or-later
// evolve with formulas for the mobility, for the law of the velocity, starts from files, and ends by energy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/evolve/config.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_own_problems {
namespace {

using nlohmann::json;
using testing::AllOf, testing::HasSubstr, testing::Not;

class OwnProblems : public EvolveProgram {
 protected:
  json with(const json& changes, const json& more = json::object()) const {
    json result = config(changes);
    result.merge_patch(more);
    return result;
  }
};

/// A mixture with the mobility 1 + u²/2 + z²/5 on a sphere of radius R = 1 + t/4, whose solution is s = a
/// z/R, a = 1 + sin(4t)/2. On functions of z/R: w = c~(s), grad w = c grad s, and with F = m c a the first
/// equation is
///   d•s + s div v - (R F' (1 - z²/R²)/R² - 2 F z/R³) = b.
json mixture_with_mobility() {
  return {{"flow", "cahn_hilliard"},
          {"problem", "mixture"},
          {"degree", 2},
          {"tau", 0.01},
          {"steps", 20},
          {"definitions",
           {{"R", "1+t/4"},
            {"a", "1+sin(4*t)/2"},
            {"s", "a*z/R"},
            {"c", "2*epsilon/R^2+(3*s^2-1)/epsilon"},
            {"F", "(1+s^2/2+z^2/5)*c*a"},
            {"dissolved", "(2*cos(4*t)+2*a/(4+t))*z/R"}}},
          {"velocity", {"x/(4+t)", "y/(4+t)", "z/(4+t)"}},
          {"mobility", "1+u^2/2+z^2/5"},
          {"source", "dissolved-R*diff(F,z)*(1-z^2/R^2)/R^2+2*F*z/R^3"},
          {"initial", {{"u", "z"}, {"w", "2*epsilon*z+(z^3-z)/epsilon"}}},
          {"exact", {{"u", "s"}, {"w", "2*epsilon*s/R^2+(s^3-s)/epsilon"}}}};
}

TEST_F(OwnProblems, AMixtureWithAMobilityConvergesToAManufacturedSolution) {
  json problem = mixture_with_mobility();
  problem["bdf"] = 3;
  double errors[2];
  for (int level : {1, 2}) {
    problem["mesh"] = {{"subdivisions", level}};
    errors[level - 1] = series_of(config(problem)).at("u_nodal_L2").back();
  }
  EXPECT_LT(errors[1], 2e-3);
  EXPECT_GT(errors[0] / errors[1], 6);
  problem.erase("mobility");  // broken
  EXPECT_GT(series_of(config(problem)).at("u_nodal_L2").back(), 0.1);
}

TEST_F(OwnProblems, TheMobilityKeepsTheOrderInTime) {
  // Without a potential, whose explicit part bounds the steps. Differences of runs on one mesh: its own error
  // drops out.
  json problem = mixture_with_mobility();
  problem.erase("exact");
  problem["potential"] = "0";
  problem["definitions"]["c"] = "2*epsilon/R^2";
  problem["initial"] = {{"u", "z"}};
  for (int order : {1, 2, 3}) {
    json u[3];
    for (int k : {0, 1, 2}) {
      const int steps = 20 << k;
      u[k] = end_of(with(problem, {{"bdf", order}, {"tau", 0.2 / steps}, {"steps", steps}})).at("u");
    }
    const double rate = std::log2(largest_difference(u[0], u[1]) / largest_difference(u[1], u[2]));
    EXPECT_GT(rate, order - 0.15) << order;
  }
}

TEST_F(OwnProblems, AConstantMobilityChangesNoBit) {
  json problem = mixture_with_mobility();
  problem.erase("mobility");
  const json expected = end_of(config(problem));
  problem["mobility"] = "1";
  const json same = end_of(config(problem));
  problem["mobility"] = "max(1, u-100)";  // by the solver for variable ones
  const json alike = end_of(config(problem));
  for (const char* field : {"u", "w"}) {
    EXPECT_EQ(same.at(field), expected.at(field));
    EXPECT_LT(largest_difference(alike.at(field), expected.at(field)), 1e-11) << field;
  }
  problem["mobility"] = "1+t";
  const json in_time = end_of(config(problem));
  EXPECT_GT(largest_difference(in_time.at("u"), expected.at("u")), 1e-3);
  problem["mobility"] = "max(1+t, u-100)";
  EXPECT_LT(largest_difference(end_of(config(problem)).at("u"), in_time.at("u")), 1e-11);
}

TEST_F(OwnProblems, AMobilityMayVanishButNotBeNegative) {
  json problem = with({{"flow", "cahn_hilliard"},
                       {"problem", "mixture"},
                       {"parameters", {{"epsilon", 0.3}}},
                       {"initial", {{"u", "1.5*tanh(3*z)"}}},
                       {"mobility", "max(1-u^2, 0)"},
                       {"tau", 1e-3},
                       {"steps", 40}});
  const json record = series_of(problem);
  EXPECT_NEAR(record.at("mass").back().get<double>(), record.at("mass")[0].get<double>(), 1e-12);
  EXPECT_LT(record.at("energy").back(), record.at("energy")[0]);
  problem["mobility"] = "1-u^2";
  EXPECT_EQ(run(problem), exit_numerics);
  EXPECT_THAT(message,
              AllOf(HasSubstr("mobility: \"1-u^2\" is -"), HasSubstr("z = "), HasSubstr("max(.., 0)")));
  problem["mobility"] = "t-1";
  EXPECT_EQ(run(problem), exit_numerics);
  EXPECT_THAT(message, HasSubstr("expected a positive mobility"));
  EXPECT_THAT(refusal(with({{"flow", "cahn_hilliard"}, {"mobility", "1"}})), HasSubstr("takes no mobility"));
}

/// nick18 7.3: r = 1 + sin(pi t)/2, u = exp(-t²) x y z, with a term `more` in g.
json growing_sphere(const std::string& alpha, const std::string& beta, const std::string& more) {
  return {{"flow", "coupled_diffusion"},
          {"problem", "kinetics"},
          {"mesh", {{"subdivisions", 2}}},
          {"bdf", 3},
          {"tau", 0.01},
          {"steps", 20},
          {"start", "substeps:4"},
          {"definitions", {{"r", "1+sin(pi*t)/2"}, {"dr", "diff(r, t)"}, {"s", "exp(-t^2)*x*y*z"}}},
          {"kinetics",
           {{"f", {"(5*dr/r-2*t+12/r^2)*u"}},
            {"diffusion", {1}},
            {"g", "dr+2*(" + alpha + ")*dr/r^2+2*(" + beta + ")/r+(u-s)" + more}}},
          {"parameters", {{"alpha", 1}, {"beta", 1}}},
          {"initial", {{"u", "x*y*z"}}},
          {"exact", {{"u", "s"}, {"x", {"x*r", "y*r", "z*r"}}, {"level_set", "x^2+y^2+z^2-r^2"}}}};
}

TEST_F(OwnProblems, AlphaAndBetaMayBeFormulas) {
  const json numbers = end_of(config(growing_sphere("1", "1", "")));
  json same = growing_sphere("1", "1", "");
  same["kinetics"]["alpha"] = "alpha";
  same["kinetics"]["beta"] = "max(beta, u-100)";
  const json alike = end_of(config(same));
  for (const char* field : {"x", "u", "v"})
    EXPECT_LT(largest_difference(alike.at(field), numbers.at(field)), 1e-11) << field;

  // alpha(t): on a sphere that grows only one that is constant on it has a normal force.
  const std::string alpha = "1+t", beta = "1+z^2+x/2";
  double errors[2];
  for (int level : {1, 2}) {
    json problem = growing_sphere(alpha, beta, "");
    problem["mesh"] = {{"subdivisions", level}};
    problem["kinetics"]["alpha"] = alpha;
    problem["kinetics"]["beta"] = beta;
    errors[level - 1] = series_of(config(problem)).at("x_nodal_L2").back();
  }
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_GT(errors[0] / errors[1], 5);
  json broken = growing_sphere(alpha, beta, "");
  broken["kinetics"]["alpha"] = alpha;
  EXPECT_GT(series_of(config(broken)).at("x_nodal_L2").back(), 1e-2);
}

TEST_F(OwnProblems, TheLawRefusesWhatHasNoMeaning) {
  json problem = growing_sphere("1", "1", "");
  problem["kinetics"]["alpha"] = "0.01-t";
  EXPECT_EQ(run(config(problem)), exit_numerics);
  EXPECT_THAT(message, AllOf(HasSubstr("alpha is "), HasSubstr("expected a positive number")));
  problem["kinetics"]["alpha"] = "H";
  EXPECT_THAT(refusal(config(problem)), HasSubstr("unknown name \"H\""));
  problem["kinetics"] = {{"f", {"0"}}, {"diffusion", {1}}, {"alpha", "1"}};
  EXPECT_THAT(refusal(config(problem)), HasSubstr("found alpha, of the law of a surface that g drives"));
  problem["kinetics"] = {{"f", {"0"}}, {"diffusion", {1}}, {"g", "1"}, {"beta", "1"}};
  problem["variant"] = {{"law", "dynamic"}};
  EXPECT_THAT(refusal(config(problem)), HasSubstr("found beta, which the dynamic law has not"));
}

TEST_F(OwnProblems, TheVelocityMayDependOnTheMeanCurvature) {
  double errors[2];
  for (int level : {1, 2}) {
    json problem = growing_sphere("1", "1", "-0.5*(H-2/r)");
    problem["mesh"] = {{"subdivisions", level}};
    errors[level - 1] = series_of(config(problem)).at("x_nodal_L2").back();
  }
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_GT(errors[0] / errors[1], 5);
  EXPECT_GT(series_of(config(growing_sphere("1", "1", "-0.5*H"))).at("x_nodal_L2").back(), 1e-2);
  // A name of the user's own stays what it is.
  json own = growing_sphere("1", "1", "-0.5*(H-2/r)");
  own["definitions"]["H"] = "2/r";
  EXPECT_LT(
      largest_difference(end_of(config(own)).at("x"), end_of(config(growing_sphere("1", "1", ""))).at("x")),
      1e-13);
}

TEST_F(OwnProblems, NormsAreLiftedWhereTheExactSurfaceIsKnown) {
  json heat = with({{"flow", "coupled_diffusion"},
                    {"problem", "kinetics"},
                    {"kinetics", {{"f", {"0"}}, {"diffusion", {1}}}},
                    {"initial", {{"u", "x*y"}}},
                    {"exact", {{"u", "x*y*exp(-6*t)"}}}});
  const json at_rest = series_of(heat);
  heat["exact"]["level_set"] = "x^2+y^2+z^2-1";
  const json given = series_of(heat);
  heat["exact"].erase("level_set");
  heat["velocity"] = {"0", "0", "0"};
  const json unknown = series_of(heat);
  EXPECT_FALSE(unknown.contains("u_lifted_L2"));
  for (const std::string norm : {"L2", "H1", "H1_semi"}) {
    const double lifted = at_rest.at("u_lifted_" + norm).back();
    EXPECT_NEAR(given.at("u_lifted_" + norm).back().get<double>(), lifted, 1e-12);
    EXPECT_NE(unknown.at("u_unlifted_" + norm).back(), lifted);
    EXPECT_NEAR(unknown.at("u_unlifted_" + norm).back().get<double>(), lifted, 0.3 * lifted) << norm;
  }
  EXPECT_THAT(refusal(with({{"exact", {{"x", {"x", "y"}}}}})),
              HasSubstr("exact: x: found 2 formulas; expected 3"));
}

TEST_F(OwnProblems, EndWhenTheEnergyHasComeToRest) {
  const json record = series_of(with({{"flow", "cahn_hilliard"},
                                      {"problem", "mixture"},
                                      {"initial", {{"u", "0.9+0.1*z"}}},
                                      {"tau", 0.01},
                                      {"steps", 500},
                                      {"stop", {{"energy_rate", 1e-3}}}}));
  EXPECT_THAT(record.at("status").get<std::string>(), HasSubstr("stationary: the energy changes by -"));
  const json &E = record.at("energy"), &t = record.at("t");
  const std::size_t n = E.size() - 1;
  EXPECT_LT(n, 400u);
  const auto rate = [&](std::size_t i) {
    return std::abs((E[i].get<double>() - E[i - 1].get<double>()) /
                    (t[i].get<double>() - t[i - 1].get<double>()));
  };
  EXPECT_LT(rate(n), 1e-3);
  EXPECT_GE(rate(n - 1), 1e-3);
  const json area = series_of(with({{"stop", {{"energy_rate", 1e3}}}}));
  EXPECT_THAT(area.at("status").get<std::string>(), HasSubstr("stationary: the area changes by -"));
  json driven = growing_sphere("1", "1", "");
  driven["stop"] = {{"energy_rate", 1}};
  EXPECT_THAT(refusal(config(driven)), HasSubstr("problem kinetics has no energy"));
}

TEST_F(OwnProblems, SpeciesOnASurfaceAtRestAreStationaryWhenTheyAre) {
  const json record = series_of(with({{"flow", "coupled_diffusion"},
                                      {"problem", "kinetics"},
                                      {"kinetics", {{"f", {"1-u1", "u1-u2"}}, {"diffusion", {1, 2}}}},
                                      {"initial", {{"u1", "0"}, {"u2", "1"}}},
                                      {"tau", 0.1},
                                      {"steps", 200},
                                      {"stop", {{"speed", 1e-3}}}}));
  EXPECT_THAT(record.at("status").get<std::string>(), HasSubstr("stationary: the largest |du/dt|"));
  EXPECT_GT(record.at("t").size(), 40u);
  EXPECT_LT(record.at("t").size(), 150u);
  const json mixture = series_of(with({{"flow", "cahn_hilliard"},
                                       {"problem", "mixture"},
                                       {"initial", {{"u", "1"}}},
                                       {"stop", {{"speed", 1e-6}}}}));
  EXPECT_EQ(mixture.at("t").size(), 2u);
}

TEST_F(OwnProblems, GoOnFromTheMiddleBitForBit) {
  const json moved = {{"velocity", {"x*cos(t)", "0", "-z*t"}}};
  const json kinetics = {{"flow", "coupled_diffusion"},
                         {"problem", "kinetics"},
                         {"kinetics", {{"f", {"u2-u1+t", "u1^2-u2"}}, {"diffusion", {1, 2}}}},
                         {"initial", {{"u1", "1+x*y"}, {"u2", "z^2"}}}};
  json mixture = mixture_with_mobility();
  mixture.erase("exact");
  mixture["variant"] = {{"theta", true}};
  mixture["initial"] = {{"u", "z"}, {"w", "x"}};  // theta is not small
  for (const json& problem : {with(kinetics), with(kinetics, moved),
                              with(growing_sphere("1", "1", "-0.5*(H-2/r)")), with(mixture)}) {
    json first = problem;
    first.erase("exact");
    first["start"] = "substeps:2";
    first["steps"] = 8;
    json whole = first, rest = first;
    whole["steps"] = 12;
    const std::string middle = (folder / "middle.json").string();
    first["output"]["nodal"] = middle;
    const json expected = end_of(whole);
    ASSERT_EQ(run(first), exit_done) << message;
    rest.erase("mesh");
    rest["initial"] = {{"file", middle}};
    rest["steps"] = 4;
    const json found = end_of(rest);
    EXPECT_THAT(message, HasSubstr("with the states before"));
    for (const char* field : {"x", "u", "u1", "u2", "w"})
      EXPECT_EQ(found.value(field, json()), expected.value(field, json())) << field;
    EXPECT_EQ(found.at("t"), expected.at("t"));
    if (!rest.contains("velocity")) continue;
    // Nodes that had another velocity are no history of these.
    rest["velocity"] = {"0", "0", "1"};
    rest.erase("surface");
    EXPECT_NEAR(end_of(rest).at("x")[3][2].get<double>(),
                read_json(middle).at("x")[3][2].get<double>() + 4 * problem.at("tau").get<double>(), 1e-12);
    EXPECT_THAT(message, HasSubstr("its history is of another \"velocity\""));
  }
}

TEST_F(OwnProblems, StartFromTheFieldsOfAFile) {
  const std::string file = (folder / "octahedron.ply").string();
  write_file(
      file,
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\nproperty double z\n"
      "property double u\nproperty double s\nelement face 8\nproperty list uchar int vertex_indices\n"
      "end_header\n1 0 0 1 7\n-1 0 0 2 7\n0 1 0 3 7\n0 -1 0 4 7\n0 0 1 5 7\n0 0 -1 6 7\n"
      "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n");
  json problem = {{"flow", "coupled_diffusion"},
                  {"problem", "kinetics"},
                  {"mesh", {{"file", file}}},
                  {"kinetics", {{"f", {"0"}}, {"diffusion", {1}}}},
                  {"tau", 0.01},
                  {"steps", 0},
                  {"output", {{"nodal", nodal}, {"series", series}}}};
  EXPECT_EQ(end_of(problem).at("u"), json({1, 2, 3, 4, 5, 6}));
  EXPECT_THAT(message, HasSubstr("u from the mesh file; s of the mesh file not used"));
  problem["kinetics"] = {{"f", {"0", "0"}}, {"diffusion", {1, 1}}};
  EXPECT_THAT(refusal(problem), HasSubstr("u1 has no initial values"));
  // A motion starts at the time of the file.
  problem["kinetics"] = {{"f", {"0"}}, {"diffusion", {1}}};
  problem.erase("mesh");
  problem["initial"] = {{"file", file}, {"time", 1}};
  problem["velocity"] = {"x/t", "y/t", "z/t"};
  problem["steps"] = 10;
  EXPECT_NEAR(end_of(problem).at("x")[0][0].get<double>(), 1.1, 1e-8);
}

TEST_F(OwnProblems, TheSeriesHasMassAndExtremesOfEachSpecies) {
  // u1 = 1 and u2 = 3 without reaction on a sphere of radius R = 1 + t/2: diluted like 1/R², their mass is
  // kept.
  const json series = series_of(config({{"flow", "coupled_diffusion"},
                                        {"problem", "kinetics"},
                                        {"mesh", {{"subdivisions", 2}}},
                                        {"tau", 0.01},
                                        {"steps", 20},
                                        {"kinetics", {{"f", {"0", "0"}}, {"diffusion", {1, 2}}}},
                                        {"velocity", {{"normal", "1/2"}}},
                                        {"initial", {{"u1", "1"}, {"u2", "3"}}}}));
  const double area = series.at("area")[0];
  for (const double mass : series.at("mass_u1")) EXPECT_NEAR(mass / area, 1, 1e-12);
  for (const double mass : series.at("mass_u2")) EXPECT_NEAR(mass / area, 3, 1e-12);
  EXPECT_NEAR(series.at("max_u1").back(), 1 / (1.1 * 1.1), 1e-3);
  EXPECT_NEAR(series.at("min_u2").back(), 3 / (1.1 * 1.1), 3e-3);
}

TEST_F(OwnProblems, AParameterThatNoFormulaNamesIsRefused) {
  const json configuration = config({{"flow", "coupled_diffusion"},
                                     {"problem", "kinetics"},
                                     {"kinetics", {{"f", {"k*u"}}, {"diffusion", {1}}}},
                                     {"parameters", {{"k", 1}, {"kk", 2}}},
                                     {"initial", {{"u", "1"}}}});
  EXPECT_THAT(refusal(configuration), HasSubstr("parameters: found kk, which no formula names"));
  json misspelt = configuration;
  misspelt["parameters"] = {{"kappa", 1}};
  misspelt["kinetics"]["f"] = {"kapa*u"};
  EXPECT_THAT(refusal(misspelt), HasSubstr("unknown name \"kapa\""))
      << "the name that is wrong, not what it leaves unused";
}

TEST_F(OwnProblems, FormulasBesideAFileAreRefusedWithWhatToDo) {
  const json both = config({{"flow", "coupled_diffusion"},
                            {"problem", "kinetics"},
                            {"mesh", nullptr},
                            {"surface", nullptr},
                            {"kinetics", {{"f", {"u"}}, {"diffusion", {1}}}},
                            {"initial", {{"file", "end.json"}, {"u", "1"}}}});
  EXPECT_THAT(refusal(both), AllOf(HasSubstr("found u beside file"), HasSubstr("\"mesh\": {\"file\": ..}")));
}

TEST_F(OwnProblems, NoStepsAreToldSo) {
  EXPECT_EQ(run(config({{"flow", "dziuk"}, {"steps", nullptr}})), exit_done);
  EXPECT_THAT(message, HasSubstr("no step was asked for: \"steps\" is 0"));
}

TEST_F(OwnProblems, KineticsThatBlowUpEndAsSingular) {
  // u' = u², u = 1/(1 - t), by steps that are too long to follow it.
  EXPECT_EQ(run(config({{"flow", "coupled_diffusion"},
                        {"problem", "kinetics"},
                        {"mesh", {{"subdivisions", 1}}},
                        {"degree", 1},
                        {"bdf", 1},
                        {"tau", 0.05},
                        {"steps", 60},
                        {"kinetics", {{"f", {"u^2"}}, {"diffusion", {1}}}},
                        {"initial", {{"u", "1"}}}})),
            exit_numerics)
      << message;
}

TEST_F(OwnProblems, MixturesThatBlowUpEndAsSingular) {
  // The explicit potential needs steps below 0.4 epsilon³.
  json problem = with({{"flow", "cahn_hilliard"},
                       {"problem", "mixture"},
                       {"bdf", 1},
                       {"tau", 0.2},
                       {"steps", 20},
                       {"parameters", {{"epsilon", 0.1}}},
                       {"initial", {{"u", "0.5*x"}}}});
  const auto is_singular = [&](const json& configuration) {
    EXPECT_EQ(run(configuration), exit_numerics) << message;
    EXPECT_THAT(message, AllOf(HasSubstr("singular at t = "), HasSubstr("u = "), HasSubstr(" at node "),
                               HasSubstr("smaller steps")));
  };
  is_singular(problem);
  problem["potential"] = "(u^2-1)^2/4";
  is_singular(problem);
  problem["mobility"] = "1+u^2/(1+u^2)";  // by the solver for variable ones
  is_singular(problem);
  problem.erase("mobility");
  problem["tau"] = 1e-4;
  EXPECT_EQ(run(problem), exit_done) << message;
  is_singular(config({{"flow", "cahn_hilliard"},
                      {"problem", "ellipsoid"},
                      {"bdf", 1},
                      {"tau", 0.2},
                      {"steps", 50},
                      {"parameters", {{"epsilon", 0.02}}}}));
}

/// Heat on the unit sphere, linear elements with edges of about 0.55.
json heat() {
  return {{"flow", "coupled_diffusion"},
          {"problem", "kinetics"},
          {"degree", 1},
          {"bdf", 1},
          {"kinetics", {{"f", {"0"}}, {"diffusion", {1}}}},
          {"initial", {{"u", "x"}}}};
}

TEST_F(OwnProblems, NodesBelongToTheLevelSetThatMovesThem) {
  const auto moved_by = [&](const char* level_set) {
    return with(heat(), {{"velocity", {{"level_set", level_set}}}});
  };
  EXPECT_EQ(run(moved_by("x^2+y^2+z^2-(1+t)^2")), exit_done);
  EXPECT_THAT(message, Not(HasSubstr("level set")));
  EXPECT_THAT(
      refusal(moved_by("x^2+y^2+z^2-(3+t)^2")),
      AllOf(HasSubstr("config.json: velocity: nodes are not on the level set at t = 0: the farthest"),
            HasSubstr("is at a distance of about 4 (longest edge: 0.6"), HasSubstr("expected zeros")));
  EXPECT_EQ(run(moved_by("x^2+y^2+z^2-(1.1+t)^2")), exit_done);
  EXPECT_THAT(message, HasSubstr("is at a distance of about 0.11 (longest edge"));

  const auto compared_with = [&](const char* level_set, const json& more = json::object()) {
    json changes = heat();
    changes["exact"] = {{"u", "x"}, {"level_set", level_set}};
    return with(changes, more);
  };
  EXPECT_EQ(run(compared_with("x^2+y^2+z^2-1")), exit_done);
  EXPECT_THAT(message, Not(HasSubstr("surface:")));
  EXPECT_THAT(refusal(compared_with("x^2+y^2+z^2-9")), HasSubstr("exact: nodes are not on the level set"));
  // Nodes that leave the exact surface on their way.
  EXPECT_EQ(run(compared_with("x^2+y^2+z^2-1", {{"velocity", {"x", "y", "z"}}, {"tau", 0.3}})), exit_done);
  EXPECT_THAT(message, AllOf(HasSubstr("exact: at t = 0.6 the nodes have left the exact surface"),
                             HasSubstr("lifted errors mean little")));
}

TEST_F(OwnProblems, KeysWithoutEffectAreRefused) {
  const auto useless = [&](const json& problem, const json& more, const char* what) {
    EXPECT_THAT(refusal(with(problem, more)), AllOf(HasSubstr("config.json: "), HasSubstr(what))) << more;
  };
  useless(heat(), {{"variant", {{"law", "dynamic"}}}}, "found law, which has no effect without g");
  useless(heat(), {{"parameters", {{"alpha", 2}}}}, "found alpha, which has no effect without g");
  useless(heat(), {{"parameters", {{"beta", 2}}}}, "found beta, which has no effect without g");
  useless(heat(), {{"limits", {{"radius_ratio", 0.1}}}}, "found radius_ratio, which has no effect without g");
  useless(heat(), {{"limits", {{"normal_length", 2}}}},
          "found normal_length, which problem kinetics does not look at; expected radius_ratio");
  useless(heat(), {{"stop", {{"area", 0.5}}}}, "found area, but the surface is at rest");
  EXPECT_EQ(run(with(heat(), {{"parameters", {{"alpha", 2}}}, {"kinetics", {{"f", {"-alpha*u"}}}}})),
            exit_done)
      << "a formula may name alpha for something of its own; " << message;
  const json driven = with(heat(), {{"kinetics", {{"g", "u"}}}});
  EXPECT_EQ(run(with(driven, {{"limits", {{"radius_ratio", 0.1}}}, {"parameters", {{"beta", 1}}}})),
            exit_done);
  useless(driven, {{"variant", {{"law", "dynamic"}}}, {"parameters", {{"beta", 2}}}},
          "found beta, which has no effect with the dynamic law");
  const json tumour = {{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}};
  useless(tumour, {{"initial", {{"u1", "1"}, {"u2", "1"}}}, {"parameters", {{"seed", 3}}}},
          "found seed, which has no effect with initial values");
  useless(tumour, {{"variant", {{"law", "dynamic"}}}, {"parameters", {{"epsilon", 1}}}},
          "found epsilon, which has no effect with the dynamic law");
  const json separation = {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}};
  useless(separation, {{"initial", {{"u", "x"}}}, {"parameters", {{"mean", 0.3}}}},
          "found mean, which has no effect with initial values");
  useless(separation, {{"limits", {{"radius_ratio", 0.1}}}}, "does not look at; expected no key limits");
  const json mixture = {{"flow", "cahn_hilliard"}, {"problem", "mixture"}, {"initial", {{"u", "x"}}}};
  useless(mixture, {{"variant", {{"theta", true}}}}, "theta is 0, since w comes from the second equation");
  useless(mixture, {{"tangential", {{"normal", "1"}}}}, "tangential: found a velocity along the normals");
  for (const char* flow : {"mean_curvature", "generalised_mean_curvature"})
    useless({{"flow", flow}},
            {{"variant", {{"tangential", "minimal_deformation"}, {"velocity", "interpolation"}}}},
            "found velocity, which has no effect with tangential motion");
  useless({{"flow", "helfrich"}}, {{"parameters", {{"reduction_time", 1}}}},
          "found reduction_time, which has no effect without reduced_volume");
  useless({{"flow", "helfrich"}}, {{"variant", {{"tangential", "minimal_deformation"}}}},
          "expected one of them: \"constraints\": []");
}

TEST_F(OwnProblems, ALevelSetNamesDefinitionsAndParametersOfTheConfiguration) {
  const json surface = {
      {"name", nullptr}, {"radius", nullptr}, {"level_set", "r2 - R^2"}, {"box", {{-2, -2, -2}, {2, 2, 2}}}};
  json problem = with(heat(), {{"surface", surface},
                               {"mesh", {{"subdivisions", nullptr}, {"edge_length", 0.4}}},
                               {"definitions", {{"r2", "x^2+y^2+z^2"}}},
                               {"parameters", {{"R", 0.9}}},
                               {"steps", 0}});
  const double pi = std::acos(-1);
  EXPECT_NEAR(series_of(problem).at("area")[0].get<double>(), 4 * pi * 0.81, 0.5);
  problem["definitions"]["r2"] = "x^2+y^2+z^2+u";
  EXPECT_THAT(refusal(problem), HasSubstr("surface: level_set: definition of r2"));
  problem.erase("definitions");
  EXPECT_THAT(refusal(problem), AllOf(HasSubstr("unknown name \"r2\"; known: x, y, z, R, pi"),
                                      HasSubstr("parts of formulas in \"definitions\"")));
  // The default of alpha has the unit of an area, which the surface must know first.
  problem["surface"]["level_set"] = "x^2+y^2+z^2-alpha";
  EXPECT_THAT(refusal(problem), HasSubstr("unknown name \"alpha\""));
}

TEST_F(OwnProblems, ABoxSelectsAComponentOfALevelSet) {
  json problem = with(heat(), {{"surface",
                                {{"name", nullptr},
                                 {"radius", nullptr},
                                 {"level_set", "(sqrt((abs(x)-1.5)^2+y^2)-0.8)^2+z^2-0.09"},
                                 {"box", {{-3, -2, -1}, {3, 2, 1}}}}},
                               {"mesh", {{"subdivisions", nullptr}, {"edge_length", 0.2}}},
                               {"steps", 0}});
  EXPECT_THAT(refusal(problem), AllOf(HasSubstr("the surface has 2 components, of which 1 got a mesh"),
                                      HasSubstr("expected a box around one of them alone, or a mesh file")));
  problem["surface"]["box"][0][0] = 0;
  const double pi = std::acos(-1);
  EXPECT_NEAR(series_of(problem).at("area")[0].get<double>(), 4 * pi * pi * 0.24, 0.3);
}

TEST_F(OwnProblems, FilesThatAreNoStartAreNamedForWhatTheyAre) {
  json problem = with(heat(), {{"surface", nullptr}, {"mesh", nullptr}});
  const std::string collection = (folder / "run.pvd").string();
  write_file(collection, "<VTKFile/>");
  problem["initial"] = {{"file", collection}};
  EXPECT_THAT(refusal(problem), HasSubstr("run.pvd: a list of snapshots; expected one of the .vtu files"));
  series_of(config(heat()));
  problem["initial"] = {{"file", series}};
  EXPECT_THAT(refusal(problem), HasSubstr("series.json: a series; expected the file that \"nodal\""));
}

}  // namespace
}  // namespace esfem::test_evolve_own_problems
