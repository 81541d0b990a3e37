// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <regex>
#include <sstream>

#include "solver/did_you_mean.hpp"
#include "solver/error.hpp"

namespace esfem {

namespace {

std::string accepted_options(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : app.get_options())
    names += (names.empty() ? "" : " ") + option->get_name(/*positional=*/option->get_positional());
  return names;
}

/// The accepted options, and the one that was probably meant by an unknown one.
std::string accepted_for_unknown(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& text : app.remaining())
    if (text[0] == '-') return accepted_options(app) + did_you_mean(text.substr(0, text.find('=')), names);
  return accepted_options(app);
}

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// The check of a positive number (CLI11's own prints 300 digits).
CLI::Validator positive_number() {
  const auto complaint = [](const std::string& text) -> std::string {
    double value = 0;
    if (CLI::detail::lexical_cast(text, value) && value > 0 && std::isfinite(value)) return "";
    return "found " + text + ", expected a positive number";
  };
  return {complaint, "POSITIVE", "positive number"};
}

}  // namespace

struct CommandLine::Parser {
  CLI::App app;
  std::string group = "Options";

  /// Adds the option to the current group; `shows_default`: --help prints the variable's value.
  template <class T>
  CLI::Option* add(const std::string& name, T& value, const std::string& help, bool shows_default = false) {
    CLI::Option* option = app.add_option(name, value, help)->group(group);
    return shows_default ? option->capture_default_str() : option;
  }
};

CommandLine::CommandLine(const std::string& help, const std::string& program) : parser_(new Parser) {
  parser_->app.description(help);
  parser_->app.name(program);
  parser_->app.footer(
      "Exit codes: 0 done, 1 wrong usage or bad input, 2 the numerics failed, 3 a claim is not met.");
}

CommandLine::~CommandLine() = default;

void CommandLine::group(const std::string& name) {
  if (parser_->group == "Options") parser_->app.get_help_ptr()->group(name);
  parser_->group = name;
}

void CommandLine::argument(const std::string& name, std::string& value, const std::string& help,
                           const std::string& type) {
  parser_->add(name, value, help)->required()->type_name(type);
}

void CommandLine::optional_argument(const std::string& name, std::string& value, const std::string& help,
                                    const std::string& type) {
  parser_->add(name, value, help)->type_name(type);
}

void CommandLine::arguments(const std::string& name, std::vector<std::string>& values,
                            const std::string& help) {
  parser_->add(name, values, help)->required();
}

void CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  parser_->app.add_flag(name, value, help)->group(parser_->group);
}

void CommandLine::text(const std::string& name, std::string& value, const std::string& help,
                       const std::string& type) {
  parser_->add(name, value, help, !value.empty())->type_name(type);
}

void CommandLine::texts(const std::string& name, std::vector<std::string>& values, const std::string& help,
                        const std::string& type) {
  parser_->add(name, values, help)->type_name(type)->allow_extra_args(false);
}

void CommandLine::one_of(const std::string& name, const std::vector<std::string>& known, std::string& value,
                         const std::string& help) {
  parser_->add(name, value, help, true)->check(CLI::IsMember(known));
}

void CommandLine::names(const std::string& name, const std::vector<std::string>& known,
                        std::vector<std::string>& values, const std::string& help) {
  parser_->add(name, values, help)->check(CLI::IsMember(known))->delimiter(',')->type_name("LIST");
}

void CommandLine::files(const std::string& name, std::vector<std::string>& values, const std::string& help) {
  parser_->add(name, values, help)->check(CLI::ExistingFile)->type_name("FILE")->allow_extra_args(false);
}

void CommandLine::integer(const std::string& name, int least, int most, int& value, const std::string& help) {
  parser_->add(name, value, help, true)->check(CLI::Range(least, most));
}

void CommandLine::integer(const std::string& name, int least, int most, std::optional<int>& value,
                          const std::string& help) {
  parser_->add(name, value, help)->check(CLI::Range(least, most));
}

void CommandLine::number(const std::string& name, double& value, const std::string& help) {
  parser_->add(name, value, help, true);
}

void CommandLine::positive(const std::string& name, double& value, const std::string& help) {
  parser_->add(name, value, help, true)->check(positive_number());
}

void CommandLine::positive(const std::string& name, std::optional<double>& value, const std::string& help) {
  parser_->add(name, value, help)->check(positive_number());
}

void CommandLine::positive(const std::string& name, std::vector<double>& values, const std::string& help) {
  parser_->add(name, values, help)->check(positive_number())->delimiter(',')->type_name("LIST");
}

void CommandLine::parsed(const std::string& name, const std::function<void(const std::string&)>& parse,
                         const std::string& help, const std::string& type) {
  parser_->app.add_option_function<std::string>(name, parse, help)->type_name(type)->group(parser_->group);
}

void CommandLine::exclude(const std::string& name, const std::string& other) {
  parser_->app.get_option(name)->excludes(parser_->app.get_option(other));
}

bool CommandLine::parse(int argc, const char* const* argv) {
  CLI::App& app = parser_->app;
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  } catch (const CLI::ExtrasError& error) {
    throw InputError(one_line(error.what()) + "; accepted: " + accepted_for_unknown(app) + " (see --help)");
  } catch (const CLI::ParseError& error) {
    // A missing argument is often one that was parsed as an unknown option.
    const std::vector<std::string> unknown = app.remaining();
    const std::string more =
        unknown.empty() ? "" : "; unknown: " + unknown.front() + "; accepted: " + accepted_for_unknown(app);
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
