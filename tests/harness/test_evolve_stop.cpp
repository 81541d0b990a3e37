// SPDX-License-Identifier: GPL-3.0-or-later
// How runs of evolve end, and what they say and write meanwhile.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>

#include <regex>
#include <sstream>

#include "experiments/evolve/series_lines.hpp"
#include "experiments/harness/progress.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_stop {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

struct EvolveStop : EvolveProgram {
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string content(const std::string& file) const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::string status() const { return read_json(series).at("status"); }
  std::vector<double> column(const std::string& name) const { return read_json(series).at(name); }
};

TEST_F(EvolveStop, WhenTheSurfaceIsStationary) {
  // With theta the unit sphere is stationary to round-off; without it it is not.
  json willmore = config({{"flow", "willmore"}, {"steps", 1000}, {"stop", {{"speed", 1e-9}}}});
  ASSERT_EQ(run(willmore), exit_done) << message;
  EXPECT_THAT(status(), AllOf(StartsWith("in the first step: stationary: the largest |v| in the nodes is"),
                              HasSubstr("at t = 0.01 (step 1)")));
  EXPECT_THAT(message, HasSubstr("in the first step: stationary: "));
  EXPECT_EQ(column("t").size(), 2u);
  willmore["steps"] = 5;
  willmore["variant"] = {{"theta", false}};
  ASSERT_EQ(run(willmore), exit_done) << message;
  EXPECT_EQ(status(), "ok");
  EXPECT_EQ(column("t").size(), 6u);
}

TEST_F(EvolveStop, WhenAMixtureIsAtRest) {
  json mixture = config({{"flow", "cahn_hilliard"},
                         {"problem", "phase_separation"},
                         {"parameters", {{"epsilon", 0.3}}},
                         {"tau", 0.5},
                         {"bdf", 1},
                         {"steps", 10000},
                         {"stop", {{"speed", 1e-4}}}});
  ASSERT_EQ(run(mixture), exit_done) << message;
  EXPECT_THAT(status(), StartsWith("stationary: the largest |du/dt| in the nodes"));
  const std::vector<double> energy = column("energy");
  const std::size_t n = energy.size();
  EXPECT_GT(n, 5u);
  EXPECT_LT(n, 10000u);
  EXPECT_LT(energy[n - 2] - energy[n - 1], 1e-5);
}

TEST_F(EvolveStop, IsPossibleForEveryFlow) {
  const std::vector<json> flows = {
      {{"flow", "mean_curvature"}},
      {{"flow", "dziuk"}},
      {{"flow", "bgn"}, {"bdf", 1}},
      {{"flow", "generalised_mean_curvature"}},
      {{"flow", "coupled_diffusion"}},
      {{"flow", "surface_diffusion"}},
      {{"flow", "helfrich"}, {"parameters", {{"constraints", {"area"}}}}},
      {{"flow", "dziuk_willmore"}, {"bdf", 1}, {"tau", 1e-5}},
      {{"flow", "bgn_willmore"}, {"bdf", 1}, {"tau", 1e-5}},
      {{"flow", "coupled_diffusion"}, {"problem", "tumour_growth"}, {"tau", 1e-3}},
      {{"flow", "cahn_hilliard"}}};
  for (json flow : flows) {
    flow["stop"] = {{"speed", 1e-15}, {"area", 1e-3}, {"seconds", 1e6}};
    ASSERT_EQ(run(config(flow)), exit_done) << flow << message;
    EXPECT_EQ(status(), "ok") << flow;
    flow["stop"] = {{"speed", 1e6}};
    ASSERT_EQ(run(config(flow)), exit_done) << flow << message;
    EXPECT_THAT(status(), StartsWith("in the first step: stationary: ")) << flow;
    EXPECT_EQ(column("t").size(), 2u);
  }
}

TEST_F(EvolveStop, WhenTheAreaHasFallenOrGrown) {
  // A sphere's area falls linearly, to 1 - 4t of that at the start.
  ASSERT_EQ(run(config({{"steps", 100}, {"stop", {{"area", 0.75}}}})), exit_done) << message;
  EXPECT_THAT(status(), StartsWith("area: 0.7"));
  const std::vector<double> area = column("area"), t = column("t");
  EXPECT_LE(area.back() / area.front(), 0.75);
  EXPECT_GT(area[area.size() - 2] / area.front(), 0.75);
  EXPECT_NEAR(t.back(), 0.065, 0.006);
  // Not extinct within the next step: the area asked for comes first.
  ASSERT_EQ(run(config({{"steps", 100}, {"tau", 0.1}, {"start", "cascade"}, {"stop", {{"area", 0.3}}}})),
            exit_done)
      << message;
  EXPECT_THAT(status(), StartsWith("area: "));
  json growing = config({{"flow", "coupled_diffusion"}, {"steps", 100}, {"stop", {{"area", 1.1}}}});
  ASSERT_EQ(run(growing), exit_done) << message;
  EXPECT_THAT(status(), StartsWith("area: 1.1"));
  // Relative to the start of the whole run, also from a file of it.
  ASSERT_EQ(run(config()), exit_done) << message;
  std::filesystem::rename(nodal, path("middle.json"));
  json rest =
      config({{"steps", 100}, {"stop", {{"area", 0.75}}}, {"initial", {{"file", path("middle.json")}}}});
  rest.erase("mesh");
  ASSERT_EQ(run(rest), exit_done) << message;
  EXPECT_EQ(column("area").back(), area.back());
}

TEST_F(EvolveStop, WhenTheTimeIsOverAndItGoesOn) {
  json endless = config({{"tau", 1e-7}, {"steps", 100000000}, {"stop", {{"seconds", 0.3}}}});
  ASSERT_EQ(run(endless), exit_done) << message;
  EXPECT_THAT(status(), StartsWith("seconds: 0.3 are over at t = "));
  EXPECT_THAT(message,
              HasSubstr("\"initial\": {\"file\": \"" + nodal + "\"} in the place of \"mesh\" goes on"));
  EXPECT_GT(column("t").size(), 1u);
}

TEST_F(EvolveStop, RefusesBoundsThatMeanNothing) {
  for (const auto& [stop, why] :
       {std::pair(json{{"speed", 0}}, "found speed = 0; expected a positive number"),
        std::pair(json{{"area", 1}}, "a smaller or a larger number"),
        std::pair(json{{"energy", 1}}, "unknown key")}) {
    EXPECT_EQ(run(config({{"stop", stop}})), exit_usage);
    EXPECT_THAT(message, HasSubstr(why));
  }
}

TEST_F(EvolveStop, SnapshotsAtMultiplesOfATime) {
  const std::string pvd = path("run.pvd");
  const json output = {{"vtu", pvd}, {"every_time", 0.025}};
  ASSERT_EQ(run(config({{"steps", 8}, {"output", output}})), exit_done) << message;
  static const std::regex element("timestep=\"([^\"]*)\"");
  const std::string text = content(pvd);
  std::vector<double> found;
  for (std::sregex_iterator match(text.begin(), text.end(), element), end; match != end; ++match)
    found.push_back(std::stod((*match)[1]));
  EXPECT_THAT(found, testing::ElementsAre(0, 0.03, 0.05, 0.08));
  EXPECT_EQ(column("t").size(), 9u) << "the steps are those without snapshots";
  EXPECT_EQ(run(config({{"output", {{"every_time", 1}}}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("expected the key vtu"));
  EXPECT_EQ(run(config({{"output", {{"vtu", pvd}, {"every_time", 0}}}})), exit_usage);
}

TEST_F(EvolveStop, SeriesAsLines) {
  ASSERT_EQ(run(config()), exit_done) << message;
  const json expected = read_json(series);
  const std::string csv = path("s.csv"), checkpoint = path("run.checkpoint");
  // In two parts: the lines before are written again.
  for (const int steps : {2, 4}) {
    ASSERT_EQ(run(config({{"steps", steps}, {"output", {{"series", csv}, {"checkpoint", checkpoint}}}})),
              exit_done)
        << message;
    if (steps == 2) std::filesystem::remove(csv);
  }
  std::istringstream lines(content(csv));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  std::vector<std::string> names;
  for (std::istringstream cells(line); std::getline(cells, line, ',');) names.push_back(line);
  EXPECT_EQ(names.front(), "t");
  std::size_t n = 0;
  for (; std::getline(lines, line); ++n) {
    std::istringstream cells(line);
    for (const std::string& name : names) {
      std::string cell;
      std::getline(cells, cell, ',');
      EXPECT_EQ(std::stod(cell), expected.at(name)[n].get<double>()) << name;
    }
  }
  EXPECT_EQ(n, 5u);
}

TEST_F(EvolveStop, LinesAreThereWhileItRuns) {
  const std::string csv = path("s.csv");
  write_file(path("endless.json"),
             config({{"tau", 1e-7}, {"steps", 100000000}, {"output", {{"series", csv}}}}).dump());
  const pid_t process = fork();
  if (process == 0) {
    std::freopen("/dev/null", "w", stderr);
    const std::string program = std::string(ESFEM_BINARY_DIR) + "/bin/evolve";
    execl(program.c_str(), program.c_str(), path("endless.json").c_str(), nullptr);
    _exit(127);
  }
  const auto lines = [&] {
    const std::string text = content(csv);
    return std::count(text.begin(), text.end(), '\n');
  };
  for (int i = 0; i < 2000 && lines() < 5; ++i) usleep(10000);
  EXPECT_GE(lines(), 5);
  kill(process, SIGKILL);
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_THAT(content(csv), StartsWith("t,area,"));
}

TEST_F(EvolveStop, OneLineAtTheEnd) {
  ASSERT_EQ(run(config({{"output", {{"vtu", path("run.pvd")}}}})), exit_done);
  EXPECT_THAT(message,
              MatchesRegex("evolve: 4 steps to t = 0.04 in [0-9.]+ s; area 12.[0-9]+ -> 10.[0-9]+, volume "
                           "4.[0-9]+ -> 3.[0-9]+; written: .*nodal.json, .*series.json, .*run.pvd "
                           "\\(2 snapshots\\)\n"));
  // Also of a run that becomes extinct; not of one that does not begin.
  EXPECT_EQ(run(config({{"steps", 60}})), exit_numerics);
  EXPECT_THAT(message, HasSubstr("written: "));
  EXPECT_EQ(run(config({{"tau", -1}})), exit_usage);
  EXPECT_THAT(message, Not(HasSubstr("written: ")));
}

/// What the program prints on a terminal.
TEST_F(EvolveStop, ProgressHasALineOfItsOwnThatIsCleared) {
  const std::string file = path("config.json");
  write_file(file, config({{"bdf", 3}, {"start", "substeps:32"}, {"mesh", {{"subdivisions", 4}}}}).dump());
  int terminal = -1;
  const pid_t process = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (process < 0) GTEST_SKIP() << "no pseudo-terminal can be opened here (is /dev/pts mounted?)";
  if (process == 0) {
    const std::string program = std::string(ESFEM_BINARY_DIR) + "/bin/evolve";
    execl(program.c_str(), program.c_str(), file.c_str(), nullptr);
    _exit(127);
  }
  std::string shown;
  char buffer[4096];
  for (ssize_t count; (count = read(terminal, buffer, sizeof buffer)) > 0;) shown.append(buffer, count);
  close(terminal);
  int status = 0;
  waitpid(process, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), exit_done) << shown;
  EXPECT_THAT(shown, HasSubstr("starting steps, t = "));
  EXPECT_THAT(shown, HasSubstr(" of 0.04 ("));
  // Each text begins in a cleared line, and the last line is the summary alone.
  const std::string cleared = "\r" + std::string(79, ' ') + "\r";
  EXPECT_THAT(shown, HasSubstr(cleared + "evolve: 4 steps to t = 0.04"));
  for (std::size_t at = shown.find(", t = "); at != std::string::npos; at = shown.find(", t = ", at + 1)) {
    const std::size_t begin = shown.rfind('\r', at);
    ASSERT_NE(begin, std::string::npos);
    EXPECT_EQ(shown.substr(begin + 1 - cleared.size(), cleared.size()), cleared);
    const std::size_t end = shown.find('\r', at);
    EXPECT_LE(end - begin, 80u);
  }
}

TEST(RunProgress, CountsTheSubstepsOfTheStart) {
  // BDF3, 10 steps: 2 starting steps of 16 substeps each, and 8 others.
  const RunProgress progress(1, 2, 0.1, 2, 16);
  EXPECT_NEAR(progress.fraction(1), 0, 1e-12);
  EXPECT_NEAR(progress.fraction(1.05), 8 / 40., 1e-12);
  EXPECT_NEAR(progress.fraction(1.2), 32 / 40., 1e-12);
  EXPECT_NEAR(progress.fraction(1.6), 36 / 40., 1e-12);
  EXPECT_NEAR(progress.fraction(2), 1, 1e-12);
  EXPECT_EQ(RunProgress(0, 0).fraction(0), 1);
  EXPECT_NEAR(RunProgress(1, 3).fraction(2), 0.5, 1e-12);
}

TEST(RunProgress, DurationsAreShort) {
  EXPECT_EQ(duration_text(0.123), "0.12 s");
  EXPECT_EQ(duration_text(12.3), "12 s");
  EXPECT_EQ(duration_text(600), "10 min");
  EXPECT_EQ(duration_text(9000), "2.5 h");
}

}  // namespace
}  // namespace esfem::test_evolve_stop
