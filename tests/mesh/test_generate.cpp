// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <set>

#include "solver/error.hpp"
#include "solver/mesh/delaunay.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/relax.hpp"
#include "solver/surfaces/formula_surface.hpp"
#include "tests/mesh/topology.hpp"

namespace esfem::test_generate {

using testing::AllOf;
using testing::HasSubstr;

namespace {

bool outward(const Mesh& mesh, const Surface& surface) {
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Vec3 a = mesh.nodes.row(mesh.elements(e, 0)), b = mesh.nodes.row(mesh.elements(e, 1)),
               c = mesh.nodes.row(mesh.elements(e, 2));
    if ((b - a).cross(c - a).normalized().dot(surface.normal((a + b + c) / 3)) < 0.8) return false;
  }
  return true;
}

bool on_surface(const Mesh& mesh, const Surface& surface) {
  for (int i = 0; i < mesh.nodes.rows(); ++i) {
    const LevelSetJet d = surface.level_set(mesh.nodes.row(i));
    if (std::abs(d.value) / d.gradient.norm() > 1e-14 * surface.bounding_radius) return false;
  }
  return true;
}

/// Names of the promises of `generate_mesh` that the mesh breaks.
std::set<std::string> broken_promises(const Mesh& mesh, const Surface& surface, double h) {
  std::set<std::string> broken;
  if (!closed_and_oriented(mesh)) broken.insert("closed");
  if (euler_characteristic(mesh) != surface.euler_characteristic) broken.insert("Euler characteristic");
  if (!outward(mesh, surface)) broken.insert("outward");
  if (!on_surface(mesh, surface)) broken.insert("on the surface");
  const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
  if (std::abs(quality.h - h) > 0.15 * h) broken.insert("edge length");
  if (quality.h_min < 0.45 * quality.h) broken.insert("quasi-uniform");
  if (quality.min_angle < 25) broken.insert("angle");
  if (quality.mean_radius_ratio < 0.94) broken.insert("radius ratio");
  return broken;
}

bool identical(const Mesh& a, const Mesh& b) {
  return a.nodes.rows() == b.nodes.rows() && a.elements.rows() == b.elements.rows() && a.nodes == b.nodes &&
         a.elements == b.elements;
}

/// Smallest and largest ratio of an edge's length to the wanted one at its midpoint.
std::pair<double, double> relative_edges(const Mesh& mesh, const SizeFunction& size) {
  double smallest = INFINITY, largest = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) {
      const Vec3 a = mesh.nodes.row(mesh.elements(e, i)), b = mesh.nodes.row(mesh.elements(e, (i + 1) % 3));
      const double ratio = (b - a).norm() / size((a + b) / 2);
      smallest = std::min(smallest, ratio);
      largest = std::max(largest, ratio);
    }
  return {smallest, largest};
}

double mean_distance_in_memory(const Mesh& mesh) {
  double sum = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < 3; ++i) sum += std::abs(mesh.elements(e, i) - mesh.elements(e, (i + 1) % 3));
  return sum / double(3 * mesh.elements.rows());
}

template <class Error, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing thrown";
}

struct Case {
  std::string name;
  Surface surface;
  double h;
};

/// From the coarsest mesh that is accepted (the smallest radius of curvature) to h = 0.05.
std::vector<Case> cases() {
  std::vector<Case> list;
  const auto add = [&](const std::string& name, const Surface& surface,
                       std::initializer_list<double> lengths) {
    for (double h : lengths) list.push_back({name + "_" + std::to_string(std::lround(1000 * h)), surface, h});
  };
  add("sphere2", sphere(2), {1, 0.5, 0.25, 0.125});
  add("sphere1", sphere(1), {1, 0.5, 0.2, 0.05});
  add("ellipsoid", ellipsoid(1, 1, 0.6), {0.36, 0.18, 0.1, 0.05});
  add("torus", torus(1, 0.4), {0.4, 0.2, 0.1, 0.05});
  add("dumbbell", dumbbell(), {0.1, 0.05});
  return list;
}

class GeneratedMesh : public testing::TestWithParam<Case> {};

/// A deformed sphere beside the origin: the ball around the origin is all that the mesher knows of its place.
Surface pebble() {
  const auto d = [](const auto& x1, const auto& x2, const auto& x3) {
    const auto s = x1 - 2.0;
    return s * s + x2 * x2 + x3 * x3 + 0.5 * s * x2 * x3 + 0.3 * s * s * s * s - 0.5;
  };
  return make_surface("pebble", d, 3, 0.4, 2);
}

}  // namespace

TEST_P(GeneratedMesh, KeepsItsPromises) {
  const Case& c = GetParam();
  const Mesh mesh = generate_mesh(c.surface, c.h);
  EXPECT_EQ(mesh.degree, 1);
  EXPECT_THAT(broken_promises(mesh, c.surface, c.h), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Surfaces, GeneratedMesh, testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

TEST(GenerateMesh, BrokenVariantsAreNoticed) {
  const Surface surface = torus(1, 0.4);
  const double h = 0.2;
  const Mesh good = generate_mesh(surface, h);

  EXPECT_TRUE(broken_promises(good, surface, 1.3 * h).count("edge length"));
  EXPECT_TRUE(broken_promises(good, surface, 0.8 * h).count("edge length"));
  Mesh inward = good;
  inward.elements.col(0).swap(inward.elements.col(1));
  EXPECT_EQ(broken_promises(inward, surface, h), std::set<std::string>{"outward"});
  Mesh open = good;
  open.elements.conservativeResize(good.elements.rows() - 1, 3);
  EXPECT_TRUE(broken_promises(open, surface, h).count("closed"));
  Mesh off = good;
  off.nodes(7, 2) += 1e-10;
  EXPECT_EQ(broken_promises(off, surface, h), std::set<std::string>{"on the surface"});
  const Mesh unrelaxed = delaunay_surface_mesh(surface, [h](const Vec3&) { return h; });
  EXPECT_TRUE(broken_promises(unrelaxed, surface, h).count("radius ratio"));
}

TEST(GenerateMesh, KnowsNothingOfTheSurfaceButItsLevelSet) {
  EXPECT_THAT(broken_promises(generate_mesh(pebble(), 0.15), pebble(), 0.15), testing::IsEmpty());
}

TEST(GenerateMesh, HalfTheEdgeLengthGivesFourTimesTheVertices) {
  const double coarse = generate_mesh(ellipsoid(1, 1, 0.6), 0.16).nodes.rows();
  const double fine = generate_mesh(ellipsoid(1, 1, 0.6), 0.08).nodes.rows();
  EXPECT_NEAR(fine / coarse, 4, 0.6);
}

TEST(GenerateMesh, IsTheSameToTheBitAfterOtherCallsAndOnAnotherHeap) {
  const Mesh first_torus = generate_mesh(torus(1, 0.4), 0.15);
  const Mesh first_dumbbell = generate_mesh(dumbbell(), 0.05);
  // Blocks of all sizes, every other one freed: the mesher's nodes and cells get other addresses.
  std::vector<std::unique_ptr<char[]>> blocks;
  for (int i = 0; i < 4000; ++i) blocks.push_back(std::make_unique<char[]>(16 + i * 37 % 9000));
  for (std::size_t i = 0; i < blocks.size(); i += 2) blocks[i].reset();
  EXPECT_TRUE(identical(first_dumbbell, generate_mesh(dumbbell(), 0.05)));
  EXPECT_TRUE(identical(first_torus, generate_mesh(torus(1, 0.4), 0.15)));
  EXPECT_FALSE(identical(first_torus, generate_mesh(torus(1, 0.4), 0.1501)));
}

TEST(GenerateMesh, NumbersNeighboursCloseToEachOther) {
  Mesh mesh = generate_mesh(sphere(1), 0.1);
  const double bound = std::sqrt(double(mesh.nodes.rows())) * 3;
  EXPECT_LT(mean_distance_in_memory(mesh), bound);
  for (int& vertex : mesh.elements.reshaped()) vertex = int(vertex * 1009L % mesh.nodes.rows());
  EXPECT_GT(mean_distance_in_memory(mesh), bound);
}

TEST(GenerateMesh, FollowsASizeFunction) {
  const SizeFunction neck = [](const Vec3& y) { return std::min(0.08, 0.015 + 0.15 * std::abs(y[2])); };
  const SizeFunction side = [](const Vec3& y) { return 0.04 + 0.055 * (1.4 + y[0]); };
  for (const auto& [surface, size] : {std::pair(dumbbell(), neck), std::pair(torus(1, 0.4), side)}) {
    const Mesh mesh = generate_mesh(surface, size);
    EXPECT_TRUE(closed_and_oriented(mesh) && outward(mesh, surface) && on_surface(mesh, surface))
        << surface.name;
    EXPECT_EQ(euler_characteristic(mesh), surface.euler_characteristic);
    const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
    EXPECT_GE(quality.min_angle, 25);
    EXPECT_GE(quality.mean_radius_ratio, 0.94);
    EXPECT_GT(quality.h / quality.h_min, 4);
    // The largest edges have the length that the function asks for, the typical ones 0.77 of it, everywhere.
    const auto [smallest, largest] = relative_edges(mesh, size);
    EXPECT_LT(largest, 1.15);
    EXPECT_GT(smallest, 0.77 / 1.5);
  }
}

void expect_graded(const Surface& surface) {
  const double grading = 0.6;
  const Mesh mesh = generate_mesh(surface, 0.3, grading);
  EXPECT_TRUE(closed_and_oriented(mesh) && outward(mesh, surface) && on_surface(mesh, surface))
      << surface.name;
  EXPECT_EQ(euler_characteristic(mesh), surface.euler_characteristic);
  const MeshQuality quality = mesh_quality(mesh.elements, mesh.nodes);
  EXPECT_GE(quality.min_angle, 25) << surface.name;
  EXPECT_LE(quality.h, 0.3 * 1.15) << surface.name;
  const SizeFunction largest = [&](const Vec3& y) {
    return std::min(0.3, grading / surface.largest_curvature(y));
  };
  EXPECT_LT(relative_edges(mesh, largest).second, 1.15) << surface.name;
}

TEST(GenerateMesh, GradesByCurvature) {
  expect_graded(dumbbell());
  expect_graded(red_blood_cell());
  for (double bad : {0.0, -1.0, 1.5, double(NAN)})
    EXPECT_THAT(message_of<InputError>([bad] { generate_mesh(sphere(1), 0.2, bad); }),
                HasSubstr("expected a number greater than 0 and at most 1"));
}

TEST(GenerateMesh, GradesByACurvatureThatJumps) {
  // Two flat faces with two holes: it jumps at the rims.
  expect_graded(formula_surface("(x^2*(1-x^2)-y^2)^2+z^2/2-0.01", {Vec3(-1.5, -1, -0.5), Vec3(1.5, 1, 0.5)}));
}

TEST(GenerateMesh, RefusesAnEdgeLengthThatMakesNoMesh) {
  for (double h : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    const auto call = [h] { generate_mesh(sphere(1), h); };
    EXPECT_THAT(message_of<InputError>(call), HasSubstr("expected a positive number")) << h;
    const auto graded = [h] {
      generate_mesh(sphere(1), [h](const Vec3& y) { return y[2] > 0.9 ? h : 0.2; });
    };
    EXPECT_THAT(message_of<InputError>(graded), HasSubstr(std::isinf(h) ? "expected" : "a positive number"))
        << h;
  }
}

TEST(GenerateMesh, RefusesAGradingThatMakesTooManyNodes) {
  EXPECT_EQ(message_of<InputError>([] { generate_mesh(torus(1, 0.4), 0.3, 1e-5); }),
            "torus: grading 1e-05 makes 3e+11 nodes or more; expected at most 1e+08");
}

TEST(GenerateMesh, RefusesAnEdgeLengthThatDoesNotResolveTheSurface) {
  const auto message = message_of<InputError>([] { generate_mesh(torus(1, 0.4), 0.41); });
  EXPECT_THAT(message, AllOf(HasSubstr("0.41"), HasSubstr("0.4,"), HasSubstr("torus")));
  EXPECT_THAT(message_of<InputError>([] { generate_mesh(dumbbell(), 0.11); }), HasSubstr("0.100503"));
  const auto everywhere = [] { generate_mesh(sphere(1), [](const Vec3&) { return 1.1; }); };
  EXPECT_THAT(message_of<InputError>(everywhere), AllOf(HasSubstr("1.1 at ("), HasSubstr("at most 1,")));
  // Coarse where the surface is flat, though coarser than the smallest radius of curvature allows: fine.
  const SizeFunction flat = [](const Vec3& y) { return std::min(0.5, 0.3 + 0.5 * std::pow(y[2], 2)); };
  EXPECT_GT(mesh_quality(generate_mesh(ellipsoid(1, 1, 0.6), flat).elements,
                         generate_mesh(ellipsoid(1, 1, 0.6), flat).nodes)
                .h,
            0.37);
}

TEST(GenerateMesh, SaysWhenItMissesTopologyOrQuality) {
  Surface wrong = sphere(1);
  wrong.euler_characteristic = 0;
  EXPECT_THAT(message_of<NumericsError>([&] { generate_mesh(wrong, 0.3); }),
              HasSubstr("Euler characteristic 2, expected 0"));
  const SizeFunction jump = [](const Vec3& y) { return y[2] > 0.1 ? 0.1 : 0.45; };
  EXPECT_THAT(message_of<NumericsError>([&] { generate_mesh(sphere(1), jump); }),
              HasSubstr("smallest angle"));
}

TEST(Relax, KeepsTheTopologyAndEvensTheTriangles) {
  const Surface surface = sphere(1);
  Mesh mesh = icosphere(1, 4);
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    for (int j = 0; j < 3; ++j) mesh.nodes(i, j) += 0.015 * std::sin(12.9898 * i + 78.233 * j);
  project_nodes(mesh, surface);
  const double before = mesh_quality(mesh.elements, mesh.nodes).mean_radius_ratio;
  relax(mesh, surface, [](const Vec3&) { return 1.0; });
  EXPECT_LT(before, 0.92);
  EXPECT_GT(mesh_quality(mesh.elements, mesh.nodes).mean_radius_ratio, 0.96);
  EXPECT_EQ(mesh.nodes.rows(), icosphere(1, 4).nodes.rows());
  EXPECT_TRUE(closed_and_oriented(mesh) && outward(mesh, surface));
}

TEST(Relax, RefusesAnOpenOrTwistedMesh) {
  const auto relaxed = [](Mesh mesh) { relax(mesh, sphere(1), [](const Vec3&) { return 1.0; }); };
  Mesh open = icosphere(1, 1);
  open.elements.conservativeResize(open.elements.rows() - 1, 3);
  EXPECT_THAT(message_of<NumericsError>([&] { relaxed(open); }), HasSubstr("has 1 triangles"));
  Mesh twisted = icosphere(1, 1);
  std::swap(twisted.elements(5, 0), twisted.elements(5, 1));
  EXPECT_THAT(message_of<NumericsError>([&] { relaxed(twisted); }), HasSubstr("opposite orientation"));
}

}  // namespace esfem::test_generate
