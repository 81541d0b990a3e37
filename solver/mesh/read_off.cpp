// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of Geomview's manual [Phillips, Levy, Munzner. Geomview: OFF Files]:
//   [ST][C][N]OFF [BINARY]                    the keyword may be missing
//   nodes elements edges                      the edges are used by nobody, and may be missing
//   x y z [normal: 3] [colour: 3 or 4] [texture: 2]     each node, as the keyword says
//   n corner ... corner [colour]              each element; the colour, 0 to 4 numbers, ends with the line
// Blanks and ends of lines are the same elsewhere; # starts a comment.
#include "solver/error.hpp"
#include "solver/mesh/bytes.hpp"
#include "solver/mesh/lines.hpp"
#include "solver/mesh/polygons.hpp"

namespace esfem {

namespace {

struct OffHead {
  bool normals = false, colours = false, textures = false, binary = false;
  long nodes = 0, elements = 0;
};

/// Reads the letters in front of OFF.
void read_prefix(const Lines& lines, std::string prefix, OffHead& head) {
  const auto has = [&prefix](const std::string& letters) {
    const std::size_t at = prefix.find(letters);
    if (at != prefix.npos) prefix.erase(at, letters.size());
    return at != prefix.npos;
  };
  head.textures = has("ST");
  head.colours = has("C");
  head.normals = has("N");
  if (prefix == "4" || prefix == "n" || prefix == "4n")
    lines.fail("keyword " + prefix + "OFF: nodes with other than 3 coordinates, OFF expected");
  if (!prefix.empty()) lines.fail("no OFF file, the keyword OFF expected");
}

/// Reads the keyword, if there is one.
void read_keyword(Lines& lines, OffHead& head) {
  if (!lines.next()) lines.fail("the file ends here, the keyword OFF expected");
  const std::string word = lines.word(0);
  const std::size_t at = word.find("OFF");
  if (at == word.npos) {
    if (lines.size() != 3 || word.find_first_not_of("0123456789") != word.npos)
      lines.fail("no OFF file, the keyword OFF expected");
    return;
  }
  // OFF42 80 0
  if (at + 3 < word.size()) lines.split_word(0, at + 3);
  lines.take("keyword");
  read_prefix(lines, word.substr(0, at), head);
  head.binary = lines.is(1, "binary");
}

void read_counts(Lines& lines, OffHead& head) {
  const char *nodes = "number of nodes", *elements = "number of elements", *edges = "number of edges";
  head.nodes = lines.count(lines.take(nodes), nodes);
  const bool all_in_a_line = lines.left() > 0;
  head.elements = lines.count(lines.take(elements), elements);
  if (lines.left() > 0 || !all_in_a_line) {
    lines.integer(lines.take(edges), edges);
  } else if (lines.next() && lines.size() == 1 &&
             lines.word(0).find_first_not_of("0123456789") == std::string::npos) {
    lines.take(edges);
  }
}

/// Takes the rest of a line, which must be that many numbers.
void take_numbers(Lines& lines, int at_least, int at_most, const char* what) {
  const int found = lines.left();
  if (found < at_least || found > at_most)
    lines.fail(format("%d more words found, %d to %d numbers expected (%s)", found, at_least, at_most, what));
  for (int i = lines.size() - found; i < lines.size(); ++i) lines.real(i, what);
  lines.take_line();
}

/// The first line on which a node starts and that has not its three coordinates alone: allowed, but
/// suspicious.
struct OtherLine {
  int number = 0, words = 0;
};

void read_nodes(Lines& lines, const OffHead& head, Polygons& result, OtherLine& other) {
  const int more = 3 * head.normals + 2 * head.textures;
  const bool alone = more == 0 && !head.colours;
  for (long i = 0; i < head.nodes; ++i) {
    const int first = lines.take("a coordinate");
    result.origin.node_lines.push_back(lines.number());
    if (alone && other.number == 0 && lines.size() != 3) other = {lines.number(), lines.size()};
    const double x = lines.coordinate(first);
    const double y = lines.coordinate(lines.take("a coordinate"));
    const double z = lines.coordinate(lines.take("a coordinate"));
    result.points.emplace_back(x, y, z);
    if (!alone)
      take_numbers(lines, more + 3 * head.colours, more + 4 * head.colours, "normal, colour, texture");
  }
}

void read_elements(Lines& lines, const OffHead& head, Polygons& result) {
  for (long e = 0; e < head.elements; ++e) {
    const int first = lines.take("an element");
    result.origin.element_lines.push_back(lines.number());
    const long corners = lines.count(first, "number of corners");
    if (corners < 3) lines.fail(format("%ld corners, at least 3 expected", corners));
    for (long i = 0; i < corners; ++i) {
      const long corner = lines.count(lines.take("a corner"), "corner");
      if (corner >= head.nodes)
        lines.fail(format("corner %ld, out of range: 0 to %ld expected", corner, head.nodes - 1));
      result.corners.push_back(corner);
    }
    result.sizes.push_back(int(corners));
    take_numbers(lines, 0, 4, "colour");
  }
  if (lines.left() > 0 || lines.next())
    lines.fail("'" + lines.word(0) + "' found after the last element, the end of the file expected");
}

/// Counts, corners as integers of 4 bytes, the rest as floats, all with the highest byte first; each element
/// ends with the number of its colours and these.
void read_binary(Bytes bytes, OffHead& head, Polygons& result) {
  const auto take_count = [&bytes](const char* what) {
    const auto n = bytes.take<std::int32_t>(what);
    if (n < 0) bytes.fail(format("%d found as %s, a number >= 0 expected", n, what));
    return n;
  };
  head.nodes = take_count("number of nodes");
  head.elements = take_count("number of elements");
  take_count("number of edges");
  const int more = 3 * head.normals + 4 * head.colours + 2 * head.textures;
  for (long i = 0; i < head.nodes; ++i) {
    Vec3 x;
    for (double& coordinate : x) coordinate = bytes.take<float>("coordinate");
    if (!x.allFinite()) bytes.fail(format("node %ld: coordinate %g, a finite number expected", i, x.sum()));
    bytes.skip(4 * std::size_t(more), "the colour of a node");
    result.points.push_back(x);
  }
  for (long e = 0; e < head.elements; ++e) {
    const int corners = take_count("number of corners");
    for (int i = 0; i < corners; ++i) result.corners.push_back(bytes.take<std::int32_t>("corner"));
    result.sizes.push_back(corners);
    bytes.skip(4 * std::size_t(take_count("number of colours")), "the colour of an element");
  }
  if (bytes.left() > 0) bytes.fail("bytes after the last element, the end of the file expected");
}

}  // namespace

MeshFile parse_off(const std::string& file, const std::string& content) {
  Lines lines(file, content, '#');
  Polygons result;
  result.origin.source = file;
  OffHead head;
  read_keyword(lines, head);
  if (head.binary) {
    const std::size_t start = content.size() - lines.rest().size();
    read_binary(Bytes(file, content, start, is_little_endian()), head, result);
    return triangulated(std::move(result));
  }
  read_counts(lines, head);
  OtherLine other;
  try {
    read_nodes(lines, head, result, other);
    read_elements(lines, head, result);
  } catch (const InputError& error) {
    if (other.number == 0) throw;
    throw InputError(format("%s (line %d has %d numbers, 3 coordinates of a node expected)", error.what(),
                            other.number, other.words));
  }
  return triangulated(std::move(result));
}

}  // namespace esfem
