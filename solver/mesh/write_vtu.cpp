// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/write_vtu.hpp"

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkIndent.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkTypeInt32Array.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/write_file.hpp"

namespace esfem {
namespace {

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

/// VTK writes names as they are, whatever they mean to XML.
bool is_plain(const std::string& name) {
  return !name.empty() && std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return c < ' ' || c == '&' || c == '<' || c == '>' || c == '"';
  });
}

void check_fields(const std::vector<PointField>& fields, int n, const std::string& file) {
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

/// VTK's array of the entries of `values`, row by row.
template <class Array, class Matrix>
vtkSmartPointer<Array> rows(const Matrix& values) {
  using Scalar = typename Matrix::Scalar;
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(int(values.cols()));
  array->SetNumberOfTuples(values.rows());
  Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      array->GetPointer(0), values.rows(), values.cols()) = values;
  return array;
}

vtkSmartPointer<vtkUnstructuredGrid> unstructured_grid(int degree, const Connectivity& elements,
                                                       const Field& x,
                                                       const std::vector<PointField>& fields) {
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetData(rows<vtkDoubleArray>(x));
  grid->SetPoints(points);

  // VTK's node order is that of fe/lagrange.hpp for all these degrees.
  const int types[] = {VTK_TRIANGLE, VTK_QUADRATIC_TRIANGLE, VTK_LAGRANGE_TRIANGLE, VTK_LAGRANGE_TRIANGLE};
  const auto nodes = rows<vtkTypeInt32Array>(elements);
  nodes->SetNumberOfComponents(1);
  vtkNew<vtkCellArray> cells;
  cells->SetData(elements.cols(), nodes);
  grid->SetCells(types[degree - 1], cells);

  for (const auto& [name, values] : fields) {
    const auto array = rows<vtkDoubleArray>(values);
    array->SetName(name.c_str());
    grid->GetPointData()->AddArray(array);
  }
  return grid;
}

std::string vtu_text(vtkUnstructuredGrid* grid) {
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetCompressorTypeToZLib();
  writer->WriteToOutputStringOn();
  bool written = false;
  // VTK computes the ranges of arrays in parallel; its threads would stay and disturb runs on other cores.
  vtkSMPTools::LocalScope(vtkSMPTools::Config(std::string("Sequential")),
                          [&] { written = writer->Write() == 1; });
  return written ? writer->GetOutputString() : "";
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& snapshots) {
  vtkNew<vtkXMLDataElement> root, collection;
  root->SetName("VTKFile");
  root->SetAttribute("type", "Collection");
  root->SetAttribute("version", "0.1");
  root->AddNestedElement(collection);
  collection->SetName("Collection");
  for (const auto& [t, file] : snapshots) {
    vtkNew<vtkXMLDataElement> snapshot;
    snapshot->SetName("DataSet");
    snapshot->SetAttribute("timestep", format("%.17g", t).c_str());
    snapshot->SetAttribute("part", "0");
    snapshot->SetAttribute("file", file.c_str());
    collection->AddNestedElement(snapshot);
  }
  std::ostringstream text;
  root->PrintXML(text, vtkIndent());
  return "<?xml version=\"1.0\"?>\n" + text.str();
}

}  // namespace

void write_vtu(int degree, const Connectivity& elements, const Field& x,
               const std::vector<PointField>& fields, const std::string& file) {
  check_elements(degree, elements, x, file);
  check_finite(x, "x", file);
  check_fields(fields, int(x.rows()), file);
  const std::string text = vtu_text(unstructured_grid(degree, elements, x, fields));
  if (text.empty()) throw InputError(file + ": cannot be written: VTK's writer failed");
  write_file(file, text);
}

SnapshotCollection::SnapshotCollection(std::string pvd, int degree, Connectivity elements)
    : pvd_(std::move(pvd)), degree_(degree), elements_(std::move(elements)) {
  const std::filesystem::path path(pvd_);
  if (path.extension() != ".pvd")
    throw InputError("'" + pvd_ + "': a name that ends in .pvd expected for a collection of snapshots");
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error)
    throw InputError(path.parent_path().string() + ": this folder cannot be made: " + error.message());
}

std::string SnapshotCollection::add(double t, const Field& x, const std::vector<PointField>& fields) {
  if (!std::isfinite(t))
    throw NumericsError(format("%s: a snapshot at time %g, a finite time expected", pvd_.c_str(), t));
  const std::filesystem::path path(pvd_);
  const std::string name = path.stem().string() + format("_%04zu.vtu", snapshots_.size());
  write_vtu(degree_, elements_, x, fields, (path.parent_path() / name).string());
  auto snapshots = snapshots_;
  snapshots.emplace_back(t, name);
  write_file(pvd_, pvd_text(snapshots));
  snapshots_ = std::move(snapshots);
  return name;
}

void SnapshotCollection::resume(std::vector<std::pair<double, std::string>> snapshots) {
  const std::filesystem::path folder = std::filesystem::path(pvd_).parent_path();
  for (const auto& [t, name] : snapshots)
    if (!std::filesystem::is_regular_file(folder / name))
      throw InputError(format("%s: the snapshot at t = %g is missing", (folder / name).c_str(), t));
  if (!snapshots.empty()) write_file(pvd_, pvd_text(snapshots));
  snapshots_ = std::move(snapshots);
}

}  // namespace esfem
