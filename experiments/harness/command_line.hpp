// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace esfem {

/// The options of a program. CLI11 parses them and prints --help; it stays in command_line.cpp, because each
/// file that includes it takes 3 s longer to compile. An option that is not given leaves its variable as it
/// is; --help shows that value as the default, unless the variable is empty or optional. The variables must
/// outlive the parsing.
class CommandLine {
 public:
  /// help: what the program does, with an example; the head of --help.
  CommandLine(const std::string& help, const std::string& program);
  ~CommandLine();

  /// The group in --help of the options that are added from now on.
  void group(const std::string& name);

  /// A positional argument that must be given, one or (strings) at least one; `type` is its name in --help.
  void argument(const std::string& name, std::string& value, const std::string& help,
                const std::string& type);
  void optional_argument(const std::string& name, std::string& value, const std::string& help,
                         const std::string& type);
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& help);

  void flag(const std::string& name, bool& value, const std::string& help);
  void text(const std::string& name, std::string& value, const std::string& help,
            const std::string& type = "TEXT");
  /// Repeatable: --set a --set b.
  void texts(const std::string& name, std::vector<std::string>& values, const std::string& help,
             const std::string& type);
  void one_of(const std::string& name, const std::vector<std::string>& known, std::string& value,
              const std::string& help);
  /// A list of some of the known names, such as --flow a,b.
  void names(const std::string& name, const std::vector<std::string>& known, std::vector<std::string>& values,
             const std::string& help);
  /// Files that exist; repeatable.
  void files(const std::string& name, std::vector<std::string>& values, const std::string& help);
  /// An integer from `least` to `most`.
  void integer(const std::string& name, int least, int most, int& value, const std::string& help);
  void integer(const std::string& name, int least, int most, std::optional<int>& value,
               const std::string& help);
  void number(const std::string& name, double& value, const std::string& help);
  void positive(const std::string& name, double& value, const std::string& help);
  void positive(const std::string& name, std::optional<double>& value, const std::string& help);
  /// A list of positive numbers, such as --gamma 10,20.
  void positive(const std::string& name, std::vector<double>& values, const std::string& help);
  /// What `parse` makes of the text; it throws InputError when it cannot.
  void parsed(const std::string& name, const std::function<void(const std::string&)>& parse,
              const std::string& help, const std::string& type);
  /// Not both may be given.
  void exclude(const std::string& name, const std::string& other);

  /// Returns false when --help was asked for and printed: then the program is done. Throws InputError with
  /// one line that says what is wrong and what is accepted.
  bool parse(int argc, const char* const* argv);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

/// Parses a list of non-negative numbers such as "0,1,2", "0-4" or "0-2,5"; `option` is named in the
/// InputError.
std::vector<int> parse_list(const std::string& text, const std::string& option);

}  // namespace esfem
