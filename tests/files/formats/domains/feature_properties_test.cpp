// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/feature_properties.h"

#include <gtest/gtest.h>
#include <shapefil.h>

#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "files/formats/domain_formats.h"
#include "tests/files/support/shapefile_writer.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

using Texts = std::map<std::string, std::string>;

Result<GeometryProperties> of_texts(const Texts& texts) {
  GeometryBuilder builder("d");
  return feature_properties(builder, "field ", [&](const char* name) {
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
  const auto named = of_texts({{"marker", "3"}, {"marker_name", " "}});
  ASSERT_TRUE(named);
  EXPECT_EQ(named->marker_name, "");
}

TEST(FeatureProperties, ThatAreNoMarkersNoRegionsAndNoNamesAreLeftOutWithAWarning) {
  GeometryBuilder builder("d");
  const auto add = [&builder](const std::map<std::string, PropertyValue>& values) {
    const auto properties = feature_properties(builder, "field ", [&](const char* name) {
      const auto found = values.find(name);
      return found == values.end() ? PropertyValue{} : found->second;
    });
    EXPECT_TRUE(properties);
  };
  const auto text = [](const char* value) { return PropertyValue{std::nullopt, value, ""}; };
  const auto other = [](const char* value) { return PropertyValue{std::nullopt, "", value}; };
  add({{"marker", other("true")}, {"region", other("[1]")}});
  add({{"marker_name", PropertyValue{5, "", ""}}, {"region_name", other("{}")}});
  add({{"marker", text("a")}, {"marker_name", text("b")}});
  add({{"marker", text("a")}, {"marker_name", text("a")}});
  add({{"marker", other("true")}});
  add({{"marker", other("true")}});
  ASSERT_TRUE(builder.point({}, ""));
  EXPECT_EQ(sentences(builder.finish()->warnings),
            (std::vector<std::string>{
                "d: field marker is left out: it is true, neither a number nor a text",
                "d: field region is left out: it is [1], neither a number nor a text",
                "d: field marker_name is left out: it is 5, not a text",
                "d: field region_name is left out: it is {}, not a text",
                "d: field marker_name is left out: it is 'b' beside the name 'a'",
                "d: 2 more properties are left out"}));
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

// What a property may be in GeoJSON; `name`: what it calls a marker or region by.
struct Given {
  std::string json;
  std::string name{};
  bool odd = false;  // to be told
};

Given random_property(std::mt19937& random, bool is_name) {
  const auto below = [&random](int n) {
    return std::uniform_int_distribution<int>(0, n - 1)(random);
  };
  const std::string name = "name " + std::to_string(below(6));
  switch (below(10)) {
    case 0:
    case 1:
    case 2:
      return {"\"" + name + "\"", name};
    case 3:
      return {"\" K\u00fcste \"", " Küste "};
    case 4:
      return is_name ? Given{"\"3\"", "3"} : Given{"\" 3.0 \""};
    case 5:
      return {std::to_string(below(4)) + ".0", "", is_name};
    case 6:
      return {below(2) == 0 ? "null" : "\" \""};
    case 7:
      return {"\"" + std::string(300, 'x') + "\"", "", true};
    case 8:
      return {"\"a\\nb\"", "", true};
    default: {
      const char* const others[] = {"true", "[\"inlet\"]", "{\"a\": 1}", "[]"};
      return {others[below(4)], "", true};
    }
  }
}

TEST(FeatureProperties, LoseNoNameInSilence) {
  TempFolder folder;
  std::mt19937 random(20240607);
  int lost = 0;
  int kept = 0;
  for (int round = 0; round < 500; ++round) {
    std::string features;
    std::vector<std::string> names[2];  // of markers, of regions
    bool odd = false;
    for (int i = 0; i <= round % 3; ++i) {
      std::string members;
      for (const bool of_region : {false, true})
        for (const bool is_name : {false, true}) {
          if (std::uniform_int_distribution<int>(0, 2)(random) == 0) continue;
          const Given given = random_property(random, is_name);
          members += std::string(members.empty() ? "" : ", ") + "\"" +
                     (of_region ? "region" : "marker") + (is_name ? "_name" : "") +
                     "\": " + given.json;
          if (!given.name.empty()) names[of_region ? 1 : 0].push_back(given.name);
          odd = odd || given.odd;
        }
      const std::string x = std::to_string(2 * i);
      features += std::string(i == 0 ? "" : ", ") + R"({"type": "Feature", "properties": {)" +
                  members + R"(}, "geometry": {"type": "Polygon", "coordinates": [[[)" + x +
                  ", 0], [" + x + ", 1], [" + x + ".5, 1], [" + x + ", 0]]]}}";
    }
    const auto domain = read_domain(folder.write(
        "d.geojson", R"({"type": "FeatureCollection", "features": [)" + features + "]}"));
    ASSERT_TRUE(domain) << domain.error().message;
    const auto is_there = [&](const NameTable& table, const std::string& name) {
      return id_of(table, name).has_value();
    };
    for (const std::string& name : names[0]) odd = odd || !is_there(domain->names.markers, name);
    for (const std::string& name : names[1]) odd = odd || !is_there(domain->names.regions, name);
    EXPECT_FALSE(odd && domain->warnings.empty()) << features;
    (odd ? lost : kept) += odd || domain->warnings.empty() ? 1 : 0;
  }
  EXPECT_GT(lost, 100);
  EXPECT_GT(kept, 40);
}

TEST(FeatureProperties, OfTablesHaveNoBoundIfItIs0) {
  EXPECT_EQ(number_of_table("max_area", 0).number, std::nullopt);
  EXPECT_EQ(number_of_table("max_edge", 0).number, std::nullopt);
  EXPECT_EQ(number_of_table("max_area", -1).number, -1);
  EXPECT_EQ(number_of_table("marker", 0).number, 0);
  TempFolder folder;
  write_sample_shapefile(folder / "d");
  std::unique_ptr<DBFInfo, decltype(&::DBFClose)> table(::DBFOpen((folder / "d").c_str(), "rb+"),
                                                        ::DBFClose);
  ASSERT_TRUE(::DBFWriteDoubleAttribute(table.get(), 0, 2, 0.0));
  table.reset();
  const auto domain = read_domain(folder / "d.shp");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->areas[0].max_area, std::nullopt);
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
}  // namespace weft::files
