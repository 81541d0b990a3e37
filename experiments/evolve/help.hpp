// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace esfem {

/// A configuration that runs, in --help.
inline const char* const evolve_example =
    R"(  {"flow": "mean_curvature", "surface": {"name": "ellipsoid", "axes": [1, 1, 0.6]}, "mesh": {"edge_length": 0.2},
   "tau": 0.001, "steps": 50, "output": {"series": "series.json", "vtu": "run.pvd", "every": 10}})";

/// One screen, the head of --help: what a configuration looks like, the flows, and where more is.
std::string evolve_help();

/// What --explain NAME prints: the keys of a flow, another subject, or "all". Throws InputError for other
/// names, listing the known ones.
std::string evolve_explanation(const std::string& name);

}  // namespace esfem
