// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of [3D Systems. Stereolithography Interface Specification. 1989]. ASCII, keywords in any case,
// words separated by any blanks:
//   solid [name]
//   facet normal x y z  outer loop  vertex x y z (three times)  endloop  endfacet
//   endsolid [name]
// A name ends with its line, or where a facet starts. Binary, lowest byte first: 80 bytes of anything, the
// number of triangles (4 bytes), and for each 12 floats, normal and corners, and 2 bytes of anything.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>

#include "solver/error.hpp"
#include "solver/mesh/bytes.hpp"
#include "solver/mesh/lines.hpp"
#include "solver/mesh/polygons.hpp"

namespace esfem {

namespace {

constexpr std::size_t stl_head = 84, stl_triangle = 50;

struct HashOfBits {
  std::size_t operator()(const std::array<double, 3>& x) const {
    std::uint64_t hash = 0;
    for (double coordinate : x) {
      std::uint64_t bits;
      std::memcpy(&bits, &coordinate, sizeof bits);
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Corners become nodes, those in one place one node.
class CornerTable {
 public:
  explicit CornerTable(Polygons& polygons) : polygons_(polygons) {}

  /// line: 0 when there is none.
  void add(const Vec3& x, int line) {
    // 0 and -0 are one place.
    const std::array<double, 3> key{x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};
    const auto [entry, is_new] = number_.emplace(key, long(polygons_.points.size()));
    if (is_new) {
      polygons_.points.push_back(x);
      if (line > 0) polygons_.origin.node_lines.push_back(line);
    }
    polygons_.corners.push_back(entry->second);
  }

 private:
  Polygons& polygons_;
  std::unordered_map<std::array<double, 3>, long, HashOfBits> number_;
};

void expect_word(Lines& lines, const char* word) {
  const int i = lines.take(word);
  if (!lines.is(i, word)) lines.fail("'" + lines.word(i) + "' found, " + word + " expected");
}

/// Takes the words of a name; returns whether a facet follows on the line, and one of the words was solid.
bool take_name(Lines& lines) {
  bool has_solid = false;
  for (int i = lines.size() - lines.left(); i < lines.size(); i = lines.take("name") + 1) {
    const bool facet = lines.is(i, "facet") && lines.is(i + 1, "normal") && i + 2 < lines.size();
    if (facet && std::string("+-.0123456789nN").find(lines.word(i + 2)[0]) != std::string::npos)
      return has_solid;
    has_solid = has_solid || lines.is(i, "solid");
  }
  return false;
}

/// What follows `facet`.
void read_facet(Lines& lines, Polygons& result, CornerTable& corners) {
  result.origin.element_lines.push_back(lines.number());
  expect_word(lines, "normal");
  // The corners say where the normal points to.
  for (int i = 0; i < 3; ++i) lines.take("a normal");
  expect_word(lines, "outer");
  expect_word(lines, "loop");
  for (int i = 0; i < 3; ++i) {
    expect_word(lines, "vertex");
    Vec3 x;
    for (double& coordinate : x) coordinate = lines.coordinate(lines.take("a coordinate"));
    corners.add(x, lines.number());
  }
  expect_word(lines, "endloop");
  expect_word(lines, "endfacet");
  result.sizes.push_back(3);
}

void read_ascii_stl(Lines& lines, Polygons& result) {
  CornerTable corners(result);
  bool in_solid = false;
  while (lines.left() > 0 || lines.next()) {
    const int i = lines.take("solid");
    if (!in_solid && lines.is(i, "solid")) {
      in_solid = true;
      take_name(lines);
    } else if (in_solid && lines.is(i, "facet")) {
      read_facet(lines, result, corners);
    } else if (in_solid && lines.is(i, "endsolid")) {
      in_solid = take_name(lines);
    } else {
      lines.fail("'" + lines.word(i) + "' found, " + (in_solid ? "facet or endsolid" : "solid") +
                 " expected");
    }
  }
  if (in_solid) lines.fail("the file ends here, endsolid expected");
}

/// Returns the number of bytes that are left, fewer than a triangle has.
std::size_t read_binary_stl(Bytes bytes, Polygons& result) {
  const std::size_t triangles = bytes.take<std::uint32_t>("number of triangles");
  const std::size_t found = bytes.left() / stl_triangle;
  if (triangles != found)
    bytes.fail(
        format("%zu triangles announced, but the file holds %zu of 50 bytes each, as many as announced "
               "expected (an ASCII file starts with solid)",
               triangles, found));
  CornerTable corners(result);
  for (std::size_t e = 0; e < triangles; ++e) {
    bytes.skip(12, "a normal");
    for (int i = 0; i < 3; ++i) {
      Vec3 x;
      for (double& coordinate : x) {
        coordinate = double(bytes.take<float>("coordinate"));
        if (!std::isfinite(coordinate))
          bytes.fail(format("element %zu (counted from 1): coordinate %g, a finite number expected", e + 1,
                            coordinate));
      }
      corners.add(x, 0);
    }
    bytes.skip(2, "attributes");
    result.sizes.push_back(3);
  }
  return bytes.left();
}

/// The size decides; when it fits neither, the first word and bytes that no text has.
bool is_binary_stl(const std::string& file, const std::string& content) {
  if (content.size() >= stl_head) {
    Bytes bytes(file, content, 80, !is_little_endian());
    if (bytes.take<std::uint32_t>("number of triangles") * stl_triangle + stl_head == content.size())
      return true;
  }
  Lines lines(file, content);
  const bool solid = lines.next() && lines.is(0, "solid");
  if (solid && content.find('\0') == content.npos) return false;
  if (content.size() < stl_head)
    lines.fail("no STL file, the keyword solid or a binary file of 84 + 50 n bytes expected");
  return true;
}

}  // namespace

MeshFile parse_stl(const std::string& file, const std::string& content) {
  Polygons polygons;
  polygons.origin.source = file;
  std::size_t left = 0;
  if (is_binary_stl(file, content)) {
    left = read_binary_stl(Bytes(file, content, 80, !is_little_endian()), polygons);
  } else {
    Lines lines(file, content);
    read_ascii_stl(lines, polygons);
  }
  MeshFile result = triangulated(std::move(polygons));
  if (left > 0) result.remarks.push_back(format("%zu bytes after the last triangle: skipped", left));
  return result;
}

}  // namespace esfem
