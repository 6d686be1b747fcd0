// SPDX-License-Identifier: Apache-2.0
// What a browser sends to the console: frames of gRPC-Web, and headers. The first byte says in what
// pieces the rest comes. Asserts:
//   split      the same messages, and the same failure, wherever the bytes are split
//   frames     each message is the bytes between its header and the next
//   limit      no message is longer than the limit
//   budget     the bytes that were counted go back
//   failure    a refusal has a sentence
//   base64     what is decoded is encoded to the same again, but for bits that no byte has
//   path       no path of a method has a byte that ends a header
//   timeout    a timeout is not negative
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/console/frames.h"
#include "server/console/request_rules.h"
#include "tests/fuzz/law.h"

namespace weft::fuzz {
namespace {

using namespace server;
using namespace std::string_view_literals;

constexpr std::uint64_t kMax = 64;
constexpr std::uint64_t kBudget = 128;

struct Reading {
  std::vector<std::string> messages;
  std::string failure;  // empty: none
  bool at_border = false;

  bool operator==(const Reading&) const = default;
};

std::string text_of(const grpc::ByteBuffer& buffer) {
  std::vector<grpc::Slice> slices;
  std::string text;
  if (buffer.Valid() && buffer.Dump(&slices).ok())
    for (const grpc::Slice& slice : slices)
      text.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  return text;
}

Reading read(std::string_view bytes, std::size_t piece) {
  ByteBudget budget(kBudget);
  Reading reading;
  {
    FrameReader reader(kMax, budget, "");
    while (!bytes.empty() && reading.failure.empty()) {
      std::string_view part = bytes.substr(0, piece);
      bytes.remove_prefix(part.size());
      while (!part.empty()) {
        const auto used = reader.feed(part);
        if (!used) {
          reading.failure = used.error().message.empty() ? "no sentence" : used.error().message;
          break;
        }
        part.remove_prefix(*used);
        if (auto message = reader.next()) {
          reading.messages.push_back(text_of(message->bytes));
          reader.give_back(message->length);
        }
      }
    }
    reading.at_border = reader.at_border();
  }
  if (!ByteBudget::Held(budget, "").hold(kBudget)) reading.failure = "the budget is not whole";
  return reading;
}

void judge(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto must = [&](bool holds, std::string_view law, const std::string& evidence) {
    if (!holds) broken(law, evidence, data, size);
  };
  const Reading whole = read(bytes, bytes.size() + 1);
  must(whole == read(bytes, data[0] % 16 + std::size_t{1}), "split", whole.failure);
  must(whole.failure != "no sentence", "failure", "no sentence");
  must(whole.failure != "the budget is not whole", "budget", whole.failure);
  std::size_t at = 0;
  for (const std::string& message : whole.messages) {
    must(message.size() <= kMax, "limit", message);
    must(bytes.substr(at + kFrameHeader, message.size()) == message, "frames", message);
    at += kFrameHeader + message.size();
  }
  must(!whole.failure.empty() || whole.at_border == (at == bytes.size()), "frames", "the border");

  if (const auto decoded = from_base64(bytes))
    must(from_base64(to_base64(*decoded)) == decoded, "base64", std::string(bytes));
  if (is_method_path(bytes))
    must(bytes.find_first_of("\r\n\0 "sv) == bytes.npos, "path", std::string(bytes));
  if (const auto timeout = parse_timeout(bytes))
    must(timeout->count() >= 0, "timeout", std::string(bytes));
  const OriginRules rules{.host = "localhost", .origins = {"https://example.org"}};
  (void)rules.knows_host(bytes);
  (void)rules.judge(bytes, bytes);
  (void)is_origin(bytes);
  (void)accepts_gzip(bytes);
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::judge(data, size);
  return 0;
}
