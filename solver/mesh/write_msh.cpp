// SPDX-License-Identifier: GPL-3.0-or-later
#include <fstream>

#include "solver/error.hpp"
#include "solver/mesh/read.hpp"

namespace esfem {

void write_msh(const Mesh& mesh, const std::string& file) {
  const int n = int(mesh.nodes.rows()), elements = int(mesh.elements.rows());
  std::ofstream out(file);
  out << "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";

  const Eigen::RowVectorXd low = mesh.nodes.colwise().minCoeff(), high = mesh.nodes.colwise().maxCoeff();
  out << "$Entities\n0 0 1 0\n1"
      << format(" %.17g %.17g %.17g %.17g %.17g %.17g 0 0\n", low[0], low[1], low[2], high[0], high[1],
                high[2])
      << "$EndEntities\n";

  out << format("$Nodes\n1 %d 1 %d\n2 1 0 %d\n", n, n, n);
  for (int i = 0; i < n; ++i) out << i + 1 << "\n";
  for (int i = 0; i < n; ++i)
    out << format("%.17g %.17g %.17g\n", mesh.nodes(i, 0), mesh.nodes(i, 1), mesh.nodes(i, 2));
  out << "$EndNodes\n";

  constexpr int types[] = {2, 9, 21, 23};  // triangles of degree 1, .., in the node order of fe/lagrange.hpp
  const int gmsh_type = types[mesh.degree - 1];
  out << format("$Elements\n1 %d 1 %d\n2 1 %d %d\n", elements, elements, gmsh_type, elements);
  for (int e = 0; e < elements; ++e) {
    out << e + 1;
    for (int i = 0; i < mesh.elements.cols(); ++i) out << ' ' << mesh.elements(e, i) + 1;
    out << '\n';
  }
  out << "$EndElements\n";
  out.close();
  if (!out) throw InputError(file + ": cannot be written, a writable place expected");
}

}  // namespace esfem
