// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/history.hpp"

#include <algorithm>

namespace esfem {

using nlohmann::json;

json in_numbers(const json& value) {
  if (!value.is_object()) return value;
  if (value.contains("values") && value.at("values").is_binary()) {
    const Field field = unpacked(value);
    return {{"rows", field.rows()},
            {"columns", field.cols()},
            {"numbers", std::vector<double>(field.data(), field.data() + field.size())}};
  }
  json result = json::object();
  for (const auto& [key, part] : value.items()) result[key] = in_numbers(part);
  return result;
}

json in_bytes(const json& value) {
  if (!value.is_object()) return value;
  if (value.contains("numbers")) {
    const auto numbers = value.at("numbers").get<std::vector<double>>();
    const auto rows = value.at("rows").get<std::size_t>(), columns = value.at("columns").get<std::size_t>();
    if (std::max(rows, columns) > numbers.size() || numbers.size() != rows * columns)
      throw InputError(format("%zu numbers for %zu x %zu", numbers.size(), rows, columns));
    return packed(Eigen::Map<const Field>(numbers.data(), rows, columns));
  }
  json result = json::object();
  for (const auto& [key, part] : value.items()) result[key] = in_bytes(part);
  return result;
}

}  // namespace esfem
