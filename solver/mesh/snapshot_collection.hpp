// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "solver/mesh/write_vtu.hpp"

namespace esfem {

/// A ParaView collection (PVD) of the snapshots of one run. "run.pvd" refers to "run_0000.vtu",
/// "run_0001.vtu", .. beside it; it is complete after each snapshot. Files of such a name that an earlier run
/// has left are removed when the first snapshot is written, or the first one after `resume`.
class SnapshotCollection {
 public:
  /// Folders that are missing are made. Throws InputError when `pvd` does not end in ".pvd" or cannot be
  /// written.
  SnapshotCollection(std::string pvd, int degree, Connectivity elements, RunLabel run = {});

  /// Writes step n at time t as the next snapshot and returns its file name without the folder. Errors as
  /// write_vtu.
  std::string add(int n, double t, const Field& x, const NodalFields& fields);

  /// Continues after these snapshots (times and names as `add` gave them), whatever is listed now. Throws
  /// InputError when the file of one is missing.
  void resume(std::vector<std::pair<double, std::string>> snapshots);

 private:
  void remove_unlisted() const;

  std::string pvd_;
  int degree_;
  Connectivity elements_;
  RunLabel run_;
  std::vector<std::pair<double, std::string>> snapshots_;
  bool others_removed_ = false;
};

/// Whether a file has the place and the name of a snapshot in this collection, which a new run removes.
bool is_snapshot_of(const std::string& file, const std::string& pvd);

}  // namespace esfem
