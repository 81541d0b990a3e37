// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>

namespace esfem {

/// All readers of input files, by the name of their corpus: a function of a file's content
/// that returns, or throws InputError or NumericsError. Anything else (another exception, a crash, a hang, a
/// leak) is a fault.
const std::map<std::string, std::function<void(const std::string& content)>>& fuzz_targets();

}  // namespace esfem
