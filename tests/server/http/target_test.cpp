// SPDX-License-Identifier: Apache-2.0
#include "server/http/target.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

TEST(Target, IsAPathAndParameters) {
  const auto target = parse_target("/v1/mesh/a%20b.poly?edge=0.1+0.2*x&lonlat&x=a%3Db=c&&y=");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/v1/mesh/a b.poly");
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(target->query,
            (Pairs{{"edge", "0.1+0.2*x"}, {"lonlat", ""}, {"x", "a=b=c"}, {"y", ""}}));
  EXPECT_EQ(parse_target("/%c3%a9")->path, "/é");
  EXPECT_EQ(parse_target("/?a#b")->query, (Pairs{{"a", ""}}));
  EXPECT_TRUE(parse_target("/")->query.empty());
}

TEST(Target, RefusesBrokenEscapes) {
  for (const char* broken :
       {"/%", "/%4", "/%4g", "/%+1", "/%00", "/?a=%", "/?%zz", "/%ff", "/?a=%0a", "/?a=\xc3"})
    EXPECT_FALSE(parse_target(broken)) << broken;
}

}  // namespace
}  // namespace weft::server
