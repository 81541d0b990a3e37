// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace esfem {

/// What every --help ends with.
extern const char* const exit_codes_help;

/// Parses the command line. Returns false when --help was asked for and printed: then the program is done.
/// Throws InputError with one line that says what is wrong and what is accepted.
bool parse_command_line(CLI::App& app, int argc, char** argv);

/// Parses a list of non-negative numbers such as "0,1,2", "0-4" or "0-2,5"; `option` is named in the
/// InputError.
std::vector<int> parse_list(const std::string& text, const std::string& option);

}  // namespace esfem
