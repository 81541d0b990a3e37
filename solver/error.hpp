// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace esfem {

/// Exit codes of every executable.
enum ExitCode { exit_done = 0, exit_usage = 1, exit_numerics = 2, exit_claim = 3, exit_signal = 128 };

/// Wrong usage or bad input (exit 1). The message is one line: what was found, where, and what was expected.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The numerics failed (exit 2): non-finite value, degenerate element (with its number), factorisation
/// failed. Low levels say what and where; the time loop adds the step and the time by `at`.
struct NumericsError : std::runtime_error {
  using std::runtime_error::runtime_error;
  /// The same error with step and time in front.
  NumericsError at(int step, double t) const;
};

/// The computed solution ends here: a singularity is near, or its elements have degenerated. Earlier results
/// are valid; a run keeps them and reports "singular at t = ...".
struct SingularityError : NumericsError {
  using NumericsError::NumericsError;
  SingularityError at(int step, double t) const;  ///< "singular at t = .. (step ..): .."
};

/// An adaptive step is not accurate enough, even the smallest.
struct ToleranceError : NumericsError {
  using NumericsError::NumericsError;
  ToleranceError at(int step, double t) const;  ///< the same with step and time in front
};

/// The surface shrinks to a point: earlier results are valid, and there is no solution afterwards.
struct ExtinctionError : NumericsError {
  using NumericsError::NumericsError;
  ExtinctionError at(int step, double t) const;  ///< the message, with step and time behind it
};

/// A run was asked to stop and has stopped after a whole step; its results are valid (by a signal:
/// exit_signal and its number, 130 for SIGINT, 143 for SIGTERM).
struct StoppedError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// printf-style formatting into a std::string ("%.17g" and so on).
std::string format(const char* pattern, ...) __attribute__((format(printf, 1, 2)));

}  // namespace esfem
