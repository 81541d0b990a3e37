// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "solver/error.hpp"
#include "tests/fuzz/targets.hpp"

namespace esfem::test_corpora {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

/// Whether the target takes the content without an error; anything but the two kinds of errors ends the test.
bool accepts(const std::string& target, const std::string& content) {
  try {
    fuzz_targets().at(target)(content);
    return true;
  } catch (const InputError&) {
  } catch (const NumericsError&) {
  }
  return false;
}

class Corpus : public testing::TestWithParam<std::string> {};

// `make fuzz` starts from these files, and puts what it finds beside them.
TEST_P(Corpus, IsReadOrRefused) {
  int accepted = 0, refused = 0;
  for (const fs::directory_entry& file :
       fs::directory_iterator(ESFEM_SOURCE_DIR "/tests/fuzz/corpus/" + GetParam())) {
    SCOPED_TRACE(file.path().string());
    const std::string content = content_of(file.path());
    ++(accepts(GetParam(), content) ? accepted : refused);
    // Cut off anywhere, it is no worse.
    for (std::size_t part = 1; part < 16; ++part)
      accepts(GetParam(), content.substr(0, content.size() * part / 16));
  }
  EXPECT_GE(accepted, 1) << "no file that the target accepts: it would never get past the first check";
}

std::vector<std::string> target_names() {
  std::vector<std::string> names;
  for (const auto& [name, target] : fuzz_targets()) names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus, testing::ValuesIn(target_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace esfem::test_corpora
