// SPDX-License-Identifier: GPL-3.0-or-later
// Programs that are compiled for another CPU, or against a library that is: `foreign_cpu` asks for extensions
// that only a Xeon Phi of 2017 has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "solver/error.hpp"

namespace esfem::test_cpu_check {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CpuCheck : public testing::Test {
 protected:
  const std::filesystem::path folder = std::filesystem::path(ESFEM_BINARY_DIR) / "test_cpu_check";
  CpuCheck() { std::filesystem::create_directories(folder); }

  /// Exit code of a command, and what it printed on standard error.
  std::pair<int, std::string> run(const std::string& command) const {
    const std::string said = (folder / "said").string();
    const int status = std::system((command + " 2>'" + said + "'").c_str());
    std::ifstream file(said);
    return {WEXITSTATUS(status), std::string(std::istreambuf_iterator<char>(file), {})};
  }
  std::pair<int, std::string> include_pack(int width, const std::string& flags) const;
};

TEST_F(CpuCheck, AnotherCpuIsToldSoInOneLine) {
  const auto [exit_code, said] = run(std::string("'") + ESFEM_BINARY_DIR + "/bin/foreign_cpu'");
#ifdef __x86_64__
  EXPECT_EQ(exit_code, exit_usage);
  EXPECT_THAT(
      said,
      AllOf(HasSubstr("foreign_cpu: this CPU lacks avx5124vnniw, avx5124fmaps, which the program was built"),
            HasSubstr("-DESFEM_NATIVE=OFF")));
  EXPECT_EQ(said.find('\n'), said.size() - 1) << said;
#else
  EXPECT_EQ(exit_code, exit_done) << said;
#endif
}

#ifdef __x86_64__
/// The compiler's messages on a source with these flags that includes the header of Packs, for a library
/// whose Packs have this width.
std::pair<int, std::string> CpuCheck::include_pack(int width, const std::string& flags) const {
  const std::filesystem::path library = folder / ("width_" + std::to_string(width));
  std::filesystem::create_directories(library / "solver");
  std::ofstream(library / "solver/config.hpp") << "#define ESFEM_PACK_SIZE " << width << std::endl;
  std::ofstream(library / "user.cpp") << "#include \"solver/pack.hpp\"" << std::endl;
  // C++17's <algorithm> would look for TBB.
  return run(format("'%s' -std=c++14 -fsyntax-only -o /dev/null %s -I'%s' -I'%s' -isystem '%s' '%s/user.cpp'",
                    ESFEM_COMPILER, flags.c_str(), library.c_str(), ESFEM_SOURCE_DIR, ESFEM_EIGEN_DIR,
                    library.c_str()));
}

TEST_F(CpuCheck, ALibraryServesProgramsOfOtherFlagsWhoseEigenAlignsAlike) {
  for (const auto& [width, flags] : {std::pair(2, "-march=x86-64"),
                                     {4, "-march=x86-64-v3"},
                                     {8, "-march=x86-64-v4"},
                                     {8, "-march=x86-64 -DEIGEN_MAX_ALIGN_BYTES=64"},
                                     {2, "-march=x86-64-v4 -DEIGEN_MAX_ALIGN_BYTES=16"}}) {
    const auto [exit_code, said] = include_pack(width, flags);
    EXPECT_EQ(exit_code, 0) << flags << ": " << said;
  }
  EXPECT_THAT(include_pack(8, "-march=x86-64").second,
              HasSubstr("Eigen must align memory as the library does"));
}
#endif

}  // namespace
}  // namespace esfem::test_cpu_check
