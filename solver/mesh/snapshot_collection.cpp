// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/snapshot_collection.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "solver/error.hpp"
#include "solver/write_file.hpp"

namespace esfem {
namespace {

namespace fs = std::filesystem;

/// The value of an XML attribute.
std::string escaped(const std::string& text) {
  static const std::map<char, std::string> entities = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string result;
  for (const char c : text) result += entities.count(c) ? entities.at(c) : std::string(1, c);
  return result;
}

std::string pvd_text(const std::vector<std::pair<double, std::string>>& snapshots) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto& [t, file] : snapshots)
    text += format("    <DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n", t, escaped(file).c_str());
  return text + "  </Collection>\n</VTKFile>\n";
}

std::string snapshot_name(const std::string& stem, std::size_t i) {
  return stem + format("_%04zu.vtu", i);
}

/// Whether snapshot_name gives this name for some i.
bool is_snapshot_name(const std::string& name, const std::string& stem) {
  static const std::regex number(R"(_([0-9]{4}|[1-9][0-9]{4,})\.vtu)");
  return name.compare(0, stem.size(), stem) == 0 && std::regex_match(name.substr(stem.size()), number);
}

}  // namespace

SnapshotCollection::SnapshotCollection(std::string pvd, int degree, Connectivity elements, RunLabel run)
    : pvd_(std::move(pvd)), degree_(degree), elements_(std::move(elements)), run_(std::move(run)) {
  const fs::path path(pvd_);
  if (path.extension() != ".pvd")
    throw InputError("'" + pvd_ + "': a name that ends in .pvd expected for a collection of snapshots");
  std::string visible = pvd_;
  std::replace_if(
      visible.begin(), visible.end(), [](unsigned char c) { return c < ' '; }, '?');
  if (visible != pvd_)
    throw InputError("'" + visible +
                     "': a name of visible characters expected for a collection of snapshots");
  prepare_output(pvd_);
  remove_abandoned(path.parent_path().string(),
                   [&](const std::string& file) { return is_snapshot_name(file, path.stem().string()); });
}

std::string SnapshotCollection::add(int n, double t, const Field& x, const NodalFields& fields) {
  const fs::path path(pvd_);
  const std::string name = snapshot_name(path.stem().string(), snapshots_.size());
  write_vtu(degree_, elements_, x, fields, {n, t, run_}, (path.parent_path() / name).string());
  auto snapshots = snapshots_;
  snapshots.emplace_back(t, name);
  write_file(pvd_, pvd_text(snapshots));
  snapshots_ = std::move(snapshots);
  if (!others_removed_) remove_unlisted();
  others_removed_ = true;
  return name;
}

bool is_snapshot_of(const std::string& file, const std::string& pvd) {
  const auto folder = [](const fs::path& path) {
    std::error_code error;
    return fs::weakly_canonical(fs::absolute(path, error).parent_path(), error);
  };
  return !pvd.empty() &&
         is_snapshot_name(fs::path(file).filename().string(), fs::path(pvd).stem().string()) &&
         folder(file) == folder(pvd);
}

void SnapshotCollection::resume(std::vector<std::pair<double, std::string>> snapshots) {
  const fs::path folder = fs::path(pvd_).parent_path();
  for (const auto& [t, name] : snapshots)
    if (!fs::is_regular_file(folder / name))
      throw InputError(format("%s, the snapshot at t = %g, is missing", (folder / name).c_str(), t));
  if (!snapshots.empty()) write_file(pvd_, pvd_text(snapshots));
  snapshots_ = std::move(snapshots);
  others_removed_ = false;
}

/// Files that `add` of an earlier run has written: beside those of this run they would look like its end.
void SnapshotCollection::remove_unlisted() const {
  const fs::path path(pvd_), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::set<std::string> listed;
  for (const auto& [t, name] : snapshots_) listed.insert(name);
  std::vector<fs::path> others;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (is_snapshot_name(name, path.stem().string()) && !listed.count(name) &&
        entry->symlink_status().type() == fs::file_type::regular)
      others.push_back(entry->path());
  }
  if (error) throw InputError(folder.string() + ": this folder cannot be listed: " + error.message());
  for (const fs::path& other : others) {
    fs::remove(other, error);
    if (error)
      throw InputError(other.string() + ": this snapshot of an earlier run cannot be removed: " +
                       error.message() + "; remove it, or choose another name for the collection");
  }
}

}  // namespace esfem
