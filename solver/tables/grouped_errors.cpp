// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/grouped_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/error.hpp"

namespace esfem {
namespace {

/// Replaces values by their logarithms less the mean of these, so that constants and orders are hardly
/// correlated; returns that mean.
double centre_logarithms(const std::vector<double>& values, std::vector<double>& logarithms) {
  double mean = 0;
  for (double value : values) logarithms.push_back(std::log(value));
  for (double value : logarithms) mean += value / values.size();
  for (double& value : logarithms) value -= mean;
  return mean;
}

void check_input(const std::vector<double>& h, const std::vector<double>& tau,
                 const std::vector<double>& error) {
  if (h.size() != error.size() || tau.size() != error.size())
    throw InputError(format("order fit: %zu values of h, %zu of tau, %zu errors: expected as many of each",
                            h.size(), tau.size(), error.size()));
  for (std::size_t i = 0; i < error.size(); ++i) {
    const bool good = h[i] > 0 && tau[i] > 0 && error[i] > 0 && std::isfinite(h[i] + tau[i] + error[i]);
    if (!good)
      throw InputError(
          format("order fit, row %zu: h = %g, tau = %g, error = %g: expected positive finite numbers", i + 1,
                 h[i], tau[i], error[i]));
  }
  if (error.size() < 3)
    throw InputError(
        format("order fit: %zu rows, at least 3 are needed (5 when h and tau both vary)", error.size()));
}

}  // namespace

std::vector<Group> groups_of(const std::vector<double>& places) {
  std::vector<int> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return places[a] > places[b]; });
  std::vector<Group> groups;
  for (int i : order) {
    if (groups.empty() || groups.back().place - places[i] > 1e-6) groups.push_back({places[i], {}});
    groups.back().rows.push_back(i);
  }
  return groups;
}

LogErrors chosen(const LogErrors& rows, const std::vector<int>& which) {
  LogErrors result;
  for (int i : which) {
    result.h.push_back(rows.h[i]);
    result.tau.push_back(rows.tau[i]);
    result.error.push_back(rows.error[i]);
  }
  return result;
}

LogErrors without(const LogErrors& rows, const Group& group) {
  std::vector<int> others;
  for (int i = 0; i < rows.rows(); ++i)
    if (std::find(group.rows.begin(), group.rows.end(), i) == group.rows.end()) others.push_back(i);
  return chosen(rows, others);
}

GroupedErrors grouped_errors(const std::vector<double>& h, const std::vector<double>& tau,
                             const std::vector<double>& error) {
  check_input(h, tau, error);
  GroupedErrors data;
  data.centre_h = centre_logarithms(h, data.rows.h);
  data.centre_tau = centre_logarithms(tau, data.rows.tau);
  for (double value : error) data.rows.error.push_back(std::log(value));
  data.meshes = groups_of(data.rows.h);
  data.step_sizes = groups_of(data.rows.tau);
  if (data.meshes.size() < 2 && data.step_sizes.size() < 2)
    throw InputError("order fit: neither h nor tau varies, at least one of them has to");
  if (data.meshes.size() > 1 && data.step_sizes.size() > 1 && data.rows.rows() < 5)
    throw InputError(
        format("order fit: %d rows, at least 5 are needed when h and tau both vary", data.rows.rows()));
  return data;
}

}  // namespace esfem
