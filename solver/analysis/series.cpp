// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/analysis/series.hpp"

#include <algorithm>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {

std::size_t first_at(const Series& series, double t) {
  const std::vector<double>& times = series.at("t");
  if (times.empty()) throw InputError("the series is empty");
  const auto found = std::lower_bound(times.begin(), times.end(), t * (1 - 1e-9));
  return std::min<std::size_t>(found - times.begin(), times.size() - 1);
}

std::size_t nearest(const Series& series, double t) {
  const std::vector<double>& times = series.at("t");
  if (times.empty()) throw InputError("the series is empty");
  const auto closer = [t](double a, double b) { return std::abs(a - t) < std::abs(b - t); };
  return std::min_element(times.begin(), times.end(), closer) - times.begin();
}

std::optional<double> recorded_at(const Series& series, const std::string& name, double t) {
  const std::size_t i = nearest(series, t);
  if (std::abs(series.at("t")[i] - t) > 1e-9) return {};
  return series.at(name)[i];
}

double value_at(const Series& series, const std::string& name, double t) {
  return series.at(name)[first_at(series, t)];
}

double largest_rise(const std::vector<double>& values) {
  double rise = 0;
  for (std::size_t i = 1; i < values.size(); ++i) rise = std::max(rise, values[i] - values[i - 1]);
  return rise;
}

double largest_deviation(const std::vector<double>& values, double exact) {
  double deviation = 0;
  for (const double value : values) deviation = std::max(deviation, std::abs(value - exact));
  return deviation;
}

double decay_rate(const Series& series, const std::string& name, double from, double to) {
  const std::size_t i = first_at(series, from), j = first_at(series, to);
  const std::vector<double>&t = series.at("t"), &values = series.at(name);
  return std::log(values[i] / values[j]) / (t[j] - t[i]);
}

double growth_rate(const std::vector<double>& t, const std::vector<double>& values, double from) {
  double n = 0, sum_t = 0, sum_y = 0, sum_tt = 0, sum_ty = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (t[i] < from) continue;
    const double y = std::log(values[i]);
    n += 1, sum_t += t[i], sum_y += y, sum_tt += t[i] * t[i], sum_ty += t[i] * y;
  }
  return (n * sum_ty - sum_t * sum_y) / (n * sum_tt - sum_t * sum_t);
}

}  // namespace esfem
