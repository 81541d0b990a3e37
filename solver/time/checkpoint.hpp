// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "solver/error.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// How far a run has come: its newest step, and of an adaptive run the size wanted for the next step and the
/// number of rejected steps.
struct RunPosition {
  int n = 0;
  double tau = 0;
  int rejected = 0;
};

/// A Field to the last bit, for CBOR: {"rows", "columns", "values": its doubles as they lie in memory}.
nlohmann::json packed(const Field& field);
/// Its inverse; InputError when the values are not rows x columns doubles.
Field unpacked(const nlohmann::json& json);

/// {"t", a packed Field for each of State::fields}.
template <class State>
nlohmann::json packed_state(const State& state) {
  nlohmann::json json = {{"t", state.t}};
  for (const NamedField<State>& field : State::fields) json[field.name] = packed(state.*field.member);
  return json;
}

/// Its inverse; InputError when a Field has not the size that it has in `like`.
template <class State>
State unpacked_state(const nlohmann::json& json, const State& like) {
  State state;
  state.t = json.at("t").get<double>();
  for (const NamedField<State>& field : State::fields) {
    const Field& expected = like.*field.member;
    Field& values = state.*field.member;
    values = unpacked(json.at(field.name));
    if (values.rows() != expected.rows() || values.cols() != expected.cols())
      throw InputError(format("%s is %td x %td, expected %td x %td", field.name, values.rows(), values.cols(),
                              expected.rows(), expected.cols()));
  }
  return state;
}

/// The bytes of a checkpoint file: the checksum (FNV-1a, 64 bits) of what follows, and the JSON as CBOR.
std::string seal(const nlohmann::json& json);
/// Its inverse; a discarded JSON value when the bytes are not what `seal` has made.
nlohmann::json unseal(const std::string& bytes);

/// A file from which a run that was stopped goes on bit for bit: the states of its History and whatever else
/// is attached. It belongs to one run; a file of another run is never taken for it.
class Checkpoint {
 public:
  /// The file is replaced (as a whole) every `seconds` seconds of wall-clock time at most; 0: at every step.
  /// `description` says which run this is; what it must contain is all that its numbers depend on: the
  /// version of the program, mesh, variant, parameters. Time grid and initial values are compared beside it.
  /// Folders that are missing are made. Throws InputError when they cannot be, or when `seconds` is negative.
  Checkpoint(std::string file, nlohmann::json description, double seconds = 30);

  /// Adds what belongs to the run beside the flow. What save() returns goes into the file; load(that) is
  /// called when the run goes on from there, and must restore it exactly, or throw.
  void attach(std::function<nlohmann::json()> save, std::function<void(const nlohmann::json&)> load);

  /// Fills the empty `past`, `progress` and what is attached from the file and returns true. Returns false
  /// and changes nothing when there is no file, or one that cannot be used: remark() says why.
  template <class State>
  bool resume(const nlohmann::json& grid, const State& initial, History<State>& past, RunPosition& progress) {
    identify(grid, packed_state(initial));
    return read([&](const nlohmann::json& run) {
      const RunPosition saved = {run.at("n").get<int>(), run.at("tau").get<double>(),
                                 run.at("rejected").get<int>()};
      std::vector<State> states;
      for (const nlohmann::json& state : run.at("states")) states.push_back(unpacked_state(state, initial));
      const int expected = std::min(past.capacity(), saved.n + 1), found = static_cast<int>(states.size());
      if (found != expected) throw InputError(format("%d states, expected %d", found, expected));
      load_attached(run.at("attached"));
      std::for_each(states.rbegin(), states.rend(), [&](State& state) { past.push(state); });
      progress = saved;
    });
  }

  /// Writes the file when it is time to. Throws InputError when it cannot be written.
  template <class State>
  void save_when_due(const RunPosition& progress, const History<State>& past) {
    if (std::chrono::steady_clock::now() - saved_ < interval_) return;
    nlohmann::json states = nlohmann::json::array();
    for (int j = 0; j < past.size(); ++j) states.push_back(packed_state(past.back(j)));
    write({{"n", progress.n},
           {"tau", progress.tau},
           {"rejected", progress.rejected},
           {"states", std::move(states)}});
  }

  /// Removes the file: the run is at its end.
  void remove();

  /// Why a file that was there has not been used; empty when it was, or when there was none.
  const std::string& remark() const { return remark_; }

 private:
  struct Companion {
    std::function<nlohmann::json()> save;
    std::function<void(const nlohmann::json&)> load;
  };

  void identify(const nlohmann::json& grid, const nlohmann::json& initial);
  bool read(const std::function<void(const nlohmann::json& run)>& restore);
  void load_attached(const nlohmann::json& saved);
  void write(nlohmann::json run);

  std::string file_;
  nlohmann::json description_, identity_;
  std::chrono::duration<double> interval_;
  std::chrono::steady_clock::time_point saved_ = std::chrono::steady_clock::now();
  std::vector<Companion> companions_;
  std::string remark_;
};

}  // namespace esfem
