// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace esfem {

/// For messages behind a list of names: "; did you mean \"tau\"?" for an unknown name that is one of the
/// known ones but for capitals and at most two letters left out, added, replaced or exchanged with their
/// neighbours, and no more than half of its own. Of equally close names the one that begins with it; "" when
/// none or several are.
std::string did_you_mean(const std::string& unknown, const std::vector<std::string>& known);

}  // namespace esfem
