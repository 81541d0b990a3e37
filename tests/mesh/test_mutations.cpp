// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever stands in a file, it is a sound surface or an InputError: no crash, no hang, no memory for what a
// head announces.
#include <gmock/gmock.h>

#include <random>

#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_mutations {

namespace {

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : random() % n;
}

/// The first and the one past the last character of a random word.
std::pair<std::size_t, std::size_t> some_word(Random& random, const std::string& text) {
  const char* blanks = " \n";
  const std::size_t first = std::min(text.find_first_not_of(blanks, below(random, text.size())), text.size());
  return {first, std::min(text.find_first_of(blanks, first), text.size())};
}

std::string mutated(Random& random, std::string text) {
  const char* words[] = {"nan", "-1", "1e308", "1e-308", "4000000000", "9223372036854775807",
                         "",    "x",  "0",     "\\",     "#",          "\t\r"};
  for (std::size_t changes = 1 + below(random, 3); changes > 0; --changes) {
    const std::size_t at = below(random, text.size()), length = below(random, 60);
    const auto [first, last] = some_word(random, text);
    switch (below(random, 7)) {
    case 0:
      if (!text.empty()) text[at] = char(below(random, 256));
      break;
    case 1:
      if (!text.empty()) text[at] = char(text[at] ^ (1 << below(random, 8)));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(at, text.substr(below(random, text.size()), length));
      break;
    case 4:
      text.resize(at);
      break;
    case 5:
      text.replace(first, last - first, words[below(random, std::size(words))]);
      break;
    default:
      text.replace(first, last - first, std::to_string(below(random, 20)));
    }
  }
  return text;
}

struct Start {
  const char* name;
  MeshFile (*parse)(const std::string&, const std::string&);
  std::string text;
};
void PrintTo(const Start& start, std::ostream* out) {
  *out << start.name;
}

const std::string cube =
    "OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 3 2 1 0\n4 4 5 6 7\n"
    "4 0 1 5 4 1 0 0\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
const Start starts[] = {{"off", parse_off, off(octasphere(1, 0))},
                        {"off_polygons", parse_off, cube},
                        {"obj", parse_obj, obj(triangle_soup(octasphere(1, 0)))},
                        {"ply", parse_ply, ply(octasphere(1, 0))},
                        {"ply_binary", parse_ply, binary_ply(octasphere(1, 0))},
                        {"stl", parse_stl, stl(octasphere(1, 0))},
                        {"stl_binary", parse_stl, binary_stl(octasphere(1, 0))}};

}  // namespace

class Mutations : public testing::TestWithParam<Start> {};
INSTANTIATE_TEST_SUITE_P(All, Mutations, testing::ValuesIn(starts),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(Mutations, AreReadOrRefused) {
  Random random(7);
  int read = 0, refused = 0;
  for (int i = 0; i < 500; ++i) {
    const std::string text = mutated(random, GetParam().text);
    try {
      MeshFile file = GetParam().parse("a", text);
      repair_and_check(file);
      ++read;
      EXPECT_TRUE(file.mesh.nodes.allFinite());
      EXPECT_TRUE(closed_and_oriented(file.mesh)) << text;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).rfind("a: ", 0), 0u) << error.what();
    }
  }
  EXPECT_GT(read, 5);
  EXPECT_GT(refused, 100);
}

}  // namespace esfem::test_mutations
