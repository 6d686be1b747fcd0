// SPDX-License-Identifier: Apache-2.0
#include "wire/named_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "wire/options.h"

namespace weft::wire {
namespace {

const NamedOption& option(std::string_view name) {
  const auto& all = named_options();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name() == name; });
  EXPECT_NE(found, all.end()) << name;
  return *found;
}

TEST(NamedOptions, HaveNamesAndVariablesOfTheirOwnAndSayWhatTheyAre) {
  std::set<std::string> names;
  std::set<std::string> variables;
  for (const NamedOption& each : named_options()) {
    EXPECT_TRUE(names.insert(each.name()).second) << each.name();
    EXPECT_TRUE(variables.insert(each.annotation.variable()).second) << each.name();
    EXPECT_FALSE(each.annotation.about().empty()) << each.path;
    EXPECT_FALSE(each.annotation.about().ends_with('.')) << each.path;
    EXPECT_EQ(each.annotation.unit().empty(), each.is_switch()) << each.path;
  }
  EXPECT_EQ(option("max-triangles").annotation.variable(), "WEFT_CLIENT_MAX_TRIANGLES");
  EXPECT_EQ(option("min-angle").annotation.variable(), "WEFT_MIN_ANGLE");
}

// What a file or a size gives has names of its own.
TEST(NamedOptions, AreAllOptionsOfTheLibraryThatAreNotGivenOtherwise) {
  const std::set<std::string_view> others = {"domain.fill", "size.constant", "size.expression",
                                             "size.measure", "budget.max_bytes"};
  for (const Option& each : kOptions) {
    const bool is_named =
        std::any_of(named_options().begin(), named_options().end(),
                    [&](const NamedOption& named) { return named.path == each.field; });
    EXPECT_NE(is_named, others.contains(each.field)) << each.field;
  }
}

TEST(SetByName, TakesWhatTheFieldHolds) {
  v1::GenerateMeshRequest request;
  EXPECT_EQ(set(option("min-angle"), "25.5", request), "");
  EXPECT_EQ(set(option("placement"), "circumcentre", request), "");
  EXPECT_EQ(set(option("optimise"), "0", request), "");
  EXPECT_EQ(set(option("max-triangles"), "0x10000000000", request), "");
  EXPECT_EQ(set(option("gradation-within"), "true", request), "");
  EXPECT_EQ(set(option("threads"), "3", request), "");
  EXPECT_EQ(request.quality().min_angle_deg(), 25.5);
  EXPECT_EQ(request.quality().placement(), v1::PLACEMENT_CIRCUMCENTRE);
  EXPECT_TRUE(request.quality().has_optimise());
  EXPECT_EQ(request.budget().max_triangles(), 1ULL << 40);
  EXPECT_TRUE(request.size().gradation_within());
  EXPECT_EQ(request.threads(), 3u);
}

TEST(SetByName, ReplacesWhatWasSetByADefault) {
  v1::GenerateMeshRequest request;
  EXPECT_EQ(set(option("min-edge"), "2", request), "");
  EXPECT_EQ(set(option("min-edge"), "0", request), "");
  EXPECT_EQ(request.quality().min_edge(), 0);
  EXPECT_EQ(set(option("allow-unrefined"), "true", request), "");
  EXPECT_EQ(set(option("allow-unrefined"), "false", request), "");
  EXPECT_FALSE(request.allow_unrefined());
}

TEST(SetByName, SaysWhatATextIsNotAndLeavesTheRequestAlone) {
  v1::GenerateMeshRequest request;
  const auto fault = [&request](const char* name, const char* text) {
    return set(option(name), text, request);
  };
  for (const char* text : {"", "much", "1 ", "nan", "1,5"})
    EXPECT_EQ(fault("min-angle", text), "a number") << text;
  for (const char* text : {"", "-1", "+1", "1.5", "0x", "4294967296"})
    EXPECT_EQ(fault("threads", text), "a count") << text;
  EXPECT_EQ(fault("max-triangles", "18446744073709551616"), "a count");
  EXPECT_EQ(fault("threads", "0"), "in the range 1 or more");
  EXPECT_EQ(fault("gradation", "0.0001"), "in the range 0.001 to 1000");
  EXPECT_EQ(fault("gradation", "inf"), "in the range 0.001 to 1000");
  EXPECT_EQ(fault("placement", "unspecified"), "lattice or circumcentre");
  EXPECT_EQ(fault("no-cache", "maybe"), "true or false");
  EXPECT_EQ(request.ByteSizeLong(), 0u);
  EXPECT_FALSE(request.has_quality());
}

}  // namespace
}  // namespace weft::wire
