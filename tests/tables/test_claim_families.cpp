// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solver/error.hpp"
#include "solver/tables/claim_families.hpp"
#include "solver/tables/claims.hpp"

namespace esfem::test_claim_families {
namespace {

using nlohmann::json;
using testing::AllOf, testing::HasSubstr;

json orders() {
  return {{"id", "{quantity}-p{degree}-bdf{bdf}"},
          {"statement", "P{degree}, BDF{bdf}: order {degree + 1} in h of {quantity}"},
          {"for", {{"quantity", {"x", "nu"}}, {"degree", {1, 2, 3}}, {"bdf", 4}}},
          {"source", {{"paper", "kll19"}, {"place", "Theorem 6.1"}, {"basis", "theory"}}},
          {"kind", "order"},
          {"quantity", "{quantity}"},
          {"norm", "lifted_L2"},
          {"variable", "h"},
          {"expected", "{degree + 1}"},
          {"tolerance", 0.3},
          {"where", {{"degree", "{degree}"}, {"bdf", "{bdf}"}, {"flow", "dziuk"}}},
          {"presets", json::array({"paper"})}};
}

Reference read(const json& family) {
  return reference_from_json({{"experiment", "e"}, {"paper", "kll19"}, {"claims", {family}}}, "r.json");
}

const Claim& member(const Reference& reference, const std::string& id) {
  for (const Claim& claim : reference.claims)
    if (claim.id == id) return claim;
  throw InputError("no claim " + id);
}

TEST(ClaimFamilies, HaveAMemberForEachCombination) {
  const Reference reference = read(orders());
  EXPECT_EQ(reference.claims.size(), 6u);
  const Claim& claim = member(reference, "nu-p3-bdf4");
  EXPECT_EQ(claim.statement, "P3, BDF4: order 4 in h of nu");
  EXPECT_EQ(claim.quantity, "nu");
  EXPECT_EQ(claim.expected, 4);
  EXPECT_EQ(claim.where.dump(), R"({"bdf":4,"degree":3,"flow":"dziuk"})") << "numbers stay numbers";
}

TEST(ClaimFamilies, SayWhatTheirMembersSayTogether) {
  const Reference reference = read(orders());
  ASSERT_EQ(reference.families.size(), 1u);
  EXPECT_EQ(reference.families.begin()->first, "{quantity}-p{degree}-bdf{bdf}");
  EXPECT_EQ(reference.families.begin()->second, "P1..3, BDF4: order 2..4 in h of x, nu");
  for (const Claim& claim : reference.claims) EXPECT_EQ(claim.family, "{quantity}-p{degree}-bdf{bdf}");
}

TEST(ClaimFamilies, OfSeveralBlocksHaveTheMembersOfAll) {
  json family = orders();
  family["for"] = {{{"quantity", "x"}, {"degree", {1, 2}}, {"bdf", {1, 2, 5}}},
                   {{"quantity", "nu"}, {"degree", 4}, {"bdf", 3}}};
  EXPECT_EQ(read(family).claims.size(), 7u);
  EXPECT_EQ(read(family).families.begin()->second, "P1, 2, 4, BDF1, 2, 3, 5: order 2, 3, 5 in h of x, nu");
}

TEST(ClaimFamilies, ExceptionsAreOfTheMembersThatHaveTheirValues) {
  json family = orders();
  family["except"] = {{{"when", {{"degree", 1}}}, {"source", {{"basis", "finding"}}}},
                      {{"when", {{"degree", json::array({1, 7})}, {"quantity", "nu"}}},
                       {"tolerance", 0.8},
                       {"remark", "P{degree} only"},
                       {"presets", nullptr}}};
  const Reference reference = read(family);
  EXPECT_EQ(member(reference, "x-p1-bdf4").basis, "finding");
  EXPECT_EQ(member(reference, "x-p1-bdf4").place, "Theorem 6.1") << "the other keys of an object stay";
  EXPECT_EQ(member(reference, "x-p1-bdf4").tolerance, 0.3);
  EXPECT_EQ(member(reference, "nu-p1-bdf4").basis, "finding");
  EXPECT_EQ(member(reference, "nu-p1-bdf4").tolerance, 0.8);
  EXPECT_EQ(member(reference, "nu-p1-bdf4").remark, "P1 only");
  EXPECT_TRUE(member(reference, "nu-p1-bdf4").presets.empty()) << "null removes";
  EXPECT_EQ(member(reference, "nu-p2-bdf4").basis, "theory");
}

std::string reading(const json& changes) {
  json family = orders();
  family.update(changes);
  try {
    read(family);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ClaimFamilies, ReadingNamesWhatIsWrong) {
  const auto with_exception = [](const json& exception) {
    return reading({{"except", json::array({exception})}});
  };
  EXPECT_THAT(with_exception({{"when", {{"degree", 4}}}, {"tolerance", 1}}),
              AllOf(HasSubstr("r.json, claim 1, except"), HasSubstr("no member has {\"degree\":4}")));
  EXPECT_THAT(with_exception({{"when", {{"dgree", 1}}}, {"tolerance", 1}}), HasSubstr("no member has"));
  EXPECT_THAT(with_exception({{"when", json::object()}, {"tolerance", 1}}), HasSubstr("no member has"));
  EXPECT_THAT(with_exception({{"tolerance", 1}}), HasSubstr("'when' is missing"));
  EXPECT_THAT(with_exception({{"when", {{"degree", 1}}}}), HasSubstr("other keys beside 'when'"));
  EXPECT_THAT(with_exception({{"when", {{"degree", 1}}}, {"id", "a"}}), HasSubstr("'id' is the same"));
  EXPECT_THAT(with_exception({{"when", {{"degree", 1}}}, {"tolerence", 1}}),
              HasSubstr("unknown key 'tolerence'"));
  EXPECT_THAT(with_exception(1), HasSubstr("expected a JSON object"));

  EXPECT_THAT(reading({{"remark", "{dgree}"}}),
              AllOf(HasSubstr("{dgree}: expected a name of 'for': bdf, degree, quantity")));
  EXPECT_THAT(reading({{"remark", "{quantity + 1}"}}), HasSubstr("{degree + 1}"));
  for (const char* broken : {"{degree + }", "{degree +1}", "{degree * 2}", "{degree + 12}", "{degree }"})
    EXPECT_THAT(reading({{"remark", broken}}), HasSubstr(broken));
  EXPECT_THAT(reading({{"remark", "P{degree"}}), HasSubstr("is not closed"));
  EXPECT_THAT(
      reading({{"id", "{quantity}-p{degree}"}, {"for", {{"quantity", "x"}, {"degree", {1, 1}}, {"bdf", 1}}}}),
      HasSubstr("'x-p1' occurs twice"));
  EXPECT_THAT(reading({{"expected", "bdf"}}), HasSubstr("'expected': expected a number"));
  const json twice = {{"experiment", "e"}, {"paper", "p"}, {"claims", {orders(), orders()}}};
  EXPECT_THROW(reference_from_json(twice, "r.json"), InputError);
}

TEST(ClaimFamilies, ReadingTakesNamesWithValuesOnly) {
  const auto with_for = [](const json& given) { return reading({{"for", given}}); };
  EXPECT_THAT(with_for(3), HasSubstr("claim 1, for: expected names with their values, found 3"));
  EXPECT_THAT(with_for(json::object()), HasSubstr("expected names"));
  EXPECT_THAT(with_for(json::array()), HasSubstr("no member"));
  EXPECT_THAT(with_for({{"degree", json::array()}}), HasSubstr("no member"));
  EXPECT_THAT(with_for({{"degree", {1, nullptr}}}),
              HasSubstr("'degree': expected a string or a finite number"));
  EXPECT_THAT(with_for({{{"degree", 1}, {"bdf", 1}, {"quantity", "x"}}, {{"degree", 1}}}),
              HasSubstr("found the names degree beside bdf, degree, quantity"));
  json many = json::array();
  for (int i = 0; i < 40; ++i) many.push_back(i);
  EXPECT_THAT(with_for({{"degree", many}, {"bdf", many}, {"quantity", "x"}}),
              HasSubstr("at most 1000 members"));
}

}  // namespace
}  // namespace esfem::test_claim_families
