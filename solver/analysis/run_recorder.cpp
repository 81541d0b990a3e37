// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/run_recorder.hpp"

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

RunRecorder::RunRecorder(const SurfaceSpace& space, SnapshotPlan plan, Energies energies)
    : space_(space), plan_(std::move(plan)), energies_(energies), curvature_(space) {
  for (std::size_t i = 1; i < plan_.times.size(); ++i)
    if (!(plan_.times[i] > plan_.times[i - 1]))
      throw InputError(format("snapshot times: found %g after %g, expected increasing times", plan_.times[i],
                              plan_.times[i - 1]));
  if (!plan_.pvd.empty()) collection_.emplace(plan_.pvd, space.degree(), space.elements(), plan_.run);
}

void RunRecorder::record(int n, double t, const Field& x, NodalFields fields) {
  Series step;
  record_geometry(space_, t, x, step);
  const Field* nu = find(fields, "nu");
  const Field* H = find(fields, "H");
  if (nu) record_normal_length(*nu, step);
  const bool writes = is_due(n, t), evolves_curvature = nu && H;
  const bool with_kappa = energies_ == of_flow_and_surface;
  if (writes || with_kappa || !evolves_curvature) curvature_.compute(x);
  if (with_kappa) step["kappa_energy"].push_back(curvature_.willmore_energy());
  record_curvature(space_, x, evolves_curvature ? *H : curvature_.H(), step);

  for (const auto& [name, values] : step) series_[name].push_back(values.front());
  newest_ = {n, t, x, std::move(fields)};
  if (writes) write_newest();
}

bool RunRecorder::is_due(int n, double t) {
  if (!collection_) return false;
  bool due = n == 0 || (plan_.every > 0 && n % plan_.every == 0);
  due = due || multiples(t) > multiples(newest_.t);
  return pass_times(t) || due;
}

/// How many multiples of every_time have been reached at time t, up to round-off.
double RunRecorder::multiples(double t) const {
  return plan_.every_time > 0 ? std::floor(t / plan_.every_time * (1 + 1e-9)) : 0;
}

bool RunRecorder::pass_times(double t) {
  const double slack = 1e-9 * std::abs(t);
  const std::size_t before = next_time_;
  while (next_time_ < plan_.times.size() && plan_.times[next_time_] <= t + slack) ++next_time_;
  return next_time_ > before;
}

void RunRecorder::write_newest() {
  NodalFields fields = newest_.fields;
  if (!find(fields, "nu")) fields.push_back({"nu", curvature_.nu()});
  if (!find(fields, "H")) fields.push_back({"H", curvature_.H()});
  fields.push_back({"kappa", curvature_.kappa()});
  snapshots_.push_back({newest_.t, collection_->add(newest_.step, newest_.t,
                                                    newest_.x.rowwise() + plan_.origin.transpose(), fields)});
}

double RunRecorder::CurvatureComparison::rate_difference() const {
  return rates.scale > 0 ? std::abs(rates.of_surface - rates.of_fields) / rates.scale : 0;
}

double RunRecorder::CurvatureComparison::energy_difference() const {
  return std::abs(energy - kappa_energy) / kappa_energy;
}

std::optional<RunRecorder::CurvatureComparison> RunRecorder::compare_curvature() {
  const Field *nu = find(newest_.fields, "nu"), *H = find(newest_.fields, "H"),
              *v = find(newest_.fields, "v");
  if (!nu || !H || !v) return {};
  curvature_.compute(newest_.x);
  return CurvatureComparison{curvature_.deviation(*nu, *H), series_.at("willmore_energy").back(),
                             curvature_.willmore_energy(), curvature_.area_rates(*nu, *H, *v)};
}

void RunRecorder::finish() {
  if (!collection_ || empty() || (!snapshots_.empty() && snapshots_.back().t == newest_.t)) return;
  curvature_.compute(newest_.x);
  write_newest();
}

nlohmann::json RunRecorder::progress() const {
  nlohmann::json snapshots = nlohmann::json::array(), collections = other_collections_,
                 fields = nlohmann::json::array();
  for (const Snapshot& snapshot : snapshots_)
    snapshots.push_back({{"t", snapshot.t}, {"file", snapshot.file}});
  if (collection_) collections[plan_.pvd] = std::move(snapshots);
  for (const NodalField& field : newest_.fields)
    fields.push_back({{"name", field.name}, {"values", packed(field.values)}});
  return {
      {"series", series_},
      {"collections", std::move(collections)},
      {"newest",
       {{"step", newest_.step}, {"t", newest_.t}, {"x", packed(newest_.x)}, {"fields", std::move(fields)}}}};
}

void RunRecorder::resume(const nlohmann::json& progress) {
  auto series = progress.at("series").get<Series>();
  nlohmann::json collections = progress.at("collections");
  std::vector<Snapshot> snapshots;
  std::vector<std::pair<double, std::string>> listed;
  if (collections.contains(plan_.pvd))
    for (const nlohmann::json& snapshot : collections.at(plan_.pvd)) {
      snapshots.push_back({snapshot.at("t").get<double>(), snapshot.at("file").get<std::string>()});
      listed.emplace_back(snapshots.back().t, snapshots.back().file);
    }
  const nlohmann::json& surface = progress.at("newest");
  Surface newest = {
      surface.at("step").get<int>(), surface.at("t").get<double>(), unpacked(surface.at("x")), {}};
  for (const nlohmann::json& field : surface.at("fields"))
    newest.fields.push_back({field.at("name").get<std::string>(), unpacked(field.at("values"))});

  if (collection_) collection_->resume(std::move(listed));
  collections.erase(plan_.pvd);
  other_collections_ = std::move(collections);
  series_ = std::move(series);
  snapshots_ = std::move(snapshots);
  newest_ = std::move(newest);
  next_time_ = 0;
  pass_times(newest_.t);
  if (collection_ && snapshots_.empty()) finish();
}

void attach(Checkpoint& checkpoint, RunRecorder& recorder) {
  checkpoint.attach([&recorder] { return recorder.progress(); },
                    [&recorder](const nlohmann::json& progress) { recorder.resume(progress); });
}

}  // namespace esfem
