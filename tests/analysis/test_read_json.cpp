// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "solver/error.hpp"
#include "solver/read_json.hpp"
#include "solver/write_file.hpp"

namespace esfem::test_read_json {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct ReadJson : testing::Test {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("esfem_json_" + std::to_string(getpid()));
  const std::string file = (folder / "a.json").string();

  ReadJson() { std::filesystem::create_directories(folder); }
  ~ReadJson() override { std::filesystem::remove_all(folder); }

  nlohmann::json read(const std::string& text) const {
    write_file(file, text);
    return read_json(file);
  }
  std::string complaint(const std::string& text) const {
    try {
      read(text);
      return "no error";
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_THAT(message, HasSubstr(file));
      EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
      return message;
    }
  }
};

TEST_F(ReadJson, AKeyThatIsGivenTwiceIsNamed) {
  EXPECT_THAT(complaint(R"({"tau": 1, "steps": 2, "tau": 1})"), HasSubstr("key \"tau\" is given twice"));
  EXPECT_THAT(complaint(R"({"output": {"series": "a", "series": "b"}})"),
              HasSubstr("key \"output.series\" is given twice"));
  EXPECT_THAT(complaint(R"({"a": [{"b": 1}, {"b": 1, "c": {"d": 1}, "b": 2}]})"),
              HasSubstr("key \"a.b\" is given twice"));
  EXPECT_THAT(complaint(R"({"a": {"b": 1}, "a": {"c": 1}})"), HasSubstr("key \"a\" is given twice"));
  EXPECT_THAT(complaint(R"({"a": 1, "\u0061": 2})"), HasSubstr("\"a\" is given twice"))
      << "however it is written";
  EXPECT_THAT(complaint("{\"a\\nb\": 1, \"a\\nb\": 2}"), HasSubstr("is given twice"));
  EXPECT_EQ(read(R"({"a": {"b": 1}, "b": [{"b": 1}, {"b": 2}]})").at("b").size(), 2u);
}

TEST_F(ReadJson, ANumberThatNoDoubleHoldsIsNamed) {
  for (const char* number : {"1e400", "-1e400", "1e309", "123456789e999999999"})
    EXPECT_THAT(complaint(std::string(R"({"tau": 1, "parameters": {"alpha": )") + number + "}}"),
                AllOf(HasSubstr("key \"parameters.alpha\""), HasSubstr(number)));
  EXPECT_EQ(read("[1.7976931348623157e308]")[0], 1.7976931348623157e308);
}

TEST_F(ReadJson, WhatIsNoJsonIsNamedWithItsLine) {
  for (const char* word :
       {"NaN", "nan", "Infinity", "-Infinity", "inf", "1d3", "0x10", ".5", "1.", "+1", "01", "'a'"})
    EXPECT_THAT(complaint(std::string("{\"flow\": \"bgn\",\n \"tau\": ") + word + "}"),
                AllOf(HasSubstr("line 2"), HasSubstr("\"tau\""), HasSubstr("not JSON")))
        << word;
  EXPECT_THAT(complaint("{\"a\": 1 // why\n}"), HasSubstr("not JSON"));
  EXPECT_THAT(complaint("{\"a\": 1 /* why */}"), HasSubstr("not JSON"));
  EXPECT_THAT(complaint("{\"a\": 1,}"), HasSubstr("not JSON"));
  EXPECT_THAT(complaint("{\"a\": 1} {}"), HasSubstr("not JSON"));
  EXPECT_THAT(complaint("{\"a\": \"\xff\"}"), HasSubstr("not JSON"));
}

TEST_F(ReadJson, AByteOrderMarkIsRead) {
  EXPECT_EQ(read("\xEF\xBB\xBF{\"a\": 1}").at("a"), 1);
  EXPECT_THAT(complaint(std::string("\xFF\xFE{\0}\0", 6)), HasSubstr("UTF-16; expected UTF-8"));
  EXPECT_THAT(complaint(std::string("\xFE\xFF\0{\0}", 6)), HasSubstr("UTF-16; expected UTF-8"));
}

TEST_F(ReadJson, DeepNestingIsRefused) {
  const auto nested = [](int depth) {
    std::string open, close;
    for (int i = 0; i < depth; ++i) open += i % 2 ? "[" : "{\"a\": ", close += i % 2 ? "]" : "}";
    return open + "1" + std::string(close.rbegin(), close.rend());
  };
  EXPECT_TRUE(read(nested(100)).is_object());
  EXPECT_THAT(complaint(nested(101)), HasSubstr("more than 100 nested arrays and objects"));
  EXPECT_THAT(complaint(nested(1000000)), HasSubstr("more than 100"));
}

}  // namespace
}  // namespace esfem::test_read_json
