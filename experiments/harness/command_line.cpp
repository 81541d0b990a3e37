// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/command_line.hpp"

#include <algorithm>
#include <iostream>
#include <regex>
#include <sstream>

#include "solver/error.hpp"

namespace esfem {

const char* const exit_codes_help =
    "Exit codes: 0 done, 1 wrong usage or bad input, 2 the numerics failed, 3 a claim is not met.";

namespace {

std::string accepted_options(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options())
    names += (names.empty() ? "" : " ") + option->get_name(/*positional=*/option->get_positional());
  return names;
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

}  // namespace

bool parse_command_line(CLI::App& app, int argc, char** argv) {
  app.footer(exit_codes_help);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  } catch (const CLI::ExtrasError& error) {
    throw InputError(one_line(error.what()) + "; accepted: " + accepted_options(app) + " (see --help)");
  } catch (const CLI::ParseError& error) {
    // An argument that is missing is often one that was taken for an unknown option.
    const std::vector<std::string> unknown = app.remaining();
    const std::string more =
        unknown.empty() ? "" : "; unknown: " + unknown.front() + "; accepted: " + accepted_options(app);
    throw InputError(one_line(error.what()) + more + " (see --help)");
  }
  return true;
}

std::vector<int> parse_list(const std::string& text, const std::string& option) {
  static const std::regex number_or_range("([0-9]{1,3})(-([0-9]{1,3}))?");
  std::vector<int> numbers;
  std::istringstream parts(text + ",");
  for (std::string part; std::getline(parts, part, ',');) {
    std::smatch match;
    const bool understood = std::regex_match(part, match, number_or_range);
    const int first = understood ? std::stoi(match[1]) : 0;
    const int last = understood && match[3].matched ? std::stoi(match[3]) : first;
    if (!understood || last < first)
      throw InputError(option + ": found '" + text +
                       "', expected numbers such as 0,1,2 or a range such as 0-4");
    for (int number = first; number <= last; ++number) numbers.push_back(number);
  }
  return numbers;
}

}  // namespace esfem
