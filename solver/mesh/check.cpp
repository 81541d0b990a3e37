// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/mesh/orientation.hpp"
#include "solver/mesh/reconnect.hpp"
#include "solver/mesh/sides.hpp"

namespace esfem {

namespace {

std::string label(const char* kind, int i, const std::vector<long>& tags, const std::vector<int>& lines,
                  bool own_numbers) {
  std::string text = format("%s %ld", kind, tags.empty() ? long(i) + 1 : tags[i]);
  if (!lines.empty())
    text += format(" (line %d)", lines[i]);
  else if (!own_numbers)
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
    if (has_no_area(mesh, e))
      fail(origin, origin.element(e), "degenerate, its corners are on a line, a positive area expected");
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
  std::size_t first = 0;
  int count = 0;
  for (std::size_t k = 1; k < triangles.size(); ++k)
    if (std::equal(triangles[k].begin(), triangles[k].begin() + 3, triangles[k - 1].begin()) && ++count == 1)
      first = k;
  if (count > 0)
    fail(origin, origin.element(triangles[first][3]),
         "duplicate, it has the corners of " + origin.element(triangles[first - 1][3]) +
             format(" (%d such element%s), every triangle once expected", count, count > 1 ? "s" : ""));
}

std::string point(const Mesh& mesh, const MeshOrigin& origin, int i) {
  return origin.node(i) + format(" at (%g, %g, %g)", mesh.nodes(i, 0), mesh.nodes(i, 1), mesh.nodes(i, 2));
}

/// "between node 3 (..) at (..) and node 4 (..) at (..)".
std::string between(const Mesh& mesh, const MeshOrigin& origin, int side) {
  return "between " + point(mesh, origin, side_corner(mesh.elements, side, 0)) + " and " +
         point(mesh, origin, side_corner(mesh.elements, side, 1));
}

/// No edge has more than two triangles.
void check_manifold_edges(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin) {
  std::map<std::pair<int, int>, std::vector<int>> crowded;
  for (int side = 0; side < int(twin.size()); ++side)
    if (twin[side] == crowded_side)
      crowded[std::minmax({side_corner(mesh.elements, side, 0), side_corner(mesh.elements, side, 1)})]
          .push_back(side);
  if (crowded.empty()) return;
  const std::vector<int>& sides = crowded.begin()->second;
  fail(origin, origin.element(sides[2] / 3),
       format("not a manifold, %zu edge%s more than 2 triangles; the one ", crowded.size(),
              crowded.size() > 1 ? "s have" : " has") +
           between(mesh, origin, sides[0]) + format(" has %zu (the first is ", sides.size()) +
           origin.element(sides[0] / 3) + "), 2 expected");
}

/// A closed line of open sides.
struct BoundaryLoop {
  int side = 0;  ///< one of them
  int sides = 0;
  double length = 0;
};

/// The open side that follows on an open side, at its second corner when `forward`, else at its first; sets
/// `forward` for the next step. Elements need not be oriented alike.
int next_open_side(const Connectivity& elements, const std::vector<int>& twin, int side, bool& forward) {
  const int corner = side_corner(elements, side, forward);
  do {
    side = side_corner(elements, side, 1) == corner ? side_after(side) : side_before(side);
    if (twin[side] == open_side) break;
    side = twin[side];
  } while (true);
  forward = side_corner(elements, side, 0) == corner;
  return side;
}

std::vector<BoundaryLoop> boundary_loops(const Mesh& mesh, const std::vector<int>& twin) {
  std::vector<BoundaryLoop> loops;
  std::vector<bool> passed(twin.size(), false);
  for (int first = 0; first < int(twin.size()); ++first) {
    if (twin[first] != open_side || passed[first]) continue;
    BoundaryLoop loop{first};
    bool forward = true;
    int side = first;
    do {
      passed[side] = true;
      ++loop.sides;
      loop.length += (mesh.nodes.row(side_corner(mesh.elements, side, 0)) -
                      mesh.nodes.row(side_corner(mesh.elements, side, 1)))
                         .norm();
      side = next_open_side(mesh.elements, twin, side, forward);
    } while (!passed[side]);
    loops.push_back(loop);
  }
  return loops;
}

/// Every edge has two triangles, when none has more.
void check_closed(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin) {
  const std::vector<BoundaryLoop> loops = boundary_loops(mesh, twin);
  if (loops.empty()) return;
  const BoundaryLoop& longest =
      *std::max_element(loops.begin(), loops.end(),
                        [](const BoundaryLoop& a, const BoundaryLoop& b) { return a.length < b.length; });
  fail(origin, origin.element(longest.side / 3),
       format("not closed, %zu boundary loop%s; the longest has %d edge%s, length %g and the edge ",
              loops.size(), loops.size() > 1 ? "s" : "", longest.sides, longest.sides > 1 ? "s" : "",
              longest.length) +
           between(mesh, origin, longest.side) +
           ", a closed surface expected: fill holes first (MeshLab, Close Holes)");
}

/// The triangles at every corner form one fan.
void check_fans(const Mesh& mesh, const MeshOrigin& origin, const std::vector<int>& twin) {
  std::vector<int> triangles(mesh.nodes.rows(), 0), first(mesh.nodes.rows(), -1);
  for (int side = 0; side < int(twin.size()); ++side) {
    const int v = side_corner(mesh.elements, side, 0);
    ++triangles[v];
    if (first[v] < 0) first[v] = side;
  }
  for (int v = 0; v < mesh.nodes.rows(); ++v) {
    if (first[v] < 0) continue;
    int fan = 0, side = first[v];
    do {
      ++fan;
      side = twin[side_before(side)];
    } while (side != first[v]);
    if (fan != triangles[v])
      fail(origin, origin.node(v),
           format("not a manifold, only %d of the %d triangles that meet here are neighbours", fan,
                  triangles[v]) +
               " of one another (" + origin.element(first[v] / 3) + " is one), a single fan expected");
  }
}

/// Neighbours have the same nodes on their edge, and no node has two roles.
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

  // The role of a node: -1 a corner, else the half-edge (the smaller of two) or, after those, the element.
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

}  // namespace

void number_by_position(std::vector<long>& tags, long n) {
  if (!tags.empty()) return;
  tags.resize(std::size_t(n));
  std::iota(tags.begin(), tags.end(), 1);
}

std::string MeshOrigin::node(int i) const {
  return label("node", i, node_tags, node_lines, own_numbers);
}

std::string MeshOrigin::element(int e) const {
  return label("element", e, element_tags, element_lines, own_numbers);
}

std::string check_closed_surface(Mesh& mesh, const MeshOrigin& origin) {
  if (mesh.elements.rows() == 0)
    throw InputError(origin.source + ": no triangle, a closed triangulated surface expected");
  if (mesh.nodes.cols() != 3 || mesh.elements.cols() != nodes_per_element(mesh.degree))
    throw InputError(format("%s: %d coordinates a node and %d nodes an element, 3 and %d expected",
                            origin.source.c_str(), int(mesh.nodes.cols()), int(mesh.elements.cols()),
                            nodes_per_element(mesh.degree)));
  check_nodes(mesh, origin);
  check_elements(mesh, origin);
  check_duplicates(mesh, origin);
  std::vector<int> twin = side_twins(mesh.elements);
  check_manifold_edges(mesh, origin, twin);
  check_closed(mesh, origin, twin);
  const std::string remark = orient(mesh, origin, twin);
  if (!remark.empty()) twin = side_twins(mesh.elements);
  check_fans(mesh, origin, twin);
  check_curved_edges(mesh, origin, twin);
  return remark;
}

}  // namespace esfem
