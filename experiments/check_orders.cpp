// SPDX-License-Identifier: GPL-3.0-or-later
// Holds tables of results against the claims in reference/<experiment>.json.
//
//   check_orders results/check/mcf_sphere.json
//   check_orders results/paper/*.json --reference reference --output results/paper/verdicts.json

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "solver/error.hpp"
#include "solver/tables/claims.hpp"

namespace {

using namespace esfem;

const char* const help =
    "Compares tables of results with the claims of the papers (reference/<experiment>.json) and prints a "
    "verdict for\n"
    "each: whether it is met, what was measured (orders with their 95% interval), what was expected, and "
    "from how many\n"
    "rows. An order is met when its whole interval is within the bounds, and cannot be told when a part of "
    "it "
    "is.\n"
    "Where the paper's statement does not hold as printed, the verdict is \"reproduced, but\", \"not "
    "reproduced\" or\n"
    "\"corrected\"; the expected numbers are then this project's findings, and are checked likewise. A "
    "family of\n"
    "claims is one line, \"18 of 20 met\"; those that are not met are listed below it.\n\n"
    "--output FILE writes all of them as JSON: {\"schema\": \"esfem-verdicts/1\", \"tables\": "
    "[{\"experiment\", \"paper\",\n"
    "\"table\", \"runs\": {\"found\", \"expected\"}, \"claims\": [{\"id\", \"statement\", \"source\", "
    "\"met\", \"outcome\", \"as_expected\", "
    "\"finding\", "
    "\"measured\", "
    "\"expected\", \"rows_used\", ...}], \"families\",\n"
    "\"elsewhere\": how many claims the other preset checks}]}.\n\n"
    "Example:\n  check_orders results/check/mcf_sphere.json\n\n"
    "Exit codes: 0 all claims are met or cannot be told where the reference says so, 1 wrong usage or input, "
    "3 "
    "one is\n"
    "not as the reference says.\n";

/// One line of the report, in columns.
struct Line {
  std::string verdict, measured, expected, rows, what, statement, reason, remark;
};

std::string measured(const Claim& claim, const Verdict& verdict) {
  if (!verdict.measured) return "-";
  if (claim.kind == Claim::size) return format("%.3e", verdict.value);
  if (claim.kind == Claim::value) return format("%.6g", verdict.value);
  const std::string order = format("%.2f", verdict.value);
  if (!verdict.remark.empty() && verdict.remark != "no dependence") return order + ", " + verdict.remark;
  return order +
         (verdict.interval ? format(" [%.2f, %.2f]", (*verdict.interval)[0], (*verdict.interval)[1]) : "");
}

double least(const Claim& claim) {
  return claim.kind == Claim::order ? claim.expected - claim.tolerance : claim.at_least;
}

std::string expected(const Claim& claim) {
  std::string text;
  if (std::isfinite(least(claim))) text = format(">= %g", least(claim));
  if (std::isfinite(claim.at_most)) text += format("%s<= %g", text.empty() ? "" : ", ", claim.at_most);
  if (claim.observed) text += format(", %g +- %g", *claim.observed, Claim::observed_tolerance);
  return text;
}

struct Checked {
  const Claim* claim;
  Verdict verdict;
  bool as_expected;
};

/// In capitals what is not as the reference says.
std::string verdict_of(const Checked& checked) {
  const Verdict::Outcome outcome = checked.verdict.outcome;
  if (outcome == Verdict::cannot_be_told) return checked.as_expected ? "cannot be told" : "CANNOT BE TOLD";
  if (outcome == Verdict::fails) return "NOT MET";
  if (!checked.as_expected) return "CAN BE TOLD";
  return checked.claim->finding.empty() ? "met" : checked.claim->finding;
}

Line describe(const Checked& checked) {
  const auto& [pointer, verdict, as_expected] = checked;
  const Claim& claim = *pointer;
  Line line;
  line.verdict = verdict_of(checked);
  line.measured = measured(claim, verdict);
  line.expected = expected(claim);
  line.rows = std::to_string(verdict.rows_used);
  line.what = claim.quantity + (claim.norm.empty() ? "" : " " + claim.norm) +
              (claim.kind == Claim::order ? ", order in " + claim.variable : "");
  line.statement = claim.id + ": " + claim.statement + " (" + claim.paper + " " + claim.place + ")";
  line.reason = verdict.reason;
  line.remark = claim.remark;
  return line;
}

void print(const std::vector<Line>& lines) {
  const auto width = [&](std::string Line::*column) {
    std::size_t most = 0;
    for (const Line& line : lines) most = std::max(most, (line.*column).size());
    return static_cast<int>(most);
  };
  const int widths[] = {width(&Line::verdict), width(&Line::measured), width(&Line::expected),
                        width(&Line::rows), width(&Line::what)};
  for (const Line& line : lines) {
    std::printf("  %-*s  %-*s  %-*s  %*s  %-*s  %s\n", widths[0], line.verdict.c_str(), widths[1],
                line.measured.c_str(), widths[2], line.expected.c_str(), widths[3], line.rows.c_str(),
                widths[4], line.what.c_str(), line.statement.c_str());
    if (!line.reason.empty()) std::printf("  %-*s  %s.\n", widths[0], "", line.reason.c_str());
    if (!line.remark.empty()) std::printf("  %-*s  %s.\n", widths[0], "", line.remark.c_str());
  }
}

/// The same for programs: "measured" and "expected" as they are printed.
nlohmann::json to_json(const Checked& checked) {
  static const char* const kinds[] = {"order", "size", "value"};
  static const char* const outcomes[] = {"holds", "cannot be told", "fails"};
  const auto& [pointer, verdict, as_expected] = checked;
  const Claim& claim = *pointer;
  nlohmann::json json = {{"id", claim.id},
                         {"statement", claim.statement},
                         {"source", {{"paper", claim.paper}, {"place", claim.place}, {"basis", claim.basis}}},
                         {"kind", kinds[claim.kind]},
                         {"quantity", claim.quantity},
                         {"met", verdict.met()},
                         {"outcome", outcomes[verdict.outcome]},
                         {"as_expected", as_expected},
                         {"finding", claim.finding},
                         {"measured", measured(claim, verdict)},
                         {"expected", expected(claim)},
                         {"rows_used", verdict.rows_used},
                         {"where", claim.where},
                         {"figures", claim.figures},
                         {"reason", verdict.reason},
                         {"remark", claim.remark}};
  if (!claim.quote.empty()) json["source"]["quote"] = claim.quote;
  if (std::isfinite(least(claim))) json["at_least"] = least(claim);
  if (std::isfinite(claim.at_most)) json["at_most"] = claim.at_most;
  if (!claim.family.empty()) json["family"] = claim.family;
  if (!claim.norm.empty()) json["norm"] = claim.norm;
  if (!claim.variable.empty()) json["variable"] = claim.variable;
  return json;
}

struct Count {
  int met = 0, cannot_be_told = 0, unexpected = 0, checked = 0;
};

Count count_of(const std::vector<Checked>& claims) {
  Count count;
  for (const Checked& checked : claims) {
    count.met += checked.verdict.met();
    count.cannot_be_told += checked.verdict.outcome == Verdict::cannot_be_told;
    count.unexpected += !checked.as_expected;
  }
  count.checked = static_cast<int>(claims.size());
  return count;
}

std::string words(const Count& count, const char* what = "") {
  return format("%d of %d %smet", count.met, count.checked, what) +
         (count.cannot_be_told > 0 ? format(", %d cannot be told", count.cannot_be_told) : "");
}

/// The members of a family that are checked, as one line.
Line describe_family(const std::string& id, const std::string& statement,
                     const std::vector<Checked>& members) {
  const Claim& first = *members[0].claim;
  int rows = 0;
  for (const Checked& member : members) rows += member.verdict.rows_used;
  Line line;
  line.verdict = words(count_of(members));
  line.rows = std::to_string(rows);
  line.statement = id + ": " + statement + " (" + first.paper + " " + first.place + ")";
  return line;
}

/// A claim by itself is a line; a family is one, and one for each of its members that is not met.
std::vector<Line> lines_of(const std::vector<Checked>& claims, const Reference& reference) {
  std::vector<Line> lines = {{"verdict", "measured", "expected", "rows", "quantity", "claim", "", ""}};
  for (auto first = claims.begin(); first != claims.end();) {
    const std::string& id = first->claim->family;
    const auto last = id.empty() ? first + 1 : std::find_if(first, claims.end(), [&](const Checked& other) {
      return other.claim->family != id;
    });
    if (!id.empty()) lines.push_back(describe_family(id, reference.families.at(id), {first, last}));
    for (; first != last; ++first)
      if (id.empty() || !first->verdict.met()) lines.push_back(describe(*first));
  }
  return lines;
}

/// {id: {"statement", "met", "cannot_be_told", "claims"}} of the families that have members among the claims.
nlohmann::json families_to_json(const std::vector<Checked>& claims, const Reference& reference) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [id, statement] : reference.families) {
    std::vector<Checked> members;
    for (const Checked& checked : claims)
      if (checked.claim->family == id) members.push_back(checked);
    const Count count = count_of(members);
    if (count.checked > 0)
      json[id] = {{"statement", statement},
                  {"met", count.met},
                  {"cannot_be_told", count.cannot_be_told},
                  {"claims", count.checked}};
  }
  return json;
}

/// Prints the verdicts on one table and appends them to `verdicts`. A table that no claim applies to counts
/// as one that fails.
Count check_table(const std::string& file, const std::string& folder, nlohmann::json& verdicts) {
  const Table table = table_from_json(read_json(file), file);
  const std::string source = folder + "/" + table.experiment + ".json";
  const Reference reference = reference_from_json(read_json(source), source);
  if (reference.experiment != table.experiment || reference.paper != table.paper)
    throw InputError(source + " is about " + reference.experiment + " of " + reference.paper + ", but " +
                     file + " is of " + table.experiment + " of " + table.paper);

  std::vector<Checked> checked;
  nlohmann::json claims = nlohmann::json::array();
  for (const Claim& claim : reference.claims) {
    if (!applies(claim, table)) continue;
    const Verdict verdict = check_claim(claim, table);
    checked.push_back({&claim, verdict, is_as_expected(claim, verdict, table)});
    claims.push_back(to_json(checked.back()));
  }
  const int found = static_cast<int>(table.rows.size()), wanted = expected_runs(reference, table);
  verdicts.push_back({{"experiment", table.experiment},
                      {"paper", table.paper},
                      {"table", file},
                      {"claims", claims},
                      {"runs", {{"found", found}, {"expected", wanted}}},
                      {"families", families_to_json(checked, reference)},
                      {"elsewhere", reference.claims.size() - checked.size()}});
  std::printf("%s (%s): %s\n", table.experiment.c_str(), table.paper.c_str(), file.c_str());
  if (checked.empty()) {
    std::printf("  NOT MET  no claim of %s applies to the preset of this table.\n\n", source.c_str());
    return {0, 0, 1, 1};
  }
  print(lines_of(checked, reference));
  Count count = count_of(checked);
  if (found != wanted) {
    std::printf("  NOT MET  the table has %d runs, expected %d, as \"runs\" of %s says.\n", found, wanted,
                source.c_str());
    ++count.unexpected;
  }
  std::printf("\n");
  return count;
}

int run(int argc, char** argv) {
  std::vector<std::string> tables;
  std::string folder = "reference", output;
  CommandLine line(help, "check_orders");
  line.arguments("TABLE", tables, "tables of results (JSON)");
  line.text("--reference", folder, "folder of the claims");
  line.text("--output", output, "the verdicts as JSON, beside what is printed");
  if (!line.parse(argc, argv)) return exit_done;
  if (!output.empty()) prepare_output(output);

  Count total;
  nlohmann::json verdicts = nlohmann::json::array();
  for (const std::string& file : tables) {
    const Count count = check_table(file, folder, verdicts);
    total.met += count.met;
    total.cannot_be_told += count.cannot_be_told;
    total.unexpected += count.unexpected;
    total.checked += count.checked;
  }
  if (!output.empty())
    write_file(output, nlohmann::json{{"schema", "esfem-verdicts/1"}, {"tables", verdicts}}.dump(1) + "\n");
  std::printf("%s\n", words(total, "claims ").c_str());
  if (total.unexpected > 0) std::printf("%d verdicts are not what the reference says\n", total.unexpected);
  return total.unexpected == 0 ? exit_done : exit_claim;
}

}  // namespace

int main(int argc, char** argv) {
  return guarded_main([&] { return run(argc, argv); });
}
