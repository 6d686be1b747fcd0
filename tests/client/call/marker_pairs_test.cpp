// SPDX-License-Identifier: Apache-2.0
// Pairs of markers, as texts and in requests.
#include "files/formats/marker_pairs.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "client/call/mesh_request.h"
#include "client/call/request_rows.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

TEST(MarkerPairs, HoldNumbersAndNames) {
  const auto pairs = parse_marker_pairs("left:right,-4:2");
  ASSERT_TRUE(pairs);
  ASSERT_EQ(pairs->size(), 2u);
  EXPECT_EQ(pairs->front().text(), "left:right");
  EXPECT_EQ(pairs->front().numbers({{7, "left"}, {5, "right"}}).value(), (std::array{7, 5}));
  EXPECT_EQ(pairs->front().numbers({{7, "left"}, {5, "rihgt"}}).error().message,
            "no marker of the domain is named 'right': did you mean `rihgt`?");
  EXPECT_EQ(pairs->front().numbers({{7, "lfet"}}).error().message,
            "no marker of the domain is named 'left': did you mean `lfet`?");
  EXPECT_EQ(pairs->back().numbers({}).value(), (std::array{-4, 2}));
  for (const char* text : {"", ",", "4", ":", "4:", ":2", "4:2,", "4:2,,1:3", "4:2:1", "4,2"})
    EXPECT_FALSE(parse_marker_pairs(text)) << text;
}

std::vector<std::array<std::int32_t, 2>> sent(const Domain& domain, const RequestOptions& options) {
  std::vector<std::array<std::int32_t, 2>> pairs;
  const v1::GenerateMeshRequest request = make_request(domain, options);
  for (const v1::PeriodicSides& sides : request.quality().periodic())
    pairs.push_back({sides.from(), sides.to()});
  return pairs;
}

TEST(PeriodicOption, ReachTheRequestAsNumbers) {
  Domain domain = square_domain(1);
  domain.names.markers = {{3, "inlet"}};
  RequestOptions given{.markers = {.periodic = {{"5", "inlet"}, {"0", "2"}}}};
  const auto options = with_size(given, domain);
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(sent(domain, *options), (std::vector{std::array{5, 3}, std::array{0, 2}}));
  EXPECT_TRUE(sent(domain, {}).empty());
  given.markers.periodic.push_back({"1", "inlot"});
  given.given = {"periodic"};
  EXPECT_EQ(with_size(given, domain).error().message,
            "--periodic 1:inlot: no marker of the domain is named 'inlot': did you mean `inlet`?");
  given.from_manifest = true;
  EXPECT_EQ(option_of("quality.periodic[0].to", given), "periodic 5:inlet");
}

TEST(PeriodicOption, AreReadFromText) {
  RequestOptions options;
  EXPECT_EQ(marker_value("periodic").read({"left:right"}, "", options), "");
  EXPECT_EQ(options.markers.periodic.size(), 1u);
  EXPECT_EQ(marker_value("periodic").read({"left"}, "", options),
            "'left' is not pairs of markers, such as left:right,4:2");
}

}  // namespace
}  // namespace weft::client
