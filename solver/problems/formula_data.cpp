// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/problems/formula_data.hpp"

#include <algorithm>
#include <memory>

#include "solver/error.hpp"

namespace esfem {

namespace {

Field with_time(const Field& x, double t) {
  Field points(x.rows(), 4);
  points << x, Eigen::VectorXd::Constant(x.rows(), t);
  return points;
}

}  // namespace

FormulaNames names_in_space_time(FormulaNames names) {
  names.variables = {"x", "y", "z", "t"};
  return names;
}

FormulaNames names_of_kinetics(int species, FormulaNames names) {
  names = names_in_space_time(std::move(names));
  for (const std::string& name : concentration_names(species)) names.variables.push_back(name);
  return names;
}

Field nodal_values(const CompiledFormulas& formulas, const Field& x, double t) {
  return formulas(with_time(x, t));
}

PointwiseKinetics formula_kinetics(const std::vector<Formula>& f_and_g) {
  const std::size_t variables = f_and_g.at(0).names().variables.size();
  return [compiled = CompiledFormulas(f_and_g), in = std::vector<Pack>(variables)](
             double t, const Pack* point, Pack* values) mutable {
    std::copy(point, point + 3, in.begin());
    in[3] = pack(t);
    std::copy(point + 6, point + 6 + (in.size() - 4), in.begin() + 4);  // behind the normal
    compiled.evaluate(in.data(), values);
  };
}

NodalFunction formula_nodal_function(const Formula& formula) {
  return [compiled = CompiledFormulas({formula})](double t, const Field& x, const Field& u, Field& values) {
    Field points(x.rows(), 4 + u.cols());
    points << with_time(x, t), u;
    values = compiled(points);
  };
}

Velocity formula_velocity(const std::vector<Formula>& components) {
  if (components.size() != 3)
    throw InputError(format("a velocity of %zu components; expected 3", components.size()));
  return [compiled = CompiledFormulas(components)](double t, const Field& x, Field& v) {
    v = compiled(with_time(x, t));
  };
}

Velocity formula_normal_velocity(const Formula& d) {
  const CompiledFormulas derivatives(
      {d.derivative("t"), d.derivative("x"), d.derivative("y"), d.derivative("z")});
  return [derivatives](double t, const Field& x, Field& v) {
    const Field values = derivatives(with_time(x, t));
    v = values.rightCols(3);
    v.array().colwise() *= -values.col(0).array() / v.rowwise().squaredNorm().array();
  };
}

namespace {

NumericsError bad_mobility(const std::string& description, double found, const char* expected,
                           const std::string& at) {
  return NumericsError(description + format(" is %g at ", found) + at + ": expected " + expected);
}

}  // namespace

Mobility formula_mobility(const Formula& m) {
  const std::string description = m.description();
  const CompiledFormulas compiled({m});
  const std::vector<std::string> in_points = {"x", "y", "z", "u"};
  if (std::none_of(in_points.begin(), in_points.end(), [&](auto& name) { return m.depends_on(name); }))
    return {[compiled, description](double t) {
              const double in[] = {0, 0, 0, t, 0};
              double value;
              compiled.evaluate(in, &value);
              if (value > 0) return value;
              throw bad_mobility(description, value, "a positive mobility", format("t = %g", t));
            },
            {}};
  return {{}, [compiled, description](double t, const PointData<1>& p, Pack& value) {
            const Pack in[] = {p.x[0], p.x[1], p.x[2], pack(t), p.u[0]};
            compiled.evaluate(in, &value);
            for (int lane = 0; lane < pack_size; ++lane)
              if (value[lane] < 0)
                throw bad_mobility(description, value[lane], "no negative mobility, for example max(.., 0)",
                                   format("x = %g, y = %g, z = %g, t = %g, u = %g", in[0][lane], in[1][lane],
                                          in[2][lane], t, in[4][lane]));
          }};
}

FormulaMixture::FormulaMixture(const Formula& potential, const std::vector<Formula>& source)
    : potential_({potential}),
      slope_({potential.derivative("u")}),
      second_({potential.derivative("u").derivative("u")}),
      source_(source) {}

void FormulaMixture::evaluate(const CompiledFormulas& formula, double t, const PointData<1>& p, Pack& value) {
  const Pack in[] = {p.x[0], p.x[1], p.x[2], pack(t), p.u[0]};
  formula.evaluate(in, &value);
}

void FormulaMixture::b(double t, const Field& x, Field& nodal) const {
  if (source_.count() > 0) nodal = nodal_values(source_, x, t);
}

double FormulaMixture::energy(const SurfaceSpace& space, double t, const Field& x, const Field& u,
                              double epsilon) const {
  const auto density = [&](const PointData<1>& p, Integrand<1, 0>& load) {
    Pack potential;
    evaluate(potential_, t, p, potential);
    load.value[0] = epsilon / 2 * dot(p.grad[0], p.grad[0]) + potential / epsilon;
  };
  Field load;
  space.assemble_load<1, 1, 0>(x, u, density, load);
  return load.sum();  // the shape functions sum to 1
}

}  // namespace esfem
