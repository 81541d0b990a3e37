// SPDX-License-Identifier: GPL-3.0-or-later
// The grammar of OFF files: what is read, and what is refused with its line.
#include <gmock/gmock.h>

#include "tests/mesh/mesh_files.hpp"

namespace esfem::test_read_off {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

namespace {

const Mesh ellipsoid = small_ellipsoid();
const std::string plain = off(ellipsoid);

/// The file with another head than "OFF\n42 80 0\n".
std::string with_head(const std::string& head) {
  return replaced(plain, "OFF\n42 80 0\n", head);
}

/// The file with more words behind each node.
std::string with_more(const std::string& head, const std::string& more) {
  std::string text = head;
  for (int i = 0; i < 42; ++i) text += coordinates(ellipsoid.nodes, i) + more + "\n";
  for (int e = 0; e < 80; ++e) text += "3 " + corners(ellipsoid, e, 0) + "\n";
  return text;
}

std::string complaint(const std::string& text) {
  return complaint_of(parse_off, text);
}

}  // namespace

TEST(ReadOff, Heads) {
  EXPECT_EQ(expect_small_ellipsoid(parse_off, plain), "");
  for (const char* head : {"OFF 42 80 0\n", "OFF42 80 0\n", "42 80 0\n", "OFF\n42 80\n", "OFF 42 80\n",
                           "OFF42 80\n", "OFF\n42\n80\n0\n", "OFF\n42 80\n120\n",
                           "# made by hand\n\nOFF # a keyword\n# counts\n42 80 0 # edges\n#\n",
                           "\xEF\xBB\xBFOFF\n42 80 0\n", "OFF\r\n42 80 0\r\n"})
    expect_small_ellipsoid(parse_off, with_head(head));
}

TEST(ReadOff, NormalsColoursAndTextures) {
  expect_small_ellipsoid(parse_off, with_more("NOFF\n42 80 0\n", " 0 nan 1"));
  expect_small_ellipsoid(parse_off, with_more("COFF\n42 80 0\n", " 255 0 0 255"));
  expect_small_ellipsoid(parse_off, with_more("COFF\n42 80 0\n", " 0.5 0 1"));
  expect_small_ellipsoid(parse_off, with_more("STOFF\n42 80 0\n", " 0.5 0.5"));
  for (const char* keyword : {"NCOFF", "CNOFF"})
    expect_small_ellipsoid(parse_off, with_more(std::string(keyword) + "\n42 80 0\n", " 0 0 1 9 9 9 255"));
  expect_small_ellipsoid(parse_off, with_more("STCNOFF\n42 80 0\n", " 0 0 1 9 9 9 255 0 1"));
  EXPECT_THAT(complaint(with_more("NOFF\n42 80 0\n", " 0 1")),
              StartsWith("a: line 3: 2 more words found, 3 to 3 numbers expected (normal"));
  EXPECT_THAT(complaint(with_more("COFF\n42 80 0\n", " red green blue")),
              StartsWith("a: line 3: 'red' found"));
  EXPECT_THAT(complaint(with_more("OFF\n42 80 0\n", " 0 0 1")),
              HasSubstr("line 3 has 6 numbers, 3 coordinates"));
}

TEST(ReadOff, ColoursOfElements) {
  const auto with_colour = [](const std::string& colour) {
    std::string text = plain.substr(0, plain.find("\n3 ") + 1);
    for (int e = 0; e < 80; ++e) text += "3 " + corners(ellipsoid, e, 0) + colour + "\n";
    return text;
  };
  for (const char* colour : {" 7", " 255 0 0", " 0.1 0.2 0.3 1", "  # none"})
    expect_small_ellipsoid(parse_off, with_colour(colour));
  EXPECT_THAT(complaint(with_colour(" red")), StartsWith("a: line 45: 'red' found"));
  EXPECT_THAT(complaint(with_colour(" 1 2 3 4 5")), StartsWith("a: line 45: 5 more words found"));
  EXPECT_THAT(complaint(plain + "3 0 1 2\n"), StartsWith("a: line 125: '3' found after the last element"));
}

TEST(ReadOff, EndsOfLinesAreBlanks) {
  std::string words = with_head("OFF 42 80 0\n");
  const std::size_t nodes_end = words.find("\n3 ");
  for (std::size_t i = 0; i < nodes_end; ++i)
    if (words[i] == '\n') words[i] = ' ';
  expect_small_ellipsoid(parse_off, words);
  expect_small_ellipsoid(parse_off, replaced_all(plain, " ", "\n\t"));
}

TEST(ReadOff, RefusesOtherSpaces) {
  for (const char* head : {"4OFF\n42 80 0\n", "nOFF\n3\n42 80 0\n", "4nOFF 4\n42 80 0\n"})
    EXPECT_THAT(complaint(with_head(head)),
                AllOf(StartsWith("a: line 1: keyword "), HasSubstr("3 coordinates")));
  EXPECT_THAT(complaint(with_head("XOFF\n42 80 0\n")), StartsWith("a: line 1: no OFF file"));
  EXPECT_THAT(complaint(with_head("42 80\n")), StartsWith("a: line 1: no OFF file"));
}

TEST(ReadOff, NamesTheLine) {
  const std::string x = coordinates(ellipsoid.nodes, 1);
  EXPECT_THAT(complaint(replaced(plain, x, "0.1 0.2 0.03D+01")), StartsWith("a: line 4: '0.03D+01' found"));
  EXPECT_THAT(complaint(replaced(plain, x, "0.1 0.2 1e400")), StartsWith("a: line 4: '1e400' found"));
  EXPECT_THAT(complaint(replaced(plain, x, "0.1 0.2 nan")), StartsWith("a: line 4: coordinate 'nan'"));
  EXPECT_THAT(complaint(replaced(plain, x, "0.1 0.2 +-1")), StartsWith("a: line 4: '+-1' found"));
  // Every later word is read in the place of the one before, so the message names the first short line, too.
  EXPECT_THAT(complaint(replaced(plain, x, "0.1 0.2")), HasSubstr("line 4 has 2 numbers, 3 coordinates"));
  const std::string element = "\n3 " + corners(ellipsoid, 1, 0);
  EXPECT_THAT(complaint(replaced(plain, element, "\n3 7.7 1 2")), StartsWith("a: line 46: '7.7' found"));
  EXPECT_THAT(complaint(replaced(plain, element, "\n3 7 1 42")),
              StartsWith("a: line 46: corner 42, out of range: 0 to 41"));
  EXPECT_THAT(complaint(replaced(plain, element, "\n2 7 1")), StartsWith("a: line 46: 2 corners"));
  EXPECT_THAT(complaint(replaced(plain, element, "\n99999999999 7 1 2")), StartsWith("a: line "));
  EXPECT_THAT(complaint(with_head("OFF\n42 81 0\n")), StartsWith("a: line 124: the file ends here"));
  EXPECT_THAT(complaint(with_head("OFF\n42 79 0\n")),
              StartsWith("a: line 124: '3' found after the last element"));
  EXPECT_THAT(complaint(with_head("OFF\n42000000000 80 0\n")), StartsWith("a: line "));
  EXPECT_THAT(complaint(with_head("OFF\n-42 80 0\n")), StartsWith("a: line 2: -42 found"));
}

TEST(ReadOff, Binary) {
  for (const std::string keyword : {"OFF", "COFF", "NOFF", "STOFF"}) {
    std::string text = keyword + " BINARY\n";
    for (std::int32_t n : {42, 80, 0}) put(text, n, true);
    const int more = keyword == "COFF" ? 4 : keyword == "NOFF" ? 3 : keyword == "STOFF" ? 2 : 0;
    for (int i = 0; i < 42; ++i) {
      for (int j = 0; j < 3; ++j) put(text, float(ellipsoid.nodes(i, j)), true);
      for (int j = 0; j < more; ++j) put(text, 0.5f, true);
    }
    for (int e = 0; e < 80; ++e) {
      put(text, std::int32_t(3), true);
      for (int i = 0; i < 3; ++i) put(text, std::int32_t(ellipsoid.elements(e, i)), true);
      put(text, std::int32_t(e % 2), true);
      if (e % 2) put(text, 0.5f, true);
    }
    expect_small_ellipsoid(parse_off, text, 1e-7);
    EXPECT_THAT(complaint(text + "more"), HasSubstr("bytes after the last element"));
    for (std::size_t size = keyword.size() + 8; size < text.size(); size += 37)
      EXPECT_THAT(complaint(text.substr(0, size)), StartsWith("a: byte "));
  }
}

}  // namespace esfem::test_read_off
