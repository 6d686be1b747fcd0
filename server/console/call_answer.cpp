// SPDX-License-Identifier: Apache-2.0
#include "server/console/call_answer.h"

#include <fmt/format.h>

#include "server/console/frames.h"

namespace weft::server {

std::vector<boost::asio::const_buffer> CallAnswer::next(std::string head) {
  begun_ = true;
  head_ = std::move(head);
  slices_.clear();
  std::uint32_t length = 0;
  std::uint8_t flags = 0;
  std::string tail = "\r\n";
  if (!messages_.empty()) {
    length = static_cast<std::uint32_t>(messages_.front().Length());
    messages_.front().Dump(&slices_);
    messages_.pop_front();
  } else {
    over_ = true;
    flags = kTrailerFlag;
    length = static_cast<std::uint32_t>(trailers_->size());
    slices_.emplace_back(*trailers_);
    tail += "0\r\n\r\n";
  }
  const auto frame = frame_header(flags, length);
  if (is_text_) {
    std::string bytes(frame.data(), frame.size());
    for (const grpc::Slice& slice : slices_)
      bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
    slices_.clear();
    std::string text = to_base64(bytes);
    text.append((4 - text.size() % 4) % 4, '=');
    head_ += fmt::format("{:x}\r\n{}", text.size(), text);
  } else {
    head_ += fmt::format("{:x}\r\n", length + kFrameHeader);
    head_.append(frame.data(), frame.size());
  }
  slices_.emplace_back(tail);
  std::vector<boost::asio::const_buffer> buffers{boost::asio::buffer(head_)};
  for (const grpc::Slice& slice : slices_) buffers.emplace_back(slice.begin(), slice.size());
  return buffers;
}

}  // namespace weft::server
