// SPDX-License-Identifier: Apache-2.0
#include "server/console/frames.h"

#include <fmt/format.h>
#include <grpc/grpc.h>
#include <grpc/slice.h>

#include <algorithm>

namespace weft::server {
namespace {

// A slice costs about 100 bytes beside its contents, so small ones would multiply a message's
// memory.
constexpr std::size_t kSlice = std::size_t{64} << 10;
constexpr std::string_view kAlphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// As gRPC does: printable ASCII but the percent sign stays.
std::string percent_encoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    if (c >= ' ' && c <= '~' && c != '%')
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

bool can_stand_in_header(const std::string& value) {
  const grpc_slice slice = grpc_slice_from_static_buffer(value.data(), value.size());
  return grpc_header_nonbin_value_is_legal(slice) != 0;
}

}  // namespace

std::array<char, kFrameHeader> frame_header(std::uint8_t flags, std::uint32_t length) {
  return {static_cast<char>(flags), static_cast<char>(length >> 24),
          static_cast<char>(length >> 16), static_cast<char>(length >> 8),
          static_cast<char>(length)};
}

std::optional<Failure> FrameReader::begin_message() {
  constexpr std::uint8_t kCompressed = 1;
  const std::uint8_t flags = header_[0];
  const auto malformed = [](const char* why) {
    return Failure{Reason::kMalformedRequest, "", why};
  };
  if (flags == kCompressed) return malformed("the message is compressed, which is not supported");
  if ((flags & kTrailerFlag) != 0) return malformed("the request has a frame of trailers");
  if (flags != 0) return malformed("the frame has flags that gRPC-Web does not know");
  length_ = 0;
  for (std::size_t i = 1; i < kFrameHeader; ++i) length_ = length_ << 8 | header_[i];
  if (length_ > most_bytes_)
    return Failure{Reason::kLimitExceeded, "",
                   fmt::format("the request has {} bytes; the limit is {}", length_, most_bytes_)};
  return std::nullopt;
}

tl::expected<std::size_t, Failure> FrameReader::feed(std::string_view bytes) {
  std::size_t used = 0;
  while (!whole_ && used < bytes.size()) {
    if (header_size_ < kFrameHeader) {
      header_[header_size_++] = static_cast<unsigned char>(bytes[used++]);
      if (header_size_ < kFrameHeader) continue;
      if (auto failure = begin_message()) return tl::unexpected(std::move(*failure));
    }
    const std::size_t part =
        std::min<std::size_t>({bytes.size() - used, length_ - received_, kSlice - slice_.size()});
    if (!held_.hold(held_.bytes() + part))
      return tl::unexpected(Failure{Reason::kOutOfMemory, "",
                                    "other requests take the memory that there is for them"});
    slice_.append(bytes.substr(used, part));
    used += part;
    received_ += static_cast<std::uint32_t>(part);
    if (slice_.size() == kSlice || received_ == length_) end_slice();
    if (received_ < length_) continue;
    whole_ = FramedMessage{grpc::ByteBuffer(slices_.data(), slices_.size()), length_};
    slices_.clear();
    header_size_ = 0;
    received_ = 0;
  }
  return used;
}

void FrameReader::end_slice() {
  slices_.emplace_back(slice_);
  slice_.clear();
}

std::string trailer_block(const grpc::Status& status, const Metadata& metadata) {
  std::string block = fmt::format("grpc-status: {}\r\n", static_cast<int>(status.error_code()));
  if (!status.error_message().empty())
    block += fmt::format("grpc-message: {}\r\n", percent_encoded(status.error_message()));
  if (!status.error_details().empty())
    block += fmt::format("grpc-status-details-bin: {}\r\n", to_base64(status.error_details()));
  for (const auto& [key, value] : metadata) {
    if (key.starts_with("grpc-") || key.starts_with(":")) continue;
    if (key.ends_with("-bin"))
      block += fmt::format("{}: {}\r\n", key, to_base64(value));
    else if (can_stand_in_header(value))
      block += fmt::format("{}: {}\r\n", key, value);
  }
  return block;
}

std::string to_base64(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (count += 8; count >= 6; count -= 6) out += kAlphabet[bits >> (count - 6) & 63];
  }
  if (count > 0) out += kAlphabet[bits << (6 - count) & 63];
  return out;
}

std::optional<std::string> from_base64(std::string_view text) {
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  std::string out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const auto digit = kAlphabet.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 0xff);
  }
  return out;
}

std::optional<std::string> Base64Reader::feed(std::string_view text) {
  constexpr std::size_t kGroup = 4;
  std::string out;
  out.reserve((group_.size() + text.size()) / kGroup * 3);
  for (const char c : text) {
    group_ += c;
    if (group_.size() < kGroup) continue;
    const auto bytes = from_base64(group_);
    if (!bytes) return std::nullopt;
    out += *bytes;
    group_.clear();
  }
  return out;
}

}  // namespace weft::server
