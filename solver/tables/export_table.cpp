// SPDX-License-Identifier: GPL-3.0-or-later
// The results table as CSV and LaTeX.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "solver/error.hpp"
#include "solver/tables/table.hpp"

namespace esfem {
namespace {

/// Quantities in the order in which the papers name them; others follow by name.
struct PapersOrder {
  bool operator()(const std::pair<std::string, std::string>& a,
                  const std::pair<std::string, std::string>& b) const {
    const auto place = [](const std::string& quantity) {
      const std::string names[] = {"x", "v", "nu", "H", "u", "w", "V", "z", "kappa"};
      return std::find(std::begin(names), std::end(names), quantity) - std::begin(names);
    };
    return std::tuple(place(a.first), a) < std::tuple(place(b.first), b);
  }
};

/// (quantity, norm) of all rows.
std::set<std::pair<std::string, std::string>, PapersOrder> error_names(const Table& table) {
  std::set<std::pair<std::string, std::string>, PapersOrder> names;
  for (const Row& row : table.rows)
    for (const auto& [quantity, norms] : row.errors)
      for (const auto& [norm, value] : norms) names.insert({quantity, norm});
  return names;
}

/// The error, or NaN when the row failed or does not have it.
double error_of(const Row& row, const std::string& quantity, const std::string& norm) {
  const auto norms = row.errors.find(quantity);
  if (row.status != "ok" || norms == row.errors.end() || norms->second.count(norm) == 0) return std::nan("");
  return norms->second.at(norm);
}

// --- CSV (RFC 4180) ---

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csv_number(double value) {
  return std::isfinite(value) ? format("%.17g", value) : "";
}

/// The labels of all rows, and further keys whose values fit into a cell.
std::set<std::string> further_keys(const Table& table) {
  std::set<std::string> keys;
  for (const Row& row : table.rows) {
    for (const auto& item : row.labels.items()) keys.insert(item.key());
    for (const auto& item : row.more.items())
      if (item.value().is_primitive()) keys.insert(item.key());
  }
  return keys;
}

/// Names of the values of all rows.
std::set<std::string> value_names(const Table& table) {
  std::set<std::string> names;
  for (const Row& row : table.rows)
    for (const auto& [name, value] : row.values) names.insert(name);
  return names;
}

double value_of(const Row& row, const std::string& name) {
  const auto value = row.values.find(name);
  return value == row.values.end() ? std::nan("") : value->second;
}

std::string csv_further(const Row& row, const std::string& key) {
  const nlohmann::json& holder = row.labels.contains(key) ? row.labels : row.more;
  const auto value = holder.find(key);
  if (value == holder.end() || !value->is_primitive() || value->is_null()) return "";
  return csv_text(value_text(*value));
}

// --- LaTeX ---

/// Which of h and tau changes within a block of a table.
enum class Direction { tau, h };

double variable(const Row& row, Direction direction) {
  return direction == Direction::tau ? row.tau : row.h;
}

std::string latex_text(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    if (c == '\\')
      escaped += "\\textbackslash{}";
    else if (c == '~' || c == '^')
      escaped += std::string("\\") + c + "{}";
    else
      escaped += std::string(std::string("#$%&_{}").find(c) != std::string::npos ? "\\" : "") + c;
  }
  return escaped;
}

std::string latex_number(double value, const char* pattern) {
  if (!std::isfinite(value)) return "--";
  const std::string text = format(pattern, value);
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return "$" + text + "$";
  return format("$%s\\cdot10^{%d}$", text.substr(0, e).c_str(), std::stoi(text.substr(e + 1)));
}

std::string latex_quantity(const std::string& quantity) {
  if (quantity == "nu") return "$\\nu$";
  if (quantity == "kappa") return "$\\kappa$";
  return quantity.size() == 1 ? "$" + quantity + "$" : latex_text(quantity);
}

/// Rows that differ in the variable of the direction only, largest first.
using Block = std::vector<const Row*>;

std::vector<Block> blocks(const Table& table, Direction direction) {
  const Direction other = direction == Direction::tau ? Direction::h : Direction::tau;
  std::vector<Block> result;
  for (const Row& row : table.rows) {
    if (row.status == "ok" && row.errors.empty()) continue;  // of this row there are values alone
    const auto same = std::find_if(result.begin(), result.end(), [&](const Block& block) {
      const Row& first = *block[0];
      const bool same_mesh =
          direction == Direction::h || (first.level == row.level && first.nodes == row.nodes);
      return same_mesh && variable(first, other) == variable(row, other) && variant(first) == variant(row);
    });
    if (same == result.end())
      result.push_back({&row});
    else
      same->push_back(&row);
  }
  const auto descending = [](Direction d) {
    return [d](const Row* a, const Row* b) { return variable(*a, d) > variable(*b, d); };
  };
  for (Block& block : result) std::stable_sort(block.begin(), block.end(), descending(direction));
  std::stable_sort(result.begin(), result.end(), [&](const Block& a, const Block& b) {
    return variant(*a[0]) != variant(*b[0]) ? variant(*a[0]) < variant(*b[0]) : descending(other)(a[0], b[0]);
  });
  return result;
}

/// Those in which some rows can be compared; h where there are none.
std::vector<Direction> directions(const Table& table) {
  std::vector<Direction> result;
  for (Direction direction : {Direction::tau, Direction::h}) {
    const std::vector<Block> all = blocks(table, direction);
    if (std::any_of(all.begin(), all.end(), [](const Block& block) { return block.size() > 1; }))
      result.push_back(direction);
  }
  return result.empty() ? std::vector<Direction>{Direction::h} : result;
}

/// Experimental order of convergence between neighbouring rows, from the measured h or tau; NaN where there
/// is none.
double eoc(const Row& previous, const Row& row, Direction direction, const std::string& quantity,
           const std::string& norm) {
  const double ratio = variable(previous, direction) / variable(row, direction);
  return std::log(error_of(previous, quantity, norm) / error_of(row, quantity, norm)) / std::log(ratio);
}

std::string block_title(const Row& row, Direction direction) {
  std::string title = direction == Direction::tau ? format("$h = %.4g$, $N = %d$", row.h, row.nodes)
                                                  : "$\\tau = $ " + latex_number(row.tau, "%.4g");
  if (!variant(row).empty()) title += ", " + latex_text(variant(row));
  return title;
}

std::string row_text(const Row& row, const Row* previous, Direction direction,
                     const std::vector<std::string>& quantities, const std::string& norm) {
  std::string text = latex_number(variable(row, direction), "%.4g");
  if (row.status != "ok")
    return text + format(" & \\multicolumn{%zu}{l}{", 2 * quantities.size()) + latex_text(row.status) +
           "} \\\\\n";
  for (const std::string& quantity : quantities) {
    text += " & " + latex_number(error_of(row, quantity, norm), "%.3e");
    const double order = previous ? eoc(*previous, row, direction, quantity, norm) : std::nan("");
    text += " & " + latex_number(order, "%.2f");
  }
  return text + " \\\\\n";
}

/// One line of fitted orders for each variant that has some.
std::string fit_text(const Table& table, Direction direction, const std::vector<std::string>& quantities,
                     const std::string& norm) {
  const std::string name = direction == Direction::tau ? "tau" : "h";
  std::map<std::string, std::map<std::string, double>> orders;
  for (const Fit& fit : table.fits)
    if (fit.norm == norm && fit.variable == name) orders[label_text(fit.labels)][fit.quantity] = fit.order;
  if (orders.empty()) orders[""];
  std::string text;
  for (const auto& [variant, order] : orders) {
    text += variant.empty() ? "fit" : "fit, " + latex_text(variant);
    for (const std::string& quantity : quantities)
      text += " & & " + latex_number(order.count(quantity) ? order.at(quantity) : std::nan(""), "%.2f");
    text += " \\\\\n";
  }
  return text;
}

std::string latex_table(const Table& table, Direction direction, const std::vector<std::string>& quantities,
                        const std::string& norm) {
  const bool in_tau = direction == Direction::tau;
  const std::size_t columns = 1 + 2 * quantities.size();
  std::string text = "\\begin{table}\n\\centering\n";
  text += "\\caption{" + latex_text(table.experiment) + ": " + latex_text(norm) + " errors and orders in " +
          (in_tau ? "$\\tau$" : "$h$") + ".}\n";
  text += "\\begin{tabular}{l" + [&] {
    std::string alignment;
    for (std::size_t i = 0; i < quantities.size(); ++i) alignment += "rr";
    return alignment;
  }() + "}\n\\toprule\n";
  text += in_tau ? "$\\tau$" : "$h$";
  for (const std::string& quantity : quantities) text += " & " + latex_quantity(quantity) + " & EOC";
  text += " \\\\\n";
  for (const Block& block : blocks(table, direction)) {
    text +=
        format("\\midrule\n\\multicolumn{%zu}{l}{", columns) + block_title(*block[0], direction) + "} \\\\\n";
    const Row* previous = nullptr;
    for (const Row* row : block) {
      text += row_text(*row, previous, direction, quantities, norm);
      previous = row;
    }
  }
  text += "\\midrule\n" + fit_text(table, direction, quantities, norm);
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

/// The values of the rows that have some, a line a row.
std::string latex_values(const Table& table) {
  const std::set<std::string> names = value_names(table);
  std::string text = "\\begin{table}\n\\centering\n\\caption{" + latex_text(table.experiment) +
                     ": values.}\n\\begin{tabular}{lrr" + std::string(names.size(), 'r') +
                     "}\n\\toprule\n & $N$ & $\\tau$";
  for (const std::string& name : names) text += " & " + latex_text(name);
  text += " \\\\\n\\midrule\n";
  for (const Row& row : table.rows) {
    if (row.values.empty()) continue;
    text += latex_text(variant(row)) + format(" & %d & ", row.nodes) + latex_number(row.tau, "%.4g");
    for (const std::string& name : names) text += " & " + latex_number(value_of(row, name), "%.5g");
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

}  // namespace

std::string to_csv(const Table& table) {
  const auto names = error_names(table);
  const std::set<std::string> further = further_keys(table), values = value_names(table);
  std::string text = "cell,level,h,nodes,tau,steps,status,seconds,peak_memory_mb";
  for (const std::string& key : further) text += "," + csv_text(key);
  for (const std::string& name : values) text += "," + csv_text(name);
  for (const auto& [quantity, norm] : names) text += "," + csv_text(quantity + "_" + norm);
  text += "\n";
  for (const Row& row : table.rows) {
    text += csv_text(row.cell) + format(",%d,", row.level) + csv_number(row.h) + format(",%d,", row.nodes) +
            csv_number(row.tau) + format(",%d,", row.steps) + csv_text(row.status) + "," +
            csv_number(row.seconds) + "," + csv_number(row.peak_memory_mb);
    for (const std::string& key : further) text += "," + csv_further(row, key);
    for (const std::string& name : values) text += "," + csv_number(value_of(row, name));
    for (const auto& [quantity, norm] : names) text += "," + csv_number(error_of(row, quantity, norm));
    text += "\n";
  }
  return text;
}

std::string to_latex(const Table& table) {
  const std::string paper = table.paper.empty() ? "" : " (" + table.paper + ")";
  std::string text = "% " + table.experiment + paper + "; needs \\usepackage{booktabs}\n";
  std::set<std::string> norms;
  for (const auto& [quantity, norm] : error_names(table)) norms.insert(norm);
  if (!value_names(table).empty()) text += "\n" + latex_values(table);
  const std::vector<Direction> shown = directions(table);
  for (const std::string& norm : norms) {
    std::vector<std::string> quantities;
    for (const auto& name : error_names(table))
      if (name.second == norm) quantities.push_back(name.first);
    for (Direction direction : shown) text += "\n" + latex_table(table, direction, quantities, norm);
  }
  return text;
}

}  // namespace esfem
