// SPDX-License-Identifier: GPL-3.0-or-later
// An experiment without a flow: its errors are the formula h^2 + tau^3 on a grid of four cells. Its own
// options make a cell fail, run out of memory, write a file, wait, or say how many threads the process has.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "experiments/harness/experiment.hpp"
#include "solver/error.hpp"
#include "solver/linalg/node_block_lu.hpp"
#include "solver/thread_count.hpp"

namespace esfem {
namespace {

struct FakeOptions {
  std::string failing_cell, memory_cell, writing_cell;
  int milliseconds = 0, earlier_seconds = 0;
};

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

Row run(Row row, const std::string& name, const std::string& folder, const FakeOptions& fake) {
  usleep(1000 * fake.milliseconds);
  if (name == fake.failing_cell) throw NumericsError("step 3, t = 0.3: element 7 is degenerate");
  if (name == fake.memory_cell) throw std::bad_alloc();
  if (name == fake.writing_cell && !folder.empty()) {
    std::filesystem::create_directories(folder);
    write_file(folder + "/snapshot", "as on the day");
  }
  row.seconds = fake.earlier_seconds;
  row.nodes = std::lround(1 / (row.h * row.h));
  row.errors["u"]["nodal_L2"] = row.h * row.h + std::pow(row.tau, 3);
  const int before = threads_of_process();
  factorise();
  row.more["threads_started"] = threads_of_process() - before;
  row.more["threads_of_a_factor"] = thread_count();
  return row;
}

std::vector<Cell> cells(const Options& options, const FakeOptions& fake) {
  std::vector<Cell> cells;
  for (const int level : options.levels.value_or(std::vector<int>{0, 1}))
    for (const int k : options.steps.value_or(std::vector<int>{0, 1})) {
      Row planned;
      planned.level = level;
      planned.h = std::pow(2.0, -level);
      planned.tau = 0.1 * std::pow(2.0, -k);
      planned.steps = 1 << k;
      const std::string name = format("h%d_tau%d", level, k);
      cells.push_back(
          {name, std::pow(4.0, level) * planned.steps,
           [=](const Row& row, const std::string& folder) { return run(row, name, folder, fake); }, planned});
    }
  return cells;
}

}  // namespace
}  // namespace esfem

int main(int argc, char** argv) {
  using namespace esfem;
  FakeOptions fake;
  Experiment experiment;
  experiment.stem = "fake_experiment";
  experiment.paper = "none";
  experiment.help = "Errors h^2 + tau^3 by formula.\nSample run: fake_experiment --list";
  experiment.add_options = [&](CommandLine& line) {
    line.group("Fake");
    line.text("--failing-cell", fake.failing_cell, "fails");
    line.text("--memory-cell", fake.memory_cell, "runs out of memory");
    line.text("--writing-cell", fake.writing_cell, "writes a file");
    line.integer("--milliseconds", 0, 60000, fake.milliseconds, "that each cell takes");
    line.integer("--earlier-seconds", 0, 60000, fake.earlier_seconds, "that its earlier processes took");
  };
  experiment.cells = [&](const Options& options) { return cells(options, fake); };
  experiment.parameters = [](const Options& options) {
    return nlohmann::json{{"degree", options.degree.value_or(2)}};
  };
  return run_experiment(experiment, argc, argv);
}
