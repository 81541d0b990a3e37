// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/method_options.hpp"

namespace esfem {

void add_quadrature_option(CommandLine& line, std::string& rule) {
  line.text("--quadrature", rule,
            "rule on each element: conical:N (N x N Gauss points) | degree:D (symmetric)", "RULE");
}

Quadrature quadrature_or_default(const std::string& rule, int degree) {
  return rule.empty() ? default_quadrature(degree) : parse_quadrature(rule);
}

}  // namespace esfem
