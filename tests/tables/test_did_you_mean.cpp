// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "solver/did_you_mean.hpp"

namespace esfem::test_did_you_mean {
namespace {

TEST(DidYouMean, NamesTheOneThatIsClose) {
  const std::vector<std::string> known = {"edge_length", "file", "tau", "steps", "sin", "min", "u1", "u2"};
  const auto suggestion = [&](const char* unknown) { return did_you_mean(unknown, known); };
  EXPECT_EQ(suggestion("taw"), "; did you mean \"tau\"?");
  EXPECT_EQ(suggestion("edge_lenght"), "; did you mean \"edge_length\"?");
  EXPECT_EQ(suggestion("edgelengt"), "; did you mean \"edge_length\"?");
  EXPECT_EQ(suggestion("Sin"), "; did you mean \"sin\"?");
  EXPECT_EQ(suggestion("edgelen"), "") << "too far";
  EXPECT_EQ(suggestion("u3"), "") << "two are as close";
  EXPECT_EQ(suggestion("x"), "") << "no letter is right";
  EXPECT_EQ(suggestion(""), "");
}

}  // namespace
}  // namespace esfem::test_did_you_mean
