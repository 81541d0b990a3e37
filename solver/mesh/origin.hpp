// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace esfem {

/// Where a mesh comes from, so that errors can name its nodes and elements as their author knows them.
struct MeshOrigin {
  std::string source;  ///< file name

  /// The file's own numbers and lines; empty when the file has none: then the 1-based position is the number.
  /// @{
  std::vector<long> node_tags, element_tags;
  std::vector<int> node_lines, element_lines;
  /// @}

  bool own_numbers = false;  ///< the numbers are written in the file, not counted

  /// "node 7 (line 12)", or "node 7 (counted from 1)" when the lines are not known; a number that the file
  /// has stands alone then.
  std::string node(int i) const;
  /// The same of element e (0-based).
  std::string element(int e) const;
};

}  // namespace esfem
