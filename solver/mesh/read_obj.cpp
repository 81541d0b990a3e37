// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of [Wavefront. Advanced Visualizer, appendix B1: Object Files (.obj)]: a statement a line, \ at
// its end continues it, # starts a comment. Read are v (x y z, then a weight or a colour) and f (and fo, its
// old name); all others are for curved surfaces, groups, looks.
#include <algorithm>
#include <charconv>

#include "solver/error.hpp"
#include "solver/mesh/lines.hpp"
#include "solver/mesh/polygons.hpp"

namespace esfem {

namespace {

void read_vertex(Lines& lines, Polygons& result) {
  result.origin.node_lines.push_back(lines.number());
  lines.continue_line();
  const int numbers = lines.size() - 1;
  if (numbers != 3 && numbers != 4 && numbers != 6 && numbers != 7)
    lines.fail(format("v with %d numbers, 3 expected (x y z, then a weight, a colour, or both)", numbers));
  result.points.emplace_back(lines.coordinate(1), lines.coordinate(2), lines.coordinate(3));
  for (int i = 4; i <= numbers; ++i) lines.real(i, "weight or colour");
}

/// The vertex of v, v/vt, v//vn or v/vt/vn; all parts must be integers, and those behind a slash may be
/// empty.
long vertex_of_corner(const Lines& lines, const std::string& word) {
  long vertex = 0;
  std::size_t start = 0;
  for (int part = 0; part < 3; ++part) {
    const std::size_t end = std::min(word.find('/', start), word.size());
    long number = 0;
    const auto [stop, error] = std::from_chars(word.data() + start, word.data() + end, number);
    const bool left_out = part > 0 && start == end;
    if (!left_out && (error != std::errc() || stop != word.data() + end)) break;
    if (part == 0) vertex = number;
    if (end == word.size()) return vertex;
    start = end + 1;
  }
  lines.fail("corner '" + word + "' found, v, v/vt, v//vn or v/vt/vn expected (integers)");
}

void read_face(Lines& lines, Polygons& result) {
  result.origin.element_lines.push_back(lines.number());
  lines.continue_line();
  const long defined = long(result.points.size());
  for (int i = 1; i < lines.size(); ++i) {
    const long vertex = vertex_of_corner(lines, lines.word(i));
    // -1 is the last vertex before this line.
    if (vertex == 0 || vertex < -defined)
      lines.fail(
          format("corner %ld, out of range: 1 to %ld or -%ld to -1 expected", vertex, defined, defined));
    result.corners.push_back(vertex > 0 ? vertex : defined + 1 + vertex);
  }
  result.sizes.push_back(lines.size() - 1);
}

}  // namespace

MeshFile parse_obj(const std::string& file, const std::string& content) {
  Lines lines(file, content, '#');
  Polygons result;
  result.origin.source = file;
  result.first = 1;
  while (lines.next()) {
    if (lines.word(0) == "v")
      read_vertex(lines, result);
    else if (lines.word(0) == "f" || lines.word(0) == "fo")
      read_face(lines, result);
  }
  return triangulated(std::move(result));
}

}  // namespace esfem
