// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>

#include "solver/mesh/read.hpp"
#include "solver/tables/table.hpp"
#include "solver/time/last_state.hpp"

namespace esfem {

/// A run of the independent implementation, from a file of reference/independent.
struct ReferenceCase {
  explicit ReferenceCase(const std::string& name)
      : json(read_json(folder() + name + ".json")),
        mesh(read_mesh(folder() + json["mesh"].get<std::string>()).mesh),
        grid{json["q"].get<int>(), json["tau"].get<double>(), json["nsteps"].get<int>(),
             parse_start(json["start"].get<std::string>())} {}

  /// The nodal values of a quantity at the end, N x c.
  Field nodal(const std::string& quantity) const {
    const nlohmann::json& rows = json["nodal"][quantity];
    Field field(rows.size(), rows[0].size());
    for (size_t i = 0; i < rows.size(); ++i) {
      for (size_t l = 0; l < rows[i].size(); ++l)
        field(i, l) = (rows[i].is_array() ? rows[i][l] : rows[i]).get<double>();
    }
    return field;
  }

  /// The largest difference of a nodal value, over the quantities of the file.
  template <class State>
  double deviation(const State& state) const {
    double largest = 0;
    for (const NamedField<State>& field : State::fields) {
      if (!json["nodal"].contains(field.name)) continue;
      const Field difference = state.*field.member - nodal(field.name);
      largest = std::max(largest, difference.cwiseAbs().maxCoeff());
    }
    return largest;
  }

  nlohmann::json json;
  Mesh mesh;
  UniformSteps grid;

 private:
  static std::string folder() { return std::string(ESFEM_SOURCE_DIR) + "/reference/independent/"; }
};

}  // namespace esfem
