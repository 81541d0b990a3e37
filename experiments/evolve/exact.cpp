// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/exact.hpp"

#include "experiments/evolve/formulas.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/problems/formula_data.hpp"

namespace esfem {
namespace {

/// The formulas and their gradients, as quadrature_errors takes them.
FunctionInSpace in_space(const CompiledFormulas& values_and_gradients, double t) {
  const int components = values_and_gradients.count() / 4;
  return [&, t, components, out = std::vector<Pack>(4 * components)](const Batch&, int, const Pack(&x)[3],
                                                                     FieldsAtPoints& at_points) mutable {
    const Pack in[4] = {x[0], x[1], x[2], pack(t)};
    values_and_gradients.evaluate(in, out.data());
    for (int l = 0; l < components; ++l) {
      at_points.value[l] = out[l];
      for (int i = 0; i < 3; ++i) at_points.gradient[l][i] = out[components + 3 * l + i];
    }
  };
}

}  // namespace

ExactFormulas::ExactFormulas(const EvolveConfig& config, const SurfaceSpace& space)
    : space_(space), where_(config.source + ": exact"), M_(space.matrix()), A_(space.matrix()) {
  if (!config.formulas.contains("exact")) return;
  const JsonReader reader(config.formulas.at("exact"), where_);
  const FormulaNames names = names_in_space_time(names_of(config));
  for (const auto& item : config.formulas.at("exact").items()) {
    const std::string& name = item.key();
    const std::vector<Formula> values = item.value().is_array()
                                            ? formulas_in(reader, name, names)
                                            : std::vector<Formula>{formula_in(reader, name, names)};
    std::vector<Formula> all = values;
    for (const Formula& value : values)
      for (const char* coordinate : {"x", "y", "z"}) all.push_back(value.derivative(coordinate));
    formulas_[name] = {CompiledFormulas(values), CompiledFormulas(all)};
  }
}

void ExactFormulas::record(double t, const Field& x, const NodalFields& fields, Series& series) {
  space_.assemble(x, M_, A_);
  for (const auto& [name, exact] : formulas_) {
    const CompiledFormulas& formulas = exact.values;
    const Field* values = find(fields, name);
    if (!values) {
      std::string known;
      for (const NodalField& field : fields) known += (known.empty() ? "" : ", ") + field.name;
      throw InputError(where_ + ": found " + name + "; expected one of " + known);
    }
    if (values->cols() != formulas.count())
      throw InputError(where_ + format(": %s has %td components; found %d formulas", name.c_str(),
                                       values->cols(), formulas.count()));
    const Field e = *values - nodal_values(formulas, x, t);
    Errors norms;
    const Quantities quantity(space_, {{name, formulas.count()}});
    raise_maxima(quantity, "nodal", nodal_norms(M_, A_, e), norms);
    raise_maxima(quantity, "quadrature",
                 quadrature_errors(space_, x, in_space(exact.values_and_gradients, t), *values), norms);
    for (const auto& [norm, error] : norms.at(name)) series[name + "_" + norm].push_back(error);
  }
}

}  // namespace esfem
