// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/fit_orders.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <numeric>
#include <set>

#include "solver/error.hpp"
#include "solver/linalg/least_squares.hpp"
#include "solver/tables/grouped_errors.hpp"
#include "solver/tables/power_law.hpp"

namespace esfem {
namespace {

/// A model that fits to 0.1% is not improved by another term: no computed errors follow a power law more
/// closely.
constexpr double noise_floor = 1e-3;
/// An order with a larger standard error does not distinguish two integer orders.
constexpr double largest_standard_error = 1;
/// No computed errors follow a power law so closely that their order is known better than this.
constexpr double smallest_half_width = 0.02;
/// Rows with larger residuals do not follow the model.
constexpr double largest_residual = 0.5;
/// A larger rms residual of log e is no scatter about a power law.
constexpr double largest_scatter = 0.2;
/// Below this an error does not depend on the variable: a term with such an order is a plateau.
constexpr double plateau_order = 0.35;
/// A dip by this factor below both neighbours is a change of sign.
const double dip = std::log(1.5);
/// Slopes that differ by less are the same for every purpose.
constexpr double smallest_change = 0.1;

/// The models that the variation of h and tau admits, largest first.
std::vector<std::pair<Term, Term>> candidates(const GroupedErrors& data) {
  const bool h_varies = data.meshes.size() > 1, tau_varies = data.step_sizes.size() > 1;
  std::vector<std::pair<Term, Term>> models;
  if (h_varies && tau_varies) models.push_back({Term::power, Term::power});
  if (h_varies && !tau_varies) models.push_back({Term::power, Term::plateau});
  if (tau_varies && !h_varies) models.push_back({Term::plateau, Term::power});
  if (h_varies) models.push_back({Term::power, Term::none});
  if (tau_varies) models.push_back({Term::none, Term::power});
  return models;
}

bool is_plateau(Term term, double order) {
  return term == Term::plateau || (term == Term::power && std::abs(order) < plateau_order);
}

/// The number of groups that have to determine the law. Beside a plateau only the other variable's count.
int groups_for(const GroupedErrors& data, const PowerLaw& law) {
  const int meshes = static_cast<int>(data.meshes.size()), steps = static_cast<int>(data.step_sizes.size());
  if (law.tau == Term::none || is_plateau(law.tau, law.parameters[3])) return meshes;
  if (law.h == Term::none || is_plateau(law.h, law.parameters[1])) return steps;
  return meshes + steps;
}

/// A robust loss lets a curve through a few rows and past the others: more than half of the rows have to
/// follow it, and more than it has parameters.
bool is_followed(const std::vector<double>& residuals, int unknowns) {
  const int rows = static_cast<int>(residuals.size());
  const int following = std::count_if(residuals.begin(), residuals.end(),
                                      [](double r) { return std::abs(r) < largest_residual; });
  return following > std::max(rows / 2, unknowns);
}

/// The largest share of a term in the error of a row.
double largest_share(const LogErrors& rows, const PowerLaw& law, bool in_tau) {
  const auto& [log_C_h, p, log_C_tau, q] = law.parameters;
  double least = 1e300;
  for (int i = 0; i < rows.rows(); ++i) {
    const double ratio = log_C_tau + q * rows.tau[i] - log_C_h - p * rows.h[i];
    least = std::min(least, in_tau ? -ratio : ratio);
  }
  return 1 / (1 + std::exp(least));
}

/// A plateau needs four groups, and is seen when it is half of an error: less of one is slopes that fall.
bool has_doubtful_plateau(const GroupedErrors& data, const PowerLaw& law) {
  if (law.h == Term::none || law.tau == Term::none) return false;
  const bool in_h = is_plateau(law.h, law.parameters[1]), in_tau = is_plateau(law.tau, law.parameters[3]);
  if (!in_h && !in_tau) return false;
  return groups_for(data, law) < 4 || largest_share(data.rows, law, in_tau) < 0.5;
}

bool is_admissible(const GroupedErrors& data, const PowerLaw& law) {
  if (has_doubtful_plateau(data, law)) return false;
  return is_followed(residuals(data.rows, law), static_cast<int>(law.free_parameters().size())) &&
         determines(data.rows, law);
}

/// Bayesian information criterion: a further term is penalised for its parameters.
double criterion(const GroupedErrors& data, const PowerLaw& law) {
  const double mean_loss = std::max(law.cost / data.rows.rows(), noise_floor * noise_floor);
  const int groups = groups_for(data, law);
  return groups * std::log(mean_loss) + law.free_parameters().size() * std::log(groups);
}

std::optional<PowerLaw> best_law(const GroupedErrors& data) {
  std::optional<PowerLaw> best;
  for (const auto& [h, tau] : candidates(data)) {
    const std::optional<PowerLaw> law = fit_power_law(data.rows, h, tau);
    if (law && is_admissible(data, *law) && (!best || criterion(data, *law) < criterion(data, *best)))
      best = law;
  }
  return best;
}

double student_quantile(double probability, int degrees_of_freedom) {
  // Boost computes in long double unless told otherwise.
  using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  const boost::math::students_t_distribution<double, InDouble> student(degrees_of_freedom);
  return boost::math::quantile(student, probability);
}

/// The order that rows show with the terms of the law, or with its own term alone where they do not determine
/// the other.
std::optional<double> order_of(const LogErrors& rows, PowerLaw law, bool in_tau) {
  for (const bool with_other : {true, false}) {
    if (!with_other) {
      (in_tau ? law.h : law.tau) = Term::none;
      law.parameters[in_tau ? 0 : 2] = PowerLaw::absent;
    }
    const std::optional<PowerLaw> fitted = refit(rows, law);
    if (fitted && determines(rows, *fitted)) return fitted->parameters[in_tau ? 3 : 1];
  }
  return std::nullopt;
}

/// The standard error of an order by the jackknife: none when the rows without one of the groups do not
/// determine it.
std::optional<double> jackknife_error(const GroupedErrors& data, const PowerLaw& law, bool in_tau) {
  std::vector<double> orders;
  for (const Group& group : data.groups(in_tau)) {
    const std::optional<double> order = order_of(without(data.rows, group), law, in_tau);
    if (!order) return std::nullopt;
    orders.push_back(*order);
  }
  const int n = static_cast<int>(orders.size());
  const double mean = std::accumulate(orders.begin(), orders.end(), 0.0) / n;
  double sum = 0;
  for (double order : orders) sum += (order - mean) * (order - mean);
  return std::sqrt((n - 1.0) / n * sum);
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value * value;
  return std::sqrt(sum / values.size());
}

/// (place, log of the term) of the groups in which the term is seen: the scatter is less than a third of it.
std::vector<std::pair<double, double>> levels(const GroupedErrors& data, const PowerLaw& law, bool in_tau) {
  const double order = law.parameters[in_tau ? 3 : 1];
  const double smallest_share = std::clamp(3 * rms(residuals(data.rows, law)), 0.01, 0.2);
  std::vector<std::pair<double, double>> seen;
  for (const Group& group : data.groups(in_tau))
    if (const auto constant = fit_constant(chosen(data.rows, group.rows), law, in_tau, smallest_share))
      seen.push_back({group.place, *constant + order * group.place});
  return seen;
}

std::vector<double> slopes_between(const std::vector<std::pair<double, double>>& levels) {
  std::vector<double> slopes;
  for (std::size_t i = 1; i < levels.size(); ++i)
    slopes.push_back((levels[i].second - levels[i - 1].second) / (levels[i].first - levels[i - 1].first));
  return slopes;
}

/// Whether a parabola through the levels is significantly better than a line: Student's test of its quadratic
/// coefficient at 5%.
bool is_curved(const std::vector<std::pair<double, double>>& levels) {
  const int n = static_cast<int>(levels.size());
  if (n < 4) return false;
  Eigen::MatrixXd terms(n, 3);
  Eigen::VectorXd values(n);
  for (int i = 0; i < n; ++i) {
    const double x = levels[i].first - levels[0].first;
    terms.row(i) << 1, x, x * x;
    values(i) = levels[i].second;
  }
  const Eigen::VectorXd c = least_squares(terms, values);
  const double variance = (terms * c - values).squaredNorm() / (n - 3);
  const double error = std::sqrt(variance * (terms.transpose() * terms).inverse()(2, 2));
  return std::abs(c[2]) > student_quantile(0.975, n - 3) * error;
}

/// Whether slopes rise or fall, and change less and less: three at least.
bool approach_a_limit(const std::vector<double>& slopes) {
  for (std::size_t i = 2; i < slopes.size(); ++i) {
    const double before = slopes[i - 1] - slopes[i - 2], change = slopes[i] - slopes[i - 1];
    if (change * before <= 0 || std::abs(change) > std::abs(before)) return false;
  }
  return slopes.size() > 2;
}

/// Twice what is left to a limit that the last two slopes approach linearly in the variable.
Interval limit_of_slopes(const std::vector<std::pair<double, double>>& levels,
                         const std::vector<double>& slopes) {
  const std::size_t n = levels.size();
  // The slope between s and r s is that at their geometric mean.
  const double ratio = std::exp((levels[n - 1].first - levels[n - 3].first) / 2);
  const double last = slopes[n - 2], change = (last - slopes[n - 3]) * ratio / (1 - ratio);
  return {std::min(last, last + 2 * change), std::max(last, last + 2 * change)};
}

/// Whether an error is much smaller than those with the next larger and smaller value of the variable, all
/// else being equal.
bool has_dip(const GroupedErrors& data, bool in_tau) {
  for (const Group& group : data.groups(!in_tau)) {
    const LogErrors series = chosen(data.rows, group.rows);
    const std::vector<Group> points = groups_of(in_tau ? series.tau : series.h);
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const auto error = [&](std::size_t k) { return series.error[points[k].rows[0]]; };
      if (error(i) < std::min(error(i - 1), error(i + 1)) - dip) return true;
    }
  }
  return false;
}

/// Why there is no interval, as far as the rows together show; empty: there is one.
std::string objection(const GroupedErrors& data, const PowerLaw& law) {
  if (has_dip(data, false) || has_dip(data, true)) return "the error changes sign";
  const double scatter = rms(residuals(data.rows, law));
  if (scatter > largest_scatter) return format("the scatter of log e is %.2f", scatter);
  return "";
}

/// The order in a variable whose term is a power; none when its standard error is too large.
std::optional<ObservedOrder> observed_order(const GroupedErrors& data, const PowerLaw& law, bool in_tau) {
  ObservedOrder observed;
  observed.order = law.parameters[in_tau ? 3 : 1];
  const std::vector<std::pair<double, double>> seen = levels(data, law, in_tau);
  observed.slopes = slopes_between(seen);
  const int groups = static_cast<int>(seen.size());
  if (groups < 2 || (groups < 3 && data.groups(in_tau).size() > 2)) return std::nullopt;
  if (groups < 3) {
    observed.remark = in_tau ? "two step sizes" : "two meshes";
    return observed;
  }
  const std::optional<double> error = jackknife_error(data, law, in_tau);
  if (!error || *error > largest_standard_error) return std::nullopt;
  observed.remark = objection(data, law);
  if (!observed.remark.empty()) return observed;
  const double change = observed.slopes.back() - observed.slopes.front();
  if (std::abs(change) > smallest_change && (approach_a_limit(observed.slopes) || is_curved(seen))) {
    observed.limit = limit_of_slopes(seen, observed.slopes);
    observed.remark = format("%s, %.1f -> %.1f", change > 0 ? "rising" : "falling", observed.slopes.front(),
                             observed.slopes.back());
    return observed;
  }
  const double half = std::max(student_quantile(0.975, groups - 1) * *error, smallest_half_width);
  observed.ci95 = Interval{observed.order - half, observed.order + half};
  if (std::abs(observed.order) < plateau_order) observed.remark = "no dependence";
  return observed;
}

}  // namespace

OrderFit fit_orders(const std::vector<double>& h, const std::vector<double>& tau,
                    const std::vector<double>& error) {
  const GroupedErrors data = grouped_errors(h, tau, error);
  OrderFit fit;
  fit.rows_used = data.rows.rows();
  if (const std::optional<PowerLaw> law = best_law(data)) {
    const auto& [log_C_h, p, log_C_tau, q] = law->parameters;
    if (law->h != Term::none) fit.constant_h = std::exp(log_C_h - p * data.centre_h);
    if (law->tau != Term::none) fit.constant_tau = std::exp(log_C_tau - q * data.centre_tau);
    if (law->h == Term::power) fit.h = observed_order(data, *law, false);
    if (law->tau == Term::power) fit.tau = observed_order(data, *law, true);
  }
  if (!fit.h && !fit.tau)
    throw NumericsError(
        format("order fit: %d rows (%zu values of h, %zu of tau) determine no order to within %g",
               fit.rows_used, data.meshes.size(), data.step_sizes.size(), largest_standard_error));
  return fit;
}

bool in_range(const Row& row, const RowRange& range) {
  const double slack = 1e-9;
  return row.tau >= range.tau_min * (1 - slack) && row.tau <= range.tau_max * (1 + slack) &&
         row.h >= range.h_min * (1 - slack) && row.h <= range.h_max * (1 + slack);
}

namespace {

/// The fits of rows of one variant, without its labels.
std::vector<Fit> fit_variant(const std::vector<const Row*>& rows) {
  std::set<std::pair<std::string, std::string>> names;
  for (const Row* row : rows)
    for (const auto& [quantity, norms] : row->errors)
      for (const auto& [norm, value] : norms) names.insert({quantity, norm});

  std::vector<Fit> fits;
  for (const auto& [quantity, norm] : names) {
    std::vector<double> h, tau, error;
    for (const Row* row : rows)
      if (row->errors.count(quantity) && row->errors.at(quantity).count(norm)) {
        h.push_back(row->h);
        tau.push_back(row->tau);
        error.push_back(row->errors.at(quantity).at(norm));
      }
    if (*std::max_element(error.begin(), error.end()) < round_off) continue;
    try {
      const OrderFit fit = fit_orders(h, tau, error);
      const auto add = [&](const std::string& variable, const std::optional<ObservedOrder>& observed) {
        if (observed)
          fits.push_back({quantity, norm, variable, observed->order, observed->ci95, observed->slopes,
                          observed->remark, fit.rows_used});
      };
      add("h", fit.h);
      add("tau", fit.tau);
    } catch (const InputError&) {
    } catch (const NumericsError&) {
    }
  }
  return fits;
}

}  // namespace

std::vector<Fit> fit_table(const Table& table, const RowRange& range) {
  std::map<std::string, std::vector<const Row*>> variants;
  for (const Row& row : table.rows)
    if (row.status == "ok" && in_range(row, range)) variants[variant(row)].push_back(&row);

  std::vector<Fit> fits;
  for (const auto& [name, rows] : variants)
    for (Fit fit : fit_variant(rows)) {
      if (variants.size() > 1) fit.labels = rows[0]->labels;
      fits.push_back(fit);
    }
  return fits;
}

}  // namespace esfem
