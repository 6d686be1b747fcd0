// SPDX-License-Identifier: Apache-2.0
// Names and lengths by marker, as texts and in requests.
#include "files/formats/name_option.h"

#include <gtest/gtest.h>

#include <vector>

#include "client/call/mesh_request.h"
#include "files/formats/edge_at.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

TEST(NameOption, IsAKindANumberAndAName) {
  const auto marker = NameOption::parse("marker=-2:the inlet: left=right");
  ASSERT_TRUE(marker) << marker.error();
  EXPECT_EQ(marker->kind, NameKind::kMarker);
  EXPECT_EQ(marker->id, -2);
  EXPECT_EQ(marker->name, "the inlet: left=right");
  EXPECT_EQ(NameOption::parse("region=1:fluid")->kind, NameKind::kRegion);
  for (const char* text : {"", "marker", "marker=2", "marker:2=inlet", "marker=x:inlet",
                           "marker=9999999999:inlet", "edge=2:inlet", "=2:inlet"})
    EXPECT_NE(NameOption::parse(text).error().find("such as marker=2:inlet"), std::string::npos)
        << text;
  EXPECT_EQ(NameOption::parse("marker=2:").error(), "the name in 'marker=2:' is empty");
  EXPECT_NE(NameOption::parse("marker=2:a\nb").error().find("has a control character"),
            std::string::npos);
}

TEST(SetNames, ReplacesThoseOfTheFileAndRefusesTwoOfTheSame) {
  Names names{{{2, "inlet"}, {3, "wall"}}, {}};
  const std::vector<NameOption> good = {{NameKind::kMarker, 2, "inflow"},
                                        {NameKind::kRegion, 2, "wall"}};
  ASSERT_TRUE(set_names(good, names));
  EXPECT_EQ(names.markers, (NameTable{{2, "inflow"}, {3, "wall"}}));
  EXPECT_EQ(names.regions, (NameTable{{2, "wall"}}));
  const std::vector<NameOption> bad = {{NameKind::kMarker, 7, "wall"}};
  const auto refused = set_names(bad, names);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit, ExitCode::kUsage);
  EXPECT_EQ(refused.error().message, "marker 7 is named 'wall', as 3 is");
}

TEST(EdgeAt, MayNameItsMarker) {
  const auto named = EdgeAt::parse("marker=a:b:500");
  ASSERT_TRUE(named) << named.error();
  EXPECT_EQ(named->name, "a:b");
  EXPECT_EQ(named->max_edge, 500);
  EXPECT_EQ(EdgeAt::parse("marker=2:500")->marker, 2);
  for (const char* text : {"marker=:500", "marker=inlet", "marker=inlet:0", "marker:500"})
    EXPECT_FALSE(EdgeAt::parse(text)) << text;
}

TEST(RequestOfNames, HasThemAndTheMarkersThatAreMeant) {
  Domain domain = square_domain(1);
  domain.names.markers = {{3, "inlet"}, {4, "w\u00e4nd"}};
  domain.names.regions = {{-1, "fluid"}};
  const auto options = with_size({.markers = {.edge_at = {{0, 0.5, "inlet"}}}}, domain);
  ASSERT_TRUE(options) << options.error().message;
  const auto request = make_request(domain, *options);
  EXPECT_EQ(request.size().at(0).marker(), 3);
  EXPECT_EQ(names_of(request.domain()), domain.names);
  const auto unknown = with_size({.markers = {.edge_at = {{0, 0.5, "inlot"}}}}, domain);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message,
            "no marker of the domain is named 'inlot': did you mean `inlet`?");
}

}  // namespace
}  // namespace weft::client
