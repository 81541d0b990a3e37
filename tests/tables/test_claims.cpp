// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "solver/error.hpp"
#include "solver/read_json.hpp"
#include "solver/tables/claims.hpp"

namespace esfem::test_claims {
namespace {

using nlohmann::json;
using testing::AllOf, testing::HasSubstr, testing::Not;

/// Errors 0.03 h^2 + 4 tau^3 of x on the grid h = 0.5 2^(-j/2), tau = 0.2 2^-k.
Table sample_table() {
  Table table;
  table.experiment = "mcf_sphere";
  table.paper = "kll19";
  table.parameters = {{"preset", "check"}};
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 7; ++k) {
      Row row;
      row.cell = "h" + std::to_string(j) + "_tau" + std::to_string(k);
      row.h = 0.5 * std::pow(2, -0.5 * j);
      row.tau = 0.2 * std::pow(2, -k);
      row.errors["x"]["nodal_H1"] = 0.03 * row.h * row.h + 4 * std::pow(row.tau, 3);
      row.errors["x"]["nodal_L2"] = 1e-13 / row.tau;
      table.rows.push_back(row);
    }
  return table;
}

json order_claim() {
  return {{"id", "x-order-tau"},
          {"statement", "x converges with order 3 in tau"},
          {"source",
           {{"paper", "kll19"},
            {"place", "§13.1, Fig. 13.1"},
            {"basis", "statement"},
            {"quote", "as in the paper"}}},
          {"kind", "order"},
          {"quantity", "x"},
          {"norm", "nodal_H1"},
          {"variable", "tau"},
          {"expected", 3},
          {"tolerance", 0.5}};
}

json size_claim() {
  json claim = order_claim();
  for (const char* key : {"variable", "expected", "tolerance"}) claim.erase(key);
  claim["id"] = "x-size";
  claim["kind"] = "size";
  claim["rows"] = {{"tau", 0.05}, {"h_min", 0.3}, {"h_max", 0.51}};
  claim["at_most"] = 0.0081;
  return claim;
}

json reference(const std::vector<json>& claims) {
  return {{"experiment", "mcf_sphere"}, {"paper", "kll19"}, {"claims", claims}};
}

/// The claim with some keys replaced.
Verdict check(json claim, const json& changes = json::object(), const Table& table = sample_table()) {
  claim.update(changes);
  return check_claim(reference_from_json(reference({claim}), "r.json").claims.at(0), table);
}

json value_claim() {
  json claim = size_claim();
  claim.erase("norm");
  claim["id"] = "pinch";
  claim["kind"] = "value";
  claim["quantity"] = "pinch_time";
  claim["at_least"] = 0.08;
  claim["at_most"] = 0.085;
  return claim;
}

TEST(Claims, OfValuesHoldRunsThatEndedAtASingularity) {
  Table table = sample_table();
  for (Row& row : table.rows) row.values["pinch_time"] = 0.0825;
  Row& row = table.rows[2];  // h = 0.5, tau = 0.05
  row.status = "singular at t = 0.0825 (step 27): element 7";
  EXPECT_TRUE(check(value_claim(), json::object(), table).met());
  EXPECT_EQ(check(value_claim(), json::object(), table).value, 0.0825);
  EXPECT_FALSE(check(size_claim(), json::object(), table).met()) << "its errors end too early";
  EXPECT_THAT(check(value_claim(), {{"at_most", 0.082}}, table).reason,
              HasSubstr("Value 0.0825 is too large, expected at most 0.082"));
  EXPECT_THAT(check(value_claim(), {{"at_least", 0.083}}, table).reason,
              HasSubstr("Value 0.0825 is too small, expected at least 0.083"));
  row.values.clear();
  EXPECT_THAT(check(value_claim(), json::object(), table).reason,
              HasSubstr("has no value pinch_time (singular"));
  row.status = "failed: factorisation";
  EXPECT_THAT(check(value_claim(), json::object(), table).reason, HasSubstr("failed: factorisation"));
}

TEST(Claims, SayWhatBecameOfAStatement) {
  const auto read = [](const json& changes) {
    json claim = value_claim();
    claim.update(changes);
    return reference_from_json(reference({claim}), "r.json").claims.at(0);
  };
  EXPECT_EQ(read(json::object()).finding, "");
  const Claim claim = read({{"finding", "reproduced, but"}, {"remark", "the start does it"}});
  EXPECT_EQ(claim.finding, "reproduced, but");
  EXPECT_EQ(claim.remark, "the start does it");
  EXPECT_EQ(read({{"remark", "it may do better"}}).remark, "it may do better");
  EXPECT_THROW(read({{"finding", "not reproduced"}}), InputError) << "without a reason";
  EXPECT_THROW(read({{"finding", "perhaps"}, {"remark", "?"}}), InputError);
  EXPECT_THROW(read({{"norm", "nodal_L2"}}), InputError) << "a value has no norm";
}

TEST(Claims, CanLeaveOutTheFirstSteps) {
  Table table = sample_table();
  for (Row& row : table.rows) row.series["x_nodal_H1"] = {0.5, 0.25, 0.001, 0.002};
  json claim = size_claim();
  claim["rows"]["from_step"] = 2;
  const auto verdict = [&] {
    const json file = {{"experiment", "mcf_sphere"}, {"paper", "kll19"}, {"claims", {claim}}};
    return check_claim(reference_from_json(file, "test").claims[0], table);
  };
  EXPECT_DOUBLE_EQ(verdict().value, 0.002);
  EXPECT_TRUE(verdict().met());
  claim["rows"]["from_step"] = 1;
  EXPECT_DOUBLE_EQ(verdict().value, 0.25);
  EXPECT_FALSE(verdict().met());
  claim["rows"]["from_step"] = 4;
  EXPECT_THAT(verdict().reason, HasSubstr("beyond step 4"));
}

TEST(Claims, AnOrderIsMetOneSidedly) {
  const Verdict verdict = check(order_claim());
  EXPECT_TRUE(verdict.met()) << verdict.reason;
  EXPECT_NEAR(verdict.value, 3, 1e-4);
  EXPECT_EQ(verdict.rows_used, 21);
  ASSERT_TRUE(verdict.interval.has_value());
  EXPECT_LE((*verdict.interval)[0], verdict.value);
  EXPECT_GE((*verdict.interval)[1], verdict.value);

  EXPECT_TRUE(check(order_claim(), {{"expected", 1}}).met()) << "higher than expected is good";
  EXPECT_TRUE(check(order_claim(), {{"variable", "h"}, {"expected", 2}}).met());

  const Verdict too_low = check(order_claim(), {{"expected", 4}});
  EXPECT_FALSE(too_low.met());
  EXPECT_EQ(too_low.outcome, Verdict::fails);
  EXPECT_THAT(too_low.reason,
              AllOf(HasSubstr("Convergence order not achieved: 3.00"), HasSubstr("expected at least 3.5")));
  EXPECT_FALSE(check(order_claim(), {{"variable", "h"}}).met());
  EXPECT_FALSE(check(order_claim(), {{"at_most", 2.9}}).met());
  EXPECT_TRUE(check(order_claim(), {{"at_most", 3.1}}).met());
}

/// Three runs in tau with the order 3 and an interval of about +- 0.9.
Table rough_table() {
  Table table = sample_table();
  table.rows.erase(table.rows.begin() + 3, table.rows.end());
  const double factors[] = {1, 1.1, 1};
  for (int i = 0; i < 3; ++i)
    table.rows[i].errors["x"]["nodal_H1"] = factors[i] * std::pow(table.rows[i].tau, 3);
  return table;
}

TEST(Claims, AnOrderHoldsWhenItsWholeIntervalDoes) {
  const auto outcome = [](const json& changes) {
    return check(order_claim(), changes, rough_table()).outcome;
  };
  EXPECT_EQ(outcome({{"expected", 1}}), Verdict::holds);
  EXPECT_EQ(outcome({{"expected", 3}}), Verdict::cannot_be_told);
  EXPECT_EQ(outcome({{"expected", 3}, {"tolerance", 1.5}}), Verdict::holds);
  EXPECT_EQ(outcome({{"expected", 5}}), Verdict::fails);
  EXPECT_EQ(outcome({{"expected", 1}, {"at_most", 3.5}}), Verdict::cannot_be_told);
  EXPECT_EQ(outcome({{"expected", 1}, {"observed", 4}}), Verdict::fails);
  EXPECT_THAT(check(order_claim(), {{"expected", 3}}, rough_table()).reason,
              HasSubstr("Cannot be told: the bound 2.5 is between"));
}

TEST(Claims, WhatCannotBeToldIsExpectedWhereTheReferenceSaysSo) {
  Table table = rough_table();
  table.parameters["preset"] = "check";
  const auto as_expected = [&](const json& changes) {
    json claim = order_claim();
    claim.update(changes);
    const Claim read = reference_from_json(reference({claim}), "r.json").claims.at(0);
    return is_as_expected(read, check_claim(read, table), table);
  };
  EXPECT_TRUE(as_expected({{"expected", 1}}));
  EXPECT_FALSE(as_expected({{"expected", 3}}));
  EXPECT_TRUE(as_expected({{"expected", 3}, {"cannot_be_told", {"check"}}}));
  EXPECT_FALSE(as_expected({{"expected", 3}, {"cannot_be_told", {"paper"}}}));
  EXPECT_FALSE(as_expected({{"expected", 1}, {"cannot_be_told", {"check"}}})) << "it can be told now";
  EXPECT_FALSE(as_expected({{"expected", 5}, {"cannot_be_told", {"check"}}})) << "it fails";
  EXPECT_THROW(as_expected({{"cannot_be_told", json::array()}}), InputError);
  EXPECT_THROW(as_expected({{"cannot_be_told", {"often"}}}), InputError);
}

TEST(Claims, TheRangeSelectsTheRows) {
  EXPECT_EQ(check(order_claim(), {{"rows", {{"tau_max", 0.1}}}}).rows_used, 18);
  EXPECT_EQ(check(order_claim(), {{"rows", {{"h", 0.5}}}}).rows_used, 7);
  EXPECT_EQ(check(size_claim()).rows_used, 2);
}

TEST(Claims, ASizeHoldsForEveryRow) {
  // 0.03 * 0.25 + 4 * 0.05^3 = 0.008 on the coarsest mesh
  const Verdict verdict = check(size_claim());
  EXPECT_TRUE(verdict.met()) << verdict.reason;
  EXPECT_NEAR(verdict.value, 0.008, 1e-12);
  const Verdict too_large = check(size_claim(), {{"at_most", 0.0079}});
  EXPECT_FALSE(too_large.met()) << "one of the two rows is larger";
  EXPECT_THAT(too_large.reason, HasSubstr("8.000e-03"));
  EXPECT_FALSE(check(size_claim(), {{"at_least", 0.005}}).met());
  EXPECT_TRUE(check(size_claim(), {{"at_least", 0.004}}).met());
}

TEST(Claims, WhatCannotBeMeasuredIsNotMet) {
  const auto reason = [](const json& claim, const json& changes, const Table& table = sample_table()) {
    const Verdict verdict = check(claim, changes, table);
    EXPECT_FALSE(verdict.met());
    EXPECT_FALSE(verdict.measured);
    return verdict.reason;
  };
  EXPECT_THAT(reason(size_claim(), {{"rows", {{"tau", 0.04}}}}), HasSubstr("no row"));
  EXPECT_THAT(reason(order_claim(), {{"quantity", "y"}}), HasSubstr("no error y nodal_H1"));
  EXPECT_THAT(reason(order_claim(), {{"norm", "lifted_H1"}}), HasSubstr("no error x lifted_H1"));
  EXPECT_THAT(reason(order_claim(), {{"rows", {{"tau_min", 0.09}, {"h", 0.5}}}}), HasSubstr("2 rows"));
  EXPECT_THAT(reason(order_claim(), {{"rows", {{"tau", 0.05}}}}), HasSubstr("depend on tau"));
  EXPECT_THAT(reason(order_claim(), {{"norm", "nodal_L2"}}), HasSubstr("round-off"));

  Table failed = sample_table();
  failed.rows[3].status = "failed: step 3, t = 0.1: degenerate element 7";
  EXPECT_THAT(reason(order_claim(), json::object(), failed),
              AllOf(HasSubstr("h0_tau3"), HasSubstr("element 7")));
  EXPECT_TRUE(check(order_claim(), {{"rows", {{"h_max", 0.4}}}}, failed).met())
      << "the failed row is out of range";
  failed.rows[3].h = 0;
  EXPECT_THAT(reason(order_claim(), {{"rows", {{"h_min", 0.1}}}}, failed), HasSubstr("element 7"));

  Table zero = sample_table();
  zero.rows[0].errors["x"]["nodal_H1"] = 0;
  EXPECT_THAT(reason(order_claim(), json::object(), zero), HasSubstr("positive"));
  zero.rows[0].errors["x"]["nodal_H1"] = std::nan("");
  EXPECT_THAT(reason(size_claim(), {{"rows", json::object()}}, zero), HasSubstr("not finite"));
}

TEST(Claims, VariantsAreNotMixed) {
  Table table = sample_table();
  for (Row row : sample_table().rows) {
    row.cell += "_dziuk";
    row.labels = {{"flow", "dziuk"}, {"bdf", 2}};
    row.errors["x"]["nodal_H1"] = row.tau;
    table.rows.push_back(row);
  }
  EXPECT_THAT(check(order_claim(), json::object(), table).reason, HasSubstr("labels in 'where' select one"));
  EXPECT_NEAR(check(order_claim(), {{"where", {{"flow", "dziuk"}}}}, table).value, 1, 1e-6)
      << "one label is enough to distinguish them";
  EXPECT_TRUE(check(order_claim(), {{"where", {{"bdf", 2.0}}}}, table).measured) << "2.0 is 2";
  for (Row& row : table.rows) row.labels["bdf"] = 2;
  EXPECT_THAT(check(order_claim(), {{"where", {{"bdf", 2}}}}, table).reason,
              AllOf(HasSubstr("'bdf=2'"), HasSubstr("'bdf=2, flow=dziuk'")));
}

TEST(Claims, LabelsThatNoRowHasAreNamed) {
  Table table = sample_table();
  for (Row& row : table.rows) row.labels = {{"flow", "dziuk"}, {"bdf", 2}};
  const auto reason = [&](const json& where) {
    return check(order_claim(), {{"where", where}}, table).reason;
  };
  EXPECT_EQ(reason({{"flow", "dziuk"}, {"bdf", 2}}), "");
  EXPECT_THAT(reason({{"flwo", "dziuk"}}),
              HasSubstr("where: no row has the label flwo; labels of the rows are bdf, flow"));
  EXPECT_THAT(reason({{"flow", "bgn"}}), HasSubstr("where: no row has flow = \"bgn\"; found are \"dziuk\""));
  EXPECT_THAT(reason({{"bdf", "2"}}), HasSubstr("where: no row has bdf = \"2\"; found are 2"));
}

TEST(Claims, PresetsRestrictWhereAClaimIsChecked) {
  json json_claim = order_claim();
  const auto applies_to = [&](const json& parameters) {
    Table table = sample_table();
    table.parameters = parameters;
    return applies(reference_from_json(reference({json_claim}), "r.json").claims.at(0), table);
  };
  EXPECT_TRUE(applies_to({{"preset", "check"}}));
  json_claim["presets"] = json::array({"paper"});
  EXPECT_FALSE(applies_to({{"preset", "check"}}));
  EXPECT_TRUE(applies_to({{"preset", "paper"}}));
  EXPECT_TRUE(applies_to(json::object()));
}

std::string reading(const json& file) {
  try {
    reference_from_json(file, "r.json");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Claims, ReadingNamesClaimAndKey) {
  const auto with = [](json claim, const json& changes) {
    claim.update(changes);
    return reading(reference({claim}));
  };
  EXPECT_EQ(reading(reference({order_claim(), size_claim()})), "no error");
  EXPECT_THAT(reading(reference({})), HasSubstr("no claim"));
  EXPECT_THAT(reading(reference({order_claim(), order_claim()})), HasSubstr("occurs twice"));
  EXPECT_THAT(
      with(order_claim(), {{"tolerence", 1}}),
      AllOf(HasSubstr("r.json, claim 1 'x-order-tau'"), HasSubstr("'tolerence'"), HasSubstr("tolerance")));
  EXPECT_THAT(with(order_claim(), {{"rows", {{"tau_mx", 1}}}}),
              AllOf(HasSubstr("rows"), HasSubstr("'tau_mx'")));
  EXPECT_THAT(with(order_claim(), {{"rows", {{"tau", 1}, {"tau_max", 1}}}}), HasSubstr("excludes"));
  EXPECT_THAT(with(order_claim(), {{"rows", {{"h_min", 2}, {"h_max", 1}}}}), HasSubstr("no h is in"));
  EXPECT_THAT(with(order_claim(), {{"source", {{"paper", "kll19"}, {"place", "§1"}}}}),
              HasSubstr("'basis' is missing"));
  EXPECT_THAT(with(order_claim(), {{"source", {{"paper", "kll19"}, {"place", "§1"}, {"basis", "hearsay"}}}}),
              AllOf(HasSubstr("source"), HasSubstr("'hearsay'"), HasSubstr("statement, theory")));
  const auto with_source = [](const json& changes) {
    json claim = order_claim();
    claim["source"].merge_patch(changes);
    return reading(reference({claim}));
  };
  EXPECT_THAT(with_source({{"quote", nullptr}}), HasSubstr("'quote', the paper's own words"));
  EXPECT_THAT(with_source({{"basis", "theory"}}), HasSubstr("of a statement and of nothing else"));
  EXPECT_THAT(with_source({{"quote", " "}}), HasSubstr("found 0 words"));
  EXPECT_THAT(with_source({{"quote", "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16"}}),
              HasSubstr("found 16 words"));
  EXPECT_EQ(with_source({{"basis", "regression"}, {"quote", nullptr}}), "no error");
  EXPECT_THAT(with(order_claim(), {{"kind", "slope"}}), HasSubstr("expected order, size or value"));
  EXPECT_THAT(with(order_claim(), {{"variable", "t"}}), HasSubstr("expected h or tau"));
  EXPECT_THAT(with(order_claim(), {{"tolerance", "some"}}), HasSubstr("a number"));
  EXPECT_THAT(with(order_claim(), {{"presets", json::array({"chek"})}}), HasSubstr("\"chek\""));
  EXPECT_THAT(with(order_claim(), {{"where", {{"bdf", json::array({1, 2})}}}}),
              AllOf(HasSubstr("claim 1 'x-order-tau', where"), HasSubstr("'bdf'"), HasSubstr("[1,2]")));
  EXPECT_THAT(with(order_claim(), {{"where", "flow=dziuk"}}), HasSubstr("an object"));
  EXPECT_THAT(with(order_claim(), {{"rows", {{"variant", "flow=dziuk"}}}}),
              HasSubstr("unknown key 'variant'"));
  EXPECT_THAT(with(order_claim(), {{"figures", json::array({13.1})}}), HasSubstr("numbers as strings"));
  EXPECT_THAT(with(size_claim(), {{"expected", 3}}), HasSubstr("unknown key 'expected'"));
  json claim = size_claim();
  claim.erase("at_most");
  EXPECT_THAT(reading(reference({claim})), HasSubstr("'at_most' or 'at_least'"));
  claim = size_claim();
  claim["observed"] = 1e-3;
  EXPECT_THAT(reading(reference({claim})), HasSubstr("or else 'observed'"));
  claim = order_claim();
  claim.erase("tolerance");
  EXPECT_THAT(reading(reference({claim})), HasSubstr("'tolerance' is missing"));
  json file = reference({order_claim()});
  file["note"] = "";
  EXPECT_THAT(reading(file), HasSubstr("unknown key 'note'"));
}

TEST(Claims, AnOrderThatIsKnownToBeHigherMustNotBecomeLower) {
  json claim = order_claim();  // the order is 3
  claim["expected"] = 2;
  const auto verdict = [&](double observed) {
    claim["observed"] = observed;
    return check_claim(reference_from_json(reference({claim}), "r.json").claims.at(0), sample_table());
  };
  EXPECT_TRUE(verdict(3.2).met());
  EXPECT_FALSE(verdict(4).met());
  EXPECT_THAT(verdict(4).reason, HasSubstr("is not the 4 that is known here"));
}

TEST(Claims, AnObservedSizeHasBoundsOnBothSides) {
  json claim = size_claim();
  claim.erase("at_most");
  claim["observed"] = 2e-3;
  const Claim read = reference_from_json(reference({claim}), "r.json").claims.at(0);
  EXPECT_DOUBLE_EQ(read.at_least, 1.9e-3);
  EXPECT_DOUBLE_EQ(read.at_most, 2.1e-3);
}

TEST(Claims, OfThisProjectCanBeRead) {
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(ESFEM_SOURCE_DIR "/reference")) {
    if (file.path().extension() != ".json") continue;
    ++files;
    const Reference reference = reference_from_json(read_json(file.path()), file.path());
    EXPECT_EQ(reference.experiment, file.path().stem());
  }
  EXPECT_GE(files, 17) << "one for each experiment";
}

TEST(Claims, HaveTheDefaultsOfTheFile) {
  json file = reference({order_claim(), size_claim()});
  file["defaults"] = {{"figures", json::array({"13.1"})},
                      {"source", {{"basis", "theory"}, {"paper", "nick18"}}}};
  file["claims"][1]["source"].erase("basis");
  file["claims"][1]["source"].erase("quote");
  file["claims"][1]["figures"] = json::array();
  const std::vector<Claim> claims = reference_from_json(file, "r.json").claims;
  EXPECT_EQ(claims[0].figures, std::vector<std::string>{"13.1"});
  EXPECT_EQ(claims[0].basis, "statement") << "its own";
  EXPECT_EQ(claims[1].basis, "theory");
  EXPECT_EQ(claims[1].paper, "kll19");
  EXPECT_TRUE(claims[1].figures.empty());
}

/// Runs the program on files in a folder of its own.
struct CheckOrders : testing::Test {
  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("esfem_check_" + std::to_string(getpid()));
  CheckOrders() { std::filesystem::create_directories(folder); }
  ~CheckOrders() override { std::filesystem::remove_all(folder); }

  int exit_code(const std::string& arguments) const {
    const std::string command = std::string(ESFEM_BINARY_DIR) + "/bin/check_orders " + arguments +
                                " --reference " + folder.string() + " > " + (folder / "out").string() +
                                " 2>&1";
    return WEXITSTATUS(std::system(command.c_str()));
  }

  std::string output() const {
    std::ifstream stream(folder / "out");
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  int exit_code_of(const std::vector<json>& claims) const {
    write_file((folder / "mcf_sphere.json").string(), reference(claims).dump());
    write_file((folder / "table.json").string(), to_json(sample_table()).dump());
    return exit_code((folder / "table.json").string());
  }
};

TEST_F(CheckOrders, ExitCodesAreTheVerdict) {
  json not_met = size_claim(), elsewhere = order_claim();
  not_met["at_most"] = 1e-9;
  elsewhere["presets"] = json::array({"paper"});
  EXPECT_EQ(exit_code_of({order_claim(), size_claim()}), exit_done);
  EXPECT_EQ(exit_code_of({order_claim(), not_met}), exit_claim);
  EXPECT_THAT(output(), AllOf(HasSubstr("3.00 ["), HasSubstr("NOT MET"), HasSubstr("1 of 2 claims met")));
  EXPECT_EQ(exit_code_of({elsewhere, size_claim()}), exit_done);
  EXPECT_EQ(exit_code_of({elsewhere}), exit_claim) << "a check that asserts nothing does not pass";
  EXPECT_EQ(exit_code("no_such_table.json"), exit_usage);
  EXPECT_EQ(exit_code(""), exit_usage);
  EXPECT_EQ(exit_code("--no-such-option"), exit_usage);
  EXPECT_THAT(output(), HasSubstr("--no-such-option"));
  EXPECT_EQ(exit_code("--help"), exit_done);
}

TEST_F(CheckOrders, CountTheRunsOfATable) {
  Table table = sample_table();
  table.parameters["preset"] = "check";
  json file = reference({order_claim()});
  file["runs"] = {{"check", table.rows.size()}};
  write_file((folder / "mcf_sphere.json").string(), file.dump());
  const auto exit_code_of_table = [&] {
    write_file((folder / "table.json").string(), to_json(table).dump());
    return exit_code((folder / "table.json").string());
  };
  EXPECT_EQ(exit_code_of_table(), exit_done);
  table.rows.pop_back();
  EXPECT_EQ(exit_code_of_table(), exit_claim);
  EXPECT_THAT(output(), HasSubstr("runs, expected " + std::to_string(table.rows.size() + 1)));
  table.parameters["preset"] = "paper";
  EXPECT_EQ(exit_code_of_table(), exit_done) << "the reference says nothing of this preset";
}

/// A family of one claim for each norm; that in L2 is at round-off and not met.
json family() {
  json claim = order_claim();
  claim["id"] = "x-{norm}";
  claim["statement"] = "x has order 3 in {norm}";
  claim["norm"] = "nodal_{norm}";
  claim["for"] = {{"norm", json::array({"H1", "L2"})}};
  return claim;
}

TEST_F(CheckOrders, AFamilyIsALineWithThoseThatAreNotMet) {
  EXPECT_EQ(exit_code_of({family(), size_claim()}), exit_claim);
  EXPECT_THAT(output(), AllOf(HasSubstr("1 of 2 met"), HasSubstr("x-{norm}: x has order 3 in H1, L2 (kll19"),
                              HasSubstr("x-L2: x has order 3 in L2"), HasSubstr("2 of 3 claims met")));
  EXPECT_THAT(output(), Not(HasSubstr("x-H1:"))) << "it is met";
}

TEST_F(CheckOrders, VerdictsOfAFamilyAreThoseOfItsMembers) {
  json elsewhere = size_claim();
  elsewhere["presets"] = json::array({"paper"});
  exit_code_of({family(), elsewhere});
  const std::string table = (folder / "table.json").string(), verdicts = (folder / "verdicts.json").string();
  EXPECT_EQ(exit_code(table + " --output " + verdicts), exit_claim);
  const json file = read_json(verdicts).at("tables").at(0);
  ASSERT_EQ(file.at("claims").size(), 2u);
  for (const json& claim : file.at("claims")) EXPECT_EQ(claim.at("family"), "x-{norm}");
  EXPECT_EQ(file.at("families").dump(),
            R"({"x-{norm}":{"cannot_be_told":0,"claims":2,"met":1,"statement":"x has order 3 in H1, L2"}})");
  EXPECT_EQ(file.at("elsewhere"), 1);
}

TEST_F(CheckOrders, VerdictsGoToAFileAsWell) {
  json corrected = order_claim(), not_met = size_claim();
  corrected["finding"] = "corrected";
  corrected["remark"] = "a sign";
  not_met["at_most"] = 1e-9;
  write_file((folder / "mcf_sphere.json").string(), reference({corrected, not_met}).dump());
  write_file((folder / "table.json").string(), to_json(sample_table()).dump());
  const std::string table = (folder / "table.json").string(), verdicts = (folder / "verdicts.json").string();
  EXPECT_EQ(exit_code(table + " --output " + verdicts), exit_claim);
  const json file = read_json(verdicts);
  EXPECT_EQ(file.at("schema"), "esfem-verdicts/1");
  const json& claims = file.at("tables").at(0).at("claims");
  ASSERT_EQ(claims.size(), 2u);
  EXPECT_EQ(claims[0].at("met"), true);
  EXPECT_EQ(claims[0].at("finding"), "corrected");
  EXPECT_EQ(claims[0].at("source").at("basis"), "statement");
  EXPECT_THAT(claims[0].at("measured").get<std::string>(), HasSubstr("3.00 ["));
  EXPECT_EQ(claims[1].at("met"), false);
  EXPECT_THAT(claims[1].at("reason").get<std::string>(), HasSubstr("too large"));
}

}  // namespace
}  // namespace esfem::test_claims
