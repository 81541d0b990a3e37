// SPDX-License-Identifier: GPL-3.0-or-later
// The configurations in reference/examples are valid (`make samples` runs them to their ends).
#include <gtest/gtest.h>

#include "tests/harness/evolve_program.hpp"

namespace esfem::test_examples {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path examples = fs::path(ESFEM_SOURCE_DIR) / "reference/examples";

struct Examples : EvolveProgram {};

/// The configuration with its keys, but 0 steps, coarse and with output elsewhere.
json initial_surface(json configuration, const std::string& nodal, const std::string& series) {
  if (configuration.contains("adaptive")) {
    configuration.erase("adaptive");
    configuration["tau"] = 1e-3;
  }
  configuration["steps"] = 0;
  json& mesh = configuration["mesh"];
  if (mesh.contains("file"))
    mesh["file"] = std::string(ESFEM_SOURCE_DIR "/") + mesh["file"].get<std::string>();
  if (mesh.contains("subdivisions")) mesh["subdivisions"] = 1;
  if (mesh.contains("grading")) mesh["grading"] = 1;
  if (configuration.contains("/output/vtu"_json_pointer)) configuration["output"]["vtu"] = nodal + ".pvd";
  if (configuration.contains("output")) configuration["output"].erase("checkpoint");
  configuration["output"].update(json{{"nodal", nodal}, {"series", series}});
  return configuration;
}

TEST_F(Examples, AreValidAndHaveExpectedValues) {
  const json expected = read_json((examples / "expected.json").string());
  std::size_t count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(examples)) {
    const std::string name = entry.path().stem().string();
    const json configuration = read_json(entry.path().string());
    if (!configuration.contains("flow")) continue;
    count += configuration.contains("output");
    // Those of sweeps and studies name no output, and are run by these.
    EXPECT_EQ(expected.contains(name), configuration.contains("output"))
        << name << ": expected.json, see make samples";
    EXPECT_EQ(run(initial_surface(configuration, nodal, series)), 0) << name << message;
  }
  EXPECT_EQ(count, expected.size()) << "expected.json has an entry without a configuration";
}

TEST_F(Examples, AKeyThatDoesNotExistIsFound) {
  json configuration = initial_surface(read_json((examples / "sphere.json").string()), nodal, series);
  configuration["step"] = 3;
  EXPECT_EQ(run(configuration), 1);
}

}  // namespace
}  // namespace esfem::test_examples
