// SPDX-License-Identifier: GPL-3.0-or-later
// experiments/harness/cell_done, by which `make figures` says how far it has come.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>

#include "tests/harness/evolve_program.hpp"

namespace esfem::test_cell_done {
namespace {

using testing::HasSubstr;

struct CellDone : EvolveProgram {
  const std::string progress = (folder / ".progress").string(), out = (folder / "out.txt").string();

  void SetUp() override {
    EvolveProgram::SetUp();
    std::filesystem::create_directories(folder / "stem");
    std::string list;
    for (int i = 1; i <= 100; ++i) list += format("c%d 2.00\n", i);
    write_file((folder / "stem/.list").string(), list);
    for (int i = 1; i <= 100; ++i)
      write_file((folder / format("stem/c%d.json", i)).string(), "{\n \"seconds\": 2.6,\n}\n");
    // 10 were done before, 110 in all.
    write_file(progress, format("%ld 10 110 200\n", static_cast<long>(std::time(nullptr)) - 100));
  }
  void done(const std::string& cells, const std::string& how = "") const {
    ASSERT_EQ(run_command("for c in " + cells + "; do " + how +
                          " " ESFEM_SOURCE_DIR "/experiments/harness/cell_done " + progress + " stem $c >>" +
                          out + "; done"),
              0);
  }
  std::string said() const {
    std::ifstream stream(out);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(CellDone, WithoutATerminalOneLineForEvery5Percent) {
  done("$(seq -f c%g 1 100)");
  const std::string text = said();
  EXPECT_NEAR(std::count(text.begin(), text.end(), '\n'), 19, 1) << text;
  // 55 of 110: 45 runs of 100 in 100 seconds and a bit, so about 122 s are left.
  EXPECT_THAT(text, HasSubstr("55 of 110 runs (50%), about 2 min left\n"));
  EXPECT_THAT(text, HasSubstr("110 of 110 runs (100%)\n"));
}

TEST_F(CellDone, OnATerminalEachRunHasItsOwnSeconds) {
  if (run_command("script -qec true /dev/null >/dev/null 2>&1") != 0) GTEST_SKIP() << "no pseudo-terminal";
  ASSERT_EQ(run_command("script -qec '" ESFEM_SOURCE_DIR "/experiments/harness/cell_done " + progress +
                        " stem c7' /dev/null >" + out),
            0);
  EXPECT_THAT(said(), HasSubstr("left: stem/c7, 3 s"));
}

TEST_F(CellDone, SideBySideEachIsCountedOnce) {
  ASSERT_EQ(
      run_command("seq -f c%g 1 100 | xargs -P8 -I{} " ESFEM_SOURCE_DIR "/experiments/harness/cell_done " +
                  progress + " stem {} >" + out),
      0);
  const std::string text = said();
  EXPECT_NEAR(std::count(text.begin(), text.end(), '\n'), 19, 1) << text;
  EXPECT_THAT(text, HasSubstr("110 of 110 runs (100%)\n"));
}

}  // namespace
}  // namespace esfem::test_cell_done
