// SPDX-License-Identifier: Apache-2.0
// What the row of a limit makes: its flag and its value in GetServerInfo. That it holds:
// tests/server/admission/refusal_test.cpp.
#include "server/wire/limits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>

#include "server/options.h"
#include "server/server_info.h"

namespace weft::server {
namespace {

TEST(CountLimits, AreFlagsAndShownToClients) {
  std::uint64_t value = 1000;
  for (const CountLimit& row : kCountLimits) {
    std::string flag = "--" + std::string(row.name);
    std::replace(flag.begin(), flag.end(), '_', '-');
    const std::string text = std::to_string(++value);
    const char* const arguments[] = {"weftd", flag.c_str(), text.c_str()};
    const auto parsed =
        parse_options(3, arguments, {.threads = 1, .memory = std::uint64_t{1} << 34});
    ASSERT_TRUE(std::holds_alternative<Options>(parsed)) << flag;
    const ServerOptions& options = std::get<Options>(parsed).server;
    EXPECT_EQ(options.service.limits.*row.limit, value) << flag;
    const v1::ServerLimits limits = server_info(options, false).limits();
    const auto* const field = limits.GetDescriptor()->FindFieldByName(std::string(row.name));
    ASSERT_NE(field, nullptr) << row.name;
    EXPECT_EQ(limits.GetReflection()->GetUInt64(limits, field), value) << row.name;
  }
}

}  // namespace
}  // namespace weft::server
