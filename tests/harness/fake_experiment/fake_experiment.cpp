// SPDX-License-Identifier: GPL-3.0-or-later
// An experiment without a flow: its errors are the formula h^exponent + tau^3 on a grid of four cells. The
// environment makes a cell fail (FAILING_CELL), run out of memory (MEMORY_CELL), kill its process group
// (KILLING_CELL) or write a file (WRITING_CELL), and all cells wait (MILLISECONDS) or have run before
// (EARLIER_SECONDS). Rows say how many threads the process has.
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "experiments/harness/grid.hpp"
#include "solver/error.hpp"
#include "solver/linalg/node_block_lu.hpp"
#include "solver/thread_count.hpp"

namespace esfem {
namespace {

const HalvedSteps time_steps{0.1, 0.1};

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

int number_in_environment(const char* name) {
  return std::atoi(environment(name).c_str());
}

/// The factorisation of a full matrix: a BLAS that is called has something to do for its threads.
void factorise() {
  const int n = 400;
  SparsityPattern pattern;
  pattern.size = n;
  pattern.column_start = {0};
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) pattern.row.push_back(i);
    pattern.column_start.push_back(pattern.entry_count());
  }
  NodeBlockLu lu(pattern, {{0}});
  lu.factorise([](int, bool, int, int) { return std::rand() % 100; });
}

int threads_of_process() {
  namespace fs = std::filesystem;
  return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
}

Block otherwise(bool) {
  return {{"exponent", 2}, {"degree", 2}, {"level", range(0, 1)}, {"step", range(0, 1)}};
}

void run(const Choice& choice, Row& row, const std::string& folder) {
  row.h = std::pow(2.0, -choice.level());
  row.nodes = std::lround(1 / (row.h * row.h));
  usleep(1000 * number_in_environment("MILLISECONDS"));
  row.seconds = number_in_environment("EARLIER_SECONDS");
  row.errors["u"]["nodal_L2"] = std::pow(row.h, choice.number("exponent")) + std::pow(row.tau, 3);
  if (row.cell == environment("FAILING_CELL"))
    throw NumericsError("step 3, t = 0.3: element 7 is degenerate");
  if (row.cell == environment("MEMORY_CELL")) throw std::bad_alloc();
  if (row.cell == environment("KILLING_CELL")) kill(0, SIGKILL);
  if (row.cell == environment("WRITING_CELL") && !folder.empty()) {
    std::filesystem::create_directories(folder);
    write_file(folder + "/snapshot", "as on the day");
  }
  const int before = threads_of_process();
  factorise();
  row.more["threads_started"] = threads_of_process() - before;
  row.more["threads_of_a_factor"] = thread_count();
}

}  // namespace
}  // namespace esfem

int main(int argc, char** argv) {
  using namespace esfem;
  Experiment experiment("fake_experiment", "none", run, otherwise);
  experiment.help = "Errors h^exponent + tau^3 by formula.\nSample run: fake_experiment --list";
  experiment.grid.axes = {{"exponent", {}, "of h"}};
  experiment.grid.refused = {{"bdf", "the formula has no steps"}};
  experiment.steps = [](const Choice&) { return time_steps; };
  experiment.cost = [](const Choice& choice) {
    return std::pow(4.0, choice.level()) * time_steps.count(choice.step());
  };
  experiment.known_end = [](const Choice& choice) {
    return choice.level() == 0 ? "level 0 is too coarse" : "";
  };
  return run_experiment(experiment, argc, argv);
}
