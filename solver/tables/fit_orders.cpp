// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/fit_orders.hpp"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <optional>
#include <set>

#include "solver/error.hpp"
#include "solver/linalg/least_squares.hpp"

namespace esfem {
namespace {

/// Residuals of log e beyond this lose their influence: deviations of 20%, more than meshes of one family
/// scatter.
constexpr double loss_scale = 0.2;
/// A model that fits to 0.1% is not improved by another term: no computed errors follow a power law more
/// closely.
constexpr double noise_floor = 1e-3;
/// An order with a larger standard error does not distinguish two integer orders.
constexpr double largest_standard_error = 0.5;
/// Rows with larger residuals do not follow the model.
constexpr double largest_residual = 0.5;
/// Smallest pivot (linalg/least_squares.hpp) of a Jacobian that determines the parameters.
constexpr double smallest_condition = 1e-6;
/// The logarithm of a constant that is zero.
constexpr double absent = -1e3;

/// log C_h, p, log C_tau, q.
using Parameters = std::array<double, 4>;

/// What a term C s^p of the model is.
enum class Term { none, plateau, power };

struct Model {
  Term h, tau;
  std::vector<int> free_parameters() const {
    std::vector<int> free;
    const Term terms[] = {h, tau};
    for (int i = 0; i < 2; ++i) {
      if (terms[i] != Term::none) free.push_back(2 * i);
      if (terms[i] == Term::power) free.push_back(2 * i + 1);
    }
    return free;
  }
};

/// Logarithms of the rows; h and tau are centred, so that constants and orders are hardly correlated.
struct Data {
  std::vector<double> log_h, log_tau, log_error;
  double centre_h = 0, centre_tau = 0;
  int rows() const { return static_cast<int>(log_error.size()); }
};

struct Residual {
  double log_h, log_tau, log_error;

  template <class T>
  bool operator()(const T* log_C_h, const T* p, const T* log_C_tau, const T* q, T* residual) const {
    using std::exp, std::log;
    const T a = *log_C_h + *p * log_h, b = *log_C_tau + *q * log_tau;
    // log(exp(a) + exp(b)) without overflow
    residual[0] = (a > b ? a + log(1.0 + exp(b - a)) : b + log(1.0 + exp(a - b))) - log_error;
    return true;
  }
};

struct Solution {
  Model model;
  Parameters parameters = {absent, 0, absent, 0};
  Parameters standard_error = {0, 0, 0, 0};
  double cost = 0;  ///< sum of the losses
  double criterion = 0;
  int degrees_of_freedom = 0;
};

void build_problem(const Data& data, const Model& model, Parameters& parameters, ceres::Problem& problem) {
  for (int i = 0; i < data.rows(); ++i)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, 1, 1, 1, 1, 1>(
                                 new Residual{data.log_h[i], data.log_tau[i], data.log_error[i]}),
                             new ceres::CauchyLoss(loss_scale), &parameters[0], &parameters[1],
                             &parameters[2], &parameters[3]);
  const std::vector<int> free = model.free_parameters();
  for (int k = 0; k < 4; ++k)
    if (std::find(free.begin(), free.end(), k) == free.end())
      problem.SetParameterBlockConstant(&parameters[k]);
}

/// Slope of log e between the smallest and the largest value of the variable, from medians so that outliers
/// and the other variable do little.
double slope_of_extremes(const std::vector<double>& variable, const std::vector<double>& log_error) {
  const auto [least, most] = std::minmax_element(variable.begin(), variable.end());
  const auto median_at = [&](double value) {
    std::vector<double> found;
    for (std::size_t i = 0; i < variable.size(); ++i)
      if (std::abs(variable[i] - value) < 1e-6) found.push_back(log_error[i]);
    std::nth_element(found.begin(), found.begin() + found.size() / 2, found.end());
    return found[found.size() / 2];
  };
  return (median_at(*most) - median_at(*least)) / (*most - *least);
}

std::vector<double> initial_orders(Term term, const std::vector<double>& variable,
                                   const std::vector<double>& log_error) {
  if (term != Term::power) return {0};
  return {slope_of_extremes(variable, log_error), 1, 2, 4};
}

/// The largest constant with which the term C s^order exceeds no error: terms are positive.
double initial_constant(Term term, double order, const std::vector<double>& variable,
                        const std::vector<double>& log_error) {
  if (term == Term::none) return absent;
  double least = log_error[0] - order * variable[0];
  for (std::size_t i = 1; i < variable.size(); ++i)
    least = std::min(least, log_error[i] - order * variable[i]);
  return least;
}

/// Solves from each initial guess; the best of the solutions, or none.
std::optional<Solution> best_solution(const Data& data, const Model& model) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-13;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;

  std::optional<Solution> best;
  for (double p : initial_orders(model.h, data.log_h, data.log_error))
    for (double q : initial_orders(model.tau, data.log_tau, data.log_error)) {
      Solution trial;
      trial.model = model;
      trial.parameters = {initial_constant(model.h, p, data.log_h, data.log_error), p,
                          initial_constant(model.tau, q, data.log_tau, data.log_error), q};
      ceres::Problem problem;
      build_problem(data, model, trial.parameters, problem);
      ceres::Solver::Summary summary;
      ceres::Solve(options, &problem, &summary);
      trial.cost = 2 * summary.final_cost;
      if (summary.IsSolutionUsable() && (!best || trial.cost < best->cost)) best = trial;
    }
  return best;
}

std::vector<double> residuals(const Data& data, const Solution& solution) {
  const Parameters& c = solution.parameters;
  std::vector<double> result(data.rows());
  for (int i = 0; i < data.rows(); ++i)
    Residual{data.log_h[i], data.log_tau[i], data.log_error[i]}(&c[0], &c[1], &c[2], &c[3], &result[i]);
  return result;
}

/// A robust loss lets a curve through a few rows and past the others: more than half of the rows have to
/// follow it, and more than it has parameters.
bool is_followed(const std::vector<double>& residuals, int unknowns) {
  const int rows = static_cast<int>(residuals.size());
  const int following = std::count_if(residuals.begin(), residuals.end(),
                                      [](double r) { return std::abs(r) < largest_residual; });
  return following > std::max(rows / 2, unknowns);
}

/// Variance of the residuals of an M-estimator (Huber, Robust Statistics, §7.6): mean psi^2 / (mean psi')^2,
/// which is the ordinary residual variance when all residuals are small against the scale of the loss.
double residual_variance(const std::vector<double>& residuals, int degrees_of_freedom) {
  double psi_squared = 0, psi_slope = 0;
  for (double r : residuals) {
    const double s = r * r / (loss_scale * loss_scale);
    psi_squared += r * r / ((1 + s) * (1 + s));
    psi_slope += (1 - s) / ((1 + s) * (1 + s));
  }
  const double mean_slope = std::max(psi_slope / residuals.size(), 0.05);
  return psi_squared / degrees_of_freedom / (mean_slope * mean_slope);
}

/// Whether the Jacobian has full rank. ceres::Covariance detects it, too, but then writes to standard error.
bool has_full_rank(ceres::Problem& problem, const std::vector<double*>& free) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = free;
  options.apply_loss_function = false;
  ceres::CRSMatrix sparse;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &sparse)) return false;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int i = 0; i < sparse.num_rows; ++i)
    for (int k = sparse.rows[i]; k < sparse.rows[i + 1]; ++k) jacobian(i, sparse.cols[k]) = sparse.values[k];
  return smallest_pivot(jacobian) > smallest_condition;
}

/// Standard errors of the free parameters; false when the data do not determine them.
bool find_standard_errors(const Data& data, Solution& solution) {
  ceres::Problem problem;
  Parameters& parameters = solution.parameters;
  build_problem(data, solution.model, parameters, problem);
  std::vector<double*> blocks;
  std::vector<std::pair<const double*, const double*>> variances;
  const std::vector<int> free = solution.model.free_parameters();
  for (int k : free) {
    blocks.push_back(&parameters[k]);
    variances.push_back({&parameters[k], &parameters[k]});
  }
  if (!has_full_rank(problem, blocks)) return false;
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.apply_loss_function = false;  // the loss is in residual_variance
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  if (!covariance.Compute(variances, &problem)) return false;
  const double variance = residual_variance(residuals(data, solution), solution.degrees_of_freedom);
  for (int k : free) {
    double value = 0;
    if (!covariance.GetCovarianceBlock(&parameters[k], &parameters[k], &value)) return false;
    solution.standard_error[k] = std::sqrt(value * variance);
    if (!std::isfinite(solution.standard_error[k])) return false;
  }
  return true;
}

/// The model's solution with its standard errors, when the rows determine all of its parameters.
std::optional<Solution> solve(const Data& data, const Model& model) {
  const int unknowns = static_cast<int>(model.free_parameters().size());
  if (data.rows() <= unknowns) return std::nullopt;
  std::optional<Solution> solution = best_solution(data, model);
  if (!solution) return std::nullopt;
  solution->degrees_of_freedom = data.rows() - unknowns;
  if (!is_followed(residuals(data, *solution), unknowns)) return std::nullopt;
  if (!find_standard_errors(data, *solution)) return std::nullopt;
  const double mean_loss = std::max(solution->cost / data.rows(), noise_floor * noise_floor);
  // Bayesian information criterion: a further term is penalised for its parameters.
  solution->criterion = data.rows() * std::log(mean_loss) + unknowns * std::log(data.rows());
  return solution;
}

/// Replaces values by their logarithms less the mean of these; returns that mean.
double centre_logarithms(const std::vector<double>& values, std::vector<double>& logarithms) {
  double mean = 0;
  for (double value : values) logarithms.push_back(std::log(value));
  for (double value : logarithms) mean += value / values.size();
  for (double& value : logarithms) value -= mean;
  return mean;
}

int distinct(std::vector<double> centred_logarithms) {
  std::sort(centred_logarithms.begin(), centred_logarithms.end());
  const auto same = [](double a, double b) { return b - a < 1e-6; };
  return std::unique(centred_logarithms.begin(), centred_logarithms.end(), same) - centred_logarithms.begin();
}

void check_input(const std::vector<double>& h, const std::vector<double>& tau,
                 const std::vector<double>& error) {
  if (h.size() != error.size() || tau.size() != error.size())
    throw InputError(format("order fit: %zu values of h, %zu of tau, %zu errors: expected as many of each",
                            h.size(), tau.size(), error.size()));
  for (std::size_t i = 0; i < error.size(); ++i) {
    const bool good = h[i] > 0 && tau[i] > 0 && error[i] > 0 && std::isfinite(h[i] + tau[i] + error[i]);
    if (!good)
      throw InputError(
          format("order fit, row %zu: h = %g, tau = %g, error = %g: expected positive finite numbers", i + 1,
                 h[i], tau[i], error[i]));
  }
  if (error.size() < 3)
    throw InputError(
        format("order fit: %zu rows, at least 3 are needed (5 when h and tau both vary)", error.size()));
}

/// The models that the variation of h and tau admits, largest first.
std::vector<Model> candidates(int distinct_h, int distinct_tau) {
  const bool h_varies = distinct_h > 1, tau_varies = distinct_tau > 1;
  std::vector<Model> models;
  if (h_varies && tau_varies) models.push_back({Term::power, Term::power});
  if (distinct_h > 2 && !tau_varies) models.push_back({Term::power, Term::plateau});
  if (distinct_tau > 2 && !h_varies) models.push_back({Term::plateau, Term::power});
  if (h_varies) models.push_back({Term::power, Term::none});
  if (tau_varies) models.push_back({Term::none, Term::power});
  return models;
}

void set_interval(double order, double standard_error, int degrees_of_freedom, double (&interval)[2]) {
  // Boost computes in long double unless told otherwise.
  using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
  const boost::math::students_t_distribution<double, InDouble> student(degrees_of_freedom);
  const double t = boost::math::quantile(student, 0.975);
  interval[0] = order - t * standard_error;
  interval[1] = order + t * standard_error;
}

OrderFit to_fit(const Data& data, const Solution& solution) {
  const auto& [log_C_h, p, log_C_tau, q] = solution.parameters;
  OrderFit fit;
  fit.rows_used = data.rows();
  fit.has_h = solution.model.h == Term::power && solution.standard_error[1] <= largest_standard_error;
  fit.has_tau = solution.model.tau == Term::power && solution.standard_error[3] <= largest_standard_error;
  if (solution.model.h != Term::none) fit.constant_h = std::exp(log_C_h - p * data.centre_h);
  if (solution.model.tau != Term::none) fit.constant_tau = std::exp(log_C_tau - q * data.centre_tau);
  if (fit.has_h) {
    fit.order_h = p;
    set_interval(p, solution.standard_error[1], solution.degrees_of_freedom, fit.ci95_h);
  }
  if (fit.has_tau) {
    fit.order_tau = q;
    set_interval(q, solution.standard_error[3], solution.degrees_of_freedom, fit.ci95_tau);
  }
  return fit;
}

}  // namespace

OrderFit fit_orders(const std::vector<double>& h, const std::vector<double>& tau,
                    const std::vector<double>& error) {
  check_input(h, tau, error);
  Data data;
  data.centre_h = centre_logarithms(h, data.log_h);
  data.centre_tau = centre_logarithms(tau, data.log_tau);
  for (double value : error) data.log_error.push_back(std::log(value));

  const int distinct_h = distinct(data.log_h), distinct_tau = distinct(data.log_tau);
  const std::vector<Model> models = candidates(distinct_h, distinct_tau);
  if (models.empty()) throw InputError("order fit: neither h nor tau varies, at least one of them has to");
  const bool both = distinct_h > 1 && distinct_tau > 1;
  if (both && data.rows() < 5)
    throw InputError(
        format("order fit: %d rows, at least 5 are needed when h and tau both vary", data.rows()));

  std::optional<Solution> best;
  for (const Model& model : models) {
    const std::optional<Solution> solution = solve(data, model);
    if (solution && (!best || solution->criterion < best->criterion)) best = solution;
  }
  const OrderFit fit = best ? to_fit(data, *best) : OrderFit{};
  if (!fit.has_h && !fit.has_tau)
    throw NumericsError(
        format("order fit: %d rows (%d values of h, %d of tau) determine no order to within %g", data.rows(),
               distinct_h, distinct_tau, largest_standard_error));
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
      if (fit.has_h)
        fits.push_back({quantity, norm, "h", fit.order_h, {fit.ci95_h[0], fit.ci95_h[1]}, fit.rows_used});
      if (fit.has_tau)
        fits.push_back(
            {quantity, norm, "tau", fit.order_tau, {fit.ci95_tau[0], fit.ci95_tau[1]}, fit.rows_used});
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
