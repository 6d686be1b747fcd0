// SPDX-License-Identifier: Apache-2.0
#include "server/front/frames.h"

namespace weft::server {
namespace {

constexpr std::uint32_t kEnhanceYourCalm = 0xb;
constexpr std::uint32_t kLastStream = 0x7fffffff;

std::uint32_t number(const char* bytes, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}

}  // namespace

FrameHeader FrameSplitter::header() const {
  return {.length = number(head_.data(), 3),
          .type = static_cast<FrameType>(head_[3]),
          .flags = static_cast<std::uint8_t>(head_[4]),
          .stream = number(head_.data() + 5, 4) & kLastStream};
}

std::string calm_down(std::string_view reason) {
  std::string frame = big_endian(static_cast<std::uint32_t>(8 + reason.size()), 3);
  frame += static_cast<char>(FrameType::kGoAway);
  frame += '\0';
  frame += big_endian(0, 4) + big_endian(kLastStream, 4) + big_endian(kEnhanceYourCalm, 4);
  return frame.append(reason);
}

}  // namespace weft::server
