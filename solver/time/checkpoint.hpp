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

/// How far a run has come: its newest step, and of an adaptive run the size wanted for the next step, the
/// number of rejected steps, and the least end time for which the sizes of its steps are the same.
struct RunPosition {
  int n = 0;             ///< the newest step
  double tau = 0;        ///< adaptive: size wanted for the next step
  int rejected = 0;      ///< adaptive: steps rejected so far
  double least_end = 0;  ///< adaptive: least end time with the same steps
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

/// FNV-1a with 64 bits, in hexadecimal digits.
std::string checksum(const std::string& bytes);

/// The bytes of a checkpoint file: the checksum of what follows, and the JSON as CBOR.
std::string seal(const nlohmann::json& json);
/// Its inverse; a discarded JSON value when the bytes are not what `seal` has made.
nlohmann::json unseal(const std::string& bytes);

/// A file from which a run resumes bit for bit: the states of its History and whatever else is attached. It
/// is kept when the run has ended, so that a run with a later end can resume from it. It belongs to one run;
/// a file of another run is neither used nor replaced. The file from which a run has resumed is kept as
/// FILE.previous when it is first replaced.
class Checkpoint {
 public:
  /// Takes a message for the user.
  using Say = std::function<void(const std::string& message)>;

  /// The file is replaced (as a whole) every `seconds` seconds of wall-clock time at most; 0: at every step.
  /// `description` identifies the run; it must contain everything that its numbers depend on: the version of
  /// the program, mesh, variant, parameters. Time grid and initial values are compared in addition. Contents
  /// of arrays are compared, but not shown in messages about differences. `say` receives the message that the
  /// run resumes, and where. Missing folders are created. Throws InputError when the file cannot be written,
  /// or when `seconds` is negative.
  Checkpoint(std::string file, nlohmann::json description, double seconds = 30, Say say = {});

  /// Instead of an InputError: a file that cannot be used is reported, and the run starts at t = 0 and
  /// replaces it. For files that no user has named; the file from which the run has resumed is not kept.
  void start_afresh_when_unusable() { starts_afresh_ = true; }

  /// Adds other parts of the run than the flow. The value of save() is stored in the file; load(value) is
  /// called when the run resumes, and must restore it exactly, or throw.
  void attach(std::function<nlohmann::json()> save, std::function<void(const nlohmann::json&)> load);

  /// Fills the empty `past`, `progress` and what is attached from the file and returns true; false when there
  /// is no file. Throws InputError, and changes nothing, when the file is of another run, damaged, or
  /// `objection` to its position is not empty: it says what differs and what to do.
  template <class State>
  bool resume(const nlohmann::json& grid, const State& initial, History<State>& past, RunPosition& progress,
              const std::function<std::string(const RunPosition&)>& objection) {
    identify(grid, packed_state(initial));
    return read([&](const nlohmann::json& run) {
      const RunPosition saved = {run.at("n").get<int>(), run.at("tau").get<double>(),
                                 run.at("rejected").get<int>(), run.at("least_end").get<double>()};
      std::vector<State> states;
      for (const nlohmann::json& state : run.at("states")) states.push_back(unpacked_state(state, initial));
      const int expected = std::min(past.capacity(), saved.n + 1), found = static_cast<int>(states.size());
      // More than steps have been taken, where the run has started with those of an earlier one.
      if (found < expected || found > past.capacity())
        throw InputError(format("%d states, expected %d", found, expected));
      const std::string why_not = objection(saved);
      if (!why_not.empty()) throw InputError(why_not);
      load_attached(run.at("attached"));
      std::for_each(states.rbegin(), states.rend(), [&](State& state) { past.push(state); });
      progress = saved;
      keeps_previous_ = !starts_afresh_;
      seconds_before_ = run.at("seconds").get<double>();
      return format("step %d, t = %g", saved.n, past.back(0).t);
    });
  }

  /// Writes the file when it is time to. Throws InputError when it cannot be written.
  template <class State>
  void save_when_due(const RunPosition& progress, const History<State>& past) {
    if (std::chrono::steady_clock::now() - saved_ >= interval_) save(progress, past);
  }
  /// The same at once.
  template <class State>
  void save(const RunPosition& progress, const History<State>& past) {
    nlohmann::json states = nlohmann::json::array();
    for (int j = 0; j < past.size(); ++j) states.push_back(packed_state(past.back(j)));
    write({{"n", progress.n},
           {"tau", progress.tau},
           {"rejected", progress.rejected},
           {"least_end", progress.least_end},
           {"states", std::move(states)}});
  }

  /// Wall-clock seconds that the run had taken when the file from which it has resumed was written; 0 when it
  /// has started at t = 0.
  double seconds_before() const { return seconds_before_; }

 private:
  struct Companion {
    std::function<nlohmann::json()> save;
    std::function<void(const nlohmann::json&)> load;
  };

  void identify(const nlohmann::json& grid, const nlohmann::json& initial);
  bool read(const std::function<std::string(const nlohmann::json& run)>& restore);
  void load_attached(const nlohmann::json& saved);
  void write(nlohmann::json run);
  void keep_previous() const;

  std::string file_;
  nlohmann::json description_, identity_;
  std::chrono::duration<double> interval_;
  Say say_;
  bool starts_afresh_ = false;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now(), saved_ = started_;
  double seconds_before_ = 0;
  bool keeps_previous_ = false;  ///< the file is that from which the run has resumed
  std::vector<Companion> companions_;
};

}  // namespace esfem
