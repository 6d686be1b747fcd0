// SPDX-License-Identifier: Apache-2.0
#include "client/lint/lint_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "files/formats/domain_formats.h"
#include "tests/files/lint/faulty_domains.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

Lint some_lint() {
  Lint lint{.file = "a.poly", .counts = {{"gap", 25}, {"warning", 1}}, .total = 26};
  for (int i = 0; i < 25; ++i)
    lint.findings.push_back({.kind = "gap",
                             .at = Point{double(i), 0.5},
                             .to = Point{double(i), 1.5},
                             .text = "a gap",
                             .remedy = "--snap 2",
                             .offenders = {"line 1", "line 2"},
                             .measure = 1});
  lint.findings.push_back({.kind = "warning", .warning = "row", .text = "odd"});
  return lint;
}

TEST(LintReport, TextHasTwentyOfAKindAndCountsAll) {
  const std::string text = lint_text(some_lint());
  EXPECT_EQ(text.substr(0, text.find('\n')), "gap at (0, 0.5): a gap; --snap 2");
  EXPECT_NE(text.find("gap at (19, 0.5)"), std::string::npos);
  EXPECT_EQ(text.find("gap at (20, 0.5)"), std::string::npos);
  EXPECT_EQ(text.substr(text.find("gap: and")),
            "gap: and 5 more\nwarning: odd\n26 faults in a.poly: 25 gap, 1 warning\n");
}

TEST(LintReport, TextSaysThatThereAreNoFaults) {
  EXPECT_EQ(lint_text({.file = "a.poly"}), "no faults in a.poly\n");
}

TEST(LintReport, TextSaysWhatWasNotLookedAt) {
  Lint lint = some_lint();
  lint.complete = false;
  EXPECT_NE(lint_text(lint).find("\nsegments meet in more than 200,000 points, so"),
            std::string::npos);
}

TEST(LintReport, JsonHasAllFindings) {
  const Json json = lint_json(some_lint());
  EXPECT_EQ(json["file"], "a.poly");
  EXPECT_EQ(json["faults"], 26);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["counts"], Json({{"gap", 25}, {"warning", 1}}));
  ASSERT_EQ(json["findings"].size(), 26U);
  EXPECT_EQ(json["findings"][3], Json({{"kind", "gap"},
                                       {"text", "a gap"},
                                       {"remedy", "--snap 2"},
                                       {"measure", 1.0},
                                       {"offenders", {"line 1", "line 2"}},
                                       {"at", {3.0, 0.5}},
                                       {"to", {3.0, 1.5}}}));
  EXPECT_EQ(json["findings"][25], Json({{"kind", "warning"}, {"text", "odd"}, {"warning", "row"}}));
}

TEST(LintReport, LayerHasAFeatureForEachFinding) {
  const TempFolder folder;
  std::vector<OutputFile> files;
  files.push_back(std::move(OutputFile::create(folder / "a.geojson", {}).value()));
  write_lint_layer(some_lint(), files[0]);
  ASSERT_TRUE(commit(files));
  const Json layer = Json::parse(contents_of(folder / "a.geojson"));
  EXPECT_EQ(layer["type"], "FeatureCollection");
  ASSERT_EQ(layer["features"].size(), 26U);
  EXPECT_EQ(layer["features"][2]["geometry"],
            Json({{"type", "LineString"}, {"coordinates", {{2.0, 0.5}, {2.0, 1.5}}}}));
  EXPECT_EQ(layer["features"][2]["properties"]["kind"], "gap");
  EXPECT_TRUE(layer["features"][25]["geometry"].is_null());
}

Image picture(const Domain& domain, const Lint& lint) {
  Drawing drawing({.pixels = 400});
  draw_lint(domain, lint, drawing);
  return drawing.image().value();
}

TEST(LintReport, PictureMarksFindings) {
  const TempFolder folder;
  const auto file = folder.write("yard.poly", kFaultyYard);
  const Domain domain = read_domain(file).value();
  const Lint lint = lint_domain(domain, file.string(), {}).value();
  const auto colored = [](const Image& image) {
    return std::count_if(image.pixels.begin(), image.pixels.end(), [](std::uint32_t pixel) {
      const auto red = static_cast<int>(pixel >> 16 & 255), blue = static_cast<int>(pixel & 255);
      return std::abs(red - blue) > 100;
    });
  };
  EXPECT_EQ(colored(picture(domain, {})), 0);
  EXPECT_GT(colored(picture(domain, lint)), 100);
}

}  // namespace
}  // namespace weft::client
