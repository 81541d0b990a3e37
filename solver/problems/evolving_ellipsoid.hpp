// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/cahn_hilliard.hpp"
#include "solver/geometry/prescribed_motion.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/surfaces/surface.hpp"

namespace esfem {

/// bk22 (9.2): {x1²/a(t) + x2² + x3² = radius²}, a(t) = 1 + amplitude sin(2 pi t/period), which moves by v =
/// V nu.
struct EvolvingEllipsoid {
  double amplitude = 0.25;  ///< below 1 in size, so that a > 0
  double period = 1;        ///< in time
  double radius = 1;        ///< of the sphere at t = 0

  /// The square of the half axis along x1, over that of the others.
  double a(double t) const;
  /// Its derivative.
  double a_t(double t) const;
  /// The surface at time t.
  Surface surface(double t) const;
  /// v = V nu, by which the material points move.
  Velocity velocity() const;
  /// The velocity (a'/(2a) x1, 0, 0), which moves the same surface: nodes that start on the sphere stay its
  /// image under a linear map.
  Velocity stretching_velocity() const;
};

/// bk22 §9: u = exp(-6t) x1 x2 on this ellipsoid, w from the second equation and b from the first one of
/// (9.1), with f = 0 and g of the double-well potential. Lap u is in closed form, what follows by automatic
/// differentiation.
class ManufacturedCahnHilliard {
 public:
  /// epsilon: that of the flow, positive.
  ManufacturedCahnHilliard(EvolvingEllipsoid ellipsoid, double epsilon)
      : ellipsoid_(ellipsoid), epsilon_(epsilon) {}

  /// In a point of the surface at time t.
  /// @{
  double u(const Vec3& x, double t) const;
  double w(const Vec3& x, double t) const;
  double b(const Vec3& x, double t) const;
  /// @}

  /// Tangential gradients.
  /// @{
  Vec3 gradient_of_u(const Vec3& x, double t) const;
  Vec3 gradient_of_w(const Vec3& x, double t) const;
  /// @}

  /// The Problem of CahnHilliard: b is interpolated in the nodes.
  struct Problem : DoubleWell {
    const ManufacturedCahnHilliard* exact;  ///< must outlive the flow

    /// b in the nodes x, N x 1.
    void b(double t, const Field& x, Field& nodal) const;
  };
  /// The surface.
  const EvolvingEllipsoid& ellipsoid() const { return ellipsoid_; }
  /// Of the flow that it solves.
  double epsilon() const { return epsilon_; }
  /// The Problem that it solves; this object must outlive it.
  Problem problem() const {
    Problem problem;
    problem.exact = this;
    return problem;
  }

 private:
  EvolvingEllipsoid ellipsoid_;
  double epsilon_;
};

/// Its quantities u and w on nodes that move from their initial positions. Both must outlive it.
ExactEvolution exact_evolution(const ManufacturedCahnHilliard& exact, MovingNodes& nodes);

/// The starting values of bk22 §9: nodal interpolation of u and w, or their Ritz maps (5.4).
enum class StartValues { interpolation, ritz };
/// The state with these values of u and w on nodes x at time t, and Mu.
CahnHilliardState exact_cahn_hilliard_state(const SurfaceSpace& space, const ManufacturedCahnHilliard& exact,
                                            Field x, double t, StartValues values);

}  // namespace esfem
