// SPDX-License-Identifier: GPL-3.0-or-later
// The description of a flow for `evolve`. A flow, or a problem of one, is an entry; the parser, --help,
// --schema, the dispatch and the list in docs/flows.md follow from it.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "experiments/evolve/settings.hpp"
#include "solver/time/bdf.hpp"

namespace esfem {

struct EvolveConfig;
struct ExactEvolution;
struct Run;

/// A key of the configuration whose value has formulas.
struct FormulaKey {
  std::string name, example, help;
  nlohmann::json schema;
  bool is_required = false;
};

struct Entry {
  std::string flow;          ///< its name in configurations
  std::string problem = "";  ///< "": the flow has one alone, without a name
  std::string help;          ///< one line
  std::string fields;        ///< nodal fields of the output beside x and v
  std::vector<Key> variant = {}, parameters = {};
  std::vector<FormulaKey> formulas = {};
  bool takes_own_parameters = false;  ///< "parameters" may have other numbers, too: formulas name them

  /// Completes the run: makes flow and initial state, and calls run_flow (run_flow.hpp).
  std::function<void(const Run&)> run;
  /// Throws InputError for what the keys alone do not show; `source` heads the message. None: nothing.
  std::function<void(const EvolveConfig&, const std::string& source)> check = {};
  /// The keys of "limits" that the flow looks at.
  std::set<std::string> limits = {};

  /// The exact solution, where one is known for the configuration; none: there is none.
  std::function<std::optional<ExactEvolution>(const EvolveConfig&)> exact_solution = {};

  int highest_order = max_bdf_order;
  int order = 3, order_on_files = 3;  ///< of BDF where none is given; on a mesh file without a surface
  bool takes_adaptive_steps = true;
  int time_power = 2;  ///< times have the unit L to this power

  /// Sets of nodal values of a mesh file that a run can start from, as a whole; beside an exact surface, too.
  std::vector<std::vector<std::string>> starts = {};
  bool starts_beside_surface = false;
  /// The same where they depend on the configuration.
  std::function<std::vector<std::vector<std::string>>(const EvolveConfig&)> own_starts = {};

  bool evolves_curvature = false;  ///< nu and H, which can deviate from those of the surface
  bool can_shrink_to_nothing = false;
  bool is_mean_curvature_flow = false;  ///< for which the lifetime is bounded
  bool slides_nodes = false;            ///< in its first step
  bool has_given_motion = false;        ///< of the surface, or none: u alone evolves
  bool moves_as_given = false;          ///< has_given_motion, and it is not at rest
  bool records_kappa_energy = false;    ///< in the series
  std::string energy = "";              ///< the series that the flow decreases; "": it has none
  bool lumps_linear_elements = false;   ///< takes the vertices as quadrature points by default

  /// Advice when nu and H deviate from the surface, and when a run has ended at a singularity.
  std::function<std::string(const EvolveConfig&)> curvature_cure = {}, cure = {};
};

/// All entries; those of a flow are adjacent, and the first is its default problem.
const std::vector<Entry>& entries();

/// That of a configuration's "flow" and "problem" (empty: not given). Throws InputError, which lists the
/// known names, for names that no entry has.
const Entry& entry_named(const std::string& flow, const std::string& problem, const std::string& source);

// One for each file of this folder that describes flows.
std::vector<Entry> mean_curvature_entries();
std::vector<Entry> dziuk_entries();
std::vector<Entry> bgn_entries();
std::vector<Entry> generalised_mean_curvature_entries();
std::vector<Entry> willmore_entries();
std::vector<Entry> helfrich_entries();
std::vector<Entry> willmore_competitor_entries();
std::vector<Entry> coupled_diffusion_entries();
std::vector<Entry> kinetics_entries();
std::vector<Entry> cahn_hilliard_entries();
std::vector<Entry> mixture_entries();

}  // namespace esfem
