// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/nearly_round_runs.hpp"

#include "solver/analysis/series.hpp"
#include "solver/flows/mean_curvature_flow.hpp"
#include "solver/problems/nearly_round_sphere.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

namespace {

template <class Flow>
void record_amplitude(Flow& flow, const UniformSteps& steps,
                      const StartingValues<typename Flow::State>& start, Row& row) {
  integrate(flow, steps, start, [&](int, const typename Flow::State& state) {
    row.series["t"].push_back(state.t);
    row.series["amplitude"].push_back(mode_amplitude(state.x));
  });
}

}  // namespace

void measure_mean_curvature_decay(const SurfaceSpace& space, const Field& x0, const UniformSteps& steps,
                                  Row& row) {
  MeanCurvatureFlow flow(space, {});
  record_amplitude(flow, steps, mean_curvature_state_on(nearly_round_sphere(), x0), row);
  row.values["amplitude_left"] = row.series["amplitude"].back() / row.series["amplitude"].front();
}

void measure_willmore_decay(const SurfaceSpace& space, const Field& x0, const WillmoreFlow::Variant& variant,
                            bool theta, const UniformSteps& steps, Row& row) {
  const WillmoreStart start = willmore_start_on(space, nearly_round_sphere(), x0, variant.law, theta);
  WillmoreFlow flow(space, variant, start.theta);
  record_amplitude(flow, steps, start.state, row);
  row.values["decay_rate"] = decay_rate(row.series, "amplitude", 0.01, row.series["t"].back());
}

}  // namespace esfem
