// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/harness/choice.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "solver/error.hpp"

namespace esfem {
namespace {

using Point = std::map<std::string, nlohmann::json>;

/// Adds all combinations of the axes from `axis` on to those of `point`.
void combine(const Block& block, Block::const_iterator axis, Point& point, std::vector<Point>& points) {
  if (axis == block.end()) return points.push_back(point);
  for (const nlohmann::json& value : axis->second) {
    point[axis->first] = value;
    combine(block, std::next(axis), point, points);
  }
}

/// The values of `first`, and those of `second` on the axes that it lacks.
Block merged(Block first, const Block& second) {
  first.insert(second.begin(), second.end());
  return first;
}

/// The option that gives values of an axis.
std::string option_of(const std::string& axis) {
  return "--" + axis + (axis == "level" || axis == "step" ? "s" : "");
}

void require_taken(const Grid& grid, const GridRequest& request) {
  const auto refuse = [&](const std::string& axis) {
    const auto found = grid.refused.find(axis);
    if (found != grid.refused.end()) throw InputError(option_of(axis) + ": " + found->second);
  };
  for (const auto& [axis, values] : request.given) refuse(axis);
  if (!request.meshes.empty()) refuse("mesh");
  if (!request.rule.empty()) refuse("quadrature");
}

/// Throws InputError unless two runs of the same name are the same.
void require_same(const std::string& name, const Point& one, const Point& other) {
  for (const auto& [axis, value] : one) {
    const auto found = other.find(axis);
    if (found == other.end() || found->second != value)
      throw InputError(option_of(axis) + ": found several values for the run " + name +
                       ", expected one: no label distinguishes its rows");
  }
}

std::string part_of_name(const std::string& axis, const nlohmann::json& value) {
  if (value.is_number()) return (axis == "degree" ? "p" : axis) + format("%g", value.get<double>());
  if (value == "yes" || value == "no") return value == "yes" ? axis : "";
  std::string name = value.get<std::string>();
  const auto is_bad = [](unsigned char c) { return !std::isalnum(c) && c != '_' && c != '.' && c != '-'; };
  name.erase(std::remove_if(name.begin(), name.end(), is_bad), name.end());
  return name;
}

}  // namespace

std::vector<int> range(int first, int last) {
  std::vector<int> list;
  for (int i = first; i <= last; ++i) list.push_back(i);
  return list;
}

double HalvedSteps::tau(int k) const {
  return largest * std::pow(2.0, -k);
}

int HalvedSteps::count(int k) const {
  return static_cast<int>(std::lround(end_time / tau(k)));
}

const nlohmann::json& Choice::value(const std::string& axis) const {
  const auto found = values_.find(axis);
  if (found == values_.end()) throw std::logic_error("the grid has no axis '" + axis + "'");
  return found->second;
}

const std::string& Choice::operator[](const std::string& axis) const {
  return value(axis).get_ref<const std::string&>();
}

double Choice::number(const std::string& axis) const {
  return value(axis).get<double>();
}

Quadrature Choice::quadrature() const {
  return rule_.empty() ? default_quadrature(degree()) : parse_quadrature(rule_);
}

std::vector<Choice> choices(const Grid& grid, const GridRequest& request) {
  require_taken(grid, request);
  Block otherwise = grid.otherwise(request.paper);
  for (const Axis& axis : grid.axes)
    if (!axis.known.empty()) otherwise.emplace(axis.name, axis.known);
  Block given = request.given;
  const int files = static_cast<int>(request.meshes.size());
  if (files > 0) given.emplace("level", range(0, files - 1));
  std::vector<Block> blocks = {given};
  if (given.empty() && grid.preset) blocks = grid.preset(request.paper);

  std::vector<Point> points;
  for (const Block& block : blocks) {
    const Block whole = merged(block, otherwise);
    Point point;
    combine(whole, whole.begin(), point, points);
  }
  std::vector<Choice> choices;
  std::map<std::string, Point> seen;
  for (Point& point : points) {
    for (const auto& [axis, values] : grid.implied(Choice(point, request.meshes, request.rule)))
      point[axis] = *values.begin();
    const Choice choice(point, request.meshes, request.rule);
    if (files > 0 && choice.level() >= files)
      throw InputError(format("--levels: found %d, expected less than %d, the number of --mesh files",
                              choice.level(), files));
    if (!grid.admits(choice)) continue;
    const auto [same, is_new] = seen.emplace(cell_name(grid, choice), point);
    if (is_new)
      choices.push_back(choice);
    else
      require_same(same->first, same->second, point);
  }
  return choices;
}

std::string cell_name(const Grid& grid, const Choice& choice) {
  std::string name;
  const auto add = [&](const std::string& part) { name += (name.empty() || part.empty() ? "" : "_") + part; };
  for (const std::string& axis : grid.labels) add(part_of_name(axis, choice.value(axis)));
  if (choice.has("level")) add(format("h%d", choice.level()));
  if (choice.has("step")) add(format("tau%d", choice.step()));
  return name;
}

nlohmann::json labels(const Grid& grid, const Choice& choice) {
  nlohmann::json labels = nlohmann::json::object();
  for (const std::string& axis : grid.labels) labels[axis] = choice.value(axis);
  return labels;
}

nlohmann::json common_values(const Grid& grid, const std::vector<Choice>& choices) {
  nlohmann::json common = nlohmann::json::object();
  if (choices.empty()) return common;
  std::vector<std::string> names = {"degree", "bdf", "start"};
  for (const Axis& axis : grid.axes) names.push_back(axis.name);
  for (const std::string& name : names) {
    if (!choices.front().has(name) ||
        std::find(grid.labels.begin(), grid.labels.end(), name) != grid.labels.end())
      continue;
    const nlohmann::json& value = choices.front().value(name);
    if (std::all_of(choices.begin(), choices.end(),
                    [&](const Choice& choice) { return choice.value(name) == value; }))
      common[name] = value;
  }
  return common;
}

}  // namespace esfem
