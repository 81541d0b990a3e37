// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/read_json.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <vector>

#include "solver/error.hpp"

namespace esfem {
namespace {

using nlohmann::json;

/// Nested arrays and objects; recursive work on values must not use up the stack.
constexpr std::size_t deepest = 100;

std::string content_of(const std::string& file) {
  if (std::filesystem::is_directory(file)) throw InputError(file + ": cannot be read: is a directory");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file + ": cannot be read: " + std::strerror(errno));
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Watches the parser: the keys of the objects that are open, and which of them is read.
class OpenObjects {
 public:
  explicit OpenObjects(const std::string& file) : file_(file) {}

  void see(json::parse_event_t event, const json& parsed) {
    switch (event) {
    case json::parse_event_t::object_start:
    case json::parse_event_t::array_start:
      open_.emplace_back();
      if (open_.size() > deepest)
        throw InputError(
            format("%s%s: more than %zu nested arrays and objects", file_.c_str(), place().c_str(), deepest));
      break;
    case json::parse_event_t::object_end:
    case json::parse_event_t::array_end:
      open_.pop_back();
      break;
    case json::parse_event_t::key:
      open_.back().key = parsed.get<std::string>();
      if (!open_.back().seen.insert(open_.back().key).second)
        throw InputError(file_ + place() + " is given twice; expected once");
      break;
    case json::parse_event_t::value:
      break;
    }
  }

  /// `: key "output.series"`, the newest key with those that it is in; empty before the first one.
  std::string place() const {
    std::string keys;
    for (const Open& object : open_)
      if (!object.key.empty()) keys += (keys.empty() ? "" : ".") + object.key;
    return keys.empty() ? "" : ": key " + json(keys).dump();
  }

 private:
  struct Open {
    std::set<std::string> seen;
    std::string key;
  };
  const std::string& file_;
  std::vector<Open> open_;
};

/// A message of the parser without its name and number.
std::string without_tag(const std::string& message) {
  const std::size_t end = message.find("] ");
  return message.rfind("[json.exception", 0) == 0 && end != std::string::npos ? message.substr(end + 2)
                                                                              : message;
}

bool is_utf16(const std::string& content) {
  return content.rfind("\xFE\xFF", 0) == 0 || content.rfind("\xFF\xFE", 0) == 0;
}

}  // namespace

json read_json(const std::string& file) {
  return parse_json(content_of(file), file);
}

json parse_json(const std::string& content, const std::string& file) {
  if (is_utf16(content)) throw InputError(file + ": not JSON: text in UTF-16; expected UTF-8");
  OpenObjects objects(file);
  const auto watch = [&objects](int, json::parse_event_t event, json& parsed) {
    objects.see(event, parsed);
    return true;
  };
  try {
    return json::parse(content, watch);
  } catch (const json::parse_error& error) {
    const std::size_t position = std::min<std::size_t>(error.byte, content.size());
    const auto line = 1 + std::count(content.begin(), content.begin() + position, '\n');
    throw InputError(format("%s, line %td%s: not JSON: %s", file.c_str(), line, objects.place().c_str(),
                            without_tag(error.what()).c_str()));
  } catch (const json::out_of_range& error) {
    throw InputError(format("%s%s: %s; expected at most %.1e", file.c_str(), objects.place().c_str(),
                            without_tag(error.what()).c_str(), std::numeric_limits<double>::max()));
  }
}

}  // namespace esfem
