// SPDX-License-Identifier: GPL-3.0-or-later
// The "history" of a nodal output: what a run of equal steps needs to go on bit for bit.
//   {"step", "tau", "start_time", "bdf", "origin": [..], "start": field, "states": [state, ..], "flow": ..}
// start: the nodes at the start of the run; states: the q newest, the newest first, all Fields of the State;
// flow: what it keeps from step to step. A field is {"rows", "columns", "numbers": column by column, all
// digits}.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/evolve/config.hpp"
#include "solver/error.hpp"
#include "solver/time/integrate.hpp"

namespace esfem {

/// JSON of a checkpoint, whose Fields are bytes (`packed`), with numbers that text can hold, and its inverse.
nlohmann::json in_numbers(const nlohmann::json& packed);
nlohmann::json in_bytes(const nlohmann::json& numbers);
inline Field field_in_numbers(const nlohmann::json& numbers) {
  return unpacked(in_bytes(numbers));
}

/// Null unless `past` has all states of a step, the newest of time t.
template <class Flow>
nlohmann::json history_of(const EvolveConfig& config, const UniformSteps& steps, int n, double t, Flow& flow,
                          const History<typename Flow::State>& past) {
  if (past.size() < steps.order || past.back(0).t != t) return nullptr;
  nlohmann::json states = nlohmann::json::array(), flow_keeps;
  for (int j = 0; j < past.size(); ++j) states.push_back(in_numbers(packed_state(past.back(j))));
  if constexpr (KeepsProgress<Flow>::value) flow_keeps = in_numbers(flow.progress());
  return {{"step", steps.first + n},
          {"tau", steps.tau},
          {"start_time", steps.start_time},
          {"bdf", steps.order},
          {"origin", {config.origin[0], config.origin[1], config.origin[2]}},
          {"start", in_numbers(packed(config.mesh.nodes))},
          {"states", std::move(states)},
          {"flow", std::move(flow_keeps)}};
}

/// Runs `body`, which reads a history; what is wrong in it is an InputError that names the file.
template <class Body>
void in_history_of(const std::string& file, Body&& body) {
  std::string wrong;
  try {
    return body();
  } catch (const nlohmann::json::exception& error) {
    wrong = error.what();
  } catch (const InputError& error) {
    wrong = error.what();
  }
  throw InputError(file + ": history: " + wrong);
}

/// What a run starts from that goes on from the configuration's history; `like`: a state of the same sizes.
/// Throws InputError when the states do not have these.
template <class Flow>
void start_from_history(const EvolveConfig& config, const typename Flow::State& like, Flow& flow,
                        StartingValues<typename Flow::State>& start) {
  using State = typename Flow::State;
  in_history_of(config.initial_file, [&] {
    std::vector<State> states;
    for (const nlohmann::json& state : config.history.at("states"))
      states.push_back(unpacked_state(in_bytes(state), like));
    if (static_cast<int>(states.size()) != config.grid.order)
      throw InputError(format("%zu states; expected %d", states.size(), config.grid.order));
    if (states[0].t != config.grid.time(0))
      throw InputError(
          format("its newest state is of t = %.17g; expected %.17g", states[0].t, config.grid.time(0)));
    if constexpr (KeepsProgress<Flow>::value) flow.resume(in_bytes(config.history.at("flow")));
    start.initial = states.front();
    start.before.assign(states.begin() + 1, states.end());
  });
}

}  // namespace esfem
