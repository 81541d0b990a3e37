// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "solver/flows/willmore_law.hpp"
#include "solver/formulas/formula.hpp"

namespace esfem {

/// Q of Helfrich flow (helfrich_law) whose spontaneous curvature is a function of place and time: a formula
/// with the variables x, y, z, t (names_in_space_time). On a surface that moves with V nu its value changes
/// at the rate V nu . grad H_0, so that two terms are added to those of a constant H_0:
///   Q = |A|² (H - H_0) - 1/2 H (H - H_0)² - Delta_Gamma H_0 + (H - H_0) nu . grad H_0,
///   Delta_Gamma H_0 = Delta H_0 - nu . D² H_0 nu - H nu . grad H_0,
/// with the derivatives in space. The energy falls where H_0 does not depend on t.
WillmoreLaw helfrich_law(const Formula& H_0);

}  // namespace esfem
