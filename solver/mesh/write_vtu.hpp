// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "solver/types.hpp"

namespace esfem {

/// A nodal field and its name in files: N x 1 (scalar) or N x 3 (vector).
struct PointField {
  std::string name;
  Field values;
};

/// Writes a surface of degree 1..4 with nodal fields as a binary VTU file that ParaView opens: triangles (VTK
/// type 5), quadratic triangles (22), Lagrange triangles (69) for degree 3 and 4. elements: E x (k+1)(k+2)/2,
/// node order of fe/lagrange.hpp. Whole or not at all. Throws InputError when a field has not one row a node
/// or the file cannot be written, NumericsError when a value is not finite.
void write_vtu(int degree, const Connectivity& elements, const Field& x,
               const std::vector<PointField>& fields, const std::string& file);

/// A ParaView collection (PVD) of the snapshots of one run. "run.pvd" refers to "run_0000.vtu",
/// "run_0001.vtu", .. beside it; it is complete after each snapshot.
class SnapshotCollection {
 public:
  /// Folders that are missing are made. Throws InputError when `pvd` does not end in ".pvd".
  SnapshotCollection(std::string pvd, int degree, Connectivity elements);

  /// Writes the next snapshot and returns its file name without the folder. Errors as write_vtu.
  std::string add(double t, const Field& x, const std::vector<PointField>& fields);

  /// Goes on after these snapshots (times and names as `add` gave them), whatever is listed now. Throws
  /// InputError when the file of one is missing.
  void resume(std::vector<std::pair<double, std::string>> snapshots);

 private:
  std::string pvd_;
  int degree_;
  Connectivity elements_;
  std::vector<std::pair<double, std::string>> snapshots_;
};

}  // namespace esfem
