// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of [Turk. The PLY Polygon File Format. 1994]: a head of lines
//   ply | format KIND 1.0 | comment .. | obj_info .. | element NAME COUNT | property TYPE NAME
//   | property list TYPE TYPE NAME | end_header
// then the elements in this order, in ASCII one a line, in binary without gaps. Real properties of a vertex
// are nodal values, NAME_x, NAME_y, NAME_z together those of a vector; normals nx, ny, nz are for shading.
// Other properties are skipped, whatever their values are.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "solver/error.hpp"
#include "solver/mesh/bytes.hpp"
#include "solver/mesh/lines.hpp"
#include "solver/mesh/polygons.hpp"

namespace esfem {

namespace {

enum PlyType { ply_int8, ply_uint8, ply_int16, ply_uint16, ply_int32, ply_uint32, ply_float32, ply_float64 };
const char* const ply_type_names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                         {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                         {"float", "float32"}, {"double", "float64"}};
constexpr std::size_t ply_type_sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};

struct PlyProperty {
  std::string name;
  PlyType type;
  bool list = false;
  PlyType count_type = ply_uint8;
};

struct PlyElement {
  std::string name;
  long count;
  std::vector<PlyProperty> properties;
};

struct PlyHead {
  bool binary = false, big_endian = false;
  std::vector<PlyElement> elements;
};

PlyType ply_type(const Lines& lines, int i) {
  for (int type = ply_int8; type <= ply_float64; ++type)
    for (const char* name : ply_type_names[type])
      if (i < lines.size() && lines.word(i) == name) return PlyType(type);
  lines.fail(
      "'" + (i < lines.size() ? lines.word(i) : "") +
      "' found as type of a property, char, uchar, short, ushort, int, uint, float or double expected");
}

void expect_words(const Lines& lines, int expected) {
  if (lines.size() != expected) lines.fail(format("%d words found, %d expected", lines.size(), expected));
}

void read_ply_format(const Lines& lines, PlyHead& head) {
  expect_words(lines, 3);
  head.big_endian = lines.word(1) == "binary_big_endian";
  head.binary = head.big_endian || lines.word(1) == "binary_little_endian";
  if ((!head.binary && lines.word(1) != "ascii") || lines.word(2) != "1.0")
    lines.fail("format " + lines.word(1) + " " + lines.word(2) +
               ", ascii, binary_little_endian or binary_big_endian and 1.0 expected");
}

void read_ply_element(const Lines& lines, PlyHead& head) {
  expect_words(lines, 3);
  for (const PlyElement& element : head.elements)
    if (element.name == lines.word(1))
      lines.fail("element " + element.name + " a second time, once expected");
  head.elements.push_back({lines.word(1), lines.count(2, "number of elements"), {}});
}

void read_ply_property(const Lines& lines, PlyHead& head) {
  if (head.elements.empty()) lines.fail("property before the first element, element NAME COUNT expected");
  PlyProperty property;
  property.list = lines.is(1, "list");
  expect_words(lines, property.list ? 5 : 3);
  if (property.list) property.count_type = ply_type(lines, 2);
  property.type = ply_type(lines, property.list ? 3 : 1);
  property.name = lines.word(property.list ? 4 : 2);
  for (const PlyProperty& other : head.elements.back().properties)
    if (other.name == property.name) lines.fail("property " + other.name + " a second time, once expected");
  head.elements.back().properties.push_back(property);
}

PlyHead read_ply_head(Lines& lines) {
  PlyHead head;
  if (!lines.next() || lines.word(0) != "ply" || lines.size() != 1)
    lines.fail("no PLY file, the keyword ply expected");
  bool has_format = false;
  while (lines.next()) {
    const std::string keyword = lines.word(0);
    if (keyword == "format") {
      read_ply_format(lines, head);
      has_format = true;
    } else if (keyword == "element") {
      read_ply_element(lines, head);
    } else if (keyword == "property") {
      read_ply_property(lines, head);
    } else if (keyword == "end_header") {
      if (!has_format) lines.fail("no format in the head, a line 'format ascii 1.0' or the like expected");
      return head;
    } else if (keyword != "comment" && keyword != "obj_info") {
      lines.fail("'" + keyword +
                 "' found in the head, format, comment, element, property or end_header expected");
    }
  }
  lines.fail("the file ends here, end_header expected");
}

/// The values of an ASCII file: an element a line.
class PlyText {
 public:
  explicit PlyText(Lines& lines) : lines_(lines) {}

  void start(const std::string& what) { lines_.expect(what); }
  void finish() {
    if (lines_.left() > 0)
      lines_.fail(format("%d words found, %d expected", lines_.size(), lines_.size() - lines_.left()));
  }
  double value(PlyType type, const char* what) {
    const int i = word(what);
    return type < ply_float32 ? double(lines_.integer(i, what)) : lines_.real(i, what);
  }
  void skip(PlyType, long count) {
    for (long i = 0; i < count; ++i) word("a property");
  }
  void finish_file() {
    if (lines_.next()) lines_.fail("a line after the last element, the end of the file expected");
  }
  int line() const { return lines_.number(); }
  [[noreturn]] void fail(const std::string& what) const { lines_.fail(what); }

 private:
  int word(const char* what) {
    if (lines_.left() == 0) lines_.fail(format("%d words found, %s expected next", lines_.size(), what));
    return lines_.take(what);
  }
  Lines& lines_;
};

/// The values of a binary file.
class PlyBytes {
 public:
  explicit PlyBytes(Bytes bytes) : bytes_(bytes) {}

  void start(const std::string& what) { what_ = what; }
  void finish() {}
  double value(PlyType type, const char* what) {
    switch (type) {
    case ply_int8:
      return bytes_.take<std::int8_t>(what);
    case ply_uint8:
      return bytes_.take<std::uint8_t>(what);
    case ply_int16:
      return bytes_.take<std::int16_t>(what);
    case ply_uint16:
      return bytes_.take<std::uint16_t>(what);
    case ply_int32:
      return bytes_.take<std::int32_t>(what);
    case ply_uint32:
      return bytes_.take<std::uint32_t>(what);
    case ply_float32:
      return double(bytes_.take<float>(what));
    default:
      return bytes_.take<double>(what);
    }
  }
  void skip(PlyType type, long count) {
    const std::size_t size = ply_type_sizes[type];
    if (std::size_t(count) > bytes_.left() / size) fail("the file ends in a property");
    bytes_.skip(std::size_t(count) * size, "a property");
  }
  void finish_file() {
    // A last newline comes from programs that take the file for text.
    if (bytes_.left() > 2)
      bytes_.fail(format("%zu bytes after the last element, the end of the file expected", bytes_.left()));
  }
  int line() const { return 0; }
  [[noreturn]] void fail(const std::string& what) const { bytes_.fail(what_ + ": " + what); }

 private:
  Bytes bytes_;
  std::string what_;
};

template <class Source>
long ply_count(Source& source, const PlyProperty& property) {
  const double n = source.value(property.count_type, "the length of a list");
  if (!(n >= 0 && n < 1e9 && n == std::floor(n)))
    source.fail(format("%g found as length of the list %s, an integer expected", n, property.name.c_str()));
  return long(n);
}

template <class Source>
void skip_property(Source& source, const PlyProperty& property) {
  source.skip(property.type, property.list ? ply_count(source, property) : 1);
}

bool is_nodal_value(const PlyProperty& property) {
  static const std::set<std::string> others = {"x", "y", "z", "nx", "ny", "nz"};
  return !property.list && property.type >= ply_float32 && !others.count(property.name);
}

/// From their values (names x points).
NodalFields nodal_fields(const std::vector<std::string>& names, const Field& values) {
  const auto place = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) - names.begin();
  };
  const long count = long(names.size());
  NodalFields fields;
  for (long i = 0; i < count; ++i) {
    const std::string stem = names[i].substr(0, std::max<std::size_t>(names[i].size(), 2) - 2);
    const long x = place(stem + "_x"), y = place(stem + "_y"), z = place(stem + "_z");
    if (!stem.empty() && x < count && y < count && z < count && (i == x || i == y || i == z)) {
      if (i == x) fields.push_back({stem, values(std::vector<long>{x, y, z}, Eigen::all).transpose()});
    } else {
      fields.push_back({names[i], values.row(i).transpose()});
    }
  }
  return fields;
}

/// Appends the nodal values to `values`.
template <class Source>
void read_ply_vertex(Source& source, const PlyElement& element, Polygons& result,
                     std::vector<double>& values) {
  Vec3 x;
  for (const PlyProperty& property : element.properties) {
    const std::size_t i =
        property.name.size() == 1 ? std::string("xyz").find(property.name) : std::string::npos;
    if (i == std::string::npos) {
      if (is_nodal_value(property))
        values.push_back(source.value(property.type, "a nodal value"));
      else
        skip_property(source, property);
      continue;
    }
    x[long(i)] = source.value(property.type, "a coordinate");
    if (!std::isfinite(x[long(i)]))
      source.fail(format("coordinate '%g', a finite number expected", x[long(i)]));
  }
  result.points.push_back(x);
  if (source.line() > 0) result.origin.node_lines.push_back(source.line());
}

bool is_corner_list(const PlyProperty& property) {
  return property.list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

template <class Source>
void read_ply_face(Source& source, const PlyElement& element, Polygons& result) {
  for (const PlyProperty& property : element.properties) {
    if (!is_corner_list(property)) {
      skip_property(source, property);
      continue;
    }
    const long corners = ply_count(source, property);
    for (long i = 0; i < corners; ++i) {
      const double corner = source.value(property.type, "a corner");
      if (!(std::abs(corner) < 1e15 && corner == std::floor(corner)))
        source.fail(format("corner %g, an integer expected", corner));
      result.corners.push_back(long(corner));
    }
    result.sizes.push_back(int(corners));
  }
  if (source.line() > 0) result.origin.element_lines.push_back(source.line());
}

template <class Source>
void read_ply_elements(Source source, const PlyHead& head, Polygons& result) {
  std::vector<std::string> names;
  std::vector<double> values;
  for (const PlyElement& element : head.elements) {
    if (element.properties.empty()) continue;
    if (element.name == "vertex")
      for (const PlyProperty& property : element.properties)
        if (is_nodal_value(property)) names.push_back(property.name);
    for (long i = 0; i < element.count; ++i) {
      source.start(format("%s %ld of %ld", element.name.c_str(), i + 1, element.count));
      if (element.name == "vertex")
        read_ply_vertex(source, element, result, values);
      else if (element.name == "face")
        read_ply_face(source, element, result);
      else
        for (const PlyProperty& property : element.properties) skip_property(source, property);
      source.finish();
    }
  }
  source.finish_file();
  if (!names.empty())
    result.fields = nodal_fields(
        names, Eigen::Map<const Field>(values.data(), long(names.size()), long(result.points.size())));
}

/// Throws InputError unless the head declares points in space and polygons.
void check_ply_head(const Lines& lines, const PlyHead& head) {
  const auto find = [&head](const std::string& name) -> const PlyElement* {
    for (const PlyElement& element : head.elements)
      if (element.name == name) return &element;
    return nullptr;
  };
  const PlyElement *vertex = find("vertex"), *face = find("face");
  if (!vertex) lines.fail("no element vertex in the head, expected");
  for (const std::string name : {"x", "y", "z"}) {
    const PlyProperty* found = nullptr;
    for (const PlyProperty& property : vertex->properties)
      if (property.name == name) found = &property;
    if (!found) lines.fail("no property " + name + " in the element vertex, x, y and z expected");
    if (found->list)
      lines.fail("the property " + name + " of the element vertex is a list, a number expected");
  }
  if (!face)
    lines.fail(find("tristrips") ? "element tristrips (strips of triangles) and no element face, expected "
                                   "(save it with faces)"
                                 : "no element face in the head, expected");
  int lists = 0;
  for (const PlyProperty& property : face->properties) lists += is_corner_list(property);
  if (lists != 1)
    lines.fail(format("%d lists vertex_indices or vertex_index in the element face, one expected", lists));
}

}  // namespace

MeshFile parse_ply(const std::string& file, const std::string& content) {
  Lines lines(file, content);
  Polygons result;
  result.origin.source = file;
  const PlyHead head = read_ply_head(lines);
  check_ply_head(lines, head);
  if (head.binary) {
    const std::size_t start = content.size() - lines.rest().size();
    read_ply_elements(PlyBytes(Bytes(file, content, start, head.big_endian == is_little_endian())), head,
                      result);
  } else {
    read_ply_elements(PlyText(lines), head, result);
  }
  return triangulated(std::move(result));
}

}  // namespace esfem
