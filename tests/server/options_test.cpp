// SPDX-License-Identifier: Apache-2.0
#include "server/options.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft::server {
namespace {

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

std::variant<Options, Exit> parse(std::vector<const char*> flags) {
  flags.insert(flags.begin(), "weftd");
  return parse_options(static_cast<int>(flags.size()), flags.data(),
                       {.threads = 2, .memory = 16 * kGiB});
}
ServiceOptions service_of(std::vector<const char*> flags) {
  const auto parsed = parse(std::move(flags));
  EXPECT_TRUE(std::holds_alternative<Options>(parsed));
  return std::holds_alternative<Options>(parsed) ? std::get<Options>(parsed).server.service
                                                 : ServiceOptions{};
}
std::string complaint_about(std::vector<const char*> flags) {
  ::testing::internal::CaptureStderr();
  const auto parsed = parse(std::move(flags));
  const std::string text = ::testing::internal::GetCapturedStderr();
  const Exit* const exit = std::get_if<Exit>(&parsed);
  EXPECT_TRUE(exit != nullptr && exit->code == kExitUsage) << text;
  return text;
}

TEST(MemoryOptions, LetAllRunsTogetherHaveWhatThereIs) {
  const ServiceOptions service = service_of({});
  EXPECT_EQ(service.jobs, 4u);
  EXPECT_EQ(service.limits.max_bytes, 3 * kGiB);
  EXPECT_EQ(service_of({"--jobs", "1"}).limits.max_bytes, 12 * kGiB);
  EXPECT_EQ(service_of({"--memory", "8GiB"}).limits.max_bytes, 2 * kGiB);
}

TEST(MemoryOptions, GiveFewerRunsMoreEachIfThatIsWanted) {
  const ServiceOptions service = service_of({"--max-bytes", "5GiB"});
  EXPECT_EQ(service.jobs, 2u);
  EXPECT_EQ(service.limits.max_bytes, 5 * kGiB);
  EXPECT_EQ(service_of({"--max-bytes", "1GiB"}).jobs, 4u);
}

TEST(MemoryOptions, ThatPromiseMoreThanThereIsAreRefused) {
  const std::string text = complaint_about({"--max-bytes", "5GiB", "--jobs", "3"});
  EXPECT_NE(text.find("5368709120 bytes for each of 3 runs"), std::string::npos) << text;
  EXPECT_NE(text.find("12884901888"), std::string::npos) << text;
  complaint_about({"--max-bytes", "13GiB"});
  complaint_about({"--memory", "1GiB", "--max-bytes", "2GiB", "--jobs", "1"});
  EXPECT_EQ(service_of({"--max-bytes", "4GiB", "--jobs", "3"}).jobs, 3u);
}

TEST(ClientShare, LeavesSomethingToOthersIfThereMayBeAny) {
  EXPECT_EQ(service_of({}).client_share, 1);
  EXPECT_EQ(service_of({"--listen", "unix:/tmp/x"}).client_share, 1);
  EXPECT_EQ(service_of({"--tokens", "file"}).client_share, 0.75);
  EXPECT_EQ(service_of({"--listen", "0.0.0.0:7421", "--insecure"}).client_share, 0.75);
  EXPECT_EQ(service_of({"--tokens", "file", "--client-share", "0.5"}).client_share, 0.5);
  EXPECT_EQ(service_of({"--tokens", "file", "--client-share", "1"}).client_share, 1);
  for (const char* bad : {"0", "-1", "1.1", "nan"}) complaint_about({"--client-share", bad});
}

TEST(ReaderOptions, HaveALeastRate) {
  EXPECT_EQ(service_of({}).patience.least_rate, 4096u);
  EXPECT_EQ(service_of({"--min-rate", "0"}).patience.least_rate, 0u);
}

TEST(ConsoleOptions, NameOriginsAsBrowsersSpellThem) {
  const auto parsed = parse({"--console-origin", "https://a.example.org,http://localhost:5173"});
  ASSERT_TRUE(std::holds_alternative<Options>(parsed));
  EXPECT_EQ(std::get<Options>(parsed).server.console.origins,
            (std::vector<std::string>{"https://a.example.org", "http://localhost:5173"}));
  for (const char* wrong : {"*", "example.org", "https://example.org/"})
    EXPECT_NE(complaint_about({"--console-origin", wrong}).find("is not an origin"),
              std::string::npos)
        << wrong;
}

TEST(ConsoleOptions, LeaveSomethingToOthersIfOtherMachinesCanConnect) {
  EXPECT_EQ(service_of({"--console", "127.0.0.1:8080"}).client_share, 1);
  EXPECT_LT(service_of({"--console", "0.0.0.0:8080"}).client_share, 1);
}

}  // namespace
}  // namespace weft::server
