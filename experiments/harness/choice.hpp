// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of runs of an experiment, as data: axes, and which of their values are combined.
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "solver/fe/quadrature.hpp"
#include "solver/time/steps.hpp"

namespace esfem {

/// first, first + 1, .., last; empty when last < first.
std::vector<int> range(int first, int last);

/// The step sizes tau = largest 2^-k on [0, end_time].
struct HalvedSteps {
  double end_time, largest;

  double tau(int k) const;
  /// The number of steps nearest to end_time / tau.
  int count(int k) const;
};

/// Values of an axis: names or numbers.
class Values {
 public:
  Values(const char* name) : list_{name} {}
  Values(int number) : list_{number} {}
  Values(double number) : list_{number} {}
  Values(std::initializer_list<nlohmann::json> values) : list_(values) {}
  Values(const std::vector<std::string>& names) : list_(names.begin(), names.end()) {}
  Values(const std::vector<int>& numbers) : list_(numbers.begin(), numbers.end()) {}
  Values(const std::vector<double>& numbers) : list_(numbers.begin(), numbers.end()) {}

  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }

 private:
  std::vector<nlohmann::json> list_;
};

/// All combinations of some values of each axis.
using Block = std::map<std::string, Values>;

/// The keys of a map, such as the names of an experiment's surfaces.
template <class Value>
std::vector<std::string> names_of(const std::map<std::string, Value>& map) {
  std::vector<std::string> names;
  for (const auto& entry : map) names.push_back(entry.first);
  return names;
}

/// An axis that an experiment has in addition to the common ones: "degree", "bdf", "start", "level" (of the
/// mesh) and "step" (k of tau = tau_0 2^-k). It is the option --NAME.
struct Axis {
  std::string name;
  std::vector<std::string> known;  ///< its values; none: it has positive numbers
  std::string help;
};

/// One run of a grid: a value on each axis.
class Choice {
 public:
  Choice(std::map<std::string, nlohmann::json> values, std::vector<std::string> meshes, std::string rule)
      : values_(std::move(values)), meshes_(std::move(meshes)), rule_(std::move(rule)) {}

  /// The name on an axis of names.
  const std::string& operator[](const std::string& axis) const;
  double number(const std::string& axis) const;
  int degree() const { return integer("degree"); }
  int bdf() const { return integer("bdf"); }
  int level() const { return integer("level"); }
  int step() const { return integer("step"); }
  Start start() const { return parse_start((*this)["start"]); }

  const nlohmann::json& value(const std::string& axis) const;
  bool has(const std::string& axis) const { return values_.count(axis) > 0; }
  /// --mesh FILE: one for each level; none: meshes are generated.
  const std::vector<std::string>& meshes() const { return meshes_; }
  /// That of --quadrature; when it is not given, the one of elements of the degree.
  Quadrature quadrature() const;

 private:
  int integer(const std::string& axis) const { return value(axis).get<int>(); }

  std::map<std::string, nlohmann::json> values_;
  std::vector<std::string> meshes_;
  std::string rule_;
};

/// Which runs there are.
struct Grid {
  std::vector<Axis> axes = {};           ///< of this experiment alone
  std::vector<std::string> labels = {};  ///< axes that distinguish rows except mesh and step size
  /// The runs of preset paper and check. Axes that a block does not have are as in `otherwise`.
  std::function<std::vector<Block>(bool paper)> preset;
  /// As soon as one axis is given on the command line, all combinations of the given values and these. An
  /// axis with known names may be omitted: then all of them.
  std::function<Block(bool paper)> otherwise;
  /// Options of all experiments that this one does not take, "mesh", "start", "quadrature", .., and why.
  std::map<std::string, std::string> refused = {};
  /// Values that follow from others, such as BDF1 for a scheme of first order; they replace those of the
  /// combination.
  std::function<Block(const Choice&)> implied = [](const Choice&) { return Block(); };
  /// Whether a combination is a run of its own; throws InputError for one that cannot be computed.
  std::function<bool(const Choice&)> admits = [](const Choice&) { return true; };
};

/// The part of the command line that concerns the grid.
struct GridRequest {
  bool paper = true;
  Block given;  ///< values of axes
  std::vector<std::string> meshes;
  std::string rule;
};

/// The runs, each once. Throws InputError for an option that the experiment does not take, for runs that
/// differ in an axis that no label shows, and when there are mesh files and a level has none.
std::vector<Choice> choices(const Grid& grid, const GridRequest& request);

/// The name of a run: its labels, "h" and the level, "tau" and the step, where it has these. Of an axis with
/// "yes" and "no" it has the name of the axis or nothing.
std::string cell_name(const Grid& grid, const Choice& choice);

/// {"flow": "dziuk", "bdf": 2, ..}
nlohmann::json labels(const Grid& grid, const Choice& choice);

/// The values of all axes on which the runs agree, but those of labels, levels and steps.
nlohmann::json common_values(const Grid& grid, const std::vector<Choice>& choices);

}  // namespace esfem
