// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities of a time series.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "solver/analysis/diagnostics.hpp"

namespace esfem {

/// The number of the first entry at or after time t, up to round-off, or of the last one. Throws InputError
/// when the series is empty.
std::size_t first_at(const Series& series, double t);

/// The number of the entry whose time is nearest to t. Throws InputError when the series is empty.
std::size_t nearest(const Series& series, double t);

/// The value of `name` at time t; nothing when there is no entry within 1e-9 of it, as after a run's end.
std::optional<double> recorded_at(const Series& series, const std::string& name, double t);

/// The value of `name` at first_at(t).
double value_at(const Series& series, const std::string& name, double t);

/// The largest rise from one value to the next; 0 when there is none.
double largest_rise(const std::vector<double>& values);

/// max |value - exact|.
double largest_deviation(const std::vector<double>& values, double exact);

/// lambda of c exp(-lambda t) through the values of `name` at two times (first_at).
double decay_rate(const Series& series, const std::string& name, double from, double to);

/// a of c exp(a t): least squares of the logarithms of the values (> 0) at the times t >= from.
double growth_rate(const std::vector<double>& t, const std::vector<double>& values, double from);

}  // namespace esfem
