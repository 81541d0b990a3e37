// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/generate.hpp"
#include "solver/mesh/read.hpp"
#include "solver/surfaces/angenent_torus.hpp"
#include "solver/surfaces/named.hpp"
#include "solver/surfaces/surface.hpp"
#include "solver/tables/table.hpp"

namespace esfem::test_surface {
namespace {

/// Points of the surface: the closest ones to random points of the ball around it. A few of these lie where
/// there is no closest point, as the centre line of a tube.
std::vector<Vec3> random_points(const Surface& surface, int count) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<Vec3> points;
  int without = 0;
  while (static_cast<int>(points.size()) < count) {
    Vec3 x(normal(generator), normal(generator), normal(generator));
    x *= surface.bounding_radius * std::cbrt(uniform(generator)) / x.norm();
    try {
      points.push_back(surface.closest_point(x));
    } catch (const NumericsError&) {
      ++without;
    }
  }
  EXPECT_LE(without, 1 + count / 100) << surface.name;
  return points;
}

std::vector<Surface> all_surfaces() {
  return {sphere(2),
          sphere(0.5),
          ellipsoid(1, 1, 0.6),
          ellipsoid(2, 1, 0.7),
          torus(1, 0.4),
          dumbbell(),
          perturbed_torus(1, 0.6, 0.05, 3),
          red_blood_cell(),
          evans_fung_cell(),
          angenent_torus(),
          angenent_torus(0.8)};
}

TEST(Surface, ClosestPointsLieOnTheSurfaceAndAlongTheNormal) {
  for (const Surface& surface : all_surfaces()) {
    for (const Vec3& y : random_points(surface, 200)) {
      EXPECT_NEAR(surface.level(y), 0, 1e-13) << surface.name;
      for (double s : {-0.3, -0.05, 0.2}) {
        const double offset = s * surface.smallest_curvature_radius;
        const Vec3 found = surface.closest_point(y + offset * surface.normal(y));
        EXPECT_LT((found - y).norm(), 1e-12)
            << surface.name << " at " << y.transpose() << ", offset " << offset;
      }
    }
  }
}

TEST(Surface, SphereHasItsClosedForms) {
  const Surface surface = sphere(2);
  const Vec3 y = Vec3(1, -2, 0.5).normalized() * 2;
  EXPECT_NEAR(surface.mean_curvature(y), 1.0, 1e-14);  // H = +2/R for the outward normal
  EXPECT_LT((surface.normal(y) - y / 2).norm(), 1e-15);
  const Mat3 expected = (Mat3::Identity() - y * y.transpose() / 4) / 2;
  EXPECT_LT((surface.weingarten(y) - expected).norm(), 1e-14);
}

TEST(Surface, TorusHasItsPrincipalCurvatures) {
  const double major = 1, minor = 0.4;
  const Surface surface = torus(major, minor);
  for (double theta = 0; theta < 6; theta += 0.37) {
    for (double phi = 0.1; phi < 6; phi += 0.7) {
      const double rho = major + minor * std::cos(theta);
      const Vec3 y(rho * std::cos(phi), rho * std::sin(phi), minor * std::sin(theta));
      const double kappa1 = 1 / minor, kappa2 = std::cos(theta) / rho;
      EXPECT_NEAR(surface.level(y), 0, 1e-15);
      EXPECT_NEAR(surface.mean_curvature(y), kappa1 + kappa2, 1e-12);
      EXPECT_NEAR(surface.weingarten(y).squaredNorm(), kappa1 * kappa1 + kappa2 * kappa2, 1e-12);
    }
  }
}

TEST(Surface, EllipsoidOfRevolutionHasItsMeanCurvature) {
  // (a cos p cos t, a cos p sin t, c sin p): kappa = a c / m³ along the meridian, c / (a m) around, m² = a²
  // sin² + c² cos².
  const double a = 1, c = 0.6;
  const Surface surface = ellipsoid(a, a, c);
  for (double p = -1.5; p < 1.5; p += 0.23) {
    const Vec3 y(a * std::cos(p) * std::cos(1.1), a * std::cos(p) * std::sin(1.1), c * std::sin(p));
    const double m = std::hypot(a * std::sin(p), c * std::cos(p));
    EXPECT_NEAR(surface.mean_curvature(y), a * c / (m * m * m) + c / (a * m), 1e-12);
  }
}

TEST(Surface, DumbbellHasTheCurvaturesOfItsProfile) {
  const Surface surface = dumbbell();
  for (double z = -0.95; z < 1; z += 0.19) {
    const double r2 = 0.04 - 2 * z * z * (z * z - 199.0 / 200.0), r = std::sqrt(r2);
    const double r1 = (1.99 * 2 * z - 8 * z * z * z) / (2 * r);
    const double r11 = ((3.98 - 24 * z * z) / 2 - r1 * r1) / r;
    const double w = std::sqrt(1 + r1 * r1);
    const Vec3 y(r * std::cos(0.4), r * std::sin(0.4), z);
    EXPECT_NEAR(surface.level(y), 0, 1e-15);
    EXPECT_NEAR(surface.mean_curvature(y), 1 / (r * w) - r11 / (w * w * w), 1e-12);
  }
}

double willmore_residual(const Surface& surface, const Vec3& y) {
  // kll21 (2.2): V = Delta H + Q, Q = -H³/2 + |A|² H.
  const double H = surface.mean_curvature(y);
  return surface.mean_curvature_laplacian(y) - H * H * H / 2 + surface.weingarten(y).squaredNorm() * H;
}

TEST(MeanCurvatureDerivatives, VanishOnSpheres) {
  for (double radius : {1.0, 1.7}) {
    const Surface surface = sphere(radius);
    for (const Vec3& y : random_points(surface, 50)) {
      EXPECT_NEAR(surface.mean_curvature_jet(y).value, 2 / radius, 1e-14);
      EXPECT_LT(surface.mean_curvature_gradient(y).norm(), 1e-14);
      EXPECT_NEAR(surface.mean_curvature_laplacian(y), 0, 2e-14);
    }
  }
}

TEST(MeanCurvatureDerivatives, HaveTheirClosedFormsOnTheTorus) {
  const double major = 1, minor = 0.4;
  const Surface surface = torus(major, minor);
  for (double theta = 0.1; theta < 6; theta += 0.37) {
    for (double phi = 0.1; phi < 6; phi += 0.7) {
      const double c = std::cos(theta), s = std::sin(theta), rho = major + minor * c;
      const Vec3 y(rho * std::cos(phi), rho * std::sin(phi), minor * s);
      const Vec3 tangent(-s * std::cos(phi), -s * std::sin(phi), c);
      // H = 1/r + cos/rho, dH/dtheta = -R sin/rho², and Delta f = (rho f')'/(r² rho).
      const double slope = -major * s / (rho * rho);
      const double laplacian = -major * (c * rho + minor * s * s) / (minor * minor * rho * rho * rho);
      EXPECT_NEAR(surface.mean_curvature_jet(y).value, surface.mean_curvature(y), 1e-13);
      EXPECT_LT((surface.mean_curvature_gradient(y) - slope / minor * tangent).norm(), 1e-12);
      EXPECT_NEAR(surface.mean_curvature_laplacian(y), laplacian, 1e-10);
    }
  }
}

TEST(MeanCurvatureDerivatives, TheCliffordTorusIsAWillmoreSurface) {
  const auto largest_residual = [](const Surface& surface) {
    double largest = 0;
    for (const Vec3& y : random_points(surface, 100)) {
      const double scale = std::pow(surface.mean_curvature(y), 3) + surface.weingarten(y).squaredNorm();
      largest = std::max(largest, std::abs(willmore_residual(surface, y)) / std::abs(scale));
    }
    return largest;
  };
  EXPECT_LT(largest_residual(torus(1, std::sqrt(0.5))), 1e-10);
  EXPECT_GT(largest_residual(torus(1, 0.69)), 1e-3);
}

TEST(MeanCurvatureDerivatives, AgreeWithTheIndependentImplementation) {
  const std::string folder = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/";
  const nlohmann::json reference = read_json(folder + "willmore_assembly.json");
  const Mesh mesh = read_mesh(folder + "ellipsoid_362.msh").mesh;
  const Surface surface = ellipsoid(1, 1, 0.6);
  ASSERT_EQ(reference["exact_u"].size(), size_t(mesh.nodes.rows()));
  double deviation = 0, without_normal_part = 0;
  for (int j = 0; j < mesh.nodes.rows(); ++j) {
    const auto u = reference["exact_u"][j].get<std::vector<double>>();
    const auto w = reference["exact_w_willmore"][j].get<std::vector<double>>();
    const double diffusion = reference["exact_w_surface_diffusion"][j][0];
    const Vec3 y = mesh.nodes.row(j), nu = surface.normal(y), z(w[1], w[2], w[3]);
    const LevelSetJet H = surface.mean_curvature_jet(y);
    const auto compare = [&](double found, double expected) {
      deviation = std::max(deviation, std::abs(found - expected) / (1 + std::abs(expected)));
    };
    compare(H.value, u[0]);
    compare((nu - Vec3(u[1], u[2], u[3])).norm(), 0);
    compare(willmore_residual(surface, y), w[0]);
    compare((surface.mean_curvature_gradient(y) - z).norm(), 0);
    compare(surface.mean_curvature_laplacian(y), diffusion);
    without_normal_part =
        std::max(without_normal_part, std::abs(H.hessian.trace() - nu.dot(H.hessian * nu) - diffusion));
  }
  EXPECT_LT(deviation, 1e-9);
  EXPECT_GT(without_normal_part, 1e-3);
}

TEST(MeanCurvatureDerivatives, DoNotDependOnTheLevelSetFunction) {
  const auto scaled = [](const auto& x1, const auto& x2, const auto& x3) {
    return (x1 * x1 + x2 * x2 + x3 * x3 / 0.36 - 1.0) * (2.0 + x1 * x1 + 0.5 * x2 * x3) / (1.0 + x2 * x2);
  };
  const auto root = [](const auto& x1, const auto& x2, const auto& x3) {
    using std::sqrt;
    return sqrt(x1 * x1 + x2 * x2 + x3 * x3 / 0.36 + 0.3 * x1) - sqrt(1.0 + 0.3 * x1);
  };
  const Surface plain = ellipsoid(1, 1, 0.6);
  const auto normal_part = [](const Surface& surface, const Vec3& y) {
    return surface.normal(y).dot(surface.mean_curvature_jet(y).gradient);
  };
  for (const Surface& other :
       {make_surface("scaled", scaled, 1, 0.36, 2), make_surface("root", root, 1, 0.36, 2)}) {
    double extensions_differ = 0;
    for (const Vec3& y : random_points(plain, 50)) {
      const double laplacian = plain.mean_curvature_laplacian(y);
      EXPECT_LT((other.mean_curvature_gradient(y) - plain.mean_curvature_gradient(y)).norm(), 1e-11);
      EXPECT_NEAR(other.mean_curvature_laplacian(y), laplacian, 1e-11 * (1 + std::abs(laplacian)));
      extensions_differ =
          std::max(extensions_differ, std::abs(normal_part(other, y) - normal_part(plain, y)));
    }
    EXPECT_GT(extensions_differ, 0.1) << other.name;
  }
}

TEST(NestedJets, QuotientsAndRootsHaveTheirFourthDerivatives) {
  using One = ceres::Jet<double, 1>;
  using Four = ceres::Jet<ceres::Jet<ceres::Jet<One, 1>, 1>, 1>;
  const double x = 1.3;
  Four y = ceres::FromDouble<Four>::make(x);
  y.v[0] = ceres::FromDouble<ceres::Jet<ceres::Jet<One, 1>, 1>>::make(1.0);
  y.a.v[0] = ceres::FromDouble<ceres::Jet<One, 1>>::make(1.0);
  y.a.a.v[0] = One(1.0);
  y.a.a.a.v[0] = 1;
  const auto fourth = [](const Four& f) { return f.v[0].v[0].v[0].v[0]; };
  EXPECT_NEAR(fourth(1.0 / y), 24 * std::pow(x, -5), 1e-12);
  EXPECT_NEAR(fourth(sqrt(y)), -15.0 / 16 * std::pow(x, -3.5), 1e-12);
  EXPECT_NEAR(fourth((2.0 - y) / (y * y)), 240 * std::pow(x, -6) - 24 * std::pow(x, -5), 1e-11);
}

/// A surface's parametrisation over two angles and the boundary of its domain: [0, 2 pi] x [from, to].
struct Parametrised {
  Surface surface;
  std::function<Vec3(double u, double v)> point;
  double from, to;
};

std::vector<Parametrised> parametrised_surfaces() {
  const auto revolve = [](const Surface& surface, auto height, double radius) {
    const auto point = [=](double u, double v) {
      const double rho = std::cos(v);
      return Vec3(radius * rho * std::cos(u), radius * rho * std::sin(u), height(rho * rho) * std::sin(v));
    };
    return Parametrised{surface, point, -pi / 2, pi / 2};
  };
  const auto torus_with = [](double major, double minor, double amplitude, int waves) {
    const auto point = [=](double u, double v) {
      const double tube = minor + amplitude * std::cos(waves * u), rho = major + tube * std::cos(v);
      return Vec3(rho * std::cos(u), rho * std::sin(u), tube * std::sin(v));
    };
    return Parametrised{perturbed_torus(major, minor, amplitude, waves), point, -pi, pi};
  };
  return {
      revolve(
          red_blood_cell(), [](double c) { return 1 - 0.7 * (c - 1) * (c - 1); }, 2),
      revolve(
          evans_fung_cell(), [](double c) { return 0.5 * (0.207161 + 2.002558 * c - 1.122762 * c * c); }, 1),
      torus_with(1, 0.6, 0.05, 3), torus_with(1, 0.6, 0.1, 4), torus_with(2, 1.2, 0.1, 1)};
}

TEST(ParametrisedSurface, LiesOnItsLevelSetWithTheNormalOutward) {
  for (const auto& [surface, point, from, to] : parametrised_surfaces()) {
    for (double u = 0.05; u < 2 * pi; u += 0.2) {
      for (double v = from + 0.02; v < to; v += 0.1) {
        const Vec3 y = point(u, v);
        const double step = 1e-5;
        const Vec3 along = point(u + step, v) - point(u - step, v),
                   around = point(u, v + step) - point(u, v - step);
        EXPECT_NEAR(surface.level(y), 0, 1e-14) << surface.name;
        EXPECT_LE(y.norm(), surface.bounding_radius);
        EXPECT_GT(surface.normal(y).dot(along.cross(around).normalized()), 1 - 1e-7) << surface.name;
        EXPECT_GT(surface.level_set(y).gradient.norm(), 0.05) << surface.name;
      }
    }
  }
}

TEST(ParametrisedSurface, ClosestPointsNearItAreFound) {
  for (const auto& [surface, point, from, to] : parametrised_surfaces()) {
    for (double u = 0.05; u < 2 * pi; u += 0.3) {
      for (double v = from + 0.02; v < to; v += 0.2) {
        const Vec3 y = point(u, v);
        for (double s : {-0.3, 0.1, 0.3}) {
          const Vec3 x = y + s * surface.smallest_curvature_radius * surface.normal(y);
          EXPECT_LT((surface.closest_point(x) - y).norm(), 1e-12) << surface.name;
        }
      }
    }
  }
}

TEST(ParametrisedSurface, PerturbedTorusWithoutPerturbationIsATorus) {
  const Surface plain = torus(1, 0.4), perturbed = perturbed_torus(1, 0.4, 0, 5);
  for (const Vec3& y : random_points(plain, 50)) {
    EXPECT_NEAR(perturbed.level(y), 0, 1e-14);
    EXPECT_LT((perturbed.weingarten(y) - plain.weingarten(y)).norm(), 1e-12);
    EXPECT_NEAR(perturbed.mean_curvature_laplacian(y), plain.mean_curvature_laplacian(y), 1e-9);
  }
}

/// Integral of the Gauss curvature over a generated mesh, by the corner rule on flat triangles.
double total_gauss_curvature(const Surface& surface, double edge_length) {
  const Mesh mesh = generate_mesh(surface, edge_length);
  const auto gauss_curvature = [&](int node) {
    const Mat3 A = surface.weingarten(mesh.nodes.row(node));
    return (A.trace() * A.trace() - A.squaredNorm()) / 2;
  };
  double sum = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const auto corner = [&](int i) -> Vec3 { return mesh.nodes.row(mesh.elements(e, i)); };
    const double area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm() / 2;
    for (int i = 0; i < 3; ++i) sum += area / 3 * gauss_curvature(mesh.elements(e, i));
  }
  return sum;
}

TEST(ParametrisedSurface, TheirMeshesSatisfyGaussBonnet) {
  for (const auto& [surface, h] : {std::pair(red_blood_cell(), 0.4),
                                   {evans_fung_cell(), 0.2},
                                   {perturbed_torus(1, 0.6, 0.05, 3), 0.22}}) {
    const double expected = 2 * pi * surface.euler_characteristic;
    const double coarse = std::abs(total_gauss_curvature(surface, h) - expected);
    const double fine = std::abs(total_gauss_curvature(surface, h / 2) - expected);
    EXPECT_LT(fine, 0.01 * 4 * pi) << surface.name;
    EXPECT_LT(fine, 0.4 * coarse) << surface.name;
  }
}

TEST(Surface, ClosestPointsInPacksAreThoseOneByOne) {
  for (const Surface& surface : all_surfaces()) {
    const double curvature = 1 / surface.smallest_curvature_radius;
    const std::vector<Vec3> on_surface = random_points(surface, 10 * pack_size);
    for (size_t first = 0; first < on_surface.size(); first += pack_size) {
      Pack x[3];
      for (int lane = 0; lane < pack_size; ++lane) {
        const Vec3& y = on_surface[first + lane];
        const Vec3 near = y + (lane % 3 - 1) * 0.2 * surface.smallest_curvature_radius * surface.normal(y);
        for (int i = 0; i < 3; ++i) x[i][lane] = near[i];
      }
      const SurfacePoints points = surface.closest_points(x);
      for (int lane = 0; lane < pack_size; ++lane) {
        const Vec3 y = surface.closest_point(lane_of(x, lane));
        const Surface::Shape shape = surface.shape_at(y);
        EXPECT_LT((lane_of(points.y, lane) - y).norm(), 1e-13 * surface.bounding_radius) << surface.name;
        EXPECT_LT((lane_of(points.normal, lane) - shape.normal).norm(), 1e-12) << surface.name;
        for (int i = 0; i < 3; ++i) {
          const Vec3 row = shape.weingarten.row(i);
          EXPECT_LT((lane_of(points.weingarten[i], lane) - row).norm(), 1e-11 * curvature) << surface.name;
        }
      }
    }
  }
}

TEST(Surface, OnePointOfAPackWithoutClosestPointIsAnError) {
  for (const Surface& surface : {sphere(2), ellipsoid(2, 1, 0.7)}) {
    Pack x[3] = {pack(surface.bounding_radius), Pack{}, Pack{}};
    EXPECT_NO_THROW(surface.closest_points(x)) << surface.name;
    x[0][pack_size - 1] = 0;
    EXPECT_THROW(surface.closest_points(x), NumericsError) << surface.name;
  }
}

TEST(Surface, StatedBoundsHold) {
  for (const Surface& surface : all_surfaces()) {
    double largest_curvature = 0;
    for (const Vec3& y : random_points(surface, 3000)) {
      EXPECT_LE(y.norm(), surface.bounding_radius * (1 + 1e-12)) << surface.name;
      const auto curvatures = Eigen::SelfAdjointEigenSolver<Mat3>(surface.weingarten(y)).eigenvalues();
      largest_curvature = std::max(largest_curvature, curvatures.cwiseAbs().maxCoeff());
    }
    EXPECT_LE(largest_curvature, (1 + 1e-9) / surface.smallest_curvature_radius) << surface.name;
    EXPECT_GE(largest_curvature, 0.8 / surface.smallest_curvature_radius) << surface.name;
  }
}

TEST(Surface, NormalsAreTangentiallyConsistentWithTheWeingartenMap) {
  for (const Surface& surface : all_surfaces()) {
    for (const Vec3& y : random_points(surface, 20)) {
      const Vec3 nu = surface.normal(y);
      const Mat3 A = surface.weingarten(y);
      EXPECT_LT((A * nu).norm(), 1e-12 / surface.smallest_curvature_radius);
      const Vec3 tangent = nu.unitOrthogonal();
      const double step = 1e-5 * surface.smallest_curvature_radius;
      const Vec3 difference = (surface.normal(surface.closest_point(y + step * tangent)) -
                               surface.normal(surface.closest_point(y - step * tangent))) /
                              (2 * step);
      EXPECT_LT((difference - A * tangent).norm(), 1e-7 / surface.smallest_curvature_radius) << surface.name;
    }
  }
}

TEST(Surface, ClosestPointsOfAnEllipsoidAreThoseOfNewtonsMethodInSpace) {
  const Surface surface = ellipsoid(2, 1, 0.7);
  Surface general = surface;
  general.own_closest_point = {};
  for (const Vec3& y : random_points(surface, 200)) {
    for (double s : {-0.3, 0.0, 0.2, 5.0}) {
      const Vec3 x = y + s * surface.smallest_curvature_radius * surface.normal(y);
      EXPECT_LT((surface.closest_point(x) - general.closest_point(x)).norm(), 2e-12) << x.transpose();
    }
  }
  EXPECT_THROW(surface.closest_point(Vec3::Zero()), NumericsError);
}

TEST(Surface, FarPointsOfAnEllipsoidAreAnErrorOrOnIt) {
  const Surface surface = ellipsoid(1, 1, 0.6);
  try {
    EXPECT_NEAR(surface.level(surface.closest_point(Vec3(0, 0, 1e-9))), 0, 1e-12);
  } catch (const NumericsError& error) {
    EXPECT_NE(std::string(error.what()).find("ellipsoid"), std::string::npos);
  }
}

TEST(NamedSurface, ReadsParametersAndRefusesUnknownOnes) {
  EXPECT_EQ(named_surface({{"name", "sphere"}, {"radius", 2}}).parameters.at("radius"), 2);
  EXPECT_EQ(named_surface({{"name", "ellipsoid"}, {"axes", {1, 2, 3}}}).parameters.at("b"), 2);
  EXPECT_EQ(named_surface({{"name", "torus"}}).euler_characteristic, 0);
  EXPECT_EQ(named_surface({{"name", "dumbbell"}}).name, "dumbbell");
  EXPECT_EQ(named_surface({{"name", "perturbed_torus"}}).parameters.at("waves"), 3);
  EXPECT_EQ(named_surface({{"name", "red_blood_cell"}}).name, "red_blood_cell");
  EXPECT_EQ(named_surface({{"name", "evans_fung_cell"}}).name, "evans_fung_cell");
  EXPECT_EQ(named_surface({{"name", "angenent_torus"}, {"scale", 2}}).parameters.at("scale"), 2);
  const std::vector<std::pair<nlohmann::json, std::string>> bad = {
      {{{"name", "spere"}}, "sphere, ellipsoid, torus, dumbbell"},
      {{{"name", "sphere"}, {"radios", 2}}, "unknown key \"radios\""},
      {{{"name", "sphere"}, {"radius", -2}}, "positive number"},
      {{{"name", "ellipsoid"}, {"axes", {1, 2}}}, "3 positive numbers"},
      {{{"name", "torus"}, {"minor", 3}}, "minor < major"},
      {{{"name", "perturbed_torus"}, {"waves", 2.5}}, "waves = 2.5; expected an integer"},
      {{{"name", "perturbed_torus"}, {"waves", 0}}, "positive number"},
      {{{"name", "perturbed_torus"}, {"waves", 1e300}}, "expected an integer from 1 to"},
      {{{"name", "perturbed_torus"}, {"amplitude", 0.4}}, "minor + amplitude < major"},
      {{{"name", "perturbed_torus"}, {"minor", 0.04}}, "expected amplitude < minor"},
      {3, "names no surface"},
  };
  for (const auto& [description, expected] : bad) {
    try {
      named_surface(description);
      ADD_FAILURE() << description;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace esfem::test_surface
