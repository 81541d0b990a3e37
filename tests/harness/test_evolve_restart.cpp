// SPDX-License-Identifier: GPL-3.0-or-later
// What evolve has computed is not lost: output files are tried beforehand, and stopped and finished runs go
// on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <regex>

#include "experiments/harness/stop_signal.hpp"
#include "tests/harness/evolve_program.hpp"

namespace esfem::test_evolve_restart {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

struct EvolveRestart : EvolveProgram {
  const std::string checkpoint = path("run.checkpoint");

  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string bytes(const std::string& file) const {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  json with_output(const json& output, const json& changes = json::object()) const {
    json all = changes;
    all["output"] = output;
    return config(all);
  }
  /// A run that takes too long to wait for.
  json endless(const json& output) const { return with_output(output, {{"steps", 100000000}}); }
  /// Times of the snapshots in a collection.
  std::vector<double> times(const std::string& pvd) const {
    static const std::regex element("timestep=\"([^\"]*)\"");
    const std::string text = bytes(pvd);
    std::vector<double> found;
    for (std::sregex_iterator match(text.begin(), text.end(), element), end; match != end; ++match)
      found.push_back(std::stod((*match)[1]));
    return found;
  }
  /// Nodal values and series without their provenance.
  json results() const {
    json all = {read_json(nodal), read_json(series)};
    for (json& file : all)
      for (const char* key : {"provenance", "config"}) file.erase(key);
    return all;
  }
  json results_without_checkpoint(const json& changes) {
    EXPECT_EQ(run(config(changes)), exit_done) << message;
    return results();
  }
};

TEST_F(EvolveRestart, MakesTheFoldersOfItsOutput) {
  const json output = {{"nodal", path("a/b/end.json")},
                       {"series", path("a/c/series.json")},
                       {"vtu", path("d/run.pvd")},
                       {"checkpoint", path("e/run.checkpoint")}};
  ASSERT_EQ(run(with_output(output)), exit_done) << message;
  for (const auto& [key, file] : output.items())
    EXPECT_TRUE(fs::is_regular_file(file.get<std::string>())) << file;
}

TEST_F(EvolveRestart, RefusesWhatItCannotWriteBeforeTheFirstStep) {
  fs::create_directories(folder / "folder.pvd");
  write_file(path("file"), "somebody's");
  for (const char* key : {"nodal", "series", "checkpoint", "vtu"}) {
    EXPECT_EQ(run(endless({{key, path("folder.pvd")}})), exit_usage) << key;
    EXPECT_THAT(message, AllOf(HasSubstr("folder.pvd: cannot be written"), HasSubstr("it is a folder")))
        << key;
    EXPECT_EQ(run(endless({{key, path("file/run.pvd")}})), exit_usage) << key;
    EXPECT_THAT(message, HasSubstr("file: this folder cannot be made")) << key;
    EXPECT_EQ(run(endless({{key, ""}})), exit_usage) << key;
    EXPECT_THAT(message, HasSubstr(std::string("found ") + key + " = \"\"")) << key;
  }
  EXPECT_EQ(bytes(path("file")), "somebody's");
}

TEST_F(EvolveRestart, RefusesWriteProtectedFiles) {
  root_heeds_permissions = true;
  write_file(series, "somebody's");
  fs::permissions(series, fs::perms::owner_read);
  EXPECT_EQ(run(endless(json::object())), exit_usage);
  EXPECT_THAT(message, HasSubstr("Permission denied"));
  EXPECT_EQ(bytes(series), "somebody's");
}

TEST_F(EvolveRestart, WritesNoFileOverAnother) {
  EXPECT_EQ(run(endless({{"series", nodal}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("which is nodal"));
  EXPECT_EQ(run(endless({{"checkpoint", path("a/../series.json")}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("which is series"));
  fs::copy_file(std::string(ESFEM_SOURCE_DIR) + "/reference/independent/sphere_radius2_162.msh",
                path("mesh.msh"));
  json from_mesh = endless({{"nodal", path("mesh.msh")}});
  from_mesh["mesh"] = {{"file", path("mesh.msh")}};
  from_mesh["surface"]["radius"] = 2;
  EXPECT_EQ(run(from_mesh), exit_usage);
  EXPECT_THAT(message, HasSubstr("which is the mesh"));
  EXPECT_EQ(run(endless({{"nodal", path("config.json")}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("which is the configuration"));
}

TEST_F(EvolveRestart, AFullDiskLosesNothingElse) {
  EXPECT_EQ(run(with_output({{"series", "/dev/full"}, {"checkpoint", checkpoint}})), exit_usage);
  EXPECT_THAT(message, AllOf(HasSubstr("/dev/full: cannot be written: No space left"),
                             HasSubstr("the same command resumes from " + checkpoint)));
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  EXPECT_EQ(read_json(nodal).at("t"), 0.04);
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}})), exit_done) << message;
  EXPECT_EQ(read_json(series).at("t").size(), 5u);
}

TEST_F(EvolveRestart, ProlongsAFinishedRun) {
  const json expected = results_without_checkpoint({{"steps", 9}});
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}})), exit_done) << message;
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}}, {{"steps", 9}})), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("run.checkpoint: the run resumes from this checkpoint, step 4, t = 0.04"));
  EXPECT_EQ(results(), expected);
}

TEST_F(EvolveRestart, ProlongsAFinishedRunWithAdaptiveSteps) {
  for (const char* flow : {"mean_curvature", "willmore", "bgn"}) {
    const auto until = [&](double end) {
      return json{{"flow", flow},
                  {"tau", nullptr},
                  {"steps", nullptr},
                  {"bdf", nullptr},
                  {"adaptive", {{"end_time", end}, {"first_step", 1e-4}}}};
    };
    fs::remove(checkpoint);
    const json expected = results_without_checkpoint(until(0.03));
    ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}}, until(0.01))), exit_done) << message;
    EXPECT_EQ(read_json(nodal).at("t"), 0.01);
    ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}}, until(0.03))), exit_done) << message;
    EXPECT_THAT(message, HasSubstr("resumes from this checkpoint"));
    EXPECT_EQ(results(), expected) << flow;
  }
}

TEST_F(EvolveRestart, GoesOnWithOtherOutputs) {
  const json expected = results_without_checkpoint({{"steps", 8}});
  const std::string pvd = path("run.pvd"), other = path("other.pvd");
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}, {"series", nullptr}, {"vtu", pvd}, {"every", 2}},
                            {{"steps", 5}})),
            exit_done)
      << message;
  ASSERT_EQ(
      run(with_output({{"checkpoint", checkpoint}, {"vtu", pvd}, {"every", 1}, {"times", {0.01, 0.065}}},
                      {{"steps", 8}})),
      exit_done)
      << message;
  EXPECT_EQ(results(), expected);
  EXPECT_THAT(times(pvd), ElementsAre(0, 0.02, 0.04, 0.05, 0.06, 0.07, 0.08));
  const std::string list = bytes(pvd);
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}, {"vtu", other}}, {{"steps", 9}})), exit_done)
      << message;
  EXPECT_THAT(times(other), ElementsAre(0.08, 0.09));
  EXPECT_EQ(bytes(pvd), list);
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}, {"vtu", pvd}}, {{"steps", 10}})), exit_done)
      << message;
  EXPECT_EQ(times(pvd).size(), 8u) << "those of the first run and the end";
}

TEST_F(EvolveRestart, TheNameOfTheMeshFileDoesNotMatter) {
  const std::string mesh = std::string(ESFEM_SOURCE_DIR) + "/reference/independent/sphere_radius2_162.msh";
  const auto from = [&](const std::string& file, int steps) {
    json all = with_output({{"checkpoint", checkpoint}}, {{"steps", steps}});
    all["mesh"] = {{"file", file}};
    all["surface"]["radius"] = 2;
    return all;
  };
  ASSERT_EQ(run(from(mesh, 3)), exit_done) << message;
  fs::copy_file(mesh, path("renamed.msh"));
  ASSERT_EQ(run(from(path("renamed.msh"), 4)), exit_done) << message;
  EXPECT_THAT(message, HasSubstr("resumes from this checkpoint"));
}

TEST_F(EvolveRestart, SaysWhyACheckpointDoesNotServeAndLeavesIt) {
  ASSERT_EQ(run(with_output({{"checkpoint", checkpoint}})), exit_done) << message;
  const std::string kept = bytes(checkpoint), written = bytes(nodal);
  const std::vector<std::pair<json, std::string>> other = {
      {{{"tau", 0.02}}, "another tau (it has 0.01, 0.02 is asked for)"},
      {{{"bdf", 3}}, "another order (it has 2, 3 is asked for)"},
      {{{"degree", 1}}, "another degree (it has 2, 1 is asked for)"},
      {{{"mesh", {{"subdivisions", 2}}}}, "another mesh"},
      {{{"surface", {{"radius", 2}}}}, "another radius in surface (it has 1, 2 is asked for)"},
      {{{"variant", {{"normalise", true}}}}, "another variant"},
      {{{"flow", "dziuk"}}, "another flow (it has \"mean_curvature\", \"dziuk\" is asked for)"},
      {{{"steps", 3}}, "it is at step 4, 3 steps are asked for"}};
  for (const auto& [changes, why] : other) {
    json all = {{"steps", 100000000}};
    all.merge_patch(changes);
    EXPECT_EQ(run(with_output({{"checkpoint", checkpoint}}, all)), exit_usage) << changes;
    EXPECT_THAT(message, AllOf(HasSubstr("run.checkpoint: this checkpoint cannot be used: "), HasSubstr(why),
                               HasSubstr("remove it")));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
    EXPECT_EQ(bytes(checkpoint), kept);
    EXPECT_EQ(bytes(nodal), written);
  }
  write_file(checkpoint, kept.substr(0, kept.size() - 1));
  EXPECT_EQ(run(with_output({{"checkpoint", checkpoint}})), exit_usage);
  EXPECT_THAT(message, HasSubstr("it is damaged, or no checkpoint"));
}

TEST_F(EvolveRestart, ASignalStopsItAfterTheStepAndItGoesOn) {
  const auto until = [&](int steps) {
    return with_output({{"checkpoint", checkpoint}, {"vtu", path("run.pvd")}, {"times", {3e-6}}},
                       {{"tau", 1e-6}, {"steps", steps}});
  };
  for (const int number : {SIGTERM, SIGINT}) {
    for (const std::string& file : {checkpoint, path("run.pvd")}) fs::remove(file);
    write_file(path("endless.json"), until(100000000).dump());
    const pid_t process = fork();
    if (process == 0) {
      signal(SIGINT, SIG_DFL);  // a shell may have started the tests with it ignored
      std::freopen(path("errors.txt").c_str(), "w", stderr);
      const std::string program = std::string(ESFEM_BINARY_DIR) + "/bin/evolve";
      execl(program.c_str(), program.c_str(), path("endless.json").c_str(), nullptr);
      _exit(127);
    }
    // Two snapshots show that the starting steps are done.
    const auto has_started = [&] {
      if (!fs::exists(path("run.pvd"))) return false;
      const std::string list = bytes(path("run.pvd"));
      return list.find("<DataSet") != list.rfind("<DataSet");
    };
    for (int i = 0; i < 2000 && !has_started(); ++i) usleep(10000);
    EXPECT_TRUE(has_started());
    kill(process, number);
    int status = 0;
    waitpid(process, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), number == SIGTERM ? 143 : 130);
    const std::string name = number == SIGTERM ? "SIGTERM" : "SIGINT";
    EXPECT_THAT(bytes(path("errors.txt")), AllOf(HasSubstr("stopped by signal " + name + " at t = "),
                                                 HasSubstr("resumes from " + checkpoint)));
    const json stopped = read_json(series);
    EXPECT_THAT(stopped.at("status").get<std::string>(), HasSubstr("stopped by signal " + name));
    const int done = static_cast<int>(stopped.at("t").size()) - 1;
    EXPECT_EQ(read_json(nodal).at("t"), stopped.at("t").back());
    const json plain = {{"tau", 1e-6}, {"steps", done + 3}};
    const json expected = results_without_checkpoint(plain);
    ASSERT_EQ(run(until(done + 3)), exit_done) << message;
    EXPECT_THAT(message, HasSubstr(format("step %d,", done)));
    EXPECT_EQ(results(), expected);
  }
}

TEST(StopSignalDeathTest, TheFirstIsNotedAndTheSecondEndsTheProcess) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto first = [] {
    note_stop_signals();
    raise(SIGTERM);
    _exit(stop_signal() == SIGTERM ? 42 : 0);
  };
  EXPECT_EXIT(first(), testing::ExitedWithCode(42), "a second signal ends the run at once");
  const auto second = [] {
    signal(SIGINT, SIG_DFL);
    note_stop_signals();
    raise(SIGTERM);
    raise(SIGINT);
    _exit(0);
  };
  EXPECT_EXIT(second(), testing::KilledBySignal(SIGINT), "");
  const auto ignored = [] {
    signal(SIGINT, SIG_IGN);
    note_stop_signals();
    raise(SIGINT);
    raise(SIGINT);
    _exit(stop_signal() == 0 ? 42 : 0);
  };
  EXPECT_EXIT(ignored(), testing::ExitedWithCode(42), "");
}

}  // namespace
}  // namespace esfem::test_evolve_restart
