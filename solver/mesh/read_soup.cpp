// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's readers accept some files that are cut off or not numbers, and say nothing of where they fail: so
// what a file announces is counted here and compared with what CGAL has read.
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <sstream>
#include <stdexcept>

#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"

namespace esfem {

namespace {

using Points = std::vector<CGAL::Simple_cartesian<double>::Point_3>;
/// The corners of a polygon. CGAL takes memory for as many as a file announces: nonsense must end before.
struct Polygon : std::vector<int> {
  void resize(std::size_t corners) {
    if (corners > 1000) throw std::length_error("corners of a polygon");
    std::vector<int>::resize(corners);
  }
};
using Polygons = std::vector<Polygon>;

/// What a file must hold besides the numbers; -1 for unknown.
struct Announced {
  long nodes = -1, elements = -1;
};

/// Calls f(line number, its words) for every line that is not blank, while f returns true.
void for_each_line(const std::string& text,
                   const std::function<bool(int, const std::vector<std::string>&)>& f) {
  std::istringstream stream(text);
  std::string line, word;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::istringstream words(line);
    std::vector<std::string> split;
    while (words >> word) split.push_back(word);
    if (!split.empty() && !f(number, split)) return;
  }
}

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
  throw InputError(format("%s: line %d: %s", file.c_str(), line, what.c_str()));
}

bool is_number(const std::string& word) {
  char* end;
  std::strtod(word.c_str(), &end);
  return *end == 0;
}

void refuse_non_finite_words(const std::string& file, const std::string& text) {
  for_each_line(text, [&](int number, const std::vector<std::string>& words) {
    if (words[0] != "v" && words[0] != "vertex" && !is_number(words[0])) return true;
    for (const std::string& word : words)
      if (is_number(word) && !std::isfinite(std::strtod(word.c_str(), nullptr)))
        fail(file, number, "coordinate '" + word + "', a finite number expected");
    return true;
  });
}

long to_count(const std::string& file, const std::string& content, int line, const std::string& word) {
  char* end;
  const long n = std::strtol(word.c_str(), &end, 10);
  if (*end != 0 || n < 0) fail(file, line, "'" + word + "' found, a number of nodes or elements expected");
  // Memory is taken for what is announced: a node or element needs at least a few bytes of file.
  if (n > long(content.size()))
    fail(file, line, format("%ld nodes or elements announced, more than the file can hold", n));
  return n;
}

Announced announced_by_off(const std::string& file, const std::string& content) {
  Announced announced;
  bool has_keyword = false;
  int last = 1;
  for_each_line(content, [&](int number, std::vector<std::string> words) {
    last = number;
    if (words[0][0] == '#') return true;
    if (!has_keyword) {
      has_keyword = true;
      const std::string& keyword = words[0];
      if (keyword.size() < 3 || keyword.substr(keyword.size() - 3) != "OFF")
        fail(file, number, "no OFF file, the keyword OFF expected");
      if (words.size() > 1 && words[1] == "BINARY") fail(file, number, "binary OFF file, ASCII expected");
      words.erase(words.begin());
      if (words.empty() || words[0][0] == '#') return true;
    }
    if (words.size() < 2) fail(file, number, "numbers of nodes and of elements expected");
    announced.nodes = to_count(file, content, number, words[0]);
    announced.elements = to_count(file, content, number, words[1]);
    return false;
  });
  if (announced.elements < 0)
    fail(file, last, "the file ends here, numbers of nodes and of elements expected");
  return announced;
}

Announced announced_by_ply(const std::string& file, const std::string& content) {
  Announced announced;
  bool closed = false;
  int last = 1;
  for_each_line(content, [&](int number, const std::vector<std::string>& words) {
    last = number;
    if (number == 1 && words[0] != "ply") fail(file, number, "no PLY file, the keyword ply expected");
    if (words[0] == "element" && words.size() == 3) {
      if (words[1] == "vertex") announced.nodes = to_count(file, content, number, words[2]);
      if (words[1] == "face") announced.elements = to_count(file, content, number, words[2]);
    }
    closed = words[0] == "end_header";
    return !closed;
  });
  if (!closed) fail(file, last, "the file ends here, end_header expected");
  if (announced.nodes < 0 || announced.elements < 0)
    fail(file, last, "no 'element vertex' or no 'element face' in the head of the file, both expected");
  return announced;
}

Announced announced_by_obj(const std::string& content, MeshOrigin& origin) {
  for_each_line(content, [&](int number, const std::vector<std::string>& words) {
    if (words[0] == "v") origin.node_lines.push_back(number);
    if (words[0] == "f") origin.element_lines.push_back(number);
    return true;
  });
  return {long(origin.node_lines.size()), long(origin.element_lines.size())};
}

Announced announced_by_ascii_stl(const std::string& file, const std::string& content) {
  Announced announced;
  announced.elements = 0;
  bool started = false, open = false;
  int last = 1;
  for_each_line(content, [&](int number, const std::vector<std::string>& words) {
    last = number;
    if (words[0] == "solid") started = open = true;
    if (words[0] == "endsolid") open = false;
    announced.elements += words[0] == "facet";
    return started;
  });
  if (!started)
    fail(file, last, "no STL file, the keyword solid or a binary file of 84 + 50 n bytes expected");
  if (open) fail(file, last, "the file ends here, endsolid expected");
  return announced;
}

std::uint32_t binary_stl_triangles(const std::string& content) {
  std::uint32_t n = 0;
  if (content.size() >= 84) std::memcpy(&n, content.data() + 80, sizeof n);
  return n;
}

bool is_binary_stl(const std::string& content) {
  return content.size() >= 84 && content.size() == 84 + 50 * std::size_t(binary_stl_triangles(content));
}

Announced announced_by_binary_stl(const std::string& file, const std::string& content) {
  Announced announced;
  announced.elements = binary_stl_triangles(content);
  for (long e = 0; e < announced.elements; ++e) {
    float corners[9];
    std::memcpy(corners, content.data() + 84 + 50 * e + 12, sizeof corners);
    for (float x : corners)
      // CGAL merges equal points, and NaN would count as equal to any.
      if (!std::isfinite(x))
        throw InputError(format("%s: element %ld (counted from 1): coordinate %g, a finite number expected",
                                file.c_str(), e + 1, x));
  }
  return announced;
}

bool read_by_cgal(std::istream& stream, const std::string& extension, Points& points, Polygons& polygons) {
  const auto quiet = CGAL::parameters::verbose(false);
  if (extension == "off") return CGAL::IO::read_OFF(stream, points, polygons, quiet);
  if (extension == "obj") return CGAL::IO::read_OBJ(stream, points, polygons, quiet);
  if (extension == "ply") return CGAL::IO::read_PLY(stream, points, polygons, quiet);
  return CGAL::IO::read_STL(stream, points, polygons, quiet);
}

}  // namespace

MeshFile parse_polygon_soup(const std::string& file, const std::string& content,
                            const std::string& extension) {
  MeshFile result;
  result.origin.source = file;
  const bool binary = extension == "stl"   ? is_binary_stl(content)
                      : extension == "ply" ? content.find("format binary") < content.find("end_header")
                                           : false;
  const Announced announced = extension == "off"   ? announced_by_off(file, content)
                              : extension == "obj" ? announced_by_obj(content, result.origin)
                              : extension == "ply" ? announced_by_ply(file, content)
                              : binary             ? announced_by_binary_stl(file, content)
                                                   : announced_by_ascii_stl(file, content);
  if (!binary) refuse_non_finite_words(file, content);

  Points points;
  Polygons polygons;
  std::istringstream stream(content);
  bool good = false;
  try {
    good = read_by_cgal(stream, extension, points, polygons);
  } catch (const std::exception&) {
    // Impossible sizes or a failed assertion: the same as `false`.
  }
  if (!good || (announced.nodes >= 0 && announced.nodes != long(points.size())) ||
      announced.elements != long(polygons.size())) {
    stream.clear();
    const auto position = stream.tellg();
    const long line =
        1 + std::count(content.begin(), content.begin() + std::max<long>(0, position - 1l), '\n');
    const std::string where = binary ? "" : format(" near line %ld", line);
    const std::string expected = announced.nodes >= 0 ? format("%ld nodes and ", announced.nodes) : "";
    throw InputError(format("%s: cut off or malformed%s, %s%ld triangles expected", file.c_str(),
                            where.c_str(), expected.c_str(), announced.elements));
  }

  result.mesh.nodes.resize(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    result.mesh.nodes.row(i) << points[i].x(), points[i].y(), points[i].z();
  result.mesh.elements.resize(polygons.size(), 3);
  for (std::size_t e = 0; e < polygons.size(); ++e) {
    if (polygons[e].size() != 3)
      throw InputError(format("%s: %s: %d corners, a triangle expected", file.c_str(),
                              result.origin.element(int(e)).c_str(), int(polygons[e].size())));
    for (int i = 0; i < 3; ++i) result.mesh.elements(e, i) = polygons[e][i];
  }
  return result;
}

}  // namespace esfem
