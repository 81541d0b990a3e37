// SPDX-License-Identifier: GPL-3.0-or-later
// Records of the spinodal decomposition on a sphere (PFHub benchmark 1d).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/analysis/run_recorder.hpp"
#include "solver/problems/pfhub_sphere.hpp"
#include "solver/tables/table.hpp"

namespace esfem {

/// Times of the published energies; the second and the third are rounded there.
struct PublishedTime {
  const char* name;
  double t;
};
const std::array<PublishedTime, 6> published_times = {{{"6.1051", 6.1051},
                                                       {"14.158", 14.15765},
                                                       {"30.263", 30.26275},
                                                       {"297.45", 297.45},
                                                       {"1000", 1000},
                                                       {"5006", 5006}}};

/// The times of the published run until its third published energy.
inline std::vector<double> moose_times() {
  std::vector<double> times = {0};
  for (int n = 0; n < 20; ++n) times.push_back(times.back() + std::pow(1.1, std::min(n, 5)));
  return times;
}

/// Observes every step of a run; records the first 200, then every fourth, and the last one: c and mu, and
/// the series energy, min_c, max_c and domains, the number of connected parts of the surface where c > 0.5,
/// and where c < 0.5. An observer of integrate; space and recorder must outlive it.
class PfhubObserver {
 public:
  /// x: the nodes, at rest.
  PfhubObserver(const SurfaceSpace& space, const Field& x, RunRecorder& recorder, double end_time);

  void operator()(int n, const CahnHilliardState& state);

  /// The numbers that claims are about: energies at the published times, the largest relative rise of the
  /// energy in a step, the drift of the mass, when the energy is within 1% of the last one, .. The row has
  /// the recorder's series.
  void describe(Row& row) const;

  /// Values that do not follow from the series.
  nlohmann::json progress() const;
  void resume(const nlohmann::json& saved);

 private:
  const SurfaceSpace& space_;
  RunRecorder& recorder_;
  double end_time_;
  SymmetricMatrix A_;
  std::array<double, 3> before_ = {};  ///< t, energy and its derivative at the step before
  std::vector<double> energies_;       ///< at the published times
  double first_mass_ = 0, mass_drift_ = 0, largest_rise_ = -1;
};

}  // namespace esfem
