// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/write_file.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <regex>

#include "solver/error.hpp"

namespace esfem {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError(file + ": cannot be written: " + why);
}

/// A device such as /dev/null must not be replaced by a file.
bool is_replaced(const std::string& file) {
  std::error_code ignored;
  return !fs::exists(file, ignored) || fs::is_regular_file(file, ignored);
}

/// What a link points to, or the file itself.
fs::path target_of(const std::string& file) {
  std::error_code error;
  const fs::path target = fs::is_symlink(file, error) ? fs::canonical(file, error) : fs::path(file);
  return error ? fs::path(file) : target;
}

std::string temporary_name(const fs::path& target) {
  return (target.parent_path() / format(".%s.%d.tmp", target.filename().c_str(), int(getpid()))).string();
}

int open_to_write(const std::string& file) {
  return open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

bool write_all(int descriptor, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t count = write(descriptor, text.data() + done, text.size() - done);
    if (count < 0 && errno != EINTR) return false;
    done += std::max<ssize_t>(count, 0);
  }
  return true;
}

/// Whether all of the text was written; errno says why not. A full disk may show only when the data are
/// really written.
bool write_through(const std::string& file, const std::string& text, bool synchronise) {
  const int descriptor = open_to_write(file);
  if (descriptor < 0) return false;
  const bool written = write_all(descriptor, text) && (!synchronise || fsync(descriptor) == 0);
  const int why = errno;
  const bool closed = close(descriptor) == 0;
  if (!written) errno = why;
  return written && closed;
}

/// The file of which this is the temporary name, when the process that has made it runs no more; else "".
std::string abandoned_file(const std::string& name) {
  static const std::regex pattern(R"(\.(.+)\.([0-9]{1,9})\.tmp)");
  std::smatch match;
  if (!std::regex_match(name, match, pattern)) return "";
  return kill(std::stoi(match[2]), 0) != 0 && errno == ESRCH ? match[1].str() : "";
}

}  // namespace

void write_file(const std::string& file, const std::string& text) {
  if (file == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw InputError("standard output: cannot be written");
    return;
  }
  if (!is_replaced(file)) {
    if (!write_through(file, text, /*synchronise=*/false)) refuse(file, std::strerror(errno));
    return;
  }
  const fs::path target = target_of(file);
  const std::string temporary = temporary_name(target);
  if (write_through(temporary, text, /*synchronise=*/true) &&
      std::rename(temporary.c_str(), target.c_str()) == 0)
    return;
  const std::string why = std::strerror(errno);
  std::remove(temporary.c_str());
  refuse(file, why);
}

void remove_abandoned(const std::string& folder,
                      const std::function<bool(const std::string& file)>& is_ours) {
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string file = abandoned_file(entry->path().filename().string());
    std::error_code ignored;
    if (!file.empty() && is_ours(file)) fs::remove(entry->path(), ignored);
  }
}

void prepare_output(const std::string& file) {
  if (file == "-") {
    if (fcntl(STDOUT_FILENO, F_GETFD) < 0)
      throw InputError("standard output: cannot be written: it is closed");
    return;
  }
  if (file.empty() || file.find('\0') != std::string::npos)
    refuse(format("'%s'", file.c_str()), "not the name of a file");
  const fs::path target = target_of(file), folder = target.parent_path();
  std::error_code error;
  if (!folder.empty()) fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": this folder cannot be made: " + error.message());
  if (fs::is_directory(target, error)) refuse(file, "it is a folder");
  if (fs::exists(target, error) && access(target.c_str(), W_OK) != 0) refuse(file, std::strerror(errno));
  if (!is_replaced(file)) return;
  remove_abandoned(folder.string(), [&](const std::string& other) { return other == target.filename(); });
  const std::string temporary = temporary_name(target);
  if (!write_through(temporary, "", /*synchronise=*/false)) refuse(file, std::strerror(errno));
  std::remove(temporary.c_str());
}

}  // namespace esfem
