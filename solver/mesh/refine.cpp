// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/refine.hpp"

#include "solver/fe/lagrange.hpp"

namespace esfem {
namespace {

/// Reference coordinates, in the element that was refined, of the corners of a part of it.
using Part = Eigen::Matrix<double, 3, 2>;

/// The 4^times parts of an element, in the order of `subdivide`.
std::vector<Part> parts(int times) {
  Part whole;
  whole << 0, 0, 1, 0, 0, 1;
  std::vector<Part> list = {whole};
  for (int s = 0; s < times; ++s) {
    std::vector<Part> finer;
    for (const Part& part : list) {
      Eigen::Matrix<double, 6, 2> node;  // of the quadratic element
      node << part, (part.row(0) + part.row(1)) / 2, (part.row(1) + part.row(2)) / 2,
          (part.row(2) + part.row(0)) / 2;
      for (const auto& child : {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}) {
        finer.emplace_back();
        for (int i = 0; i < 3; ++i) finer.back().row(i) = node.row(child[i]);
      }
    }
    list = std::move(finer);
  }
  return list;
}

}  // namespace

Field refined_values(const Mesh& mesh, const Field& values, const RefinedMesh& refined) {
  const Eigen::MatrixXd shapes = shape_functions(mesh.degree, refined.place).value;
  Field result(refined.place.rows(), values.cols());
  for (int i = 0; i < result.rows(); ++i)
    result.row(i) = shapes.row(i) * values(mesh.elements.row(refined.element[i]), Eigen::all);
  return result;
}

RefinedMesh refine(const Mesh& mesh, int times) {
  Mesh corners = corner_mesh(mesh);
  for (int s = 0; s < times; ++s) corners = subdivide(corners);
  RefinedMesh refined;
  refined.mesh = lagrange_mesh(corners, mesh.degree);
  Mesh& fine = refined.mesh;
  refined.element.resize(fine.nodes.rows());
  refined.place.resize(fine.nodes.rows(), 2);
  const auto local = reference_nodes(mesh.degree);
  const std::vector<Part> children = parts(times);
  for (int e = 0; e < fine.elements.rows(); ++e) {
    const Part& part = children[e % children.size()];
    for (int i = 0; i < local.rows(); ++i) {
      const int node = fine.elements(e, i);
      refined.element[node] = e / int(children.size());
      refined.place.row(node) =
          part.row(0) + local(i, 0) * (part.row(1) - part.row(0)) + local(i, 1) * (part.row(2) - part.row(0));
    }
  }
  fine.nodes = refined_values(mesh, mesh.nodes, refined);
  return refined;
}

}  // namespace esfem
