// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/surfaces/formula_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/formulas/formula.hpp"
#include "solver/surfaces/sign_grid.hpp"

namespace esfem {
namespace {

/// A function d(x, y, z) with its partial derivatives up to an order.
class Partials {
 public:
  Partials(const Formula& d, int order) {
    std::vector<Formula> formulas;
    for (int sum = 0; sum <= order; ++sum)
      for (int i = 0; i <= sum; ++i)
        for (int j = 0; i + j <= sum; ++j) {
          const int k = sum - i - j;
          place_[i][j][k] = int(formulas.size());
          formulas.push_back(sum == 0 ? d
                             : i > 0  ? formulas[place_[i - 1][j][k]].derivative("x")
                             : j > 0  ? formulas[place_[i][j - 1][k]].derivative("y")
                                      : formulas[place_[i][j][k - 1]].derivative("z"));
        }
    compiled_ = CompiledFormulas(formulas);
    values_.resize(formulas.size());
  }

  /// d at a point as a number, a Jet, a Jet of Jets, ..: the innermost numbers are the partial derivatives.
  template <class T>
  T at(const double (&point)[3]) const {
    compiled_.evaluate(point, values_.data());
    return jet<T>({0, 0, 0});
  }

 private:
  template <class T>
  T jet(const std::array<int, 3>& order) const {
    if constexpr (std::is_same_v<T, double>) {
      return values_[place_[order[0]][order[1]][order[2]]];
    } else {
      using Inner = std::decay_t<decltype(T().a)>;
      T result;
      result.a = jet<Inner>(order);
      for (int i = 0; i < 3; ++i) {
        std::array<int, 3> higher = order;
        ++higher[i];
        result.v[i] = jet<Inner>(higher);
      }
      return result;
    }
  }

  int place_[5][5][5];
  CompiledFormulas compiled_;
  mutable std::vector<double> values_;
};

double number(double x) {
  return x;
}
template <class T>
double number(const ceres::Jet<T, 3>& x) {
  return number(x.a);
}

template <class T>
constexpr int depth = 0;
template <class T>
constexpr int depth<ceres::Jet<T, 3>> = 1 + depth<T>;

/// The functor of make_surface: its arguments are always the coordinates in space, as numbers or as Jets.
class FormulaLevelSet {
 public:
  explicit FormulaLevelSet(const Formula& d) : shared_(std::make_shared<Shared>(Shared{d, {}})) {}

  template <class T>
  T operator()(const T& x, const T& y, const T& z) const {
    static_assert(depth<T> == 0 || depth<T> == 2 || depth<T> == 4);
    const double point[] = {number(x), number(y), number(z)};
    std::optional<Partials>& partials = shared_->partials[depth<T> / 2];
    if (!partials) partials.emplace(shared_->d, depth<T>);
    return partials->template at<T>(point);
  }

 private:
  struct Shared {
    Formula d;
    std::optional<Partials> partials[3];  ///< up to order 0, 2, 4; made when they are needed
  };
  std::shared_ptr<Shared> shared_;
};

/// A point of the surface near y, by Newton's method along the gradient; nothing if it leads away, or
/// converges as slowly as to a multiple zero.
std::optional<Vec3> projected(const Surface& surface, Vec3 y, double reach) {
  const Vec3 start = y;
  for (int iteration = 0; iteration < 50; ++iteration) {
    const LevelSetJet d = surface.level_set(y);
    const Vec3 step = d.value / d.gradient.squaredNorm() * d.gradient;
    y -= step;
    if (!((y - start).norm() < reach)) return {};
    if (step.norm() <= 1e-13 * reach) return y;
  }
  return {};
}

/// Points of the surface, one near each edge of the grid that it crosses.
std::vector<Vec3> surface_points(const Surface& surface, const SignGrid& grid, const std::string& where) {
  std::vector<Vec3> points;
  grid.visit([&](const SignGrid::Index& index) {
    for (int i = 0; i < 3; ++i) {
      SignGrid::Index next = index;
      ++next[i];
      if (!grid.contains(next) || grid.is_inside(index) == grid.is_inside(next)) continue;
      const Vec3 middle = (grid.point(index) + grid.point(next)) / 2;
      if (const auto y = projected(surface, middle, 4 * grid.cell()))
        points.push_back(*y);
      else
        throw InputError(where + format(": near (%g, %g, %g) d changes its sign without a smooth zero; "
                                        "expected a gradient that is not zero on the surface",
                                        middle[0], middle[1], middle[2]));
    }
  });
  return points;
}

/// The greatest curvature that a search on the surface finds from y: it goes to the best of eight points
/// around, or closer.
double highest_curvature(const Surface& surface, Vec3 y, double step) {
  double best = surface.largest_curvature(y);
  const double smallest_step = 1e-9 * step, reach = 4 * step;
  while (step > smallest_step) {
    const Vec3 normal = surface.normal(y), one = normal.unitOrthogonal(), other = normal.cross(one);
    Vec3 next = y;
    for (int k = 0; k < 8; ++k) {
      const double angle = k * pi / 4;
      const auto candidate =
          projected(surface, y + step * (std::cos(angle) * one + std::sin(angle) * other), reach);
      if (!candidate) continue;
      const double curvature = surface.largest_curvature(*candidate);
      if (curvature > best) {
        best = curvature;
        next = *candidate;
      }
    }
    if (next == y)
      step /= 2;
    else
      y = next;
  }
  return best;
}

InputError not_smooth(const Vec3& y, const std::string& where) {
  return InputError(where +
                    format(": the surface has an edge or crosses itself near (%g, %g, %g); expected a "
                           "smooth one",
                           y[0], y[1], y[2]));
}

double smallest_curvature_radius(const Surface& surface, const std::vector<Vec3>& points, double cell,
                                 const std::string& where) {
  std::vector<std::pair<double, Vec3>> ranked;
  for (const Vec3& y : points) ranked.emplace_back(surface.largest_curvature(y), y);
  const std::size_t count = std::min<std::size_t>(ranked.size(), 10);
  std::partial_sort(ranked.begin(), ranked.begin() + count, ranked.end(),
                    [](const auto& a, const auto& b) { return a.first > b.first; });
  double highest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [curvature, y] = ranked[i];
    const double found = std::isfinite(curvature) ? highest_curvature(surface, y, cell / 4) : curvature;
    if (!(found * cell < 1e3)) throw not_smooth(y, where);
    highest = std::max(highest, found);
  }
  return 1 / highest;
}

/// Between points of a smooth surface the normal turns by at most the greatest curvature times their
/// distance; at an edge it jumps.
void check_normals(const Surface& surface, const std::vector<Vec3>& points, double cell,
                   const std::string& where) {
  for (const Vec3& y : points) {
    const Vec3 normal = surface.normal(y);
    const Vec3 along = cell * normal.unitOrthogonal(), across = normal.cross(along);
    for (const Vec3& step : {along, across}) {
      const auto next = projected(surface, y + step, 4 * cell);
      if (!next) throw not_smooth(y, where);
      const double turn = (surface.normal(*next) - normal).norm();
      // Twice: the way along the surface is longer.
      if (turn > 1e-6 + 2 * (*next - y).norm() / surface.smallest_curvature_radius)
        throw not_smooth(y, where);
    }
  }
}

void check_box(const Box& box, const std::string& where) {
  const Vec3 size = box.high - box.low;
  if (size.allFinite() && size.minCoeff() > 0) return;
  throw InputError(where + format(": the box from (%g, %g, %g) to (%g, %g, %g) is empty; expected "
                                  "[[x, y, z], [x, y, z]], first the smaller coordinates",
                                  box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]));
}

}  // namespace

Surface formula_surface(const std::string& level_set, const Box& box,
                        const std::map<std::string, double>& constants, const std::string& where,
                        const std::map<std::string, std::string>& definitions) {
  const Formula d(level_set, {{"x", "y", "z"}, constants, definitions}, where);
  check_box(box, where);
  try {
    const SignGrid grid = resolving_grid(d, box, where);
    Surface surface =
        make_surface("level set", FormulaLevelSet(d), 0, 1, grid.euler_characteristic(), constants);
    surface.components = grid.components();
    const std::vector<Vec3> points = surface_points(surface, grid, where);
    Vec3 low = points[0], high = points[0];
    for (const Vec3& y : points) {
      low = low.cwiseMin(y);
      high = high.cwiseMax(y);
    }
    surface.centre = (low + high) / 2;
    for (const Vec3& y : points)
      surface.bounding_radius = std::max(surface.bounding_radius, (y - surface.centre).norm());
    surface.bounding_radius += grid.cell();
    surface.smallest_curvature_radius = smallest_curvature_radius(surface, points, grid.cell(), where);
    check_normals(surface, points, grid.cell(), where);
    surface.level = [inside = surface.level, box](const Vec3& y) {
      const bool is_in_box = (y - box.low).minCoeff() >= 0 && (box.high - y).minCoeff() >= 0;
      return is_in_box ? inside(y) : 1.0;  // other zeros of d are no part of the surface
    };
    return surface;
  } catch (const NumericsError& error) {
    throw InputError(error.what());
  }
}

}  // namespace esfem
