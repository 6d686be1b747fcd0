// SPDX-License-Identifier: Apache-2.0
// What one client may send to gRPC, which bounds none of it: header blocks, streams, resets, and
// frames that cost their sender less than the server.
//
//   ConnectionRules rules({.max_resets = 600});
//   std::string passes;
//   const auto received = rules.received(bytes, passes, now, may_begin);
//   if (received.violation) close(received.violation->cause);
//   ... passes goes to gRPC, received.rest is kept; rules.sent(answer) follows what gRPC sends ...
//
// Rules, on the bytes after the client's preface:
//   - A header block has at most kMaxHeaderBytes, in at most 1 + kMaxContinuations frames
//     ("CONTINUATION flood", CVE-2024-27316).
//   - At most kMaxOpen streams have begun and not ended: twice what HTTP/2 lets a client open.
//   - At most `max_resets` streams are reset in a second ("rapid reset", CVE-2023-44487). Honest
//     clients reset calls when their users cancel; one that stops all at once resets kMaxStreams.
//   - All other frames cost a credit. It is earned by time and by what is sent and received: a
//     client answers data with window updates and pings. Frames of a priority and of unknown types
//     cost it, too, and do not pass: receivers ignore them.
//   - At most kMaxPings wait for their answers: gRPC keeps over 1 KB for each.
//
// Source: RFC 9113, 5.1, 6 and 10.5. Thread-safety: none.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/front/frames.h"
#include "server/net/connections.h"

namespace weft::server {

class ConnectionRules {
 public:
  using Clock = std::chrono::steady_clock;

  static constexpr std::uint32_t kMaxHeaderBytes = 32 << 10;
  static constexpr std::uint32_t kMaxContinuations = 8;
  static constexpr std::size_t kMaxOpen = 2 * kMaxStreams;
  static constexpr std::uint32_t kMaxPings = 64;
  static constexpr double kMaxCredit = 8192;        // frames
  static constexpr double kCreditPerSecond = 1024;  // frames
  static constexpr double kCreditPerKibibyte = 1;   // of data, in either direction
  static constexpr double kCreditPerFrameSent = 4;

  struct Options {
    // 0: no bound on resets, nor on streams that do not end.
    std::uint64_t max_resets = 600;
  };
  struct Violation {
    const char* cause;   // for the log and the client: a word or words joined by _
    std::uint64_t most;  // what was exceeded; 0 if the frame is never allowed
  };

  ConnectionRules(const Options& options, Clock::time_point now)
      : options_(options), credit_time_(now), second_(now) {}

  struct Received {
    std::optional<Violation> violation{};  // then the connection must be closed
    // A call may not begin yet; `rest` are the bytes from there on, for another try.
    bool waits = false;
    std::string_view rest{};
  };

  // Appends to `passes` what gRPC may see of the client's bytes. Asks `may_begin()` for each call
  // that begins. After a violation no function may be called any more.
  template <class MayBegin>
  Received received(std::string_view bytes, std::string& passes, Clock::time_point now,
                    MayBegin&& may_begin);
  // Follows the bytes that gRPC sends to the client.
  void sent(std::string_view bytes);

  // Forgets resets of a second that has passed, and earns credit.
  void pass_time(Clock::time_point now);

  // Whether a frame of our own may be sent.
  bool sent_whole_frames() const { return to_client_.between_frames(); }
  std::size_t open_streams() const { return open_.size(); }
  std::uint64_t resets() const { return resets_; }      // in this second
  std::uint64_t answered() const { return answered_; }  // streams that gRPC ended

 private:
  bool begins_call(const FrameHeader& frame) const {
    return frame.type == FrameType::kHeaders && block_stream_ == 0 && frame.stream > last_stream_;
  }
  std::optional<Violation> judge(const FrameHeader& frame);
  std::optional<Violation> judge_headers(const FrameHeader& frame);
  std::optional<Violation> judge_continuation(const FrameHeader& frame);
  std::optional<Violation> judge_reset(const FrameHeader& frame);
  std::optional<Violation> spend(double frames);
  bool end_stream(std::uint32_t stream);

  const Options options_;
  FrameSplitter from_client_;
  FrameSplitter to_client_;
  bool passing_ = false;            // the frame that is being received
  std::uint32_t block_stream_ = 0;  // of a header block that has not ended; 0: there is none
  std::uint32_t block_bytes_ = 0;
  std::uint32_t continuations_ = 0;
  std::uint32_t last_stream_ = 0;
  std::vector<std::uint32_t> open_;  // streams, ascending
  std::uint32_t pings_ = 0;          // that gRPC has not answered
  double credit_ = kMaxCredit;
  double earned_ = 0;  // since credit_time_
  Clock::time_point credit_time_;
  Clock::time_point second_;  // when the current second of resets began
  std::uint64_t resets_ = 0;
  std::uint64_t answered_ = 0;
};

// --- implementation ---

template <class MayBegin>
ConnectionRules::Received ConnectionRules::received(std::string_view bytes, std::string& passes,
                                                    Clock::time_point now, MayBegin&& may_begin) {
  pass_time(now);
  Received received;
  received.rest = from_client_.split(
      bytes,
      [&](const FrameHeader& frame, std::string_view head) {
        received.waits = begins_call(frame) && !may_begin();
        if (received.waits) return false;
        received.violation = judge(frame);
        if (!received.violation && passing_) passes.append(head);
        return !received.violation;
      },
      [&](std::string_view payload) {
        if (passing_) passes.append(payload);
      });
  return received;
}

}  // namespace weft::server
