// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/post.h"

#include <openssl/ssl.h>

#include <algorithm>
#include <array>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include "server/net/beast.h"

namespace weft::server {
namespace {

using Clock = std::chrono::steady_clock;

// Of an answer.
constexpr std::uint32_t kMaxHeader = 16 << 10;
constexpr std::size_t kMaxBody = 64 << 10;

http::request<http::string_body> message_of(const PostRequest& request) {
  http::request<http::string_body> message{http::verb::post, request.url.target, 11};
  message.set(http::field::host, request.url.authority());
  message.set(http::field::user_agent, "weftd");
  message.set(http::field::content_type, "application/json");
  message.set(http::field::connection, "close");
  for (const auto& [name, value] : request.headers) message.set(name, value);
  message.body() = request.body;
  message.prepare_payload();
  return message;
}

Posted unanswered(const error_code& error) {
  return {.error = error == beast::error::timeout ? "it took too long" : error.message()};
}

}  // namespace

// One request, on its own io_context, which runs until what was begun has ended, or is stopped.
class Poster::Sending {
 public:
  explicit Sending(Poster& poster) : poster_(poster) {
    MutexLock lock(poster_.mutex_);
    poster_.sending_.insert(io_.get());
    if (poster_.stopping_) io_->stop();
  }
  ~Sending() {
    MutexLock lock(poster_.mutex_);
    poster_.sending_.erase(io_.get());
  }
  Sending(const Sending&) = delete;
  Sending& operator=(const Sending&) = delete;

  Posted send(const PostRequest& request) {
    error_code error = find(request.url);
    if (error == beast::error::timeout) return {.error = "looking up the host took too long"};
    if (error) return {.error = "the host is not found: " + error.message()};
    beast::tcp_stream stream(*io_);
    error = asio::error::access_denied;
    for (const tcp::endpoint& each : found_) {
      if (!poster_.rules_.may_reach(each.address())) continue;
      stream.expires_at(std::min(Clock::now() + poster_.limits_.connect, end_));
      error = finish([&](auto done) { stream.async_connect(each, std::move(done)); });
      if (!error) break;
    }
    if (error == asio::error::access_denied)
      return {.refused = true, .error = "the host has no address that callbacks may go to"};
    if (error) return unanswered(error);
    stream.expires_at(end_);
    if (!request.url.tls) return exchange(stream, request);
    beast::ssl_stream<beast::tcp_stream> encrypted(std::move(stream), poster_.authorities_);
    encrypted.set_verify_callback(asio::ssl::host_name_verification(request.url.host));
    SSL_set_tlsext_host_name(encrypted.native_handle(), request.url.host.c_str());
    error = finish([&](auto done) {
      encrypted.async_handshake(asio::ssl::stream_base::client, std::move(done));
    });
    if (error) return unanswered(error);
    return exchange(encrypted, request);
  }

 private:
  // What `begin` begins may call more than once; the first call counts.
  template <class Begin>
  error_code finish(const Begin& begin) {
    const auto result = std::make_shared<std::optional<error_code>>();
    begin([result](const error_code& error, const auto&...) {
      if (!*result) *result = error;
    });
    while (!*result)
      if (io_->run_one() == 0) return asio::error::operation_aborted;
    return **result;
  }

  // Looks the host up on a thread that may outlive this: the system cannot be told to give up, and
  // Asio's own look-up would hold up the end of its io_context.
  error_code find(const CallbackUrl& url) {
    asio::steady_timer timer(*io_, end_);
    const auto found = std::make_shared<std::vector<tcp::endpoint>>();
    const error_code error = finish([&](auto done) {
      timer.async_wait([done](const error_code&) mutable { done(beast::error::timeout); });
      std::thread([io = io_, look_up = poster_.look_up_, host = url.host, port = url.port, found,
                   done] {
        error_code failed;
        *found = look_up(host, port, failed);
        asio::post(*io, [done, failed]() mutable { done(failed); });
      }).detach();
    });
    if (!error) found_ = std::move(*found);
    return error;
  }

  template <class Stream>
  Posted exchange(Stream& stream, const PostRequest& request) {
    if (Clock::now() >= end_) return unanswered(beast::error::timeout);
    const auto message = message_of(request);
    error_code error =
        finish([&](auto done) { http::async_write(stream, message, std::move(done)); });
    if (error) return unanswered(error);
    beast::flat_buffer buffer(2 * kMaxHeader);
    http::response_parser<http::buffer_body> answer;
    answer.header_limit(kMaxHeader);
    answer.body_limit(std::numeric_limits<std::uint64_t>::max());  // skip_body has its own
    error = finish(
        [&](auto done) { http::async_read_header(stream, buffer, answer, std::move(done)); });
    if (error) return unanswered(error);
    skip_body(stream, buffer, answer);
    return {.status = answer.get().result_int()};
  }

  // So that a receiver with a short answer does not see a broken connection.
  template <class Stream>
  void skip_body(Stream& stream, beast::flat_buffer& buffer,
                 http::response_parser<http::buffer_body>& answer) {
    std::array<char, 4096> scrap;
    for (std::size_t read = 0; !answer.is_done() && read < kMaxBody; read += scrap.size()) {
      answer.get().body().data = scrap.data();
      answer.get().body().size = scrap.size();
      const error_code error =
          finish([&](auto done) { http::async_read(stream, buffer, answer, std::move(done)); });
      if (error && error != http::error::need_buffer) return;
    }
  }

  Poster& poster_;
  const Clock::time_point end_ = Clock::now() + poster_.limits_.total;
  std::vector<tcp::endpoint> found_;
  const std::shared_ptr<asio::io_context> io_ = std::make_shared<asio::io_context>(1);
  const asio::executor_work_guard<asio::io_context::executor_type> work_{io_->get_executor()};
};

std::vector<tcp::endpoint> look_up(const std::string& host, const std::string& port,
                                   error_code& error) {
  asio::io_context io;
  std::vector<tcp::endpoint> found;
  for (const auto& each :
       tcp::resolver(io).resolve(host, port, tcp::resolver::numeric_service, error))
    found.push_back(each.endpoint());
  return found;
}

Poster::Poster(AddressRules rules, const PostLimits& limits, LookUp look_up)
    : rules_(std::move(rules)),
      limits_(limits),
      look_up_(look_up),
      authorities_(asio::ssl::context::tls_client) {
  SSL_CTX_set_min_proto_version(authorities_.native_handle(), TLS1_2_VERSION);
  authorities_.set_default_verify_paths();
  authorities_.set_verify_mode(asio::ssl::verify_peer);
}

Posted Poster::post(const PostRequest& request) {
  return Sending(*this).send(request);
}

void Poster::stop() {
  MutexLock lock(mutex_);
  stopping_ = true;
  for (asio::io_context* const io : sending_) io->stop();
}

}  // namespace weft::server
