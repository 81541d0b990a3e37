// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/sides.hpp"

namespace esfem {

namespace {

/// The corner triangle of an element.
struct Triangle {
  Vec3 a, b, c;
};

Triangle triangle(const Mesh& mesh, int e) {
  return {mesh.nodes.row(mesh.elements(e, 0)), mesh.nodes.row(mesh.elements(e, 1)),
          mesh.nodes.row(mesh.elements(e, 2))};
}

/// A connected part of a surface, consistently oriented.
struct Component {
  std::vector<int> elements;
  double volume = 0, area = 0;  ///< the volume with the sign of the orientation
  Eigen::AlignedBox3d box;
};

/// The elements that are reached from e; marks in `against` those with the other orientation than e, and all
/// in `reached`.
std::vector<int> reach(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin, int e,
                       std::vector<bool>& reached, std::vector<bool>& against) {
  std::vector<int> elements{e};
  reached[e] = true;
  for (std::size_t k = 0; k < elements.size(); ++k)
    for (int side = 3 * elements[k]; side < 3 * elements[k] + 3; ++side) {
      const int other = twin[side] / 3;
      const bool differ = side_corner(mesh.elements, side, 0) == side_corner(mesh.elements, twin[side], 0);
      const bool expected = against[elements[k]] != differ;
      if (!reached[other]) {
        reached[other] = true;
        against[other] = expected;
        elements.push_back(other);
      } else if (against[other] != expected) {
        throw InputError(origin.source + ": " + origin.element(other) +
                         ": not orientable, a path on the surface "
                         "that ends at " +
                         origin.element(elements[k]) +
                         " returns on the other side (as on a Möbius strip or a Klein bottle), a surface "
                         "with an inside expected");
      }
    }
  return elements;
}

void measure(const Mesh& mesh, const std::vector<bool>& against, Component& component) {
  const Vec3 origin = triangle(mesh, component.elements[0]).a;
  for (int e : component.elements) {
    const auto [a, b, c] = triangle(mesh, e);
    const double sign = against[e] ? -1 : 1;
    component.volume += sign * (a - origin).dot((b - origin).cross(c - origin)) / 6;
    component.area += 0.5 * (b - a).cross(c - a).norm();
    for (const Vec3& x : {a, b, c}) component.box.extend(x);
  }
}

/// The components; afterwards `against` marks the elements that must be turned to follow most of the others.
std::vector<Component> components_of(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin,
                                     std::vector<bool>& against) {
  std::vector<Component> components;
  std::vector<bool> reached(mesh.elements.rows(), false);
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    if (reached[e]) continue;
    Component component;
    component.elements = reach(mesh, origin, twin, e, reached, against);
    const auto differ = std::count_if(component.elements.begin(), component.elements.end(),
                                      [&against](int i) { return against[i]; });
    if (2 * differ > long(component.elements.size()))
      for (int i : component.elements) against[i] = !against[i];
    measure(mesh, against, component);
    if (!(std::abs(component.volume) > 1e-10 * std::pow(component.area, 1.5)))
      throw InputError(
          format("%s: %s: its component has the volume %g and the area %g (pressed flat?), a "
                 "surface with an inside expected",
                 origin.source.c_str(), origin.element(e).c_str(), component.volume, component.area));
    components.push_back(std::move(component));
  }
  return components;
}

/// How often the component goes round a point: the sum of the solid angles over 4 pi [Van Oosterom,
/// Strackee. The Solid Angle of a Plane Triangle. 1983].
double winding_number(const Mesh& mesh, const std::vector<bool>& against, const Component& component,
                      const Vec3& x) {
  double angle = 0;
  for (int e : component.elements) {
    auto [a, b, c] = triangle(mesh, e);
    for (Vec3* corner : {&a, &b, &c}) *corner = (*corner - x).normalized();
    const double half = std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
    angle += against[e] ? -half : half;
  }
  return angle / (2 * pi);
}

/// Which components must be turned.
std::vector<bool> turned_components(const Mesh& mesh, const std::vector<bool>& against,
                                    const std::vector<Component>& components) {
  const auto inward = [](const Component& c) { return c.volume < 0; };
  if (std::none_of(components.begin(), components.end(), inward))
    return std::vector<bool>(components.size(), false);
  if (std::all_of(components.begin(), components.end(), inward))
    return std::vector<bool>(components.size(), true);
  std::vector<int> by_volume(components.size());
  std::iota(by_volume.begin(), by_volume.end(), 0);
  std::stable_sort(by_volume.begin(), by_volume.end(), [&components](int i, int j) {
    return std::abs(components[i].volume) > std::abs(components[j].volume);
  });
  std::vector<bool> turned(components.size());
  for (std::size_t k = 0; k < by_volume.size(); ++k) {
    const Component& component = components[by_volume[k]];
    const Vec3 x = triangle(mesh, component.elements[0]).a;
    // The largest one around it lies in no other.
    const auto around = std::find_if(by_volume.begin(), by_volume.begin() + long(k), [&](int i) {
      return components[i].box.contains(component.box) &&
             std::abs(winding_number(mesh, against, components[i], x)) > 0.5;
    });
    turned[by_volume[k]] = around == by_volume.begin() + long(k) ? component.volume < 0 : turned[*around];
  }
  return turned;
}

/// Swaps the second and the third corner of the marked elements, and all other nodes with them.
void turn_elements(Mesh& mesh, const std::vector<bool>& turned) {
  const int on_edge = mesh.degree - 1, inner = 3 + 3 * on_edge;
  std::vector<int> from{0, 2, 1};
  for (int edge : {2, 1, 0})
    for (int i = on_edge - 1; i >= 0; --i) from.push_back(3 + edge * on_edge + i);
  const int count = int(mesh.elements.cols()) - inner;
  if (count == 1) from.push_back(inner);
  if (count == 3) from.insert(from.end(), {inner, inner + 2, inner + 1});
  for (int e = 0; e < mesh.elements.rows(); ++e)
    if (turned[e]) {
      const Eigen::RowVectorXi element = mesh.elements(e, from);
      mesh.elements.row(e) = element;
    }
}

}  // namespace

std::string orient(Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin) {
  std::vector<bool> turned(mesh.elements.rows(), false);
  const std::vector<Component> components = components_of(mesh, origin, twin, turned);
  const auto against = std::count(turned.begin(), turned.end(), true);
  const std::vector<bool> inward = turned_components(mesh, turned, components);
  for (std::size_t i = 0; i < components.size(); ++i)
    if (inward[i])
      for (int e : components[i].elements) turned[e] = !turned[e];
  turn_elements(mesh, turned);

  std::string remark;
  const auto add = [&remark](const std::string& text) { remark += (remark.empty() ? "" : "; ") + text; };
  if (components.size() > 1) add(format("%zu components", components.size()));
  if (against > 0)
    add(format("%ld element%s oriented against the others: turned", long(against), against > 1 ? "s" : ""));
  if (const auto n = std::count(inward.begin(), inward.end(), true); n > 0)
    add(components.size() == 1
            ? "orientation was inward: turned"
            : format("orientation of %ld component%s inward: turned", long(n), n > 1 ? "s were" : " was"));
  return remark;
}

}  // namespace esfem
