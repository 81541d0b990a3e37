// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/write_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "solver/error.hpp"

namespace esfem {

void write_file(const std::string& file, const std::string& text) {
  namespace fs = std::filesystem;
  if (file == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw InputError("standard output: cannot be written");
    return;
  }
  // A device such as /dev/null must not be replaced by a file.
  std::error_code ignored;
  const bool replace = !fs::exists(file, ignored) || fs::is_regular_file(file, ignored);
  const fs::path target(file);
  const std::string temporary =
      replace
          ? (target.parent_path() / format(".%s.%d.tmp", target.filename().c_str(), int(getpid()))).string()
          : file;

  errno = 0;
  std::ofstream stream(temporary, std::ios::binary);
  stream << text;
  stream.close();
  bool written = static_cast<bool>(stream);
  if (written && replace) written = std::rename(temporary.c_str(), file.c_str()) == 0;
  if (written) return;
  const std::string why = std::strerror(errno);
  if (replace) std::remove(temporary.c_str());
  throw InputError(file + ": cannot be written: " + why);
}

}  // namespace esfem
