// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "solver/geometry/discrete_curvature.hpp"
#include "solver/nodal_field.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/time/history.hpp"

namespace esfem {

/// The quantities of an error table, found by name among the nodal fields of a state.
class Quantities {
 public:
  /// The space must outlive this.
  Quantities(const SurfaceSpace& space, std::vector<ExactEvolution::Quantity> quantities);

  /// Their values side by side, N x all components: of nodal_fields, or of State::fields. nu is that of
  /// the discrete surface where the flow has none, and H where it does not evolve both (that of BGN's scheme
  /// is a mean over the step). Throws InputError when there is no field of a quantity's name and size.
  template <class State>
  Field of(const State& state) {
    NodalFields fields = nodal_fields(state);
    for (const NamedField<State>& field : State::fields) fields.push_back({field.name, state.*field.member});
    return columns(state.x, std::move(fields));
  }

  /// The quantities, in the order of their columns.
  /// @{
  auto begin() const { return quantities_.begin(); }
  auto end() const { return quantities_.end(); }
  /// @}

 private:
  Field columns(const Field& x, NodalFields fields);

  std::vector<ExactEvolution::Quantity> quantities_;
  const SurfaceSpace& space_;
  std::unique_ptr<DiscreteCurvature> curvature_;  ///< made when it is needed: it costs a symbolic phase
};

}  // namespace esfem
