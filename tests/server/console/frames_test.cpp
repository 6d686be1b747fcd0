// SPDX-License-Identifier: Apache-2.0
// Frames of gRPC-Web, whatever is sent and wherever it is split.
#include "server/console/frames.h"

#include <gtest/gtest.h>

#include "tests/server/console/web_client.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

constexpr std::uint64_t kMaxBytes = 1000;

// All messages of some bytes that come in pieces of `piece`.
tl::expected<std::vector<std::string>, Failure> read_all(FrameReader& reader,
                                                         const std::string& bytes,
                                                         std::size_t piece) {
  std::vector<std::string> messages;
  for (std::size_t start = 0; start < bytes.size(); start += piece) {
    std::string_view part = std::string_view(bytes).substr(start, piece);
    while (!part.empty()) {
      const auto used = reader.feed(part);
      if (!used) return tl::unexpected(used.error());
      part.remove_prefix(*used);
      if (const auto message = reader.next()) {
        EXPECT_EQ(message->length, message->bytes.Length());
        messages.push_back(to_string(message->bytes));
        reader.give_back(message->length);
      }
    }
  }
  return messages;
}

Reason failure_of(const std::string& bytes) {
  ByteBudget budget(kMaxBytes);
  FrameReader reader(kMaxBytes, budget, "ann");
  const auto messages = read_all(reader, bytes, bytes.size());
  EXPECT_FALSE(messages);
  return messages ? Reason::kInternal : messages.error().reason;
}

TEST(Frames, AreReadWhereverTheyAreSplit) {
  const std::vector<std::string> messages = {"one", "", std::string(kMaxBytes, 'x'),
                                             std::string("\0\x80", 2)};
  std::string bytes;
  for (const std::string& message : messages) bytes += framed(message);
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    ByteBudget budget(kMaxBytes);
    FrameReader reader(kMaxBytes, budget, "ann");
    EXPECT_EQ(read_all(reader, bytes, piece).value(), messages) << piece;
    EXPECT_TRUE(reader.at_border());
  }
}

TEST(Frames, MayEndBetweenMessagesOnly) {
  const std::string bytes = framed("message");
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    ByteBudget budget(kMaxBytes);
    FrameReader reader(kMaxBytes, budget, "ann");
    ASSERT_TRUE(read_all(reader, bytes.substr(0, size), 1));
    EXPECT_EQ(reader.at_border(), size == 0 || size == bytes.size()) << size;
  }
}

TEST(Frames, OfARequestHaveNoFlags) {
  for (int flags = 1; flags < 256; ++flags)
    EXPECT_EQ(failure_of(framed("message", static_cast<std::uint8_t>(flags))),
              Reason::kMalformedRequest)
        << flags;
}

TEST(Frames, ThatAreTooLargeAreRefusedByTheirHeader) {
  EXPECT_EQ(failure_of(framed(std::string(kMaxBytes + 1, 'x')).substr(0, kFrameHeader)),
            Reason::kLimitExceeded);
  EXPECT_EQ(failure_of(std::string("\0\xff\xff\xff\xff", kFrameHeader)), Reason::kLimitExceeded);
}

TEST(Frames, TakeFromTheBudgetWhatHasComeAndGiveItBack) {
  ByteBudget budget(15);
  {
    FrameReader first(kMaxBytes, budget, "ann");
    ASSERT_TRUE(read_all(first, framed("0123456789").substr(0, kFrameHeader + 9), 1));
    FrameReader second(kMaxBytes, budget, "ann");
    const auto refused = read_all(second, framed("0123456"), 1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().reason, Reason::kOutOfMemory);
  }
  EXPECT_TRUE(ByteBudget::Held(budget, "ann").hold(15));
}

TEST(Trailers, SayHowACallEnded) {
  EXPECT_EQ(trailer_block(grpc::Status::OK, {}), "grpc-status: 0\r\n");
  EXPECT_EQ(trailer_block({grpc::StatusCode::NOT_FOUND, "50 % gone\r\n\xc3\xa9", "\xff"}, {}),
            "grpc-status: 5\r\ngrpc-message: 50 %25 gone%0D%0A%C3%A9\r\n"
            "grpc-status-details-bin: /w\r\n");
}

TEST(Trailers, HaveTheMetadataThatMayStandThere) {
  EXPECT_EQ(trailer_block(grpc::Status::OK, {{"a", "b"},
                                             {"evil", "x\r\ngrpc-status: 5"},
                                             {"grpc-status", "5"},
                                             {"x-bin", std::string("\0\r\n", 3)}}),
            "grpc-status: 0\r\na: b\r\nx-bin: AA0K\r\n");
}

// The vectors of RFC 4648, section 10, without padding.
TEST(Base64, IsThatOfItsStandard) {
  const std::pair<const char*, const char*> vectors[] = {
      {"", ""},           {"f", "Zg"},          {"fo", "Zm8"},         {"foo", "Zm9v"},
      {"foob", "Zm9vYg"}, {"fooba", "Zm9vYmE"}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) {
    EXPECT_EQ(to_base64(bytes), text);
    EXPECT_EQ(from_base64(text), bytes);
  }
  EXPECT_EQ(from_base64("Zg=="), "f");
  EXPECT_EQ(from_base64("+/+/"), "\xfb\xff\xbf");
  for (const char* wrong : {"Z g", "Zg=x", "Zg===", "Z*", "\xff"})
    EXPECT_EQ(from_base64(wrong), std::nullopt) << wrong;
}

TEST(Base64, IsReadInPiecesAndWithPaddingWithin) {
  const std::string text = "Zm9vYg==Zm8=YmFy";
  for (std::size_t i = 0; i <= text.size(); ++i) {
    Base64Reader reader;
    const auto first = reader.feed(text.substr(0, i));
    ASSERT_TRUE(first);
    EXPECT_EQ(reader.at_border(), i % 4 == 0);
    EXPECT_EQ(*first + reader.feed(text.substr(i)).value_or("?"), "foobfobar");
    EXPECT_TRUE(reader.at_border());
  }
  for (const char* wrong : {"Zm9*", "====", "Z===", "Zg=v", "Zm9vY g=", "\xff\xff\xff\xff"})
    EXPECT_EQ(Base64Reader().feed(wrong), std::nullopt) << wrong;
}

}  // namespace
}  // namespace weft::server::testing
