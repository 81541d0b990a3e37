// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>

#include "experiments/harness/command_line.hpp"
#include "experiments/harness/experiment.hpp"
#include "solver/error.hpp"

namespace esfem::test_guarded_main {
namespace {

template <class Error>
std::pair<int, std::string> guarded(const Error& error) {
  testing::internal::CaptureStderr();
  const int exit_code = guarded_main([&]() -> int { throw error; });
  return {exit_code, testing::internal::GetCapturedStderr()};
}

TEST(GuardedMain, MapsErrorsToExitCodesAndOneLine) {
  using testing::Pair;
  EXPECT_THAT(guarded(InputError("a.msh:3: cut off")), Pair(1, "test_harness: a.msh:3: cut off\n"));
  EXPECT_THAT(guarded(NumericsError("step 3: nan")), Pair(2, "test_harness: step 3: nan\n"));
  EXPECT_THAT(guarded(std::bad_alloc()), Pair(2, "test_harness: out of memory\n"));
  EXPECT_THAT(guarded(std::out_of_range("map::at")), Pair(2, "test_harness: unexpected error: map::at\n"));
}

TEST(GuardedMain, ReturnsWhatTheBodyReturns) {
  EXPECT_EQ(guarded_main([] { return int(exit_claim); }), 3);
}

TEST(ParseList, ReadsNumbersAndRanges) {
  EXPECT_EQ(parse_list("0,1,2", "--levels"), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(parse_list("0-2,5", "--levels"), (std::vector<int>{0, 1, 2, 5}));
  EXPECT_EQ(parse_list("3-3", "--levels"), (std::vector<int>{3}));
}

TEST(ParseList, RefusesWhatIsNotAList) {
  for (const char* text : {"", ",", "1,", "a", "1-", "-1", "2-1", "1 2", "1.5", "1-2-3", "99999999999"})
    EXPECT_THROW(parse_list(text, "--levels"), InputError) << text;
}

}  // namespace
}  // namespace esfem::test_guarded_main
