// SPDX-License-Identifier: GPL-3.0-or-later
//
// Convergence of a configuration of evolve: the same problem on finer meshes and with smaller steps
//
// Sample run:  build/bin/study reference/examples/study_ellipsoid.json --levels 0-3 --output build/study
//
// Runs all combinations of levels and steps, compares each with the exact solution or with the finest run,
// and fits orders. plots/study.py draws the table.
#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/evolve/cell_run.hpp"
#include "experiments/evolve/config.hpp"
#include "experiments/evolve/initial.hpp"
#include "experiments/evolve/refinement.hpp"
#include "experiments/harness/experiment.hpp"
#include "experiments/harness/kept_cells.hpp"
#include "experiments/harness/provenance.hpp"
#include "experiments/harness/warn.hpp"
#include "solver/analysis/differences.hpp"
#include "solver/error.hpp"
#include "solver/problems/exact_evolution.hpp"
#include "solver/tables/fit_orders.hpp"
#include "solver/thread_count.hpp"

namespace {

using namespace esfem;
using nlohmann::json;

const char* const help =
    R"(Convergence of a configuration of evolve: the same problem on finer meshes and with smaller steps.
Example: study reference/examples/study_ellipsoid.json --levels 0-3 --output build/study
         /usr/bin/python3 plots/study.py build/study/table.json build/study

Level l halves the edge length l times: edge_length and grading of a generated mesh, subdivisions + l; of a mesh file the
length of "remesh", or "refine" + l, which cuts each triangle into four: on the surface, if one is given, with "curve" on
the smooth surface through the corners, else on the elements of the file. Step level s halves tau and doubles steps, s
times. All combinations are run.
Errors, --against
  exact    the exact solution of the flow (mean curvature flow of sphere and angenent_torus, growing_sphere, ..), or the
           formulas "exact": maxima over time of the nodal and the lifted norms (unlifted where the exact surface is unknown)
  formula  the formulas "exact" only
  finest   the run with the largest level and step, at the end: norms by quadrature on the surface of the coarser run of
           the difference to the values in the closest points of the finest surface ("closest_L2", ..); x is the distance
           of the surfaces, without the tangential motion of nodes. The closest point is found to round-off. Orders are
           those of the differences between neighbours in level or step, which fall as errors do; differences to the
           finest run do not, since it has an error of its own (see docs/studies.md)
Default: exact where there is such a solution, else finest.
Orders are fitted to all errors of a quantity and norm, with 95% intervals where there are at least three levels
(four against the finest run).
)";

/// What the errors are differences to.
enum class Against { exact, formula, finest };

std::optional<Against> against_named(const std::string& name) {
  if (name.empty()) return {};
  const std::map<std::string, Against> known = {
      {"exact", Against::exact}, {"formula", Against::formula}, {"finest", Against::finest}};
  const auto found = known.find(name);
  if (found == known.end())
    throw InputError("--against: found '" + name + "', expected exact, formula or finest");
  return found->second;
}

/// The reference of the errors. Throws InputError when what is asked for is not there.
Against reference_of(const json& configuration, const std::string& source, std::optional<Against> asked) {
  const EvolveConfig config = checked_keys(configuration, source);
  const bool has_formula = configuration.contains("exact");
  const bool is_known =
      has_formula || (config.entry->exact_solution && config.entry->exact_solution(config).has_value());
  if (asked == Against::formula && !has_formula)
    throw InputError(source + ": found --against formula and no formulas; expected the key exact");
  if (asked == Against::exact && !is_known)
    throw InputError(source +
                     ": found --against exact and no exact solution; expected the key exact with formulas, "
                     "or --against finest");
  return asked ? *asked : is_known ? Against::exact : Against::finest;
}

std::string cell_name(int level, int step) {
  return format("h%d_tau%d", level, step);
}

Cell cell_of(const json& configuration, const std::string& source, int level, int step, const json& origin) {
  const json finer = refined_configuration(configuration, level, step, source);
  checked_keys(finer, source);
  Cell cell;
  cell.planned = planned_row(finer, cell_name(level, step));
  cell.planned.level = level;
  cell.run = [=](Row& row, const std::string& folder) {
    run_as_cell(finer, source, origin, /*wants_nodal=*/true, folder, row);
  };
  return cell;
}

/// The nodal output of a cell.
struct Solution {
  DiscreteFunctions functions;
  double t;
};

/// Those of the cells that have come to their end.
std::map<std::string, Solution> solutions_of(const std::vector<Row>& rows, const std::string& cells) {
  std::map<std::string, Solution> solutions;
  for (const Row& row : rows) {
    if (row.status != "ok") continue;
    ReadMesh read = read_nodal_output(cells + "/" + row.cell + "/" + nodal_file);
    solutions[row.cell] = {{std::move(read.mesh), std::move(read.fields)}, read.t.value()};
  }
  return solutions;
}

/// How far cells are from finer ones.
class Differences {
 public:
  Differences(const std::vector<Row>& rows, const std::string& cells)
      : solutions_(solutions_of(rows, cells)) {}

  /// None when one of the runs is singular or failed. Each pair is compared once.
  const Errors& operator()(const std::string& cell, const std::string& finer) {
    const auto [known, is_new] = known_.try_emplace({cell, finer});
    if (is_new) known->second = compared(cell, finer);
    return known->second;
  }

 private:
  Errors compared(const std::string& cell, const std::string& finer) const {
    const auto one = solutions_.find(cell), other = solutions_.find(finer);
    if (one == solutions_.end() || other == solutions_.end()) return {};
    const double t = one->second.t, end = other->second.t;
    if (std::abs(t - end) > 1e-9 * std::abs(end))
      throw InputError(
          format("cell %s ends at t = %g, and %s, which is finer, at t = %g; expected runs of one length",
                 cell.c_str(), t, finer.c_str(), end));
    return differences(one->second.functions, other->second.functions);
  }

  std::map<std::string, Solution> solutions_;
  std::map<std::pair<std::string, std::string>, Errors> known_;
};

/// Orders in the level or in the step, from the differences of cells that are next to each other in it. Two
/// such cells have errors e and 2^-p e. These may be aligned, as smooth errors are, or orthogonal, as those
/// of gradients on meshes that are not nested: the difference is between (1 - 2^-p) e and (1 + 2^-p) e, and
/// falls with the order p in any case. Differences to the finest cell do not, since its own error is a
/// growing part of them.
std::vector<Fit> fits_of_neighbours(Differences& differences, const std::vector<int>& levels,
                                    const std::vector<int>& steps, bool in_level, Table table) {
  std::map<std::string, Errors> errors;
  for (std::size_t i = 0; i + in_level < levels.size(); ++i)
    for (std::size_t j = 0; j + !in_level < steps.size(); ++j) {
      const std::string cell = cell_name(levels[i], steps[j]);
      errors[cell] = differences(cell, cell_name(levels[i + in_level], steps[j + !in_level]));
    }
  for (Row& row : table.rows) {
    row.errors = errors[row.cell];
    (in_level ? row.tau : row.h) = in_level ? table.rows[0].tau : table.rows[0].h;
  }
  return fit_table(table, {});
}

void add_errors_of_finest(const std::string& cells, std::vector<int> levels, std::vector<int> steps,
                          Table& table) {
  std::sort(levels.begin(), levels.end());
  std::sort(steps.begin(), steps.end());
  const std::string finest = cell_name(levels.back(), steps.back());
  table.parameters["against"] = "finest: " + finest + ", at the end, by closest point";
  table.parameters["orders"] = "of the differences between runs that are next to each other in level or step";
  Differences differences(table.rows, cells);
  for (Row& row : table.rows) {
    if (row.cell == finest && row.status != "ok")
      warn("the finest run, " + finest + ", is no reference: " + row.status);
    row.errors = row.cell == finest ? Errors() : differences(row.cell, finest);
  }
  for (const bool in_level : {true, false})
    for (Fit& fit : fits_of_neighbours(differences, levels, steps, in_level, table))
      table.fits.push_back(std::move(fit));
}

void print_fits(const Table& table) {
  if (table.fits.empty())
    warn(
        "no orders: they need errors of three levels or steps, so four of them when runs are compared with "
        "each other (--against finest), and five rows when both vary");
  for (const Fit& fit : table.fits) {
    const std::string interval = fit.ci95 ? format(" in [%.2f, %.2f]", fit.ci95->at(0), fit.ci95->at(1)) : "";
    const std::string remark = fit.remark.empty() ? "" : ", " + fit.remark;
    std::printf("%s %s: order %.2f in %s%s%s\n", fit.quantity.c_str(), fit.norm.c_str(), fit.order,
                fit.variable.c_str(), interval.c_str(), remark.c_str());
  }
}

void study(const std::string& source, const std::vector<int>& levels, const std::vector<int>& steps,
           std::optional<Against> asked, const CellRequest& request, const json& origin) {
  const json configuration = read_json(source);
  const Against against = reference_of(configuration, source, asked);
  std::vector<Cell> cells;
  for (int level : levels)
    for (int step : steps) cells.push_back(cell_of(configuration, source, level, step, origin));
  Table table;
  table.experiment = "study";
  table.parameters = {{"configuration", configuration}};
  table.parameters["configuration"].erase("$schema");
  table.provenance = origin;
  NodeCounts nodes;
  const auto cost = [&](const Cell& cell) {
    const double finer = std::ldexp(1.0, 2 * cell.planned.level);
    json sized = configuration;
    if (sized.contains("steps")) sized["steps"] = cell.planned.steps;
    return estimated_seconds(sized, finer * nodes.of(configuration, source));
  };
  answer_kept(std::move(cells), request, std::move(table), cost, [&](Table& all) {
    const std::string folder =
        request.collect_from.empty() ? request.output + "/cells" : request.collect_from;
    if (against == Against::finest) {
      add_errors_of_finest(folder, levels, steps, all);
    } else {
      all.parameters["against"] = configuration.contains("exact") ? "formula" : "exact";
      all.fits = fit_table(all, {});
    }
    print_fits(all);
  });
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main([&] {
    std::string file, against;
    std::vector<int> levels = {0, 1, 2, 3}, steps = {0};
    int threads = 1;
    CellRequest request;
    CommandLine line(help + ("\n" + kept_cells_help("study", "--levels 0-3 --steps 0-3")), "study");
    line.argument("config", file, "the configuration, see evolve --explain keys", "CONFIG.json");
    line.parsed(
        "--levels", [&](const std::string& text) { levels = parse_list(text, "--levels"); },
        "how often the edge length is halved (default: 0-3)", "LIST");
    line.parsed(
        "--steps", [&](const std::string& text) { steps = parse_list(text, "--steps"); },
        "how often tau is halved (default: 0)", "LIST");
    line.text("--against", against,
              "what the errors are differences to (default: exact if known, else finest)",
              "exact|formula|finest");
    add_kept_cell_options(line, request);
    line.integer("--threads", 1, 1024, threads, "threads that the factorisations may use");
    if (!line.parse(argc, argv)) return static_cast<int>(exit_done);
    set_thread_count(threads);
    study(file, levels, steps, against_named(against), request, provenance(argc, argv));
    return static_cast<int>(exit_done);
  });
}
