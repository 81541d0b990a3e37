// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/assembly/symmetric_matrix.hpp"

namespace esfem {

/// A fill-reducing order of the unknowns of a pattern by METIS's nested dissection: the k-th is ordering[k].
/// The same in every process, so that runs are reproducible to the last bit. Throws NumericsError when it
/// fails.
std::vector<int> metis_ordering(const SparsityPattern& pattern);

}  // namespace esfem
