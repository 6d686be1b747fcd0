// SPDX-License-Identifier: Apache-2.0
#include "server/front/connection_rules.h"

#include <algorithm>

namespace weft::server {
namespace {

constexpr double kBytesPerKibibyte = 1024;
// Settings are acknowledged, and kept until then.
constexpr double kCostOfSettings = 16;
// Data that carries so little is a frame like others.
constexpr std::uint32_t kSmallData = 64;

}  // namespace

std::optional<ConnectionRules::Violation> ConnectionRules::judge(const FrameHeader& frame) {
  passing_ = true;
  if (block_stream_ != 0) return judge_continuation(frame);
  switch (frame.type) {
    case FrameType::kData:
      earned_ += kCreditPerKibibyte * frame.length / kBytesPerKibibyte;
      return frame.length < kSmallData && !frame.has(kFlagEndStream) ? spend(1) : std::nullopt;
    case FrameType::kHeaders:
      return judge_headers(frame);
    case FrameType::kReset:
      return judge_reset(frame);
    case FrameType::kSettings:
      return spend(frame.has(kFlagAck) ? 1 : kCostOfSettings);
    case FrameType::kPing:
      if (!frame.has(kFlagAck) && ++pings_ > kMaxPings) return Violation{"pings", kMaxPings};
      return spend(1);
    case FrameType::kGoAway:
    case FrameType::kWindowUpdate:
      return spend(1);
    case FrameType::kPushPromise:
    case FrameType::kContinuation:
      return Violation{"unexpected_frame", 0};
    case FrameType::kPriority:
      break;
  }
  passing_ = false;
  return spend(1 + frame.length / kBytesPerKibibyte);
}

std::optional<ConnectionRules::Violation> ConnectionRules::judge_headers(const FrameHeader& frame) {
  if (frame.stream % 2 == 0) return Violation{"unexpected_frame", 0};  // only servers begin those
  if (frame.length > kMaxHeaderBytes) return Violation{"header_block", kMaxHeaderBytes};
  if (!frame.has(kFlagEndHeaders)) block_stream_ = frame.stream;
  block_bytes_ = frame.length;
  continuations_ = 0;
  if (frame.stream <= last_stream_) return spend(1);  // trailers
  last_stream_ = frame.stream;
  open_.push_back(frame.stream);
  if (options_.max_resets != 0 && open_.size() > kMaxOpen)
    return Violation{"calls_without_end", kMaxOpen};
  return std::nullopt;
}

std::optional<ConnectionRules::Violation> ConnectionRules::judge_continuation(
    const FrameHeader& frame) {
  if (frame.type != FrameType::kContinuation || frame.stream != block_stream_)
    return Violation{"unexpected_frame", 0};
  block_bytes_ += std::min(frame.length, kMaxHeaderBytes + 1);
  if (block_bytes_ > kMaxHeaderBytes) return Violation{"header_block", kMaxHeaderBytes};
  if (++continuations_ > kMaxContinuations) return Violation{"continuations", kMaxContinuations};
  if (frame.has(kFlagEndHeaders)) block_stream_ = 0;
  return std::nullopt;
}

std::optional<ConnectionRules::Violation> ConnectionRules::judge_reset(const FrameHeader& frame) {
  if (!end_stream(frame.stream)) return spend(1);
  if (++resets_ > options_.max_resets && options_.max_resets != 0)
    return Violation{"resets", options_.max_resets};
  return std::nullopt;
}

void ConnectionRules::sent(std::string_view bytes) {
  to_client_.split(
      bytes,
      [this](const FrameHeader& frame, std::string_view) {
        earned_ += kCreditPerFrameSent;
        if (frame.type == FrameType::kPing && frame.has(kFlagAck) && pings_ != 0) --pings_;
        const bool data = frame.type == FrameType::kData;
        if (data) earned_ += kCreditPerKibibyte * frame.length / kBytesPerKibibyte;
        const bool last = (data || frame.type == FrameType::kHeaders) && frame.has(kFlagEndStream);
        if ((last || frame.type == FrameType::kReset) && end_stream(frame.stream)) ++answered_;
        return true;
      },
      [](std::string_view) {});
}

bool ConnectionRules::end_stream(std::uint32_t stream) {
  const auto found = std::lower_bound(open_.begin(), open_.end(), stream);
  if (found == open_.end() || *found != stream) return false;
  open_.erase(found);
  return true;
}

void ConnectionRules::pass_time(Clock::time_point now) {
  if (now - second_ >= std::chrono::seconds(1)) {
    second_ = now;
    resets_ = 0;
  }
  const double seconds = std::chrono::duration<double>(now - credit_time_).count();
  credit_ = std::min(kMaxCredit, credit_ + seconds * kCreditPerSecond + earned_);
  credit_time_ = now;
  earned_ = 0;
}

std::optional<ConnectionRules::Violation> ConnectionRules::spend(double frames) {
  credit_ -= frames;
  if (credit_ >= 0) return std::nullopt;
  return Violation{"frames", static_cast<std::uint64_t>(kCreditPerSecond)};
}

}  // namespace weft::server
