// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "experiments/evolve/formulas.hpp"
#include "experiments/evolve/run_flow.hpp"
#include "experiments/evolve/willmore.hpp"
#include "solver/error.hpp"
#include "solver/flows/helfrich_law.hpp"
#include "solver/problems/formula_data.hpp"
#include "solver/problems/spontaneous_curvature.hpp"

namespace esfem {
namespace {

const char* const H_0_key = "spontaneous_curvature";

/// With those of Willmore flow a red blood cell breaks at t = 0.26: nu_h and H_h leave the surface, and
/// theta, that of the initial shape, moves each other stationary one.
const WillmoreDefaults for_stationary_shapes = {"coefficients", false, nullptr};

Formula spontaneous_curvature(const EvolveConfig& config) {
  return {config.parameters.text(H_0_key), names_in_space_time(names_of(config)),
          config.source + ": parameters: " + H_0_key};
}

bool is_number(const EvolveConfig& config) {
  return config.parameters.numbers().count(H_0_key) > 0;
}

AreaAndVolume prescribed(const EvolveConfig& config, double area, double volume) {
  const Settings& parameters = config.parameters;
  AreaAndVolume prescribed;
  if (parameters.has_word("constraints", "area")) prescribed.area = constant_target(area);
  if (parameters.has_word("constraints", "volume")) {
    const double last =
        parameters.has("reduced_volume") ? volume_of(area, parameters.number("reduced_volume")) : volume;
    prescribed.volume = smooth_target(volume, last, 0, parameters.number("reduction_time"));
  }
  return prescribed;
}

WillmoreProblem helfrich_problem(const Run& run) {
  const EvolveConfig& config = run.config;
  const Field& x0 = config.mesh.nodes;
  return {is_number(config) ? helfrich_law(config.parameters.number(H_0_key))
                            : helfrich_law(spontaneous_curvature(config)),
          prescribed(config, run.space.area(x0), run.space.volume(x0))};
}

void check_helfrich(const EvolveConfig& config, const std::string& source) {
  const Settings& parameters = config.parameters;
  const std::string where = source + ": parameters: ";
  if (!is_number(config)) spontaneous_curvature(config);
  const bool is_constrained =
      parameters.has_word("constraints", "area") || parameters.has_word("constraints", "volume");
  if (is_constrained && config.variant.is("tangential", "minimal_deformation"))
    throw InputError(source +
                     ": variant: found tangential = \"minimal_deformation\" and prescribed area or volume; "
                     "expected one of them: \"constraints\": [], or no key tangential");
  if (!parameters.has("reduced_volume"))
    return refuse_given(parameters, {"reduction_time"}, source + ": parameters", "without reduced_volume");
  if (!parameters.has_word("constraints", "area") || !parameters.has_word("constraints", "volume"))
    throw InputError(where +
                     "found a reduced_volume without both constraints; expected \"constraints\": "
                     "[\"area\", \"volume\"]");
  if (parameters.number("reduced_volume") > 1)
    throw InputError(where + format("found reduced_volume = %g; expected at most 1, that of spheres",
                                    parameters.number("reduced_volume")));
}

}  // namespace

void record_more(const Run& run, const WillmoreFlow::State& state) {
  look_at_steps(run, state);
  if (!run.config.parameters.has(H_0_key)) return;
  Series& series = run.recorder.series();
  const Field H_0 =
      is_number(run.config)
          ? Field::Constant(state.x.rows(), 1, run.config.parameters.number(H_0_key))
          : nodal_values(CompiledFormulas({spontaneous_curvature(run.config)}), state.x, state.t);
  series["helfrich_energy"].push_back(helfrich_energy(run.space, state.x, state.u.col(0), H_0));
  series["lambda_A"].push_back(state.lambda(0, Multipliers::area));
  series["lambda_V"].push_back(state.lambda(0, Multipliers::volume));
}

std::vector<Entry> helfrich_entries() {
  Entry entry = willmore_entry(helfrich_problem, false, for_stationary_shapes);
  entry.flow = "helfrich";
  entry.energy = "helfrich_energy";
  entry.order = entry.order_on_files = 2;
  for (Key& key : entry.variant)
    if (key.name == "tangential") key.help += "; with \"constraints\": []";
  entry.help =
      "Helfrich flow by kll21 (3.4)-(3.5): V = Delta H + Q - lambda_A H - lambda_V decreases 1/2 int (H - "
      "H_0)² and keeps area and volume";
  entry.parameters = {
      {Key::number_or_formula, H_0_key, 0, "H_0, of x, y, z, t; H is 2/R on a sphere"},
      {Key::words_of,
       "constraints",
       nlohmann::json::array({"area", "volume"}),
       "what is kept",
       0,
       {"area", "volume"}},
      {Key::positive, "reduced_volume", nullptr,
       "6 sqrt(pi) volume/area^(3/2) that the volume is changed to; default: that at the start"},
      {Key::positive, "reduction_time", 1, "when it is reached", 4}};
  const auto check_scheme = entry.check;
  entry.check = [check_scheme](const EvolveConfig& config, const std::string& source) {
    check_scheme(config, source);
    check_helfrich(config, source);
  };
  return {entry};
}

}  // namespace esfem
