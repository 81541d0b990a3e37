// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/pfhub_observer.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace esfem {
namespace {

/// The number of connected parts of the surface where c > 0.5, and where c < 0.5. On a sphere there is one
/// curve less between them.
int count_domains(const SparsityPattern& neighbours, const Field& c) {
  std::vector<int> parent(neighbours.size);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  int domains = neighbours.size;
  for (int j = 0; j < neighbours.size; ++j) {
    for (int k = neighbours.column_start[j]; k < neighbours.column_start[j + 1]; ++k) {
      const int i = neighbours.row[k];
      if ((c(i) > 0.5) != (c(j) > 0.5) || root(i) == root(j)) continue;
      parent[root(i)] = root(j);
      --domains;
    }
  }
  return domains;
}

/// Hermite's cubic interpolation at t of a function with values and derivatives at two times.
double interpolate(const std::array<double, 3>& before, const std::array<double, 3>& after, double t) {
  const auto [t0, f0, d0] = before;
  const auto [t1, f1, d1] = after;
  const double tau = t1 - t0, s = (t - t0) / tau, r = 1 - s;
  return r * r * (1 + 2 * s) * f0 + s * s * (1 + 2 * r) * f1 + tau * s * r * (r * d0 - s * d1);
}

}  // namespace

PfhubObserver::PfhubObserver(const SurfaceSpace& space, const Field& x, RunRecorder& recorder,
                             double end_time)
    : space_(space), recorder_(recorder), end_time_(end_time), A_(space.matrix()) {
  SymmetricMatrix M = space.matrix();
  space.assemble(x, M, A_);
}

void PfhubObserver::operator()(int n, const CahnHilliardState& state) {
  // d/dt of the energy is - int M |grad mu|², and w = M mu.
  const double energy = pfhub_energy(space_, state.x, state.u), mass = state.Mu.sum();
  const std::array<double, 3> now = {state.t, energy, -A_.energy(state.w) / PfhubSphere::mobility};
  if (n == 0) first_mass_ = mass;
  mass_drift_ = std::max(mass_drift_, std::abs(mass / first_mass_ - 1));
  if (n > 0) {
    largest_rise_ = std::max(largest_rise_, energy / before_[1] - 1);
    while (energies_.size() < published_times.size() &&
           published_times[energies_.size()].t <= state.t * (1 + 1e-9))
      energies_.push_back(interpolate(before_, now, published_times[energies_.size()].t));
  }
  before_ = now;
  if (n > 200 && n % 4 != 0 && state.t < end_time_ * (1 - 1e-9)) return;
  recorder_.record(n, state.t, state.x, {{"c", state.u}, {"mu", state.w / PfhubSphere::mobility}});
  Series& series = recorder_.series();
  series["energy"].push_back(energy);
  series["min_c"].push_back(state.u.minCoeff());
  series["max_c"].push_back(state.u.maxCoeff());
  series["domains"].push_back(count_domains(*space_.pattern(), state.u));
}

void PfhubObserver::describe(Row& row) const {
  for (std::size_t i = 0; i < energies_.size(); ++i)
    row.values[std::string("energy_at_") + published_times[i].name] = energies_[i];
  const std::vector<double>&t = row.series.at("t"), &energy = row.series.at("energy");
  row.values["initial_energy"] = energy.front();
  row.values["last_energy"] = energy.back();
  row.values["last_domains"] = row.series.at("domains").back();
  row.values["largest_rise"] = largest_rise_;
  row.values["mass_drift"] = mass_drift_;
  std::size_t i = energy.size() - 1;
  while (i > 0 && std::abs(energy[i - 1] / energy.back() - 1) < 0.01) --i;
  row.values["steady_from"] = t[i];
}

nlohmann::json PfhubObserver::progress() const {
  return {{"before", before_},
          {"energies", energies_},
          {"first_mass", first_mass_},
          {"mass_drift", mass_drift_},
          {"largest_rise", largest_rise_}};
}

void PfhubObserver::resume(const nlohmann::json& saved) {
  before_ = saved.at("before");
  energies_ = saved.at("energies").get<std::vector<double>>();
  first_mass_ = saved.at("first_mass");
  mass_drift_ = saved.at("mass_drift");
  largest_rise_ = saved.at("largest_rise");
}

}  // namespace esfem
