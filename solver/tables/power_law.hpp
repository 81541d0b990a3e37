// SPDX-License-Identifier: GPL-3.0-or-later
// The model of errors that orders are fitted with, and its fit by Ceres.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace esfem {

/// Logarithms of rows (h, tau, error).
struct LogErrors {
  /// One a row.
  /// @{
  std::vector<double> h, tau, error;
  /// @}

  /// How many there are.
  int rows() const { return static_cast<int>(error.size()); }
};

/// What a term C s^p of the model is.
enum class Term { none, plateau, power };

/// e = C_h h^p + C_tau tau^q with positive constants; a plateau has the order 0.
struct PowerLaw {
  Term h = Term::none;    ///< what C_h h^p is
  Term tau = Term::none;  ///< what C_tau tau^q is

  /// log C_h, p, log C_tau, q.
  std::array<double, 4> parameters = {absent, 0, absent, 0};
  double cost = 0;  ///< sum of the losses of the residuals

  /// The logarithm of a constant that is zero.
  static constexpr double absent = -1e3;
  /// Places in `parameters` of those that are fitted.
  std::vector<int> free_parameters() const;
};

/// Ceres' fit of log e with Cauchy's loss, from several initial guesses; none when there are no more rows
/// than parameters, or no guess leads to a solution.
std::optional<PowerLaw> fit_power_law(const LogErrors& rows, Term h, Term tau);

/// The fit of the same terms to other rows, from that of `law`.
std::optional<PowerLaw> refit(const LogErrors& rows, const PowerLaw& law);

/// log C_h (or log C_tau) alone, fitted to some rows with all else as in `law`; none where the share of this
/// term in the error is less than `smallest_share` in all of them.
std::optional<double> fit_constant(const LogErrors& rows, const PowerLaw& law, bool in_tau,
                                   double smallest_share);

/// Logarithm of the law less log e, of each row.
std::vector<double> residuals(const LogErrors& rows, const PowerLaw& law);

/// Whether the rows determine all free parameters: the Jacobian has full rank.
bool determines(const LogErrors& rows, const PowerLaw& law);

}  // namespace esfem
