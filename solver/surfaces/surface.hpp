// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "solver/pack.hpp"
#include "solver/surfaces/nested_jets.hpp"
#include "solver/types.hpp"

namespace esfem {

/// Value, gradient and Hessian of a level set function at a point.
struct LevelSetJet {
  double value;   ///< of the function itself
  Vec3 gradient;  ///< in space
  Mat3 hessian;   ///< in space; symmetric
};

/// pack_size points of a surface at once, with the normals and Weingarten maps there.
struct SurfacePoints {
  Pack y[3];              ///< positions
  Pack normal[3];         ///< outward, of length 1
  Pack weingarten[3][3];  ///< as Surface::weingarten

  /// Entry of P = I - nu nu^T.
  [[gnu::always_inline]] Pack projection(int i, int j) const {
    return (i == j ? 1.0 : 0.0) - normal[i] * normal[j];
  }
};

/// The vector of one lane.
inline Vec3 lane_of(const Pack (&x)[3], int lane) {
  return {x[0][lane], x[1][lane], x[2][lane]};
}

/// A smooth closed surface {d = 0} with d < 0 inside, so that nu = grad d/|grad d| points outward.
struct Surface {
  std::string name;                                   ///< "sphere", "torus": which formula it is
  std::map<std::string, double> parameters;           ///< of its formula, under their names
  std::function<LevelSetJet(const Vec3&)> level_set;  ///< d with its derivatives, in points of space
  std::function<double(const Vec3&)> level;           ///< d alone (cheaper; for the mesher)
  double bounding_radius;                             ///< the surface lies inside this ball around `centre`
  double smallest_curvature_radius;                   ///< min over the surface of 1/max(|kappa_1|, |kappa_2|)
  int euler_characteristic;  ///< of all components together; 2 of a sphere, 0 of a torus

  /// This surface's own way to the closest point, where there is one (a closed form); otherwise Newton's
  /// method in space finds it.
  std::function<Vec3(const Vec3&)> own_closest_point = {};
  /// The mean curvature div(grad d/|grad d|) of the level set through y as a function of space.
  std::function<LevelSetJet(const Vec3&)> mean_curvature_jet = {};
  /// This surface's own way to pack_size closest points, where it is faster than one after the other; not
  /// finite where it fails.
  std::function<SurfacePoints(const Pack (&x)[3])> own_closest_points = {};
  Vec3 centre = Vec3::Zero();  ///< of the bounding ball
  int components = 1;          ///< how many connected parts it has

  /// Outward unit normal of the level set through y. Pointwise; y need not lie on the surface.
  Vec3 normal(const Vec3& y) const;
  /// Extended Weingarten map grad_Gamma nu = P (Hess d) P / |grad d| of the level set through y; symmetric, A
  /// nu = 0.
  Mat3 weingarten(const Vec3& y) const;
  /// Mean curvature kappa_1 + kappa_2 = tr grad_Gamma nu (kll19 (2.2)); 2/R on a sphere.
  double mean_curvature(const Vec3& y) const;
  /// max |kappa_i|.
  double largest_curvature(const Vec3& y) const;
  /// Tangential gradient grad_Gamma H. y must lie on the surface.
  Vec3 mean_curvature_gradient(const Vec3& y) const;
  /// Delta_Gamma H = tr(P Hess H) - H nu . grad H, for any extension of H into space. y must lie on the
  /// surface.
  double mean_curvature_laplacian(const Vec3& y) const;
  /// What `normal` and `weingarten` are in one point.
  struct Shape {
    Vec3 normal;      ///< outward, of length 1
    Mat3 weingarten;  ///< extended: 3 x 3
  };
  /// Normal and Weingarten map from one evaluation of the level set.
  Shape shape_at(const Vec3& y) const;
  /// The closest point of the surface, to 1e-12 of the bounding radius, for x near it (within the reach).
  /// Throws NumericsError when Newton's iteration does not converge.
  Vec3 closest_point(const Vec3& x) const;
  /// The closest points of pack_size points with their normals and Weingarten maps, as closest_point and
  /// shape_at have them one by one.
  SurfacePoints closest_points(const Pack (&x)[3]) const;
};

/// Fills in one lane: the point y of a surface, and its shape there.
void set_lane(SurfacePoints& points, int lane, const Vec3& y, const Surface::Shape& shape);

/// A number with its gradient in space.
template <class T>
using SpaceJet = ceres::Jet<T, 3>;

/// f and its first two derivatives in the point x, as a Jet of Jets over the scalar of x.
template <class T, class Function>
SpaceJet<SpaceJet<T>> second_jet(const Function& f, const std::array<T, 3>& x) {
  const T one = ceres::FromDouble<T>::make(1.0);
  std::array<SpaceJet<SpaceJet<T>>, 3> arguments;
  for (int i = 0; i < 3; ++i) {
    SpaceJet<T> inner(x[i]);
    inner.v[i] = one;
    arguments[i] = SpaceJet<SpaceJet<T>>(inner);
    arguments[i].v[i] = SpaceJet<T>(one);
  }
  return f(arguments[0], arguments[1], arguments[2]);
}

/// The same for f in space, as numbers.
template <class Function>
LevelSetJet level_set_jet(const Function& f, const Vec3& y) {
  const auto jet = second_jet<double>(f, {y[0], y[1], y[2]});
  LevelSetJet result;
  result.value = jet.a.a;
  for (int i = 0; i < 3; ++i) {
    result.gradient[i] = jet.v[i].a;
    for (int j = 0; j < 3; ++j) result.hessian(i, j) = jet.v[i].v[j];
  }
  return result;
}

/// Mean curvature div(grad d/|grad d|) = (Delta d - n . (Hess d) n)/|grad d|, n = grad d/|grad d|, of the
/// level set through x.
template <class T, class LevelSet>
T level_set_mean_curvature(const LevelSet& d, const std::array<T, 3>& x) {
  const auto jet = second_jet<T>(d, x);
  T squared_slope = jet.v[0].a * jet.v[0].a;
  T laplacian = jet.v[0].v[0], along_gradient = ceres::FromDouble<T>::make(0.0);
  for (int i = 1; i < 3; ++i) {
    squared_slope = squared_slope + jet.v[i].a * jet.v[i].a;
    laplacian = laplacian + jet.v[i].v[i];
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) along_gradient = along_gradient + jet.v[i].a * jet.v[i].v[j] * jet.v[j].a;
  return (laplacian - along_gradient / squared_slope) / sqrt(squared_slope);
}

/// Delta_Gamma f = Delta f - n . (Hess f) n - H n . grad f in the point x of the level set of d through it,
/// for f given in space.
template <class T, class LevelSet, class Function>
T surface_laplacian(const LevelSet& d, const Function& f, const std::array<T, 3>& x) {
  const auto slope = second_jet<T>(d, x);
  const auto jet = second_jet<T>(f, x);
  T squared_slope = slope.v[0].a * slope.v[0].a;
  T laplacian = jet.v[0].v[0], along_slope = slope.v[0].a * jet.v[0].a;
  for (int i = 1; i < 3; ++i) {
    squared_slope = squared_slope + slope.v[i].a * slope.v[i].a;
    laplacian = laplacian + jet.v[i].v[i];
    along_slope = along_slope + slope.v[i].a * jet.v[i].a;
  }
  T twice_along_slope = ceres::FromDouble<T>::make(0.0);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      twice_along_slope = twice_along_slope + slope.v[i].a * jet.v[i].v[j] * slope.v[j].a;
  return laplacian - twice_along_slope / squared_slope -
         level_set_mean_curvature<T>(d, x) * along_slope / sqrt(squared_slope);
}

/// A surface from a functor with `template <class T> T operator()(const T& x1, const T& x2, const T& x3)
/// const`: all derivatives come from Ceres Jets, so only the formula of d (made of + - * / sqrt) is needed.
template <class LevelSet>
Surface make_surface(std::string name, LevelSet d, double bounding_radius, double smallest_curvature_radius,
                     int euler_characteristic, std::map<std::string, double> parameters = {}) {
  Surface surface = {std::move(name),
                     std::move(parameters),
                     [d](const Vec3& y) { return level_set_jet(d, y); },
                     [d](const Vec3& y) { return d(y[0], y[1], y[2]); },
                     bounding_radius,
                     smallest_curvature_radius,
                     euler_characteristic};
  surface.mean_curvature_jet = [d](const Vec3& y) {
    return level_set_jet(
        [&d](const auto& x1, const auto& x2, const auto& x3) {
          return level_set_mean_curvature<std::decay_t<decltype(x1)>>(d, {x1, x2, x3});
        },
        y);
  };
  return surface;
}

/// {|x| = radius}
Surface sphere(double radius);
/// {x1²/a² + x2²/b² + x3²/c² = 1}
Surface ellipsoid(double a, double b, double c);
/// Torus around the x3 axis: tube of radius minor around a circle of radius major > minor.
Surface torus(double major, double minor);
/// kll19 §13.2: d = x1² + x2² + 2 x3² (x3² - 199/200) - 0.04
Surface dumbbell();
/// Torus around the x3 axis whose tube has the radius minor + amplitude cos(waves u), u the angle around the
/// axis: {(rho - major)² + x3² = (tube radius)²}, rho² = x1² + x2². |grad d| is about 1. amplitude < minor,
/// minor + amplitude < major.
Surface perturbed_torus(double major, double minor, double amplitude, int waves);
/// {x3² = s (1 - 0.7 s²)², s = 1 - (x1² + x2²)/4}: the biconcave surface (2 cos p cos t, 2 cos p sin t,
/// (1 - 0.7 (cos² p - 1)²) sin p).
Surface red_blood_cell();
/// The resting red blood cell that Evans & Fung (Microvasc. Res. 4, 1972) measured, with equatorial radius 1:
/// x3 = ±(1/2) sqrt(1 - s) (C0 + C2 s + C4 s²), s = x1² + x2².
Surface evans_fung_cell();

}  // namespace esfem
