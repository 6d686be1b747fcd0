// SPDX-License-Identifier: Apache-2.0
// The body of a call's response: messages, then trailers, each as a frame in an HTTP chunk of its
// own.
//
//   CallAnswer answer(is_text);
//   answer.add(message);
//   answer.end(trailer_block(status, trailers));
//   while (answer.has_next()) write(answer.next(answer.begun() ? "" : head));
#pragma once

#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/slice.h>

#include <boost/asio/buffer.hpp>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace weft::server {

class CallAnswer {
 public:
  // `is_text`: the frames are sent in base64.
  explicit CallAnswer(bool is_text) : is_text_(is_text) {}

  void add(grpc::ByteBuffer message) { messages_.push_back(std::move(message)); }
  // `trailers`: the bytes of their frame. Nothing is added after that.
  void end(std::string trailers) { trailers_ = std::move(trailers); }

  bool is_text() const { return is_text_; }
  bool begun() const { return begun_; }
  // The trailers are written, or are what `next` returned last.
  bool over() const { return over_; }
  // Messages that wait.
  std::size_t waiting() const { return messages_.size(); }
  bool has_next() const { return !over_ && (!messages_.empty() || trailers_); }

  // What is to be written next, after `head`. It stays in memory until the next call. REQUIRES:
  // has_next().
  std::vector<boost::asio::const_buffer> next(std::string head);

 private:
  const bool is_text_;
  bool begun_ = false;
  bool over_ = false;
  std::deque<grpc::ByteBuffer> messages_;
  std::optional<std::string> trailers_;
  // What is being written.
  std::string head_;
  std::vector<grpc::Slice> slices_;
};

}  // namespace weft::server
