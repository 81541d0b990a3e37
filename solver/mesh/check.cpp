// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/mesh_file.hpp"

namespace esfem {

namespace {

std::string label(const char* kind, int i, const std::vector<long>& tags, const std::vector<int>& lines) {
  std::string text = format("%s %ld", kind, tags.empty() ? long(i) + 1 : tags[i]);
  if (!lines.empty())
    text += format(" (line %d)", lines[i]);
  else
    text += " (counted from 1)";
  return text;
}

[[noreturn]] void fail(const MeshOrigin& origin, const std::string& where, const std::string& what) {
  throw InputError(origin.source + ": " + where + ": " + what);
}

void check_nodes(const Mesh& mesh, const MeshOrigin& origin) {
  for (int i = 0; i < mesh.nodes.rows(); ++i)
    if (!mesh.nodes.row(i).allFinite())
      fail(origin, origin.node(i),
           format("coordinates (%g, %g, %g), finite numbers expected", mesh.nodes(i, 0), mesh.nodes(i, 1),
                  mesh.nodes(i, 2)));
}

void check_elements(const Mesh& mesh, const MeshOrigin& origin) {
  const int n = int(mesh.nodes.rows());
  std::vector<bool> used(n, false);
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    for (int i = 0; i < mesh.elements.cols(); ++i) {
      const int node = mesh.elements(e, i);
      if (node < 0 || node >= n)
        fail(origin, origin.element(e), format("node number out of range, 1 to %d expected", n));
      for (int j = 0; j < i; ++j)
        if (mesh.elements(e, j) == node)
          fail(origin, origin.element(e),
               "degenerate, it has " + origin.node(node) + " twice, distinct nodes expected");
      used[node] = true;
    }
    const Vec3 a = mesh.nodes.row(mesh.elements(e, 0)), b = mesh.nodes.row(mesh.elements(e, 1)),
               c = mesh.nodes.row(mesh.elements(e, 2));
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double area = 0.5 * (b - a).cross(c - a).norm();
    // Round-off of collinear points is near 1e-16; no triangle that can be computed with is near 1e-10.
    if (!(area > 1e-10 * longest * longest))
      fail(origin, origin.element(e), format("degenerate, its area is %g, a positive area expected", area));
  }
  for (int i = 0; i < n; ++i)
    if (!used[i]) fail(origin, origin.node(i), "in no element, every node in at least one expected");
}

void check_duplicates(const Mesh& mesh, const MeshOrigin& origin) {
  std::vector<std::array<int, 4>> triangles(mesh.elements.rows());
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    triangles[e] = {mesh.elements(e, 0), mesh.elements(e, 1), mesh.elements(e, 2), e};
    std::sort(triangles[e].begin(), triangles[e].begin() + 3);
  }
  std::sort(triangles.begin(), triangles.end());
  for (std::size_t k = 1; k < triangles.size(); ++k)
    if (std::equal(triangles[k].begin(), triangles[k].begin() + 3, triangles[k - 1].begin()))
      fail(origin, origin.element(triangles[k][3]),
           "duplicate, it has the corners of " + origin.element(triangles[k - 1][3]) +
               ", every triangle once expected");
}

/// One side of a triangle: half-edge 3 element + local edge.
struct Side {
  int low, high, half_edge;
};

/// The half-edge on the other side of each half-edge.
std::vector<int> twins(const Mesh& mesh, const MeshOrigin& origin) {
  const auto corner = [&](int half_edge, int i) {
    return mesh.elements(half_edge / 3, (half_edge % 3 + i) % 3);
  };
  std::vector<Side> sides;
  for (int h = 0; h < 3 * mesh.elements.rows(); ++h)
    sides.push_back({std::min(corner(h, 0), corner(h, 1)), std::max(corner(h, 0), corner(h, 1)), h});
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.half_edge) < std::tie(b.low, b.high, b.half_edge);
  });

  std::vector<int> twin(sides.size());
  for (std::size_t k = 0; k < sides.size();) {
    std::size_t end = k;
    while (end < sides.size() && sides[end].low == sides[k].low && sides[end].high == sides[k].high) ++end;
    const int a = sides[k].half_edge;
    const std::string edge =
        "the edge between " + origin.node(sides[k].low) + " and " + origin.node(sides[k].high);
    if (end == k + 1)
      fail(origin, origin.element(a / 3),
           "not closed, " + edge + " has no second triangle, a closed surface expected");
    const int b = sides[k + 1].half_edge;
    if (end > k + 2)
      fail(origin, origin.element(sides[k + 2].half_edge / 3),
           "not a manifold, " + edge + format(" has %d triangles", int(end - k)) + " (the first is " +
               origin.element(a / 3) + "), 2 expected");
    if (corner(a, 0) == corner(b, 0))
      fail(origin, origin.element(b / 3),
           "oriented against its neighbour " + origin.element(a / 3) + " at " + edge +
               ", the same orientation expected");
    twin[a] = b;
    twin[b] = a;
    k = end;
  }
  return twin;
}

/// The triangles at every corner form one fan.
void check_fans(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin) {
  std::vector<int> triangles(mesh.nodes.rows(), 0), first(mesh.nodes.rows(), -1);
  for (int h = 0; h < int(twin.size()); ++h) {
    const int v = mesh.elements(h / 3, h % 3);
    ++triangles[v];
    if (first[v] < 0) first[v] = h;
  }
  for (int v = 0; v < mesh.nodes.rows(); ++v) {
    if (first[v] < 0) continue;
    int fan = 0, h = first[v];
    do {
      ++fan;
      h = twin[h / 3 * 3 + (h + 2) % 3];
    } while (h != first[v]);
    if (fan != triangles[v])
      fail(origin, origin.node(v),
           format("not a manifold, only %d of the %d triangles that meet here are neighbours", fan,
                  triangles[v]) +
               " of one another (" + origin.element(first[v] / 3) + " is one), a single fan expected");
  }
}

void check_connected(const MeshOrigin& origin, const std::vector<int>& twin) {
  std::vector<bool> reached(twin.size() / 3, false);
  std::vector<int> todo{0};
  reached[0] = true;
  while (!todo.empty()) {
    const int e = todo.back();
    todo.pop_back();
    for (int i = 0; i < 3; ++i) {
      const int neighbour = twin[3 * e + i] / 3;
      if (!reached[neighbour]) todo.push_back(neighbour);
      reached[neighbour] = true;
    }
  }
  const auto other = std::find(reached.begin(), reached.end(), false);
  if (other != reached.end())
    fail(origin, origin.element(int(other - reached.begin())),
         "not connected with " + origin.element(0) + ", one connected surface expected");
}

/// Neighbours have the same nodes on their edge, and no node plays two parts.
void check_curved_edges(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin) {
  const int on_edge = mesh.degree - 1;
  const auto edge_node = [&](int half_edge, int i) {
    return mesh.elements(half_edge / 3, 3 + half_edge % 3 * on_edge + i);
  };
  for (int h = 0; h < int(twin.size()); ++h)
    for (int i = 0; i < on_edge; ++i)
      if (edge_node(h, i) != edge_node(twin[h], on_edge - 1 - i))
        fail(origin, origin.element(h / 3),
             "its edge has " + origin.node(edge_node(h, i)) + ", but " + origin.element(twin[h] / 3) +
                 " has there " + origin.node(edge_node(twin[h], on_edge - 1 - i)) +
                 ", the same node expected");

  // The part of a node: -1 a corner, else the half-edge (the smaller of two) or, after those, the element.
  constexpr int none = -2;
  std::vector<int> part(mesh.nodes.rows(), none);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int i = 0; i < mesh.elements.cols(); ++i) {
      const int h = 3 * e + (i - 3) / std::max(1, on_edge);
      const int mine = i < 3 ? -1 : i < 3 + 3 * on_edge ? std::min(h, twin[h]) : int(twin.size()) + e;
      int& known = part[mesh.elements(e, i)];
      if (known != none && known != mine)
        fail(origin, origin.element(e),
             origin.node(mesh.elements(e, i)) +
                 " belongs to two edges, or is a corner elsewhere, one corner or one edge expected");
      known = mine;
    }
}

double enclosed_volume(const Mesh& mesh) {
  const Vec3 origin = mesh.nodes.row(mesh.elements(0, 0));
  double volume = 0;
  for (int e = 0; e < mesh.elements.rows(); ++e) {
    const Vec3 a = mesh.nodes.row(mesh.elements(e, 0)), b = mesh.nodes.row(mesh.elements(e, 1)),
               c = mesh.nodes.row(mesh.elements(e, 2));
    volume += (a - origin).dot((b - origin).cross(c - origin)) / 6;
  }
  return volume;
}

/// Swaps the second and the third corner of every element, and all other nodes with them.
void reverse_orientation(Mesh& mesh) {
  const int on_edge = mesh.degree - 1, inner = 3 + 3 * on_edge;
  std::vector<int> from{0, 2, 1};
  for (int edge : {2, 1, 0})
    for (int i = on_edge - 1; i >= 0; --i) from.push_back(3 + edge * on_edge + i);
  const int count = int(mesh.elements.cols()) - inner;
  if (count == 1) from.push_back(inner);
  if (count == 3) from.insert(from.end(), {inner, inner + 2, inner + 1});
  const Connectivity turned = mesh.elements(Eigen::all, from);
  mesh.elements = turned;
}

}  // namespace

std::string MeshOrigin::node(int i) const {
  return label("node", i, node_tags, node_lines);
}

std::string MeshOrigin::element(int e) const {
  return label("element", e, element_tags, element_lines);
}

bool check_closed_surface(Mesh& mesh, const MeshOrigin& origin) {
  if (mesh.elements.rows() == 0)
    throw InputError(origin.source + ": no triangle, a closed triangulated surface expected");
  if (mesh.nodes.cols() != 3 || mesh.elements.cols() != nodes_per_element(mesh.degree))
    throw InputError(format("%s: %d coordinates a node and %d nodes an element, 3 and %d expected",
                            origin.source.c_str(), int(mesh.nodes.cols()), int(mesh.elements.cols()),
                            nodes_per_element(mesh.degree)));
  check_nodes(mesh, origin);
  check_elements(mesh, origin);
  check_duplicates(mesh, origin);
  const std::vector<int> twin = twins(mesh, origin);
  check_fans(mesh, origin, twin);
  check_connected(origin, twin);
  check_curved_edges(mesh, origin, twin);
  const bool inward = enclosed_volume(mesh) < 0;
  if (inward) reverse_orientation(mesh);
  return inward;
}

}  // namespace esfem
