// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace esfem {

/// Reads and parses a JSON file (RFC 8259 in UTF-8, with or without byte order mark; no comments). Throws
/// InputError that names the file, and where they are known the line and the key, when it cannot be read, is
/// not JSON, has a key twice in one object, a number that no double can hold, or more than 100 nested arrays
/// and objects.
nlohmann::json read_json(const std::string& file);

/// The same for the content of a file.
nlohmann::json parse_json(const std::string& content, const std::string& file);

}  // namespace esfem
