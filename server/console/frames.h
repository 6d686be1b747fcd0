// SPDX-License-Identifier: Apache-2.0
// The frames of gRPC-Web: a byte of flags, four bytes of length, most significant first, and so
// many bytes of a message, or, if the flags say so, of trailers.
//
//   FrameReader reader(limits, budget);
//   reader.feed(bytes);                           // as they come, split anywhere
//   while (auto message = reader.next()) send(*message);
//
// Source: https://github.com/grpc/grpc/blob/master/doc/PROTOCOL-WEB.md
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>
#include <grpcpp/support/status.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "server/console/byte_budget.h"
#include "server/wire/errors.h"

namespace weft::server {

inline constexpr std::size_t kFrameHeader = 5;
inline constexpr std::uint8_t kTrailerFlag = 0x80;

std::array<char, kFrameHeader> frame_header(std::uint8_t flags, std::uint32_t length);

// A whole message. Its bytes go back to the budget with `give_back`, or with the reader.
struct FramedMessage {
  grpc::ByteBuffer bytes;
  std::uint64_t length = 0;
};

// Reads the messages of one request. Bytes are counted before memory is taken for them. Errors:
// kMalformedRequest for a flag that a request may not have, kLimitExceeded for a message of more
// than `most_bytes`, kOutOfMemory if the budget, or the client's share of it, is spent. After an
// error nothing is read any more.
class FrameReader {
 public:
  // The budget must outlive the reader.
  FrameReader(std::uint64_t most_bytes, ByteBudget& budget, std::string client)
      : most_bytes_(most_bytes), held_(budget, std::move(client)) {}

  // Takes bytes up to the end of a message, and returns how many those were. None are taken while
  // a message waits for `next`.
  tl::expected<std::size_t, Failure> feed(std::string_view bytes);

  // Returns nullopt if no message is whole.
  std::optional<FramedMessage> next() { return std::exchange(whole_, std::nullopt); }

  // Whether the request may end here.
  bool at_border() const { return header_size_ == 0; }

  // A message of so many bytes has been passed on.
  void give_back(std::uint64_t bytes) { held_.hold(held_.bytes() - bytes); }

 private:
  std::optional<Failure> begin_message();
  void end_slice();

  const std::uint64_t most_bytes_;
  ByteBudget::Held held_;
  std::array<unsigned char, kFrameHeader> header_{};
  std::size_t header_size_ = 0;  // bytes of the header that have come; 0: between two messages
  std::uint32_t length_ = 0;     // of the message
  std::uint32_t received_ = 0;   // of that
  std::string slice_;            // the last bytes, which make no slice yet
  std::vector<grpc::Slice> slices_;
  std::optional<FramedMessage> whole_;
};

using Metadata = std::vector<std::pair<std::string, std::string>>;

// The trailers that end a response, as the bytes of their frame without its header. Values of keys
// that end in -bin are written in base64; those that cannot stand in a header are left out.
std::string trailer_block(const grpc::Status& status, const Metadata& metadata);

// Standard base64 without padding, as gRPC writes binary metadata.
std::string to_base64(std::string_view bytes);
// With or without padding; nullopt if it is not base64.
std::optional<std::string> from_base64(std::string_view text);

// Reads base64 that comes in pieces, split anywhere. Padding may stand within it, as gRPC-Web's
// text mode allows: what follows is decoded anew.
class Base64Reader {
 public:
  // Returns the bytes that are complete; nullopt if the text is not base64.
  std::optional<std::string> feed(std::string_view text);

  // Whether the text may end here.
  bool at_border() const { return group_.empty(); }

 private:
  std::string group_;  // less than four characters
};

}  // namespace weft::server
