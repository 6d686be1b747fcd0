// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/feature_properties.h"

#include <gtest/gtest.h>

#include <map>

#include "client/formats/domain_formats.h"
#include "tests/client/support/shapefile_writer.h"
#include "tests/client/support/temp_folder.h"

namespace weft::client {
namespace {

using Texts = std::map<std::string, std::string>;

Result<GeometryProperties> of_texts(const Texts& texts) {
  return feature_properties(GeometryBuilder("d"), "field ", [&](const char* name) {
    const auto found = texts.find(name);
    return PropertyValue{std::nullopt, found == texts.end() ? "" : found->second, ""};
  });
}

TEST(FeatureProperties, OfTextAreTheNumbersThatTheTextsAre) {
  const auto properties =
      of_texts({{"marker", "3"}, {"region", " -7.0 "}, {"max_area", "1.0D-01"}, {"max_edge", "2"}});
  ASSERT_TRUE(properties) << properties.error().message;
  EXPECT_EQ(properties->marker, 3);
  EXPECT_EQ(properties->region, -7);
  EXPECT_EQ(properties->max_area, 0.1);
  EXPECT_EQ(properties->max_edge, 2);
  EXPECT_EQ(properties->marker_name + properties->region_name, "");
}

TEST(FeatureProperties, OfTextAreNamesIfTheyAreNoNumbers) {
  const auto names = of_texts({{"marker", "west wall"}, {"region", "7a"}});
  ASSERT_TRUE(names);
  EXPECT_EQ(names->marker_name, "west wall");
  EXPECT_EQ(names->region_name, "7a");
  EXPECT_EQ(names->region, std::nullopt);
  const auto both = of_texts({{"marker", "3"}, {"marker_name", "inlet"}});
  ASSERT_TRUE(both);
  EXPECT_EQ(both->marker, 3);
  EXPECT_EQ(both->marker_name, "inlet");
}

TEST(FeatureProperties, OfTextAreNothingIfTheyAreBlank) {
  const auto properties = of_texts({{"marker", ""}, {"region", " "}, {"max_area", "\t"}});
  ASSERT_TRUE(properties);
  EXPECT_EQ(properties->region, std::nullopt);
  EXPECT_EQ(properties->max_area, std::nullopt);
  EXPECT_EQ(properties->region_name, "");
}

TEST(FeatureProperties, AreRefusedIfTheyCannotBeMeant) {
  const auto refusal = [](const Texts& texts) {
    const auto properties = of_texts(texts);
    return properties ? "they were read" : properties.error().message;
  };
  EXPECT_EQ(refusal({{"marker", "1.5"}}), "d: field marker is 1.5, not an integer of 32 bits");
  EXPECT_EQ(refusal({{"region", "4294967296"}}),
            "d: field region is 4294967296, not an integer of 32 bits");
  EXPECT_EQ(refusal({{"max_area", "small"}}), "d: field max_area is 'small', not a number");
  EXPECT_EQ(refusal({{"max_edge", "0"}}), "d: field max_edge is 0, not positive");
}

TEST(FeatureProperties, OfAShapefileMayBeTexts) {
  TempFolder folder;
  write_text_shapefile(folder / "d");
  const auto domain = read_domain(folder / "d.shp");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->segments[0].marker, 3);
  EXPECT_EQ(domain->areas, (std::vector<Domain::Area>{{7, 0.1}}));
  EXPECT_TRUE(domain->names.empty());
}

}  // namespace
}  // namespace weft::client
