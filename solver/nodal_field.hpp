// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "solver/types.hpp"

namespace esfem {

/// Nodal values and their name in files and tables, N x c.
struct NodalField {
  std::string name;  ///< "nu", "H"; by this `find` finds it
  Field values;      ///< one row a node
};
/// The fields of one surface, in the order in which files have them.
using NodalFields = std::vector<NodalField>;

/// The field of that name; nullptr when there is none.
inline const Field* find(const NodalFields& fields, const std::string& name) {
  for (const NodalField& field : fields)
    if (field.name == name) return &field.values;
  return nullptr;
}

}  // namespace esfem
