// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of a Cahn-Hilliard run over time, and its periodicity.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "solver/analysis/diagnostics.hpp"
#include "solver/flows/cahn_hilliard.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {

/// Appends to the series "t", "energy" (Ginzburg-Landau), "mass" (integral of u), "min_u" and "max_u" (of the
/// nodal values).
void record_energy(const SurfaceSpace& space, const CahnHilliardState& state, double epsilon, Series& series);

/// A run that resumes from the checkpoint continues its series, too. They must outlive the run.
void attach(Checkpoint& checkpoint, Series& series);

/// Every k-th entry of each series, and the last one, with the smallest k that leaves at most `most` + 1 of
/// them.
Series thinned(const Series& series, std::size_t most);

/// The number of the entry with the largest (smallest) value of `name` for times in [from, to], the first of
/// equal ones. Throws InputError when there is none.
/// @{
std::size_t largest_in(const Series& series, const std::string& name, double from, double to);
std::size_t smallest_in(const Series& series, const std::string& name, double from, double to);
/// @}

/// The period of a quantity sampled at equal steps: the lag L in [shortest, longest] for which the mean of
/// (f(t + L) - f(t))² over t in [from, end - longest] is least, between two steps by a parabola. Throws
/// InputError when the series is shorter than that.
double period(const Series& series, const std::string& name, double from, double shortest, double longest);

/// max |f(t) - f(t - period)| over the last period, relative to max f - min f in it; the period is rounded to
/// steps. Throws InputError when the series is shorter than two periods.
double aperiodicity(const Series& series, const std::string& name, double period);

}  // namespace esfem
