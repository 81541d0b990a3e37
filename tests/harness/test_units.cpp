// SPDX-License-Identifier: GPL-3.0-or-later
// evolve on one surface in other units and at another place: the same results, in these units.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "solver/constants.hpp"
#include "solver/error.hpp"
#include "solver/mesh/mesh.hpp"
#include "solver/tables/table.hpp"

namespace esfem::test_units {
namespace {

using nlohmann::json;

/// A flow of evolve: keys of its configuration, the power of a length that its time is, its steps.
struct FlowCase {
  const char* name;
  json keys;
  int time_power;
  double tau, end_time;
};

std::ostream& operator<<(std::ostream& out, const FlowCase& flow) {
  return out << flow.name;
}

const std::vector<FlowCase> flows = {
    {"MeanCurvature", {{"flow", "mean_curvature"}}, 2, 1e-3, 2e-3},
    {"Interpolation",
     {{"flow", "mean_curvature"}, {"variant", {{"velocity", "interpolation"}}}},
     2,
     1e-3,
     2e-3},
    {"Dziuk", {{"flow", "dziuk"}}, 2, 1e-3, 2e-3},
    {"Bgn", {{"flow", "bgn"}, {"bdf", 1}}, 2, 1e-3, 2e-3},
    {"Willmore", {{"flow", "willmore"}}, 4, 1e-4, 1e-4},
    {"ImplicitWillmore", {{"flow", "willmore"}, {"variant", {{"F", "implicit"}}}}, 4, 1e-4, 1e-4},
    {"SurfaceDiffusion", {{"flow", "surface_diffusion"}}, 4, 1e-4, 1e-4},
    {"Helfrich", {{"flow", "helfrich"}}, 4, 1e-4, 1e-4},
    {"PhaseSeparation",
     {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}, {"parameters", {{"mean", 0.1}}}},
     3,
     0.1,
     0.1},
    {"TumourGrowth", {{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}}, 2, 1e-3, 1e-3}};

/// The power of a length that a quantity has the unit of.
int power_of(const std::string& quantity, int time_power) {
  if (quantity == "t") return time_power;
  if (quantity == "v" || quantity == "V") return 1 - time_power;
  if (quantity == "x" || quantity == "h" || quantity == "energy") return 1;
  if (quantity == "area" || quantity.rfind("mass", 0) == 0) return 2;
  if (quantity == "volume") return 3;
  if (quantity == "lambda_A") return -2;
  if (quantity == "lambda_V") return -3;
  if (quantity == "H" || quantity == "max_H" || quantity == "w") return -1;
  return quantity == "z" ? -2 : 0;
}

/// A smooth surface without symmetry. Its coordinates are multiples of 2^-20: an integer shift leaves them
/// exact.
Mesh potato() {
  Mesh mesh = icosphere(1, 1);
  mesh = subdivide(mesh);
  for (int j = 0; j < mesh.nodes.rows(); ++j) {
    const Vec3 y = mesh.nodes.row(j).normalized();
    const double radius = 1 + 0.1 * y[0] + 0.15 * y[1] * y[2] + 0.2 * y[0] * y[0] * y[2];
    for (int i = 0; i < 3; ++i) mesh.nodes(j, i) = std::ldexp(std::round(std::ldexp(radius * y[i], 20)), -20);
  }
  return mesh;
}

class InFolder : public testing::Test {
 protected:
  const std::filesystem::path folder =
      std::filesystem::path(ESFEM_BINARY_DIR) / "test_units" / std::to_string(getpid());

  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string path(const char* name) const { return (folder / name).string(); }

  /// A P1 mesh, shifted and then multiplied by `length`, as a file.
  json mesh_file(const Mesh& mesh, double length, double shift) const {
    std::string text = format("OFF\n%td %td 0\n", mesh.nodes.rows(), mesh.elements.rows());
    for (int j = 0; j < mesh.nodes.rows(); ++j) {
      const Vec3 x = length * (mesh.nodes.row(j).transpose() + Vec3(shift, -shift, 2 * shift));
      text += format("%.17g %.17g %.17g\n", x[0], x[1], x[2]);
    }
    for (int e = 0; e < mesh.elements.rows(); ++e)
      text += format("3 %d %d %d\n", mesh.elements(e, 0), mesh.elements(e, 1), mesh.elements(e, 2));
    write_file(path("mesh.off"), text);
    return {{"file", path("mesh.off")}};
  }

  /// Nodal values and series of a run; "error" is what it says when it fails.
  json run(json config) const {
    config["output"] = {{"nodal", path("nodal.json")}, {"series", path("series.json")}};
    write_file(path("config.json"), config.dump());
    const std::string command =
        std::string(ESFEM_BINARY_DIR) + "/bin/evolve " + path("config.json") + " 2>" + path("errors.txt");
    const int status = std::system(command.c_str());
    std::ifstream stream(path("errors.txt"));
    if (WEXITSTATUS(status) != exit_done)
      return {{"error", std::string(std::istreambuf_iterator<char>(stream), {})}};
    return {{"nodal", read_json(path("nodal.json"))}, {"series", read_json(path("series.json"))}};
  }

  /// The last value of a series divided by the first.
  double ratio(const json& config, const char* quantity) const {
    const json result = run(config);
    if (result.contains("error")) {
      ADD_FAILURE() << result;
      return NAN;
    }
    const json& values = result["series"][quantity];
    return values.back().get<double>() / values.front().get<double>();
  }
};

class Units : public InFolder, public testing::WithParamInterface<FlowCase> {
 protected:
  const Mesh mesh = potato();

  json scaled_run(bool adaptive, double length, double shift) const {
    const FlowCase& flow = GetParam();
    json config = flow.keys;
    config["mesh"] = mesh_file(mesh, length, shift);
    config["degree"] = 1;
    const double time = std::pow(length, flow.time_power);
    if (adaptive) {
      config["adaptive"] = {{"end_time", flow.end_time * time}};
    } else {
      config["tau"] = flow.tau * time;
      config["steps"] = 4;
      if (!config.contains("bdf")) config["bdf"] = 2;
    }
    return run(config);
  }

  /// Numbers of a result, in units of `length` and about the origin of the mesh.
  static Eigen::VectorXd numbers(const json& values, const std::string& quantity, int time_power,
                                 double length, double shift) {
    std::vector<double> list;
    for (const json& value : values) {
      if (!value.is_array())
        list.push_back(value.get<double>());
      else
        for (const json& component : value) list.push_back(component.get<double>());
    }
    Eigen::VectorXd result = Eigen::Map<Eigen::VectorXd>(list.data(), list.size());
    result /= std::pow(length, power_of(quantity, time_power));
    for (int i = 0; quantity == "x" && i < result.size(); ++i)
      result[i] -= i % 3 == 0 ? shift : i % 3 == 1 ? -shift : 2 * shift;
    return result;
  }

  void expect_equal(const json& some, const json& other, double length, double shift) const {
    for (const auto& [quantity, values] : some.items()) {
      if (!values.is_array()) continue;
      ASSERT_EQ(values.size(), other.at(quantity).size()) << quantity;
      const int power = GetParam().time_power;
      const Eigen::VectorXd expected = numbers(values, quantity, power, 1, 0),
                            found = numbers(other.at(quantity), quantity, power, length, shift);
      // Positions far from the origin have lost digits in the file.
      double tolerance = quantity == "x" ? 1e-10 + 1e-15 * std::abs(shift) : 1e-10;
      // Multipliers have the round-off of the area, over tau, and the velocity that they are a part of has
      // some.
      if (quantity == "lambda_A" || quantity == "lambda_V") tolerance = 1e-8;
      if (GetParam().keys["flow"] == "helfrich" && (quantity == "V" || quantity == "v")) tolerance = 1e-9;
      EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff())
          << quantity;
    }
  }

  void expect_invariance(bool adaptive) const {
    const json plain = scaled_run(adaptive, 1, 0);
    ASSERT_FALSE(plain.contains("error")) << plain;
    for (const auto& [length, shift] : {std::pair(1e-9, 0.0), {1e9, 0.0}, {1.0, 65536.0}}) {
      SCOPED_TRACE(format("length %g, shift %g", length, shift));
      const json other = scaled_run(adaptive, length, shift);
      ASSERT_FALSE(other.contains("error")) << other;
      expect_equal(plain["nodal"], other["nodal"], length, shift);
      expect_equal(plain["series"], other["series"], length, shift);
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Evolve, Units, testing::ValuesIn(flows),
                         [](const auto& info) { return info.param.name; });

TEST_P(Units, FixedStepsGiveTheSameResult) {
  expect_invariance(false);
}

TEST_P(Units, AdaptiveStepsGiveTheSameResult) {
  expect_invariance(true);
}

using Spheres = InFolder;

TEST_F(Spheres, OfAMillimetreIsFollowedByAdaptiveSteps) {
  const json config = {{"flow", "mean_curvature"},
                       {"degree", 1},
                       {"mesh", mesh_file(icosphere(1, 2), 1e-3, 0)},
                       {"adaptive", {{"end_time", 1e-7}}}};
  EXPECT_NEAR(ratio(config, "area"), 0.6, 0.004);
}

TEST_F(Spheres, OfANanometreShrinksAtTheRateOfItsSize) {
  json config = {{"flow", "mean_curvature"}, {"degree", 1}, {"bdf", 2}, {"tau", 1e-21}, {"steps", 5}};
  config["mesh"] = mesh_file(icosphere(1, 2), 1e-9, 0);
  EXPECT_NEAR(ratio(config, "area"), 0.98, 1e-4);
  config["variant"] = {{"velocity", "interpolation"}};
  EXPECT_NEAR(ratio(config, "area"), 0.98, 1e-4);
}

TEST_F(Spheres, FarFromTheOriginHaveTheirVolume) {
  const double of_triangles = 4.04704467998;
  for (const int degree : {1, 2, 3}) {
    const json config = {{"flow", "dziuk"}, {"degree", degree}, {"bdf", 1}, {"tau", 1e-4}, {"steps", 0}};
    json far = config, near = config;
    near["mesh"] = mesh_file(icosphere(1, 2), 1, 0);
    const double volume = run(near)["series"]["volume"][0];
    far["mesh"] = mesh_file(icosphere(1, 2), 1, 1e6);
    EXPECT_NEAR(run(far)["series"]["volume"][0].get<double>() / volume, 1, 1e-9) << degree;
    if (degree == 1) {
      EXPECT_NEAR(volume, of_triangles, 1e-9);
    }
  }
}

TEST_F(Spheres, SeparatePhasesInStepsOfAnySize) {
  json config = {{"flow", "cahn_hilliard"}, {"problem", "phase_separation"}, {"degree", 1}, {"bdf", 1}};
  config["mesh"] = mesh_file(icosphere(1, 2), 1, 0);
  config["tau"] = 100;
  config["steps"] = 5;
  config["parameters"] = {{"epsilon", 0.15}, {"disturbance", 0.5}, {"seed", 3}};
  const json result = run(config);
  ASSERT_TRUE(result.contains("series")) << result;
  const std::vector<double> energy = result["series"]["energy"];
  for (std::size_t n = 1; n < energy.size(); ++n) EXPECT_LE(energy[n], energy[n - 1] + 1e-6 * energy[0]);
  EXPECT_NEAR(energy.back(), 6, 0.5);
}

}  // namespace
}  // namespace esfem::test_units
