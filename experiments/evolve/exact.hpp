// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/evolve/config.hpp"
#include "solver/formulas/formula.hpp"
#include "solver/nodal_field.hpp"

namespace esfem {

/// The errors of a run's fields against the formulas of "exact", per step: nodal norms, and norms by
/// quadrature on the computed surface (quadrature_errors).
class ExactFormulas {
 public:
  /// The space must outlive this. Throws InputError for what is no formula, or a list of other than 3.
  ExactFormulas(const EvolveConfig& config, const SurfaceSpace& space);

  bool empty() const { return formulas_.empty(); }
  /// Adds NAME_nodal_L2, _H1 and _H1_semi of the differences to the exact values in the nodes x of the
  /// computed surface, and NAME_quadrature_L2, ... Throws InputError when a formula belongs to no field, or
  /// to one with another number of components.
  void record(double t, const Field& x, const NodalFields& fields, Series& series);

 private:
  const SurfaceSpace& space_;
  std::string where_;
  struct Exact {
    CompiledFormulas values, values_and_gradients;  ///< all values, then the gradients, one after the other
  };
  std::map<std::string, Exact> formulas_;
  SymmetricMatrix M_, A_;
};

}  // namespace esfem
