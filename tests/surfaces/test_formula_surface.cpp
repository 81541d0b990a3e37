// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/error.hpp"
#include "solver/surfaces/formula_surface.hpp"
#include "solver/surfaces/named.hpp"

namespace esfem::test_formula_surface {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const Box cube = {Vec3(-1.3, -1.3, -1.3), Vec3(1.3, 1.3, 1.3)};

/// Named surfaces and their level sets, written as formulas.
struct Pair {
  Surface named, formula;
};
std::vector<Pair> pairs() {
  const Box wide = {Vec3(-2.1, -2.1, -1.1), Vec3(2.1, 2.1, 1.1)};
  return {{dumbbell(), formula_surface("x^2+y^2+2*z^2*(z^2-199/200)-0.04", cube)},
          {sphere(0.5), formula_surface("(x^2+y^2+z^2-R^2)/(2*R)", cube, {{"R", 0.5}})},
          {ellipsoid(1, 0.8, 0.6), formula_surface("(x^2+(y/0.8)^2+(z/0.6)^2-1)/2", cube)},
          {torus(0.8, 0.3), formula_surface("((x^2+y^2+z^2+R^2-r^2)^2-4*R^2*(x^2+y^2))/(8*R^2*r)", cube,
                                            {{"R", 0.8}, {"r", 0.3}})},
          {red_blood_cell(), formula_surface("z^2-(1-(x^2+y^2)/4)*(1-0.7*(1-(x^2+y^2)/4)^2)^2", wide)},
          {perturbed_torus(1, 0.6, 0.05, 3),
           formula_surface("((sqrt(x^2+y^2)-1)^2+z^2-(0.6+0.05*(x^3-3*x*y^2)/(x^2+y^2)^1.5)^2)/1.2",
                           {Vec3(-1.8, -1.85, -1), Vec3(1.8, 1.87, 1)})}};
}

std::vector<Vec3> points_of(const Surface& surface, int count) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec3> points;
  while (int(points.size()) < count) {
    const Vec3 x(uniform(generator), uniform(generator), uniform(generator));
    try {
      points.push_back(surface.closest_point(surface.bounding_radius * x));
    } catch (const NumericsError&) {  // on the axis of a torus
    }
  }
  return points;
}

TEST(FormulaSurface, HasTheShapeOfTheNamedSurface) {
  for (const auto& [named, formula] : pairs()) {
    EXPECT_EQ(formula.euler_characteristic, named.euler_characteristic) << named.name;
    const double size = 1 / named.smallest_curvature_radius;
    for (const Vec3& y : points_of(named, 50)) {
      EXPECT_NEAR(formula.level(y), 0, 1e-13) << named.name;
      EXPECT_LT((formula.normal(y) - named.normal(y)).norm(), 1e-12) << named.name;
      EXPECT_LT((formula.weingarten(y) - named.weingarten(y)).norm(), 1e-12 * size) << named.name;
      EXPECT_LT((formula.mean_curvature_gradient(y) - named.mean_curvature_gradient(y)).norm(),
                1e-11 * size * size)
          << named.name;
      EXPECT_NEAR(formula.mean_curvature_laplacian(y), named.mean_curvature_laplacian(y),
                  1e-11 * size * size * size)
          << named.name;
      const Vec3 near = y + 0.2 * named.smallest_curvature_radius * named.normal(y);
      EXPECT_LT((formula.closest_point(near) - y).norm(), 1e-12) << named.name;
    }
  }
}

TEST(FormulaSurface, FindsItsSizeAndItsSmallestRadiusOfCurvature) {
  for (const auto& [named, formula] : pairs()) {
    // perturbed_torus and red_blood_cell are themselves sampled, with an allowance of 0.1%.
    const bool is_sampled = named.name == "perturbed_torus" || named.name == "red_blood_cell";
    EXPECT_NEAR(formula.smallest_curvature_radius / named.smallest_curvature_radius, 1,
                is_sampled ? 2e-3 : 1e-8)
        << named.name;
    for (const Vec3& y : points_of(named, 50))
      EXPECT_LE((y - formula.centre).norm(), formula.bounding_radius) << named.name;
    EXPECT_LT(formula.bounding_radius, 1.15 * named.bounding_radius) << named.name;
  }
}

TEST(FormulaSurface, KnowsTheGenus) {
  const auto characteristic = [](const std::string& level_set, const Box& box) {
    return formula_surface(level_set, box).euler_characteristic;
  };
  // Two, and three, spheres; a torus off the origin; surfaces of genus 2 and 3.
  EXPECT_EQ(characteristic("min((x-0.6)^2+y^2+z^2, (x+0.6)^2+y^2+z^2) - 0.1", cube), 4);
  EXPECT_EQ(
      characteristic("(sqrt((x-5)^2+(y+3)^2)-0.8)^2+z^2-0.09", {Vec3(3.7, -4.3, -0.5), Vec3(6.3, -1.7, 0.5)}),
      0);
  EXPECT_EQ(characteristic("(x^2*(1-x^2)-y^2)^2+z^2/2-0.01", {Vec3(-1.5, -1, -0.6), Vec3(1.5, 1, 0.6)}), -2);
  const std::string three_tori =
      "-log(exp(-8*((sqrt((x-1.8)^2+y^2)-0.7)^2+z^2))+exp(-8*((sqrt(x^2+y^2)-0.7)^2+z^2))"
      "+exp(-8*((sqrt((x+1.8)^2+y^2)-0.7)^2+z^2)))/8-0.07";
  EXPECT_EQ(characteristic(three_tori, {Vec3(-3, -1.2, -0.5), Vec3(3, 1.2, 0.5)}), -4);
}

TEST(FormulaSurface, KnowsHowManyComponentsItHas) {
  const Box box = {Vec3(-3, -2, -1.2), Vec3(3, 2, 1.2)}, half = {Vec3(0, -2, -1.2), Vec3(3, 2, 1.2)};
  const std::string two_tori = "(sqrt((abs(x)-1.5)^2+y^2)-0.8)^2+z^2-0.09",
                    torus_and_sphere = "min((sqrt((x-1.5)^2+y^2)-0.8)^2+z^2-0.09, (x+1.5)^2+y^2+z^2-0.49)",
                    shell = "(sqrt(x^2+y^2+z^2)-0.8)^2-0.04";
  EXPECT_EQ(formula_surface(two_tori, box).components, 2);
  EXPECT_EQ(formula_surface(torus_and_sphere, box).components, 2);
  EXPECT_EQ(formula_surface(shell, box).components, 2) << "one inside the other";
  for (const std::string& level_set : {two_tori, torus_and_sphere}) {
    const Surface torus = formula_surface(level_set, half);
    EXPECT_EQ(torus.components, 1) << "the one in the box";
    EXPECT_EQ(torus.euler_characteristic, 0);
    EXPECT_GT(torus.level(Vec3(-1.5, 0, 0)), 0) << "there is nothing beside the box";
  }
}

TEST(FormulaSurface, NamesDefinitionsAndNumbersOfTheConfiguration) {
  const FormulaNames names = {{}, {{"R", 0.5}, {"c", 1}}, {{"r2", "x^2+y^2+z^2/c"}, {"of_time", "t"}}};
  const json box = {{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}};
  const auto height = [&](const json& parameters) {
    return named_surface({{"level_set", "r2-R^2"}, {"box", box}, {"parameters", parameters}}, names)
        .closest_point(Vec3(0, 0, 0.6))[2];
  };
  EXPECT_NEAR(height(json::object()), 0.5, 1e-12);
  EXPECT_NEAR(height({{"R", 0.55}}), 0.55, 1e-12) << "its own go first";
  EXPECT_NEAR(height({{"c", 1.21}}), 0.55, 1e-12) << "in definitions, too";
}

std::string refusal(const json& description) {
  try {
    named_surface(description);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FormulaSurface, RefusesWhatIsNoClosedSmoothSurface) {
  const json box = {{-1.3, -1.3, -1.3}, {1.3, 1.3, 1.3}};
  const auto with = [&](const std::string& level_set) {
    return json{{"level_set", level_set}, {"box", box}};
  };
  const std::pair<json, const char*> cases[] = {
      {with("x^2+y^2+*z"), "surface: level_set: \"x^2+y^2+*z\": column 9: found \"*\""},
      {with("x^2+y^2+w"), "column 9: unknown name \"w\"; known: x, y, z, pi"},
      {with("x^2+y^2+z^2+1"),
       "the level set has no zero in the box, it is positive there; expected d < 0 inside"},
      {with("x^2+y^2+z^2-100"), "the level set has no zero in the box, it is negative there"},
      {with("x^2+y^2-0.5"), "the surface is open at the box: d < 0 at"},
      {with("0.5-x^2-y^2-z^2"), "negative on all sides of the box; expected it negative inside the surface"},
      {with("log(x)+y^2+z^2"), "is nan at x = -1.3"},
      {with("max(max(abs(x), abs(y)), abs(z))-1"), "the surface has an edge or crosses itself near"},
      {with("(x^2+y^2+z^2-1)^3"), "expected a gradient that is not zero on the surface"},
      {with("1/(x^2+y^2+z^2-1.01)"), "without a smooth zero"},
      {{{"level_set", "x"}}, "needs \"box\""},
      {{{"level_set", 3}, {"box", box}}, "expected a formula in x, y, z as text"},
      {{{"level_set", "x"}, {"box", 3}}, "found box = 3; expected [[x, y, z], [x, y, z]]"},
      {{{"level_set", "x"}, {"box", {{0, 0, 0}, {1, 1, 0}}}}, "is empty"},
      {{{"level_set", "x"}, {"box", box}, {"name", "sphere"}}, "unknown key \"name\" beside level_set"},
      {{{"level_set", "x"}, {"box", box}, {"parameters", {{"a", "b"}}}},
       "found a = \"b\"; expected a number"},
  };
  for (const auto& [description, expected] : cases) EXPECT_THAT(refusal(description), HasSubstr(expected));
}

}  // namespace
}  // namespace esfem::test_formula_surface
