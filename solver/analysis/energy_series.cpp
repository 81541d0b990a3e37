// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/energy_series.hpp"

#include <algorithm>
#include <cmath>

#include "solver/analysis/series.hpp"
#include "solver/error.hpp"

namespace esfem {

void record_energy(const SurfaceSpace& space, const CahnHilliardState& state, double epsilon,
                   Series& series) {
  series["t"].push_back(state.t);
  series["energy"].push_back(ginzburg_landau_energy(space, state.x, state.u, epsilon));
  series["mass"].push_back(state.Mu.sum());
  series["min_u"].push_back(state.u.minCoeff());
  series["max_u"].push_back(state.u.maxCoeff());
}

void attach(Checkpoint& checkpoint, Series& series) {
  checkpoint.attach([&series] { return nlohmann::json(series); },
                    [&series](const nlohmann::json& saved) { series = saved.get<Series>(); });
}

Series thinned(const Series& series, std::size_t most) {
  Series result;
  for (const auto& [name, values] : series) {
    const std::size_t k = std::max<std::size_t>(1, (values.size() + most - 1) / most);
    for (std::size_t i = 0; i < values.size(); i += k) result[name].push_back(values[i]);
    if (!values.empty() && (values.size() - 1) % k != 0) result[name].push_back(values.back());
  }
  return result;
}

namespace {

std::size_t extremum_in(const Series& series, const std::string& name, double from, double to, double sign) {
  const std::vector<double>&times = series.at("t"), &values = series.at(name);
  std::size_t found = times.size();
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i] < from || times[i] > to) continue;
    if (found == times.size() || sign * values[i] > sign * values[found]) found = i;
  }
  if (found == times.size())
    throw InputError(format("%s: found no time in [%g, %g], expected some", name.c_str(), from, to));
  return found;
}

double step_of(const std::vector<double>& times) {
  return (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

}  // namespace

std::size_t largest_in(const Series& series, const std::string& name, double from, double to) {
  return extremum_in(series, name, from, to, 1);
}

std::size_t smallest_in(const Series& series, const std::string& name, double from, double to) {
  return extremum_in(series, name, from, to, -1);
}

double period(const Series& series, const std::string& name, double from, double shortest, double longest) {
  const std::vector<double>&times = series.at("t"), &f = series.at(name);
  if (times.size() < 2 || times.back() - longest <= from)
    throw InputError(format("period of %s: found times to %g, expected more than %g", name.c_str(),
                            times.empty() ? 0 : times.back(), from + longest));
  const double tau = step_of(times);
  const int first = static_cast<int>(nearest(series, from)), low = static_cast<int>(shortest / tau),
            high = static_cast<int>(longest / tau), end = static_cast<int>(times.size()) - 1 - high;
  const auto change = [&](int lag) {
    double sum = 0;
    for (int i = first; i < end; ++i) sum += (f[i + lag] - f[i]) * (f[i + lag] - f[i]);
    return sum;
  };
  std::vector<double> changes;
  for (int lag = low; lag <= high; ++lag) changes.push_back(change(lag));
  const auto best = std::min_element(changes.begin(), changes.end());
  const double lag = low + static_cast<double>(best - changes.begin());
  if (best == changes.begin() || best == changes.end() - 1) return lag * tau;
  const double slope = (best[1] - best[-1]) / 2, bend = best[1] - 2 * best[0] + best[-1];
  return (bend > 0 ? lag - slope / bend : lag) * tau;
}

double aperiodicity(const Series& series, const std::string& name, double period) {
  const std::vector<double>&times = series.at("t"), &f = series.at(name);
  const std::size_t lag = times.size() < 2 ? 0 : std::lround(period / step_of(times));
  if (lag == 0 || 2 * lag >= times.size())
    throw InputError(format("periods of %s: found times to %g, expected two periods of %g", name.c_str(),
                            times.empty() ? 0 : times.back(), period));
  double change = 0;
  for (std::size_t i = f.size() - 1 - lag; i < f.size(); ++i)
    change = std::max(change, std::abs(f[i] - f[i - lag]));
  const auto [low, high] = std::minmax_element(f.end() - 1 - lag, f.end());
  return change / (*high - *low);
}

}  // namespace esfem
