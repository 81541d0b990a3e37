// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/method_options.hpp"

#include <cmath>

namespace esfem {

const char* const method_group = "Method (not given: as in the preset)";

void add_names_option(CLI::App& app, const std::string& option, const std::vector<std::string>& known,
                      const std::string& help, std::vector<std::string>& names) {
  app.add_option(option, names, help)
      ->check(CLI::IsMember(known))
      ->delimiter(',')
      ->type_name("LIST")
      ->group(method_group);
}

CLI::Validator positive_number() {
  const auto complaint = [](const std::string& text) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)) return "";
    return "found " + text + ", expected a positive number";
  };
  return {complaint, "POSITIVE", "positive number"};
}

void add_quadrature_option(CLI::App& app, std::string& rule) {
  app.add_option("--quadrature", rule,
                 "rule on each element: conical:N (N x N Gauss points) | degree:D (symmetric)")
      ->type_name("RULE")
      ->group(method_group);
}

Quadrature quadrature_or_default(const std::string& rule, int degree) {
  return rule.empty() ? default_quadrature(degree) : parse_quadrature(rule);
}

}  // namespace esfem
