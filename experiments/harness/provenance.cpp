// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/provenance.hpp"

#include <limits.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <set>

#include "solver/thread_count.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {

namespace {

std::string folder_of(const std::string& path) {
  return path.substr(0, path.rfind('/') + 1);
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

/// The command line with the bare name of the program: the folder it was called from says nothing about the
/// result.
std::string command_line(int argc, char** argv) {
  std::string command = std::string(argv[0]).substr(folder_of(argv[0]).size());
  for (int i = 1; i < argc; ++i) command += std::string(" ") + argv[i];
  return command;
}

}  // namespace

std::string executable_path() {
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  return length > 0 ? std::string(path, length) : std::string();
}

nlohmann::json build_identity() {
  std::ifstream file(executable_path(), std::ios::binary);
  return nlohmann::json::array({checksum({std::istreambuf_iterator<char>(file), {}})});
}

nlohmann::json provenance(int argc, char** argv) {
  nlohmann::json result = {{"version", "unknown"},
                           {"git", "unknown"},
                           {"dirty", false},
                           {"compiler", "unknown"},
                           {"flags", "unknown"}};
  std::ifstream file(folder_of(executable_path()) + "provenance.json");
  const nlohmann::json build = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  if (build.is_object()) result.update(build);
  result["cpu"] = cpu_model();
  result["threads"] = thread_count();
  result["date"] = utc_now();
  result["command"] = command_line(argc, argv);
  return result;
}

nlohmann::json collected_provenance(const std::vector<nlohmann::json>& cells, nlohmann::json own) {
  for (auto& [key, value] : own.items()) {
    if (key == "date" || key == "command") continue;
    std::set<nlohmann::json> different;
    for (const nlohmann::json& cell : cells)
      if (cell.contains(key)) different.insert(cell.at(key));
    if (different.size() == 1) value = *different.begin();
    if (different.size() > 1) value = different;
  }
  return own;
}

}  // namespace esfem
