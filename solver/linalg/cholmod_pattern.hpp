// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cholmod.h>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// The pattern as CHOLMOD sees it: a symmetric matrix without values, which CHOLMOD only reads and which must
/// outlive the result.
inline cholmod_sparse cholmod_pattern(const SparsityPattern& pattern) {
  cholmod_sparse lower = {};
  lower.nrow = lower.ncol = pattern.size;
  lower.nzmax = pattern.row.size();
  lower.p = const_cast<int*>(pattern.column_start.data());
  lower.i = const_cast<int*>(pattern.row.data());
  lower.stype = -1;
  lower.itype = CHOLMOD_INT;
  lower.xtype = CHOLMOD_PATTERN;
  lower.dtype = CHOLMOD_DOUBLE;
  lower.sorted = lower.packed = true;
  return lower;
}

}  // namespace esfem
