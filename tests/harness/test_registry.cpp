// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "experiments/evolve/config.hpp"
#include "experiments/evolve/help.hpp"
#include "solver/error.hpp"
#include "solver/surfaces/named.hpp"

namespace esfem::test_registry {
namespace {

using nlohmann::json;
using testing::AllOf, testing::Contains, testing::HasSubstr, testing::Not;

/// The message of the error that a configuration of these flow, variant and parameters meets; "" without one.
std::string refusal(const json& keys) {
  json description = {
      {"mesh", {{"subdivisions", 1}}}, {"surface", {{"name", "sphere"}, {"radius", 1}}}, {"tau", 0.1}};
  description.update(keys);
  try {
    evolve_config(description, "file");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Registry, EachFlowAndProblemIsThereOnceAndSaysWhatItIs) {
  std::set<std::pair<std::string, std::string>> seen;
  for (const Entry& entry : entries()) {
    EXPECT_TRUE(seen.insert({entry.flow, entry.problem}).second) << entry.flow;
    EXPECT_FALSE(entry.help.empty()) << entry.flow;
    EXPECT_TRUE(entry.run) << entry.flow;
    EXPECT_TRUE(entry.cure) << entry.flow;
    EXPECT_EQ(&entry_named(entry.flow, entry.problem, ""), &entry);
    EXPECT_LE(entry.order, entry.highest_order) << entry.flow;
    EXPECT_LE(entry.order_on_files, entry.highest_order) << entry.flow;
  }
}

TEST(Registry, ANameThatNoEntryHasReachesNoRun) {
  EXPECT_THAT(refusal({{"flow", "mean_curvatur"}}),
              AllOf(HasSubstr("found flow = \"mean_curvatur\""),
                    HasSubstr("expected one of bgn, bgn_willmore, cahn_hilliard")));
  EXPECT_THAT(refusal({{"flow", ""}}), HasSubstr("expected one of"));
  EXPECT_THAT(refusal({{"flow", "coupled_diffusion"}, {"problem", "growing"}}),
              HasSubstr("expected one of growing_sphere, kinetics, tumour_growth"));
  EXPECT_THAT(refusal({{"flow", "dziuk"}, {"problem", "growing_sphere"}}),
              HasSubstr("expected no key problem"));
  for (const Entry& entry : entries()) EXPECT_NE(refusal({{"flow", entry.flow + "x"}}), "");
}

/// A configuration of this flow and problem with what it needs.
json needed_by(const Entry& entry) {
  json flow = {{"flow", entry.flow}};
  if (!entry.problem.empty()) flow["problem"] = entry.problem;
  for (const FormulaKey& key : entry.formulas)
    if (key.is_required) flow[key.name] = json::parse(key.example);
  return flow;
}

/// What a key needs beside it to have an effect.
json needed_beside(const Entry& entry, const Key& key) {
  if (entry.problem == "kinetics") return {{"kinetics", {{"g", "u1"}}}};
  if (key.name == "reduction_time") return {{"parameters", {{"reduced_volume", 0.9}}}};
  if (entry.flow == "helfrich" && key.name == "tangential")
    return {{"parameters", {{"constraints", json::array()}}}};
  return json::object();
}

TEST(Registry, EveryKeyIsReadAndCheckedWhereItBelongs) {
  for (const Entry& entry : entries()) {
    const json flow = needed_by(entry);
    EXPECT_EQ(refusal(flow), "") << flow;
    for (const auto& [object, keys] :
         {std::pair("variant", &entry.variant), {"parameters", &entry.parameters}}) {
      json bad = flow;
      const bool takes_any_number = entry.takes_own_parameters && object == std::string("parameters");
      bad[object] = {{"no_such_key", takes_any_number ? json("text") : json(1)}};
      EXPECT_NE(refusal(bad), "") << bad;
      for (const Key& key : *keys) {
        bad[object] = {{key.name, key.kind == Key::words_of ? json(1) : json::array()}};
        EXPECT_THAT(refusal(bad), HasSubstr(key.name)) << bad;
        json good = flow;
        good[object] = {{key.name, key.kind == Key::truth      ? json(true)
                                   : key.kind == Key::words_of ? json(key.words)
                                   : !key.words.empty()        ? json(key.words.back())
                                                               : json(1)}};
        good.merge_patch(needed_beside(entry, key));
        EXPECT_EQ(refusal(good), "") << good;
        if (!key.words.empty()) {
          bad[object] = {{key.name, key.kind == Key::words_of ? json{"no_such_word"} : json("no_such_word")}};
          EXPECT_THAT(refusal(bad), AllOf(HasSubstr("expected one of"), HasSubstr(key.words.back()))) << bad;
          const bool names_truth = refusal(bad).find("false, true") != std::string::npos;
          EXPECT_EQ(names_truth, key.kind == Key::truth_or_word) << refusal(bad);
        }
        if (key.kind != Key::positive && key.kind != Key::not_negative) continue;
        good[object][key.name] = -1;
        EXPECT_THAT(refusal(good), HasSubstr(key.name + " = -1")) << good;
      }
    }
  }
}

TEST(Registry, HelpAndSchemaKnowEveryKey) {
  const std::string help = evolve_explanation("all");
  const json schema = evolve_schema();
  for (const Entry& entry : entries()) {
    EXPECT_THAT(help, HasSubstr("\"" + entry.flow + "\""));
    EXPECT_THAT(schema["properties"]["flow"]["enum"], Contains(entry.flow));
    const auto rule = std::find_if(schema["allOf"].begin(), schema["allOf"].end(), [&](const json& rule) {
      const json& is = rule["if"]["properties"];
      return is["flow"]["const"] == entry.flow &&
             (entry.problem.empty() || is["problem"]["const"] == entry.problem);
    });
    ASSERT_NE(rule, schema["allOf"].end());
    for (const Key& key : entry.variant) {
      EXPECT_THAT(help, HasSubstr("\"" + key.name + "\": "));
      EXPECT_TRUE((*rule)["then"]["properties"]["variant"]["properties"].contains(key.name)) << key.name;
    }
    for (const Key& key : entry.parameters)
      EXPECT_TRUE((*rule)["then"]["properties"]["parameters"]["properties"].contains(key.name)) << key.name;
  }
  EXPECT_EQ(refusal({{"flow", "dziuk"}, {"$schema", "evolve.schema.json"}}), "");
}

TEST(Registry, HelpIsOneScreenWithAConfigurationThatIsAccepted) {
  const std::string help = evolve_help();
  EXPECT_LE(std::count(help.begin(), help.end(), '\n'), 60);
  for (const Entry& entry : entries())
    EXPECT_THAT(help, AllOf(HasSubstr(entry.flow), HasSubstr(entry.problem)));
  EXPECT_THAT(help, HasSubstr(evolve_example));
  json example = json::parse(evolve_example);
  example["mesh"] = {{"subdivisions", 1}};
  EXPECT_NO_THROW(evolve_config(example, "help"));
}

TEST(Registry, EachNameInHelpIsExplainedAndOthersAreRefused) {
  const std::string all = evolve_explanation("all");
  for (const Entry& entry : entries()) EXPECT_THAT(evolve_explanation(entry.flow), HasSubstr(entry.problem));
  EXPECT_THAT(evolve_explanation("willmore"), AllOf(HasSubstr("relaxation"), Not(HasSubstr("bgn"))));
  for (const char* name :
       {"keys", "units", "surfaces", "formulas", "output", "end", "initial", "checkpoint", "sweeps"}) {
    EXPECT_THAT(evolve_help(), HasSubstr(std::string("  ") + name + "  "));
    EXPECT_THAT(all, HasSubstr(evolve_explanation(name))) << name;
  }
  try {
    evolve_explanation("wilmore");
    FAIL() << "an unknown name was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("found wilmore"), HasSubstr("willmore, surface_diffusion")));
  }
}

TEST(Registry, FormulasAreReadAndCheckedWhereTheyBelong) {
  const std::string help = evolve_explanation("all");
  std::set<std::string> all;
  for (const Entry& entry : entries())
    for (const FormulaKey& key : entry.formulas) all.insert(key.name);
  for (const Entry& entry : entries()) {
    std::set<std::string> others = all;
    for (const FormulaKey& key : entry.formulas) {
      others.erase(key.name);
      EXPECT_THAT(help, AllOf(HasSubstr("\"" + key.name + "\""), HasSubstr(key.example)));
      json flow = needed_by(entry);
      flow[key.name] = json::parse(key.example);
      EXPECT_EQ(refusal(flow), "") << flow;
      flow[key.name] = true;
      EXPECT_THAT(refusal(flow), HasSubstr(key.name)) << flow;
      if (!key.is_required) continue;
      flow.erase(key.name);
      EXPECT_THAT(refusal(flow), HasSubstr("needs the key " + key.name));
    }
    for (const std::string& other : others) {
      json flow = needed_by(entry);
      flow[other] = json{{"u", "x"}};
      flow["mesh"] = {{"subdivisions", 1}};
      EXPECT_THAT(refusal(flow), HasSubstr("expected no key " + other)) << flow;
    }
  }
}

// `make gallery` writes the list.
TEST(Registry, TheSchemaKnowsTheParametersOfEachSurface) {
  const json choices = evolve_schema().at("properties").at("surface").at("oneOf");
  const json defaults = named_surface_defaults();
  ASSERT_EQ(choices.size(), defaults.size() + 1);  // and a formula
  for (const json& choice : choices) {
    const json& properties = choice.at("properties");
    EXPECT_EQ(choice.at("additionalProperties"), false);
    if (!properties.contains("name")) continue;
    for (const auto& [parameter, value] : defaults.at(properties.at("name").at("const")).items())
      EXPECT_EQ(properties.at(parameter).at("default"), value) << parameter;
  }
}

TEST(Registry, TheDocumentationListsFlowsAndProblems) {
  std::ifstream file(std::string(ESFEM_SOURCE_DIR) + "/docs/flows.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const Entry& entry : entries()) {
    const std::string problem = entry.problem.empty() ? "" : "`" + entry.problem + "`";
    EXPECT_THAT(text.str(), HasSubstr("| `" + entry.flow + "` | " + problem + " | " + entry.help + " |"));
  }
}

}  // namespace
}  // namespace esfem::test_registry
