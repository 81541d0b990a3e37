// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/tables/power_law.hpp"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "solver/linalg/least_squares.hpp"

namespace esfem {
namespace {

/// Residuals of log e beyond this lose their influence: deviations of 20%, more than meshes of one family
/// scatter.
constexpr double loss_scale = 0.2;
/// Smallest pivot (linalg/least_squares.hpp) of a Jacobian that determines the parameters.
constexpr double smallest_condition = 1e-6;

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

void build_problem(const LogErrors& rows, const std::vector<int>& free, std::array<double, 4>& parameters,
                   ceres::Problem& problem) {
  for (int i = 0; i < rows.rows(); ++i)
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Residual, 1, 1, 1, 1, 1>(
                                 new Residual{rows.h[i], rows.tau[i], rows.error[i]}),
                             new ceres::CauchyLoss(loss_scale), &parameters[0], &parameters[1],
                             &parameters[2], &parameters[3]);
  for (int k = 0; k < 4; ++k)
    if (std::find(free.begin(), free.end(), k) == free.end())
      problem.SetParameterBlockConstant(&parameters[k]);
}

/// Ceres' solution from the law's parameters.
std::optional<PowerLaw> solve(const LogErrors& rows, const std::vector<int>& free, PowerLaw law) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 200;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 1e-13;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Problem problem;
  build_problem(rows, free, law.parameters, problem);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) return std::nullopt;
  law.cost = 2 * summary.final_cost;
  return law;
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
  if (term == Term::none) return PowerLaw::absent;
  double least = log_error[0] - order * variable[0];
  for (std::size_t i = 1; i < variable.size(); ++i)
    least = std::min(least, log_error[i] - order * variable[i]);
  return least;
}

}  // namespace

std::vector<int> PowerLaw::free_parameters() const {
  std::vector<int> free;
  const Term terms[] = {h, tau};
  for (int i = 0; i < 2; ++i) {
    if (terms[i] != Term::none) free.push_back(2 * i);
    if (terms[i] == Term::power) free.push_back(2 * i + 1);
  }
  return free;
}

std::optional<PowerLaw> fit_power_law(const LogErrors& rows, Term h, Term tau) {
  PowerLaw guess;
  guess.h = h;
  guess.tau = tau;
  const std::vector<int> free = guess.free_parameters();
  if (rows.rows() <= static_cast<int>(free.size())) return std::nullopt;
  std::optional<PowerLaw> best;
  for (double p : initial_orders(h, rows.h, rows.error))
    for (double q : initial_orders(tau, rows.tau, rows.error)) {
      guess.parameters = {initial_constant(h, p, rows.h, rows.error), p,
                          initial_constant(tau, q, rows.tau, rows.error), q};
      const std::optional<PowerLaw> trial = solve(rows, free, guess);
      if (trial && (!best || trial->cost < best->cost)) best = trial;
    }
  return best;
}

std::optional<PowerLaw> refit(const LogErrors& rows, const PowerLaw& law) {
  return solve(rows, law.free_parameters(), law);
}

std::optional<double> fit_constant(const LogErrors& rows, const PowerLaw& law, bool in_tau,
                                   double smallest_share) {
  const int k = in_tau ? 2 : 0;
  const std::optional<PowerLaw> fitted = solve(rows, {k}, law);
  if (!fitted) return std::nullopt;
  const auto& [log_C_h, p, log_C_tau, q] = fitted->parameters;
  for (int i = 0; i < rows.rows(); ++i) {
    const double term = in_tau ? log_C_tau + q * rows.tau[i] : log_C_h + p * rows.h[i];
    if (term - rows.error[i] >= std::log(smallest_share)) return fitted->parameters[k];
  }
  return std::nullopt;
}

std::vector<double> residuals(const LogErrors& rows, const PowerLaw& law) {
  const std::array<double, 4>& c = law.parameters;
  std::vector<double> result(rows.rows());
  for (int i = 0; i < rows.rows(); ++i)
    Residual{rows.h[i], rows.tau[i], rows.error[i]}(&c[0], &c[1], &c[2], &c[3], &result[i]);
  return result;
}

bool determines(const LogErrors& rows, const PowerLaw& law) {
  PowerLaw at = law;
  const std::vector<int> free = law.free_parameters();
  ceres::Problem problem;
  build_problem(rows, free, at.parameters, problem);
  ceres::Problem::EvaluateOptions options;
  for (int k : free) options.parameter_blocks.push_back(&at.parameters[k]);
  options.apply_loss_function = false;
  ceres::CRSMatrix sparse;
  if (!problem.Evaluate(options, nullptr, nullptr, nullptr, &sparse)) return false;
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int i = 0; i < sparse.num_rows; ++i)
    for (int k = sparse.rows[i]; k < sparse.rows[i + 1]; ++k) jacobian(i, sparse.cols[k]) = sparse.values[k];
  return smallest_pivot(jacobian) > smallest_condition;
}

}  // namespace esfem
