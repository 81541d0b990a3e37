// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/warn.hpp"

#include <cerrno>
#include <cstdio>
#include <utility>

#include "experiments/harness/progress.hpp"
#include "solver/mesh/read.hpp"

namespace esfem {

void warn(const std::string& text) {
  if (text.empty()) return;
  clear_progress_line();
  std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, text.c_str());
}

Mesh mesh_from_file(const std::string& file) {
  ReadMesh found = read_mesh(file);
  warn(found.remark);
  return std::move(found.mesh);
}

}  // namespace esfem
