// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "experiments/evolve/config.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/formulas/formula.hpp"
#include "solver/nodal_field.hpp"

namespace esfem {

/// The errors of a run's fields against the formulas of "exact", per step. Beside those of fields there may
/// be
///   "x": the trajectories of the material points: formulas in t and in x, y, z, where they are at the start;
///   "level_set": d(x, y, z, t), negative inside, whose zeros are the exact surface.
class ExactFormulas {
 public:
  /// Configuration and space must outlive this. Throws InputError for what is no formula.
  ExactFormulas(const EvolveConfig& config, const SurfaceSpace& space);

  bool empty() const { return exact_.quantities.empty(); }
  /// Adds for each field NAME_nodal_L2, NAME_nodal_H1 and NAME_nodal_H1_semi of the differences to the exact
  /// values in the exact nodes, or, without "x", in the nodes of the computed surface. Beside them lifted
  /// norms where the exact surface is known: by "level_set" or that of the velocity, or because the surface
  /// is at rest. Else unlifted ones, on the surface of these nodes (unlifted_errors). Throws InputError when
  /// a formula belongs to no field, or to one with another number of components.
  void record(double t, const Field& x, const NodalFields& fields, Series& series);

 private:
  Field columns(const Field& x, const NodalFields& fields) const;
  void find_exact_surface(const EvolveConfig& config);
  /// Once, when nodes are farther from the exact surface than the longest edge at the start.
  void warn_of_distance(double t, const Field& x);

  const SurfaceSpace& space_;
  std::string where_;
  Field x0_;
  ExactEvolution exact_;    ///< surface and trajectories only where they are known
  CompiledFormulas nodal_;  ///< all but x
  /// Of the nodes from a level set of the exact surface before it warns: the longest edge at the start.
  std::optional<double> largest_distance_;
  std::optional<Quantities> quantities_;
  SymmetricMatrix M_, A_;
};

}  // namespace esfem
