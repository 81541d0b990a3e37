// SPDX-License-Identifier: GPL-3.0-or-later
// Integrands of one's own, compiled with other flags than the library, which is called from them and calls
// them: what passes between both, Packs and Eigen's objects, must look alike on both sides. Exit code 1 when
// it does not.
#include <cmath>
#include <cstdio>

#include "esfem/assembly/lifted_points.hpp"
#include "esfem/assembly/surface_space.hpp"
#include "esfem/error.hpp"
#include "esfem/mesh/mesh.hpp"
#include "esfem/mesh/read.hpp"
#include "esfem/surfaces/surface.hpp"

namespace {

using esfem::Field, esfem::Pack, esfem::PointData;

int failures = 0;

void expect_zero(const char* what, double error, double tolerance) {
  if (std::abs(error) <= tolerance) return;
  std::printf("%s: %g, expected 0 within %g\n", what, error, tolerance);
  ++failures;
}

/// Of a double, or of a Pack.
template <class T>
T formula(const T& u) {
  return esfem::exp(esfem::sin(u)) + esfem::sqrt(1.0 + u * u) * esfem::cos(u);
}

/// M u + A u, assembled by the library and as loads of the integrand (u, grad u).
void compare_loads(const esfem::SurfaceSpace& space, const Field& x) {
  const Field u = x.col(2);
  Field load;
  space.assemble_load<1, 1, 1>(
      x, u,
      [](const PointData<1>& p, esfem::Integrand<1, 1>& out) {
        out.value[0] = p.u[0];
        for (int i = 0; i < 3; ++i) out.flux[0][i] = p.grad[0][i];
      },
      load);
  esfem::SymmetricMatrix M = space.matrix(), A = space.matrix();
  space.assemble(x, M, A);
  expect_zero("loads of (u, grad u) - (M + A) u", (load - M * u - A * u).cwiseAbs().maxCoeff(), 1e-13);
}

/// The mass matrix with a weight, times one, and the load of the weight; by Packs, and by one lane after the
/// other.
void compare_weights(const esfem::SurfaceSpace& space, const Field& x) {
  const Field u = x.col(2);
  Field load;
  space.assemble_load<1, 1, 0>(
      x, u,
      [](const PointData<1>& p, esfem::Integrand<1, 0>& out) {
        out.value[0] = esfem::apply([](double value) { return formula(value); }, p.u[0]);
      },
      load);
  esfem::SymmetricMatrix weighted = space.matrix();
  space.assemble_weighted_mass<1>(
      x, u, [](const PointData<1>& p) { return formula(p.u[0]); }, weighted);
  const Field ones = Field::Ones(x.rows(), 1);
  expect_zero("weighted mass - loads", (weighted * ones - load).cwiseAbs().maxCoeff(), 1e-13);
}

/// Closest points that the library finds, and those of a surface with a formula of this program, which the
/// library calls.
void compare_closest_points(const esfem::SurfaceSpace& space, const Field& x, double radius) {
  esfem::Surface own = esfem::sphere(radius);
  own.own_closest_points = [&own](const Pack(&at)[3]) {
    esfem::SurfacePoints points;
    for (int lane = 0; lane < esfem::pack_size; ++lane) {
      const esfem::Vec3 y = own.closest_point(esfem::lane_of(at, lane));
      esfem::set_lane(points, lane, y, own.shape_at(y));
    }
    return points;
  };
  double area = 0, own_area = 0, distance = 0;
  esfem::visit_lifted_points(
      space, x, esfem::sphere(radius), [&](const esfem::Batch&, const esfem::LiftedPoints& at) {
        area += esfem::sum_of_lanes(at.dA);
        for (int lane = 0; lane < esfem::pack_size; ++lane)
          distance = std::max(distance, std::abs(esfem::lane_of(at.on_surface.y, lane).norm() - radius));
      });
  esfem::visit_lifted_points(space, x, own, [&](const esfem::Batch&, const esfem::LiftedPoints& at) {
    own_area += esfem::sum_of_lanes(at.dA);
  });
  expect_zero("closest points: distance from the sphere", distance, 1e-13 * radius);
  expect_zero("area of the lifted elements, by the library and by this program", area / own_area - 1, 1e-12);
  expect_zero("area of the lifted elements - 4 pi R²", area / (4 * M_PI * radius * radius) - 1, 1e-5);
}

void catch_error() {
  try {
    esfem::read_mesh("no such file.msh");
    expect_zero("an error that was not thrown", 1, 0);
  } catch (const esfem::InputError&) {
  }
}

}  // namespace

int main() {
  const double radius = 1.5;
  esfem::Mesh mesh = esfem::lagrange_mesh(esfem::icosphere(radius, 2), 2);
  esfem::project_nodes(mesh, esfem::sphere(radius));
  const esfem::SurfaceSpace space(mesh);
  compare_loads(space, mesh.nodes);
  compare_weights(space, mesh.nodes);
  compare_closest_points(space, mesh.nodes, radius);
  catch_error();
  return failures > 0;
}
