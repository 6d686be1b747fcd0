// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/log.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

TEST(LogValue, LeavesPlainWordsAlone) {
  EXPECT_EQ(log_value("ipv4:127.0.0.1:80"), "ipv4:127.0.0.1:80");
}

TEST(LogValue, QuotesWhatWouldBreakALine) {
  EXPECT_EQ(log_value(""), R"("")");
  EXPECT_EQ(log_value("a b"), R"("a b")");
  EXPECT_EQ(log_value("a=b"), R"("a=b")");
  EXPECT_EQ(log_value("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(log_value("a\nevent=forged"), R"("a\nevent=forged")");
  EXPECT_EQ(log_value("a\x1b[0m"), R"("a\x1b[0m")");
}

}  // namespace
}  // namespace weft::server
