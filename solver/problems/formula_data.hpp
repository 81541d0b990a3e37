// SPDX-License-Identifier: GPL-3.0-or-later
// Data of flows from formulas in x, y, z, t, and concentrations.
#pragma once

#include <vector>

#include "solver/flows/cahn_hilliard.hpp"
#include "solver/flows/coupled_diffusion.hpp"
#include "solver/formulas/formula.hpp"
#include "solver/geometry/prescribed_motion.hpp"

namespace esfem {

/// x, y, z, t, with the constants and definitions of `names`.
FormulaNames names_in_space_time(FormulaNames names);
/// The same with the concentration_names.
FormulaNames names_of_kinetics(int species, FormulaNames names);

/// One column for each formula in space and time, in the nodes x at time t.
Field nodal_values(const CompiledFormulas& formulas, const Field& x, double t);

/// f_1, .., f_m and, for CoupledKinetics, g: formulas with names_of_kinetics, and H behind these where it is
/// an input.
PointwiseKinetics formula_kinetics(const std::vector<Formula>& f_and_g);

/// A formula with names_of_kinetics in the nodes.
NodalFunction formula_nodal_function(const Formula& formula);

/// The velocity with three components in space and time.
Velocity formula_velocity(const std::vector<Formula>& components);
/// The normal velocity of the level set of a formula in space and time (normal_velocity).
Velocity formula_normal_velocity(const Formula& level_set);

/// The mobility m(x, y, z, t, u), in_time where only t occurs. A step throws NumericsError, which names the
/// place, where m is negative, or m(t) is not positive.
Mobility formula_mobility(const Formula& m);

/// The Problem of CahnHilliard (f = 0) and of LinearisedCahnHilliard for a potential F(u), g = F', and a
/// source b in space and time, which is interpolated in the nodes.
class FormulaMixture {
 public:
  /// potential: a formula in x, y, z, t, u. source: none where it is empty.
  FormulaMixture(const Formula& potential, const std::vector<Formula>& source);

  /// f = 0.
  Pack f(double, const PointData<1>&) const { return Pack{}; }
  /// g = F'(u). Throws NumericsError where it is not finite; so do dg and b.
  Pack g(double t, const PointData<1>& p) const {
    Pack result;
    evaluate(slope_, t, p, result);
    return result;
  }
  /// g' = F''(u).
  Pack dg(double t, const PointData<1>& p) const {
    Pack result;
    evaluate(second_, t, p, result);
    return result;
  }
  /// The source in the nodes, N x 1; leaves `nodal` as it is where there is none.
  void b(double t, const Field& x, Field& nodal) const;

  /// Integral of epsilon/2 |grad u|² + F(u)/epsilon over Gamma_h[x].
  double energy(const SurfaceSpace& space, double t, const Field& x, const Field& u, double epsilon) const;

 private:
  static void evaluate(const CompiledFormulas& formula, double t, const PointData<1>& p, Pack& value);

  CompiledFormulas potential_, slope_, second_, source_;
};

}  // namespace esfem
