// SPDX-License-Identifier: Apache-2.0
// The body of a call's request, as the messages in it.
//
//   CallBody body(is_text, most_bytes, budget, client);
//   if (auto failure = body.add(bytes)) ...                        // as they come, split anywhere
//   while (true) {
//     auto message = body.next();                                  // or a failure
//     if (!*message) break;                                        // more bytes are needed
//     ... send(**message), then body.passed_on() ...
//   }
//   if (auto failure = body.end()) ...                             // no bytes follow
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "server/console/frames.h"
#include "server/wire/errors.h"

namespace weft::server {

class CallBody {
 public:
  // `is_text`: the frames come in base64. `most_bytes`: of a message. The budget must outlive this.
  CallBody(bool is_text, std::uint64_t most_bytes, ByteBudget& budget, std::string client)
      : is_text_(is_text),
        most_bytes_(most_bytes),
        frames_(most_bytes, budget, std::move(client)) {}

  // The bytes must stay where they are until `next` has asked for more. Errors: kMalformedRequest
  // if they are no base64, kLimitExceeded for a body much larger than the largest message.
  std::optional<Failure> add(std::string_view bytes);

  // Returns nullopt if more bytes are needed. Errors: those of FrameReader.
  tl::expected<std::optional<grpc::ByteBuffer>, Failure> next();

  // The last message of `next` has been passed on.
  void passed_on();

  // Error: kMalformedRequest if the body ends within a message.
  std::optional<Failure> end() const;

 private:
  const bool is_text_;
  const std::uint64_t most_bytes_;
  FrameReader frames_;
  Base64Reader decoder_;
  std::string decoded_;        // what was added last, if it came in base64
  std::string_view unread_;    // what of it, or of the bytes added, is not used yet
  std::uint64_t bytes_ = 0;    // so far
  std::uint64_t passing_ = 0;  // length of the last message
};

}  // namespace weft::server
