// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/coupled_diffusion.hpp"

namespace esfem {

/// The tumour growth model of the literature (Barreira, Elliott, Madzvamuse, J. Math. Biol. 63,
/// 2011): an activator u_1 and a substrate u_2 with Schnakenberg's kinetics on a surface that grows where
/// there is activator,
///   f_1 = gamma (a - u_1 + u_1² u_2),  f_2 = gamma (b - u_1² u_2),  g = delta u_1,
/// with diffusion 1 and D and the regularised law v - alpha Lap v + epsilon H nu = g nu (epsilon is beta of
/// the flow).
class TumourGrowth {
 public:
  /// Of a Problem of CoupledDiffusion: activator and substrate.
  static constexpr int species = 2;

  /// The parameters of f and g, all positive.
  struct Kinetics {
    double a = 0.1;      ///< supply of activator
    double b = 0.9;      ///< supply of substrate
    double gamma = 30;   ///< the size of the tumour
    double delta = 0.4;  ///< growth per activator
  };

  /// Throws InputError unless all are positive.
  explicit TumourGrowth(const Kinetics& kinetics);

  /// f_1 and f_2.
  void f(double, const PointData<2>& p, Pack (&out)[2]) const {
    const Pack reaction = p.u[0] * p.u[0] * p.u[1];
    out[0] = kinetics_.gamma * (kinetics_.a - p.u[0] + reaction);
    out[1] = kinetics_.gamma * (kinetics_.b - reaction);
  }

  /// delta u_1.
  Pack g(double, const PointData<2>& p) const { return kinetics_.delta * p.u[0]; }

  /// The spatially homogeneous steady state: u_1 = a + b, u_2 = b/(a + b)², where f_1 = f_2 = 0. It is
  /// unstable for D = 10.
  static Eigen::RowVector2d steady_state(const Kinetics& kinetics);

 private:
  Kinetics kinetics_;
};

/// alpha = 1, beta = epsilon = 0.01, diffusion 1 and 10.
CoupledDiffusionParameters tumour_growth_parameters();

/// The steady state on nodes x, disturbed by plane waves of up to `disturbance` of itself, in units of the
/// space's length from `origin`, and v = 0; t = 0.
CoupledDiffusionState tumour_growth_state(const SurfaceSpace& space, const Field& x,
                                          const TumourGrowth::Kinetics& kinetics, double disturbance = 0.01,
                                          unsigned seed = 1, const Vec3& origin = Vec3::Zero());

}  // namespace esfem
