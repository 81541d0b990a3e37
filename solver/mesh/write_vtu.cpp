// SPDX-License-Identifier: GPL-3.0-or-later
// The format: https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html, restricted to the
// common part of VTK 9, ParaView 5 and meshio 5.
#include "solver/mesh/write_vtu.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/write_file.hpp"

namespace esfem {
namespace {

template <class Scalar>
using Rows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

void check_finite(const Field& values, const std::string& what, const std::string& file) {
  for (int i = 0; i < values.rows(); ++i)
    for (int l = 0; l < values.cols(); ++l)
      if (!std::isfinite(values(i, l)))
        throw NumericsError(format("%s: %s is %g at node %d (counted from 1), a finite value expected",
                                   file.c_str(), what.c_str(), values(i, l), i + 1));
}

void check_elements(int degree, const Connectivity& elements, const Field& x, const std::string& file) {
  const int local = nodes_per_element(degree), n = int(x.rows());
  if (x.cols() != 3)
    throw InputError(format("%s: x has %d columns, 3 expected", file.c_str(), int(x.cols())));
  if (elements.cols() != local)
    throw InputError(format("%s: elements of degree %d with %d nodes, %d expected", file.c_str(), degree,
                            int(elements.cols()), local));
  for (int e = 0; e < elements.rows(); ++e)
    for (int i = 0; i < local; ++i)
      if (elements(e, i) < 0 || elements(e, i) >= n)
        throw InputError(format("%s: element %d has node %d (both counted from 1), 1 to %d expected",
                                file.c_str(), e + 1, elements(e, i) + 1, n));
}

/// A name that is the same in XML and in the formulas of ParaView's calculator.
bool is_plain(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return c < ' ' || c == '&' || c == '<' || c == '>' || c == '"';
  });
}

void check_fields(const NodalFields& fields, int n, const std::string& file) {
  std::set<std::string> names;
  for (const auto& [name, values] : fields) {
    if (!is_plain(name))
      throw InputError(
          format("%s: field %zu (counted from 1) has a name that XML cannot have, one of visible characters "
                 "without & < > \" expected",
                 file.c_str(), names.size() + 1));
    if (!names.insert(name).second) throw InputError(file + ": two fields have the name '" + name + "'");
    const std::string field = "field '" + name + "'";
    if (values.rows() != n)
      throw InputError(format("%s: %s has %d rows, one for each of %d nodes expected", file.c_str(),
                              field.c_str(), int(values.rows()), n));
    if (values.cols() != 1 && values.cols() != 3)
      throw InputError(
          format("%s: %s has %d columns, 1 or 3 expected", file.c_str(), field.c_str(), int(values.cols())));
    check_finite(values, field, file);
  }
}

template <class Scalar>
constexpr const char* vtk_type = nullptr;
template <>
constexpr const char* vtk_type<double> = "Float64";
template <>
constexpr const char* vtk_type<std::int32_t> = "Int32";
template <>
constexpr const char* vtk_type<std::int64_t> = "Int64";
template <>
constexpr const char* vtk_type<std::uint8_t> = "UInt8";

/// The arrays of a file: the XML refers to them, and their bytes follow it as they lie in memory, the number
/// of bytes (UInt64) in front of each array.
class AppendedArrays {
 public:
  /// Appends the entries of a matrix row by row and returns the XML element that refers to them.
  template <class Matrix>
  std::string add(const std::string& name, const Matrix& values, const std::string& shape = "") {
    using Scalar = typename Matrix::Scalar;
    const std::size_t offset = bytes_.size();
    const Rows<Scalar> rows = values;
    const std::uint64_t size = rows.size() * sizeof(Scalar);
    append(&size, sizeof size);
    append(rows.data(), size);
    return format("<DataArray type=\"%s\" Name=\"%s\"%s format=\"appended\" offset=\"%zu\"/>\n",
                  vtk_type<Scalar>, name.c_str(), shape.c_str(), offset);
  }

  /// One tuple for each row: what field data, and no other arrays, must say.
  template <class Matrix>
  std::string add_field_data(const std::string& name, const Matrix& values) {
    return add(name, values, format(" NumberOfTuples=\"%td\"", values.rows()));
  }

  const std::string& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }

  std::string bytes_;
};

/// The label as an XML element. Texts are arrays of bytes: meshio refuses a whole file for one of VTK's
/// string arrays.
std::string field_data(const SnapshotLabel& label, AppendedArrays& arrays) {
  std::string xml = "<FieldData>\n";
  xml += arrays.add_field_data("TimeValue", Rows<double>::Constant(1, 1, label.t));
  xml += arrays.add_field_data("step", Rows<std::int32_t>::Constant(1, 1, label.step));
  const std::pair<const char*, const std::string&> texts[] = {{"flow", label.run.flow},
                                                              {"configuration", label.run.configuration}};
  for (const auto& [name, text] : texts) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    if (!text.empty())
      xml += arrays.add_field_data(name, Eigen::Map<const Rows<std::uint8_t>>(bytes, text.size(), 1));
  }
  return xml + "</FieldData>\n";
}

std::string cells(int degree, const Connectivity& elements, AppendedArrays& arrays) {
  // VTK's node order is that of fe/lagrange.hpp for all these degrees.
  constexpr std::uint8_t triangle = 5, quadratic = 22, lagrange = 69,
                         types[] = {triangle, quadratic, lagrange, lagrange};
  const Eigen::Index count = elements.rows();
  Rows<std::int64_t> ends(count, 1);
  for (Eigen::Index e = 0; e < count; ++e) ends(e) = (e + 1) * elements.cols();
  std::string xml = "<Cells>\n";
  xml += arrays.add("connectivity", elements);
  xml += arrays.add("offsets", ends);
  xml += arrays.add("types", Rows<std::uint8_t>::Constant(count, 1, types[degree - 1]));
  return xml + "</Cells>\n";
}

std::string point_data(const NodalFields& fields, AppendedArrays& arrays) {
  std::string xml = "<PointData>\n";
  for (const auto& [name, values] : fields)
    xml += arrays.add(name, values, values.cols() == 1 ? "" : " NumberOfComponents=\"3\"");
  return xml + "</PointData>\n";
}

const char* byte_order() {
  const std::uint16_t one = 1;
  return *reinterpret_cast<const std::uint8_t*>(&one) == 1 ? "LittleEndian" : "BigEndian";
}

std::string vtu_text(int degree, const Connectivity& elements, const Field& x, const NodalFields& fields,
                     const SnapshotLabel& label) {
  AppendedArrays arrays;
  std::string text = format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n"
      "<UnstructuredGrid>\n",
      byte_order());
  text += field_data(label, arrays);
  text += format("<Piece NumberOfPoints=\"%td\" NumberOfCells=\"%td\">\n", x.rows(), elements.rows());
  text += point_data(fields, arrays);
  text += "<Points>\n" + arrays.add("Points", x, " NumberOfComponents=\"3\"") + "</Points>\n";
  text += cells(degree, elements, arrays);
  text += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  text += arrays.bytes();
  return text + "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace

void write_vtu(int degree, const Connectivity& elements, const Field& x, const NodalFields& fields,
               const SnapshotLabel& label, const std::string& file) {
  check_elements(degree, elements, x, file);
  check_finite(x, "x", file);
  check_fields(fields, int(x.rows()), file);
  if (!std::isfinite(label.t))
    throw NumericsError(format("%s: a snapshot at time %g, a finite time expected", file.c_str(), label.t));
  write_file(file, vtu_text(degree, elements, x, fields, label));
}

}  // namespace esfem
