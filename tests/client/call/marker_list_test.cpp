// SPDX-License-Identifier: Apache-2.0
// Lists of markers, as texts and in requests.
#include "files/formats/marker_list.h"

#include <gtest/gtest.h>

#include <vector>

#include "client/call/mesh_request.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::client {
namespace {

TEST(MarkerList, HoldsNumbersAndNames) {
  const auto list = MarkerList::parse("2,inlet,-3");
  ASSERT_TRUE(list);
  EXPECT_EQ(list->markers, (std::vector<std::int32_t>{2, -3}));
  EXPECT_EQ(list->names, (std::vector<std::string>{"inlet"}));
  EXPECT_EQ(list->numbers({{7, "inlet"}}).value(), (std::vector<std::int32_t>{2, -3, 7}));
  EXPECT_EQ(list->numbers({{7, "inlot"}}).error().message,
            "no marker of the domain is named 'inlet': did you mean `inlot`?");
  for (const char* text : {"", ",", "2,", "2,,3"}) EXPECT_FALSE(MarkerList::parse(text)) << text;
}

TEST(MarkersToKeep, ReachTheRequestAsNumbers) {
  Domain domain = square_domain(1);
  domain.names.markers = {{3, "inlet"}};
  const auto options = with_size({.markers = {.keep = MarkerList{{5}, {"inlet"}}}}, domain);
  ASSERT_TRUE(options) << options.error().message;
  const auto request = make_request(domain, *options);
  const auto& markers = request.quality().keep().markers();
  EXPECT_EQ(std::vector<std::int32_t>(markers.begin(), markers.end()),
            (std::vector<std::int32_t>{5, 3}));
  EXPECT_FALSE(make_request(domain, {}).quality().has_keep());
  EXPECT_TRUE(make_request(domain, with_size({.markers = {.keep = MarkerList{}}}, domain).value())
                  .quality()
                  .has_keep());
  EXPECT_EQ(with_size({.markers = {.keep = MarkerList{{}, {"inlot"}}}, .given = {"keep"}}, domain)
                .error()
                .message,
            "--keep: no marker of the domain is named 'inlot': did you mean `inlet`?");
}

}  // namespace
}  // namespace weft::client
