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
         python3 plots/study.py build/study/table.json build/study

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
           of the surfaces, without the tangential motion of nodes. The closest point is found to round-off. Since the
           finest run has an error of its own, slopes next to it are too steep: of order p, between the last two levels
           by log2(1 + 2^-p); fits take account of this (see docs/studies.md)
Default: exact where there is such a solution, else finest.
Orders are fitted to all errors of a quantity and norm, with 95% intervals where there are at least three levels.
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

Cell cell_of(const json& configuration, const std::string& source, int level, int step, const json& origin) {
  const json finer = refined_configuration(configuration, level, step, source);
  checked_keys(finer, source);
  Cell cell;
  cell.planned = planned_row(finer, format("h%d_tau%d", level, step));
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

Solution solution_of(const Row& row, const std::string& cells) {
  ReadMesh read = read_nodal_output(cells + "/" + row.cell + "/" + nodal_file);
  return {{std::move(read.mesh), std::move(read.fields)}, read.t.value()};
}

/// The errors of all rows but `finest`, relative to it.
void compare_with(const Row& finest, const std::string& cells, std::vector<Row>& rows) {
  const Solution reference = solution_of(finest, cells);
  for (Row& row : rows) {
    row.errors.clear();
    if (row.cell == finest.cell || row.status != "ok") continue;
    const Solution solution = solution_of(row, cells);
    if (std::abs(solution.t - reference.t) > 1e-9 * std::abs(reference.t))
      throw InputError(
          format("cell %s ends at t = %g, and %s, the finest, at t = %g; expected runs of one length",
                 row.cell.c_str(), solution.t, finest.cell.c_str(), reference.t));
    row.errors = differences(solution.functions, reference.functions);
  }
}

/// Fits of errors against the finest run, which has errors of its own: with e = C_h h^p + C_tau tau^q for
/// both, aligned as they are asymptotically, the difference is e less e(finest). So e(finest) of a fit is
/// added to the differences, and the fit repeated until it does not change.
std::vector<Fit> fits_against(const Row& finest, const Table& table) {
  Errors names;  // of the errors that there are
  for (const Row& row : table.rows)
    if (!row.errors.empty()) names = row.errors;
  Table corrected = table;
  const int rounds = 30;
  for (int round = 0; round < rounds; ++round) {
    double change = 0;
    for (const auto& [quantity, norms] : names)
      for (const auto& [norm, first] : norms) {
        std::vector<double> h, tau, errors;
        for (const Row& row : corrected.rows) {
          if (row.errors.empty() || row.status != "ok") continue;
          h.push_back(row.h);
          tau.push_back(row.tau);
          errors.push_back(row.errors.at(quantity).at(norm));
        }
        double of_finest = 0;
        try {
          const OrderFit fit = fit_orders(h, tau, errors);
          if (fit.h) of_finest += fit.constant_h * std::pow(finest.h, fit.h->order);
          if (fit.tau) of_finest += fit.constant_tau * std::pow(finest.tau, fit.tau->order);
        } catch (const std::exception&) {
          continue;  // fit_table leaves it out, too
        }
        for (std::size_t i = 0; i < table.rows.size(); ++i) {
          if (table.rows[i].errors.empty()) continue;
          double& error = corrected.rows[i].errors[quantity][norm];
          const double next = table.rows[i].errors.at(quantity).at(norm) + of_finest;
          change = std::max(change, std::abs(next - error) / next);
          error = next;
        }
      }
    if (change < 1e-4) break;
  }
  return fit_table(corrected, {});
}

void add_errors_of_finest(const std::string& cells, Table& table) {
  const Row finest = *std::max_element(table.rows.begin(), table.rows.end(), [](const Row& a, const Row& b) {
    return std::pair(a.level, -a.tau) < std::pair(b.level, -b.tau);
  });
  table.parameters["against"] = "finest: " + finest.cell + ", at the end, by closest point";
  if (finest.status != "ok") {
    for (Row& row : table.rows) row.errors.clear();
    return warn("the finest run, " + finest.cell + ", is no reference: " + finest.status);
  }
  compare_with(finest, cells, table.rows);
  table.fits = fits_against(finest, table);
}

void print_fits(const Table& table) {
  if (table.fits.empty())
    warn(
        "no orders: they need at least three rows with errors, of three levels or steps (five when both "
        "vary)");
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
      add_errors_of_finest(folder, all);
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
