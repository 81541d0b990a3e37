// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/evolve/exact.hpp"

#include "experiments/evolve/formulas.hpp"
#include "solver/analysis/errors.hpp"
#include "solver/error.hpp"
#include "solver/problems/formula_data.hpp"

namespace esfem {

ExactFormulas::ExactFormulas(const EvolveConfig& config, const SurfaceSpace& space)
    : space_(space), where_(config.source + ": exact"), M_(space.matrix()), A_(space.matrix()) {
  if (!config.formulas.contains("exact")) return;
  const JsonReader reader(config.formulas.at("exact"), where_);
  const FormulaNames names = names_in_space_time(names_of(config));
  for (const auto& item : config.formulas.at("exact").items()) {
    const std::string& name = item.key();
    formulas_[name] =
        CompiledFormulas(item.value().is_array() ? formulas_in(reader, name, names)
                                                 : std::vector<Formula>{formula_in(reader, name, names)});
  }
}

void ExactFormulas::record(double t, const Field& x, const NodalFields& fields, Series& series) {
  space_.assemble(x, M_, A_);
  for (const auto& [name, formulas] : formulas_) {
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
    raise_maxima({space_, {{name, formulas.count()}}}, "nodal", nodal_norms(M_, A_, e), norms);
    for (const auto& [norm, error] : norms.at(name)) series[name + "_" + norm].push_back(error);
  }
}

}  // namespace esfem
