// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace esfem {

/// Half a turn, in radians.
constexpr double pi = 3.14159265358979323846;
/// A full turn, in radians.
constexpr double turn = 2 * pi;

}  // namespace esfem
