// SPDX-License-Identifier: Apache-2.0
// The frames of an HTTP/2 connection, as its bytes pass by.
//
//   FrameSplitter splitter;
//   splitter.split(bytes, [](const FrameHeader& frame, std::string_view head) { return true; },
//                  [](std::string_view payload) {});
//
// Source: RFC 9113, 4.1 and 6. Thread-safety: none.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace weft::server {

enum class FrameType : std::uint8_t {
  kData = 0,
  kHeaders = 1,
  kPriority = 2,
  kReset = 3,
  kSettings = 4,
  kPushPromise = 5,
  kPing = 6,
  kGoAway = 7,
  kWindowUpdate = 8,
  kContinuation = 9
};

inline constexpr std::uint8_t kFlagAck = 0x1;
inline constexpr std::uint8_t kFlagEndStream = 0x1;
inline constexpr std::uint8_t kFlagEndHeaders = 0x4;

// What a client sends before its first frame.
inline constexpr std::string_view kClientPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";

struct FrameHeader {
  std::uint32_t length = 0;  // bytes of its payload
  FrameType type{};          // any value: receivers ignore types that they do not know
  std::uint8_t flags = 0;
  std::uint32_t stream = 0;  // 0: the connection

  bool has(std::uint8_t flag) const { return (flags & flag) != 0; }
};

// GOAWAY with ENHANCE_YOUR_CALM: ends a connection. `reason` is shown to the user of most clients.
std::string calm_down(std::string_view reason);

class FrameSplitter {
 public:
  static constexpr std::size_t kHeaderBytes = 9;

  // Calls `begin(FrameHeader, its nine bytes)` as soon as a frame's header is complete, then
  // `payload(bytes)` for its payload, in parts as they come. If `begin` returns false, returns the
  // bytes after that header at once; the next call, which must bring them, asks `begin` again.
  template <class Begin, class Payload>
  std::string_view split(std::string_view bytes, Begin&& begin, Payload&& payload);

  // Whether all frames so far are complete.
  bool between_frames() const { return left_ == 0 && got_ == 0; }

 private:
  FrameHeader header() const;

  std::array<char, kHeaderBytes> head_{};
  std::size_t got_ = 0;   // bytes of head_
  std::size_t left_ = 0;  // bytes of the payload that are still to come
};

// --- implementation ---

template <class Begin, class Payload>
std::string_view FrameSplitter::split(std::string_view bytes, Begin&& begin, Payload&& payload) {
  while (!bytes.empty() || got_ == kHeaderBytes) {
    if (got_ == kHeaderBytes) {
      const FrameHeader frame = header();
      if (!begin(frame, std::string_view(head_.data(), kHeaderBytes))) return bytes;
      got_ = 0;
      left_ = frame.length;
      continue;
    }
    if (left_ != 0) {
      const std::string_view part = bytes.substr(0, left_);
      left_ -= part.size();
      bytes.remove_prefix(part.size());
      payload(part);
      continue;
    }
    const std::size_t now = std::min(bytes.size(), kHeaderBytes - got_);
    bytes.copy(head_.data() + got_, now);
    got_ += now;
    bytes.remove_prefix(now);
  }
  return bytes;
}

}  // namespace weft::server
