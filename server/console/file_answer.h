// SPDX-License-Identifier: Apache-2.0
// A response whose body is a file: one that is there, or one that is still written, which is sent
// in HTTP chunks with trailers after the last.
//
//   FileAnswer answer(std::move(head_and_file));
//   while (answer.has_next()) write(answer.next());   // and again after `grow` and `end`
#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/fields.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/console/exchange.h"

namespace weft::server {

class FileAnswer {
 public:
  // REQUIRES: the answer has a file.
  explicit FileAnswer(Answer answer);

  // REQUIRES: the answer grows, and has not ended.
  void grow(std::uint64_t bytes) { left_ += bytes; }
  void end(const boost::beast::http::fields& trailers);

  // All is written, or is what `next` returned last.
  bool over() const { return !grows_ && !has_next(); }
  bool has_next() const { return !head_.empty() || left_ > 0 || !tail_.empty(); }
  // What is to be written next, which stays in memory until the next call; nullopt if the file
  // cannot be read. REQUIRES: has_next().
  std::optional<std::vector<boost::asio::const_buffer>> next();

 private:
  const std::shared_ptr<const void> place_;
  files::FileDescriptor file_;
  std::uint64_t at_;
  std::uint64_t left_;  // bytes
  bool grows_;
  const bool chunked_;
  std::string head_;  // until it is returned, as is the tail
  std::string tail_;
  std::string text_;          // of what was returned last,
  std::vector<char> window_;  // and its bytes of the file
};

}  // namespace weft::server
