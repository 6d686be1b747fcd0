// SPDX-License-Identifier: Apache-2.0
#include "server/console/call_body.h"

#include <fmt/format.h>

#include <utility>

namespace weft::server {
namespace {

// A body may be this much larger than the largest message, because of its frames.
constexpr std::uint64_t kMaxFraming = 4096;

}  // namespace

std::optional<Failure> CallBody::add(std::string_view bytes) {
  unread_ = bytes;
  if (is_text_) {
    auto decoded = decoder_.feed(bytes);
    if (!decoded) return Failure{Reason::kMalformedRequest, "", "the request is not base64"};
    decoded_ = std::move(*decoded);
    unread_ = decoded_;
  }
  bytes_ += unread_.size();
  if (bytes_ > most_bytes_ + kMaxFraming)
    return Failure{Reason::kLimitExceeded, "",
                   fmt::format("the request has more than {} bytes", most_bytes_)};
  return std::nullopt;
}

tl::expected<std::optional<grpc::ByteBuffer>, Failure> CallBody::next() {
  while (!unread_.empty()) {
    const auto used = frames_.feed(unread_);
    if (!used) return tl::unexpected(used.error());
    unread_.remove_prefix(*used);
    if (auto message = frames_.next()) {
      passing_ = message->length;
      return std::move(message->bytes);
    }
  }
  return std::nullopt;
}

void CallBody::passed_on() {
  frames_.give_back(std::exchange(passing_, 0));
}

std::optional<Failure> CallBody::end() const {
  if (frames_.at_border() && decoder_.at_border()) return std::nullopt;
  return Failure{Reason::kMalformedRequest, "", "the request ends within a message"};
}

}  // namespace weft::server
