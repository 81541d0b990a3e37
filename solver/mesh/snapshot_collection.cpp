// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh/snapshot_collection.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

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
  std::error_code error;
  if (path.has_parent_path()) fs::create_directories(path.parent_path(), error);
  if (error)
    throw InputError(path.parent_path().string() + ": this folder cannot be made: " + error.message());
}

std::string SnapshotCollection::add(int n, double t, const Field& x, const std::vector<PointField>& fields) {
  const fs::path path(pvd_);
  const std::string name = snapshot_name(path.stem().string(), snapshots_.size());
  write_vtu(degree_, elements_, x, fields, {n, t, run_}, (path.parent_path() / name).string());
  auto snapshots = snapshots_;
  snapshots.emplace_back(t, name);
  write_file(pvd_, pvd_text(snapshots));
  snapshots_ = std::move(snapshots);
  return name;
}

void SnapshotCollection::resume(std::vector<std::pair<double, std::string>> snapshots) {
  const fs::path folder = fs::path(pvd_).parent_path();
  for (const auto& [t, name] : snapshots)
    if (!fs::is_regular_file(folder / name))
      throw InputError(format("%s: the snapshot at t = %g is missing", (folder / name).c_str(), t));
  if (!snapshots.empty()) write_file(pvd_, pvd_text(snapshots));
  snapshots_ = std::move(snapshots);
}

}  // namespace esfem
