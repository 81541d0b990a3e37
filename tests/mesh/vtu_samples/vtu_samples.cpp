// SPDX-License-Identifier: GPL-3.0-or-later
// Files for test_vtu_files.py: `vtu_samples FOLDER` writes spheres of degree 1 to 4 with awkward numbers,
// and as raw doubles and ints what a reader must find in them.
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/harness/experiment.hpp"
#include "solver/error.hpp"
#include "solver/fe/lagrange.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/mesh/snapshot_collection.hpp"
#include "solver/write_file.hpp"

namespace esfem {
namespace {

/// What is not plain in XML and JSON.
const RunLabel run = {"mean_curvature", R"({"name": "<τ & \"ν\">", "axes": [1, 2.5, 1e-300]})"};
const double sample_time = 0.1 + 0.2;
const int sample_step = 123456789;

/// A sphere with curved elements, nodes with numbers that need all digits.
Mesh curved_sphere(int degree) {
  Mesh mesh = lagrange_mesh(icosphere(1.0 / 3, 1), degree);
  mesh.nodes.rowwise().normalize();
  return mesh;
}

/// Fields with numbers that only binary files keep.
NodalFields sample_fields(const Mesh& mesh) {
  Field H = mesh.nodes.rowwise().sum() / 7, v = -mesh.nodes.array().exp().matrix();
  using Limits = std::numeric_limits<double>;
  H.topRows(4) << Limits::denorm_min(), Limits::max(), -0.0, std::nextafter(1.0, 2.0);
  return {{"H", H}, {"v", v}, {"|A|²", H.cwiseAbs()}};
}

/// The entries of a matrix row by row, as they lie in memory.
template <class Matrix>
void write_raw(const Matrix& values, const std::string& file) {
  const Eigen::Matrix<typename Matrix::Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
  write_file(file,
             std::string(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(*rows.data())));
}

/// Where VTK's cells are to be evaluated.
Eigen::Matrix<double, Eigen::Dynamic, 2> reference_points() {
  Eigen::Matrix<double, Eigen::Dynamic, 2> points(6, 2);
  points << 0.2, 0.3, 0.7, 0.1, 0.05, 0.9, 0.5, 0, 0, 0.15, 0.4, 0.6;
  return points;
}

/// The images of the reference points under the element maps: a row for each point of each element.
Field element_maps(const Mesh& mesh) {
  const Eigen::MatrixXd shape = shape_functions(mesh.degree, reference_points()).value;
  Field places(mesh.elements.rows() * shape.rows(), 3);
  for (int e = 0; e < mesh.elements.rows(); ++e)
    for (int q = 0; q < shape.rows(); ++q) {
      places.row(e * shape.rows() + q).setZero();
      for (int i = 0; i < mesh.elements.cols(); ++i)
        places.row(e * shape.rows() + q) += shape(q, i) * mesh.nodes.row(mesh.elements(e, i));
    }
  return places;
}

/// degree_2.vtu, and degree_2.points, .cells, .maps and .FIELD with what is in it.
void write_degree(int degree, const std::string& folder) {
  const Mesh mesh = curved_sphere(degree);
  const std::string stem = folder + format("/degree_%d", degree);
  write_vtu(degree, mesh.elements, mesh.nodes, sample_fields(mesh), {sample_step, sample_time, run},
            stem + ".vtu");
  write_raw(mesh.nodes, stem + ".points");
  write_raw(mesh.elements, stem + ".cells");
  write_raw(element_maps(mesh), stem + ".maps");
  for (const auto& [name, values] : sample_fields(mesh)) write_raw(values, stem + "." + name);
}

/// wrong_4_12_13.vtu: two nodes of an edge, or two inner ones, have changed places. For the check that sees
/// it.
void write_wrong_orders(const std::string& folder) {
  const int swapped[][3] = {{2, 3, 4}, {3, 3, 4}, {3, 7, 8}, {4, 12, 13}, {4, 13, 14}};
  for (const auto& [degree, a, b] : swapped) {
    Mesh mesh = curved_sphere(degree);
    mesh.elements.col(a).swap(mesh.elements.col(b));
    write_vtu(degree, mesh.elements, mesh.nodes, {}, {},
              folder + format("/wrong_%d_%d_%d.vtu", degree, a, b));
  }
}

/// A collection whose name XML must escape; the snapshots are spheres of radius 1 + t.
void write_collection(const std::string& folder) {
  const Mesh mesh = curved_sphere(2);
  SnapshotCollection collection(folder + "/τ = 0.1 & \"<R>\".pvd", 2, mesh.elements, run);
  int n = 0;
  for (const double t : {0.0, 1e-17, 0.1, sample_time, 1.0 / 3}) {
    collection.add(n, t, (1 + t) * mesh.nodes, {{"H", Field::Constant(mesh.nodes.rows(), 1, 2 / (1 + t))}});
    n += 10;
  }
}

void write_samples(const std::string& folder) {
  std::filesystem::create_directories(folder);
  for (int degree = 1; degree <= max_degree; ++degree) write_degree(degree, folder);
  write_wrong_orders(folder);
  write_collection(folder);
  write_raw(reference_points(), folder + "/reference.points");
  const nlohmann::json expected = {
      {"flow", run.flow}, {"configuration", run.configuration}, {"t", sample_time}, {"step", sample_step}};
  write_file(folder + "/expected.json", expected.dump() + "\n");
}

}  // namespace
}  // namespace esfem

int main(int argc, char** argv) {
  return esfem::guarded_main([&] {
    if (argc != 2) throw esfem::InputError("usage: vtu_samples FOLDER");
    esfem::write_samples(argv[1]);
    return esfem::exit_done;
  });
}
