// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/fe/quadrature.hpp"

#include <cmath>
#include <vector>

#include "solver/error.hpp"

namespace esfem {
namespace {

struct GaussPoint {
  double s, weight;
};

/// Gauss-Legendre rule with n points on (0, 1), by Newton's method on P_n. In long double, so that points and
/// weights near the ends keep their last digits.
std::vector<GaussPoint> gauss_legendre(int n) {
  const long double pi = std::acos(-1.0L);
  std::vector<GaussPoint> rule;
  for (int i = 0; i < n; ++i) {
    long double x = -std::cos(pi * (i + 0.75L) / (n + 0.5L)), slope = 0;
    for (int iteration = 0; iteration < 10; ++iteration) {
      long double before = 0, p = 1;  // P_{m-1} and P_m by the three-term recurrence
      for (int m = 0; m < n; ++m) {
        const long double next = ((2 * m + 1) * x * p - m * before) / (m + 1);
        before = p;
        p = next;
      }
      slope = n * (before - x * p) / (1 - x * x);
      x -= p / slope;
    }
    rule.push_back({double((1 + x) / 2), double(1 / ((1 - x * x) * slope * slope))});
  }
  return rule;
}

}  // namespace

Quadrature conical_quadrature(int n) {
  if (n < 1 || n > 64) throw InputError(format("conical quadrature with n = %d: expected 1 to 64", n));
  const std::vector<GaussPoint> gauss = gauss_legendre(n);
  Quadrature rule;
  rule.points.resize(n * n, 2);
  rule.weights.resize(n * n);
  int row = 0;
  for (const auto& [t, weight_t] : gauss)
    for (const auto& [s, weight_s] : gauss) {
      rule.points.row(row) << s * (1 - t), t;
      rule.weights(row++) = weight_s * weight_t * (1 - t);
    }
  rule.degree = 2 * n - 2;
  rule.name = format("conical %dx%d", n, n);
  return rule;
}

Quadrature vertex_quadrature() {
  Quadrature rule;
  rule.points.resize(3, 2);
  rule.points << 0, 0, 1, 0, 0, 1;
  rule.weights.setConstant(3, 1.0 / 6);
  rule.degree = 1;
  rule.name = "vertices";
  return rule;
}

Quadrature default_quadrature(int fe_degree) {
  // For P1, P2, P3, P4: 6, 12, 16, 25 points. On spheres with h <= R/2 a 14x14 conical rule changes the error
  // of the normal's elliptic equation (H1, nodal) by 1e-13, 7e-6, 1.4e-5, 5e-6 of itself.
  static constexpr int degree_of_rule[] = {4, 6, 8, 10};
  if (fe_degree < 1 || fe_degree > 4)
    throw InputError(format("degree %d of the finite elements: expected 1 to 4", fe_degree));
  return symmetric_quadrature(degree_of_rule[fe_degree - 1]);
}

Quadrature parse_quadrature(const std::string& text) {
  const size_t colon = text.find(':');
  const std::string kind = text.substr(0, colon),
                    number = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool is_number =
      !number.empty() && number.size() < 4 && number.find_first_not_of("0123456789") == std::string::npos;
  if (is_number && kind == "conical") return conical_quadrature(std::stoi(number));
  if (is_number && kind == "degree") return symmetric_quadrature(std::stoi(number));
  throw InputError("quadrature: found '" + text +
                   "'; expected conical:N or degree:D, such as conical:6 or degree:8");
}

}  // namespace esfem
