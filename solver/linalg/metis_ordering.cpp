// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/linalg/metis_ordering.hpp"

#include "solver/error.hpp"
#include "solver/linalg/cholmod_pattern.hpp"

namespace esfem {

std::vector<int> metis_ordering(const SparsityPattern& pattern) {
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  common.error_handler = nullptr;
  cholmod_sparse lower = cholmod_pattern(pattern);
  std::vector<int> ordering(pattern.size);
  const int permute_no_columns = 0, by_postorder = 1;
  const bool done =
      cholmod_metis(&lower, nullptr, permute_no_columns, by_postorder, ordering.data(), &common);
  const int status = common.status;
  cholmod_finish(&common);
  if (!done)
    throw NumericsError(format("ordering of %d unknowns failed (CHOLMOD status %d)", pattern.size, status));
  return ordering;
}

}  // namespace esfem
