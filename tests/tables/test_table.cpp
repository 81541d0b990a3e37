// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "solver/error.hpp"
#include "solver/tables/table.hpp"

namespace esfem::test_table {
namespace {

using nlohmann::json;
using testing::AllOf, testing::HasSubstr, testing::Not;
namespace fs = std::filesystem;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Row sample_row(const std::string& cell, double h, double tau) {
  Row row;
  row.cell = cell;
  row.level = 1;
  row.h = h;
  row.nodes = 642;
  row.tau = tau;
  row.steps = 12;
  row.seconds = 0.1 + 0.2;
  row.peak_memory_mb = 33.5;
  row.errors["x"] = {{"nodal_L2", 0.1 * h * h + tau}, {"nodal_H1", 1.0 / 3}};
  row.errors["nu"] = {{"nodal_L2", 2e-9}};
  row.series["t"] = {0, 0.05, 0.1};
  row.values["pinch_time"] = 1.0 / 12;
  row.labels = {{"flow", "dziuk"}, {"bdf", 4}};
  row.more["snapshots"] = json::array({"a.vtu"});
  return row;
}

Table sample_table() {
  Table table;
  table.experiment = "mcf_sphere";
  table.paper = "kll19";
  table.parameters = {{"preset", "check"}};
  table.provenance = {{"version", "0.1.0"}};
  table.rows = {sample_row("h1_tau2", 0.4999999999999999, 0.1 / 3), sample_row("h1_tau3", 0.5, 0.05 / 3)};
  table.fits = {
      {"x", "nodal_L2", "tau", 2.9, Interval{2.8, 3.05}, {2.7, 3.1}, "", 12, {{"flow", "dziuk"}, {"bdf", 4}}},
      {"x", "nodal_L2", "h", 2.5, {}, {2.4, 2.9}, "rising, 2.4 -> 2.9", 12}};
  return table;
}

template <class Body>
std::string input_error(Body&& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string reading(const json& table) {
  return input_error([&] { table_from_json(table, "t.json"); });
}

/// A folder of its own for each test.
struct TableFile : testing::Test {
  fs::path folder = fs::path(testing::TempDir()) / ("esfem_table_" + std::to_string(getpid()));
  TableFile() { fs::create_directories(folder); }
  ~TableFile() override { fs::remove_all(folder); }
  std::string path(const char* name) const { return (folder / name).string(); }
};

TEST(Table, RoundTripKeepsEveryBit) {
  const Table table = sample_table();
  const json written = to_json(table);
  const Table again = table_from_json(json::parse(written.dump(1)), "t.json");
  EXPECT_EQ(to_json(again), written);
  EXPECT_EQ(again.rows[0].h, table.rows[0].h);
  EXPECT_EQ(again.rows[0].tau, table.rows[0].tau);
  EXPECT_EQ(again.rows[0].errors, table.rows[0].errors);
  EXPECT_EQ(again.rows[0].series, table.rows[0].series);
  EXPECT_EQ(again.rows[0].more, table.rows[0].more);
  EXPECT_EQ(again.rows[0].values, table.rows[0].values);
  EXPECT_EQ(again.fits[0].ci95, table.fits[0].ci95);
  EXPECT_EQ(again.fits[0].slopes, table.fits[0].slopes);
  EXPECT_FALSE(again.fits[1].ci95.has_value());
  EXPECT_EQ(again.fits[1].remark, "rising, 2.4 -> 2.9");
  EXPECT_EQ(again.rows[0].labels, table.rows[0].labels);
  EXPECT_EQ(again.fits[0].labels, table.fits[0].labels);
}

TEST(Table, HasTheKeysOfTheSchema) {
  const json written = to_json(sample_table());
  EXPECT_EQ(written["schema"], "esfem-table/1");
  EXPECT_EQ(written["rows"][0]["errors"]["x"]["nodal_H1"], 1.0 / 3);
  EXPECT_EQ(written["rows"][0]["labels"].dump(), R"({"bdf":4,"flow":"dziuk"})");
  EXPECT_EQ(written["fits"][0]["ci95"], json({2.8, 3.05}));
  for (const char* key :
       {"cell", "level", "h", "nodes", "tau", "steps", "status", "seconds", "peak_memory_mb", "series"})
    EXPECT_TRUE(written["rows"][0].contains(key)) << key;
}

TEST(Table, ASingularRunHasNotFailed) {
  Table table = sample_table();
  table.rows[0].status = "singular at t = 0.08 (step 27): element 3 is too thin";
  table.rows[1].status = "failed: step 3, t = 0.1: factorisation failed";
  const Table again = table_from_json(to_json(table), "t.json");
  EXPECT_FALSE(failed(again.rows[0]));
  EXPECT_TRUE(failed(again.rows[1]));
  json other = to_json(table);
  other["rows"][0]["status"] = "stopped";
  EXPECT_THAT(reading(other), HasSubstr("expected ok, singular at t = ..: why, or failed: why"));
}

TEST(Table, NonFiniteErrorsMakeTheRowFail) {
  Table table = sample_table();
  table.rows[1].errors["x"]["nodal_L2"] = nan;
  table.rows[1].series["energy"] = {1, std::numeric_limits<double>::infinity()};
  const json written = to_json(table);
  EXPECT_TRUE(written["rows"][1]["errors"]["x"]["nodal_L2"].is_null());
  EXPECT_TRUE(written["rows"][1]["series"]["energy"][1].is_null());
  EXPECT_EQ(written["rows"][1]["status"], "failed: error x.nodal_L2 is not finite");
  EXPECT_EQ(written["rows"][0]["status"], "ok");
  const Table again = table_from_json(written, "t.json");
  EXPECT_TRUE(std::isnan(again.rows[1].errors.at("x").at("nodal_L2")));

  json forged = written;
  forged["rows"][1]["status"] = "ok";
  EXPECT_THAT(reading(forged), AllOf(HasSubstr("t.json, row 2"), HasSubstr("x.nodal_L2")));

  table = sample_table();
  table.rows[0].tau = nan;
  EXPECT_THAT(input_error([&] { to_json(table); }), AllOf(HasSubstr("h1_tau2"), HasSubstr("tau")));
}

TEST(Table, FurtherKeysMustNotHideTheRowsOwn) {
  Table table = sample_table();
  table.rows[0].more["tau"] = 1;
  EXPECT_THAT(input_error([&] { to_json(table); }), HasSubstr("'tau'"));
}

TEST(Table, LabelsAreStringsAndNumbers) {
  Table table = sample_table();
  EXPECT_EQ(variant(table.rows[0]), "bdf=4, flow=dziuk");
  EXPECT_EQ(label_text({{"radius", 1.5}, {"a", "b"}}), "a=b, radius=1.5");
  EXPECT_EQ(label_text(json::object()), "");
  for (const json& bad : {json(nullptr), json(true), json::array({1}), json(nan)}) {
    table.rows[0].labels["bdf"] = bad;
    EXPECT_THAT(input_error([&] { to_json(table); }), AllOf(HasSubstr("h1_tau2"), HasSubstr("label 'bdf'")))
        << bad;
  }
  table.rows[0].labels = json::array({1});
  EXPECT_THAT(input_error([&] { to_json(table); }), HasSubstr("expected an object of strings and numbers"));
  json written = to_json(sample_table());
  written["rows"][1]["labels"]["bdf"] = json::array();
  EXPECT_THAT(reading(written), AllOf(HasSubstr("t.json, row 2, labels"), HasSubstr("'bdf'")));
  written["rows"][1].erase("labels");
  EXPECT_THAT(reading(written), HasSubstr("'labels' is missing"));
  written = to_json(sample_table());
  written["fits"][0]["labels"] = "bdf=4";
  EXPECT_THAT(reading(written), HasSubstr("'labels': expected an object"));
}

TEST(Table, ReadingNamesPlaceAndKey) {
  const json good = to_json(sample_table());
  EXPECT_EQ(reading(good), "no error");
  const auto with = [&](const char* pointer, const json& value) {
    json bad = good;
    bad[json::json_pointer(pointer)] = value;
    return reading(bad);
  };
  const auto without = [&](const char* pointer, const char* key) {
    json bad = good;
    bad[json::json_pointer(pointer)].erase(key);
    return reading(bad);
  };
  EXPECT_THAT(reading(json::array()), HasSubstr("t.json: expected a JSON object"));
  EXPECT_THAT(with("/schema", "esfem-table/2"), HasSubstr("expected 'esfem-table/1'"));
  EXPECT_THAT(with("/colour", 1), HasSubstr("unknown key 'colour'"));
  EXPECT_THAT(with("/rows/1/h", "big"), AllOf(HasSubstr("row 2"), HasSubstr("'h'"), HasSubstr("a number")));
  EXPECT_THAT(with("/rows/0/nodes", 1.5), AllOf(HasSubstr("row 1"), HasSubstr("'nodes'")));
  EXPECT_THAT(with("/rows/0/h", nullptr), HasSubstr("'h'"));
  EXPECT_THAT(with("/rows/0/status", "fine"),
              HasSubstr("expected ok, singular at t = ..: why, or failed: why"));
  EXPECT_THAT(with("/rows/0/errors/x", 1.0), HasSubstr("errors.x"));
  EXPECT_THAT(with("/rows/1/cell", "h1_tau2"), HasSubstr("occurs twice"));
  EXPECT_THAT(with("/fits/0/ci95", json({1})), HasSubstr("fit 1"));
  EXPECT_THAT(without("/rows/1", "tau"), AllOf(HasSubstr("row 2"), HasSubstr("key 'tau' is missing")));
  EXPECT_THAT(without("", "provenance"), HasSubstr("key 'provenance' is missing"));
}

TEST_F(TableFile, WritesReadsAndLeavesNothingElse) {
  write_file(path("a.json"), "{\"old\": 1}");
  write_file(path("a.json"), to_json(sample_table()).dump());
  EXPECT_EQ(read_json(path("a.json")), to_json(sample_table()));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(TableFile, UnwritablePathsAreErrorsAndLeaveNothing) {
  EXPECT_THAT(input_error([&] { write_file(path("no/such/a.json"), "{}"); }),
              AllOf(HasSubstr("no/such/a.json"), HasSubstr("No such file or directory")));
  fs::create_directory(folder / "sub");
  EXPECT_THAT(input_error([&] { write_file(path("sub"), "{}"); }), HasSubstr("cannot be written"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST_F(TableFile, DevicesAreNotReplaced) {
  write_file("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(TableFile, BadFilesAreErrorsWithTheLine) {
  EXPECT_THAT(input_error([&] { read_json(path("missing.json")); }),
              AllOf(HasSubstr("missing.json"), HasSubstr("No such file")));
  EXPECT_THAT(input_error([&] { read_json(folder.string()); }), HasSubstr("directory"));
  write_file(path("cut.json"), "{\n \"a\": 1,\n \"b\": [1, 2");
  EXPECT_THAT(input_error([&] { read_json(path("cut.json")); }), HasSubstr("cut.json, line 3"));
  write_file(path("bad.json"), "{\n \"a\": nan\n}");
  EXPECT_THAT(input_error([&] { read_json(path("bad.json")); }), HasSubstr("bad.json, line 2"));
  write_file(path("empty.json"), "");
  EXPECT_THAT(input_error([&] { read_json(path("empty.json")); }), HasSubstr("empty.json, line 1"));
}

}  // namespace
}  // namespace esfem::test_table
