// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/disjoint_sets.hpp"

namespace esfem::test_disjoint_sets {
namespace {

TEST(DisjointSets, AreCountedInTheOrderOfTheirLeastMembers) {
  DisjointSets sets(7);
  EXPECT_EQ(sets.count(), 7);
  sets.unite(6, 4);
  sets.unite(1, 5);
  sets.unite(4, 2);
  sets.unite(2, 6);
  EXPECT_THAT(sets.numbered(), testing::ElementsAre(0, 1, 2, 3, 2, 1, 2));
  EXPECT_EQ(sets.count(), 4);
  EXPECT_EQ(DisjointSets(0).count(), 0);
}

}  // namespace
}  // namespace esfem::test_disjoint_sets
