// SPDX-License-Identifier: GPL-3.0-or-later
// The one form of a VTU file that write_vtu writes, and no other.
#include <cstdint>
#include <limits>
#include <optional>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/bytes.hpp"
#include "solver/mesh/mesh_file.hpp"

namespace esfem {

namespace {

/// The XML head of the file, line by line.
class VtuHead {
 public:
  VtuHead(std::string file, std::string_view content) : file_(std::move(file)), content_(content) { next(); }

  std::string_view line() const { return line_; }

  void next() {
    start_ = std::min(end_, content_.size());
    const std::size_t stop = content_.find('\n', start_);
    line_ = content_.substr(start_, stop == content_.npos ? stop : stop - start_);
    end_ = stop == content_.npos ? content_.size() : stop + 1;
    ++number_;
  }

  void expect(std::string_view text) {
    if (line_ != text) fail("'" + std::string(text) + "'");
    next();
  }

  /// What stands between the quotes behind key=.
  std::string text(const std::string& key) const {
    const std::string head = " " + key + "=\"";
    const std::size_t start = line_.find(head);
    const std::size_t stop = start == line_.npos ? start : line_.find('"', start + head.size());
    if (stop == line_.npos) fail("the attribute " + key);
    return std::string(line_.substr(start + head.size(), stop - start - head.size()));
  }

  std::size_t number(const std::string& key) const {
    const std::string digits = text(key);
    if (digits.empty() || digits.size() > 15 || digits.find_first_not_of("0123456789") != digits.npos)
      fail("a number as " + key);
    return std::stoull(digits);
  }

  /// The place of the first byte of the current line.
  std::size_t start() const { return start_; }

  [[noreturn]] void fail(const std::string& expected) const {
    throw InputError(
        format("%s: line %d: no VTU file of evolve, %s expected; plots/convert_mesh.py IN OUT.msh "
               "converts those of other programs",
               file_.c_str(), number_, expected.c_str()));
  }

 private:
  std::string file_;
  std::string_view content_, line_;
  std::size_t start_ = 0, end_ = 0;
  int number_ = 0;
};

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

/// An array of the file, which the head refers to.
struct VtuArray {
  std::string name, type;
  int components = 1;
  std::size_t offset = 0;
};

/// Reads the line that refers to an array; a name or a type that is given must be that.
VtuArray array_of(VtuHead& head, const std::string& type = "", const std::string& name = "") {
  if (!starts_with(head.line(), "<DataArray ")) head.fail("<DataArray .../>");
  VtuArray array{head.text("Name"), head.text("type")};
  if (!name.empty() && array.name != name) head.fail("the array " + name);
  if (!type.empty() && array.type != type) head.fail(array.name + " of type " + type);
  if (head.text("format") != "appended") head.fail("format=\"appended\"");
  if (head.line().find(" NumberOfComponents=") != std::string_view::npos)
    array.components = int(std::min<std::size_t>(head.number("NumberOfComponents"), 1000));
  array.offset = head.number("offset");
  head.next();
  return array;
}

/// What the head says.
struct VtuDescription {
  bool little_endian;
  std::size_t points, cells;
  std::optional<VtuArray> time;
  std::vector<VtuArray> fields;
  VtuArray nodes, connectivity, ends, types;
};

VtuDescription description_of(VtuHead& head) {
  VtuDescription vtu;
  head.expect("<?xml version=\"1.0\"?>");
  const std::string order = head.text("byte_order");
  if (order != "LittleEndian" && order != "BigEndian") head.fail("byte order LittleEndian or BigEndian");
  vtu.little_endian = order == "LittleEndian";
  head.expect("<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" + order +
              "\" header_type=\"UInt64\">");
  head.expect("<UnstructuredGrid>");
  head.expect("<FieldData>");
  while (head.line() != "</FieldData>") {
    VtuArray array = array_of(head);
    if (array.name == "TimeValue" && array.type == "Float64") vtu.time = std::move(array);
  }
  head.next();
  if (!starts_with(head.line(), "<Piece ")) head.fail("<Piece ...>");
  vtu.points = head.number("NumberOfPoints");
  vtu.cells = head.number("NumberOfCells");
  head.next();
  head.expect("<PointData>");
  while (head.line() != "</PointData>") vtu.fields.push_back(array_of(head, "Float64"));
  head.next();
  head.expect("<Points>");
  vtu.nodes = array_of(head, "Float64", "Points");
  head.expect("</Points>");
  head.expect("<Cells>");
  vtu.connectivity = array_of(head, "Int32", "connectivity");
  vtu.ends = array_of(head, "Int64", "offsets");
  vtu.types = array_of(head, "UInt8", "types");
  for (const char* end : {"</Cells>", "</Piece>", "</UnstructuredGrid>", "<AppendedData encoding=\"raw\">"})
    head.expect(end);
  if (!starts_with(head.line(), "_")) head.fail("'_'");
  return vtu;
}

/// The arrays behind the head.
class VtuArrays {
 public:
  VtuArrays(std::string file, std::string_view content, std::size_t start, bool swapped)
      : file_(std::move(file)), content_(content), start_(start), swapped_(swapped) {}

  /// rows x columns values of an array.
  template <class Value>
  Eigen::Matrix<Value, Eigen::Dynamic, Eigen::Dynamic> read(const VtuArray& array, std::size_t rows,
                                                            std::size_t columns) const {
    Bytes bytes(file_, content_, std::min(start_ + array.offset, content_.size()), swapped_);
    const std::uint64_t size = bytes.take<std::uint64_t>("the size of an array"), expected = rows * columns;
    if (size != expected * sizeof(Value))
      bytes.fail(format("array %s has %llu bytes, %zu numbers of %zu bytes expected", array.name.c_str(),
                        static_cast<unsigned long long>(size), rows * columns, sizeof(Value)));
    if (bytes.left() < size) bytes.fail("the file ends in array " + array.name);
    Eigen::Matrix<Value, Eigen::Dynamic, Eigen::Dynamic> values(rows, columns);
    for (std::size_t i = 0; i < rows; ++i)
      for (std::size_t j = 0; j < columns; ++j) values(i, j) = bytes.take<Value>(array.name.c_str());
    return values;
  }

  /// How many bytes an array has.
  std::uint64_t size(const VtuArray& array) const {
    return Bytes(file_, content_, std::min(start_ + array.offset, content_.size()), swapped_)
        .take<std::uint64_t>("the size of an array");
  }

 private:
  std::string file_;
  std::string_view content_;
  std::size_t start_;
  bool swapped_;
};

/// The degree of elements with so many nodes and of one of VTK's types.
int degree_of(const std::string& file, std::size_t nodes, int type) {
  constexpr int types[] = {5, 22, 69, 69};
  for (int degree = 1; degree <= max_degree; ++degree)
    if (nodes == std::size_t(nodes_per_element(degree)) && type == types[degree - 1]) return degree;
  throw InputError(
      format("%s: cells of type %d with %zu nodes, triangles of degree 1 to 4 (types 5, 22, 69) "
             "expected",
             file.c_str(), type, nodes));
}

}  // namespace

MeshFile parse_vtu(const std::string& file, const std::string& content) {
  VtuHead head(file, content);
  const VtuDescription vtu = description_of(head);
  const VtuArrays arrays(file, content, head.start() + 1, vtu.little_endian != is_little_endian());
  if (vtu.points == 0 || vtu.cells == 0) throw InputError(file + ": no point or no cell, a surface expected");

  MeshFile result;
  result.origin.source = file;
  const auto types = arrays.read<std::uint8_t>(vtu.types, vtu.cells, 1);
  const std::size_t per_cell = arrays.size(vtu.connectivity) / sizeof(std::int32_t) / vtu.cells;
  result.mesh.degree = degree_of(file, per_cell, types(0));
  result.mesh.elements = arrays.read<std::int32_t>(vtu.connectivity, vtu.cells, per_cell);
  const auto ends = arrays.read<std::int64_t>(vtu.ends, vtu.cells, 1);
  for (std::size_t e = 0; e < vtu.cells; ++e)
    if (types(e) != types(0) || ends(e) != std::int64_t((e + 1) * per_cell))
      throw InputError(
          format("%s: element %zu (counted from 1) is of another type than the first, triangles of "
                 "one degree expected",
                 file.c_str(), e + 1));
  for (std::size_t e = 0; e < vtu.cells; ++e)
    for (int i : result.mesh.elements.row(e))
      if (i < 0 || std::size_t(i) >= vtu.points)
        throw InputError(
            format("%s: element %zu (counted from 1) has node %d (counted from 0), 0 to %zu expected",
                   file.c_str(), e + 1, i, vtu.points - 1));
  result.mesh.nodes = arrays.read<double>(vtu.nodes, vtu.points, 3);
  for (const VtuArray& field : vtu.fields)
    if (field.components == 1 || field.components == 3)
      result.fields.push_back({field.name, arrays.read<double>(field, vtu.points, field.components)});
  if (vtu.time) result.t = arrays.read<double>(*vtu.time, 1, 1)(0);
  return result;
}

}  // namespace esfem
