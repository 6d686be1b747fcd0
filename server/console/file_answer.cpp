// SPDX-License-Identifier: Apache-2.0
#include "server/console/file_answer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/beast/http/write.hpp>
#include <sstream>
#include <utility>

namespace weft::server {
namespace {

constexpr std::size_t kPiece = std::size_t{64} << 10;
constexpr std::string_view kLineEnd = "\r\n";

std::string text_of(const Response& head) {
  std::ostringstream text;
  text << head.base();
  return text.str();
}

}  // namespace

FileAnswer::FileAnswer(Answer answer)
    : place_(std::move(answer.place)),
      file_(std::move(answer.file)),
      at_(answer.file_first),
      left_(answer.file_bytes),
      grows_(answer.grows),
      chunked_(answer.grows),
      window_(kPiece) {
  if (chunked_)
    answer.head.chunked(true);
  else
    answer.head.content_length(left_);
  head_ = text_of(answer.head);
}

void FileAnswer::end(const boost::beast::http::fields& trailers) {
  grows_ = false;
  tail_ = "0\r\n";
  for (const auto& field : trailers)
    tail_ += fmt::format("{}: {}\r\n", view(field.name_string()), view(field.value()));
  tail_ += kLineEnd;
}

std::optional<std::vector<boost::asio::const_buffer>> FileAnswer::next() {
  using boost::asio::buffer;
  if (!head_.empty() || left_ == 0) {
    text_ = std::exchange(head_.empty() ? tail_ : head_, {});
    return std::vector<boost::asio::const_buffer>{buffer(text_)};
  }
  const ssize_t read = ::pread(file_.get(), window_.data(), std::min<std::uint64_t>(kPiece, left_),
                               static_cast<off_t>(at_));
  if (read <= 0) return std::nullopt;
  const auto size = static_cast<std::size_t>(read);
  at_ += size;
  left_ -= size;
  if (!chunked_) return std::vector<boost::asio::const_buffer>{buffer(window_, size)};
  text_ = fmt::format("{:x}\r\n", size);
  return std::vector<boost::asio::const_buffer>{buffer(text_), buffer(window_, size),
                                                buffer(kLineEnd)};
}

}  // namespace weft::server
