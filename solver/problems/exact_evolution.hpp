// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "solver/problems/exact_evolution.hpp"
#include "solver/surfaces/surface.hpp"
#include "solver/types.hpp"

namespace esfem {

/// Values and tangential gradients of components in pack_size points of a surface: gradient[l][i] is the i-th
/// coordinate of that of component l.
struct FieldsAtPoints {
  std::vector<Pack> value;                    ///< one a component
  std::vector<std::array<Pack, 3>> gradient;  ///< one a component

  /// Of so many components, with values that are not set.
  explicit FieldsAtPoints(int components) : value(components), gradient(components) {}
};

/// A known exact solution of a flow: the surface, the trajectories of its material points, and the solution's
/// fields.
struct ExactEvolution {
  /// A quantity of the error tables and its number of components.
  struct Quantity {
    std::string name;  ///< "x", "nu": of a nodal field of the flow
    int components;    ///< 1 of a scalar, 3 of a vector
  };
  std::vector<Quantity> quantities;          ///< in the order of the columns of `nodal_values`
  std::function<Surface(double t)> surface;  ///< at time t

  /// Positions at time t of the points that start at x0 (N x 3).
  std::function<Field(const Field& x0, double t)> trajectories;
  /// In points of the surface at time t: the components, all quantities side by side.
  std::function<void(double t, const SurfacePoints& at, FieldsAtPoints& out)> fields;

  /// Of all quantities together: the number of columns of `nodal_values`.
  int components() const;
  /// The first column of a quantity. Throws InputError when there is none of this name.
  int column(const std::string& quantity) const;
  /// Values of all components in points x of the surface at time t: N x components.
  Field nodal_values(const Field& x, double t) const;
};

/// A sphere of radius R(t) whose points move along its normals with the speed R'(t) = outward_speed(R).
/// Quantities x, v, nu and a scalar that is constant on the sphere.
ExactEvolution round_sphere(const std::function<double(double t)>& radius,
                            const std::function<double(double R)>& outward_speed, const std::string& scalar,
                            const std::function<double(double R)>& scalar_of);

/// kll19 §13.1: a sphere of radius R_0 under mean curvature flow, R(t) = sqrt(R_0² - 4t) for t < R_0²/4.
/// Quantities x, v = -H nu, nu, H.
ExactEvolution shrinking_sphere(double initial_radius);

/// The self-shrinking torus (surfaces/angenent_torus.hpp) under mean curvature flow: its scale is sqrt(s² -
/// t), s = initial_scale, for 0 <= t < s². Quantities x, v = -H nu, nu, H with H = <x, nu>/(2(s² - t)). The
/// initial positions of trajectories must lie on the torus.
ExactEvolution shrinking_angenent_torus(double initial_scale = 1);

/// The same torus with the velocity of minimal deformation rate: v = -x/(2(s² - t)), by which it shrinks as a
/// whole. Its normal part is -H, and -Lap x = H nu gives -Lap v = -H/(2(s² - t)) nu, a multiple of nu
/// (flows/minimal_deformation.hpp). Trajectories are straight lines to the centre, for 0 <= t < s².
ExactEvolution homothetic_angenent_torus(double initial_scale = 1);

/// A sphere at rest, stationary under Willmore flow and surface diffusion (kll21 §7.1). Quantities x, nu, H.
ExactEvolution stationary_sphere(double radius);

/// A torus at rest: the Clifford torus, major = sqrt(2) minor, under Willmore flow (kll21 §7.3). Quantities
/// x, nu, H = 2/minor - major/(minor rho), rho the distance from the x3 axis.
ExactEvolution stationary_torus(double major, double minor);

}  // namespace esfem
