// SPDX-License-Identifier: Apache-2.0
// A request that is answered by a response of HTTP rather than by the messages of a call: its
// session has the connection, the exchange decides what comes back.
//
//   auto exchange = routes.open(std::move(visit));    // or a response, which needs no body
//   while (...) if (!exchange->take(bytes)) ...       // what the body has
//   exchange->body_ended();                           // then `answer`, at some time
//
// Thread-safety: none; every function is called on the thread that runs the io_context.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "files/base/atomic_file.h"
#include "server/console/frames.h"
#include "server/console/pages.h"

namespace weft::server {

struct Answer {
  Response head;  // with its body, unless that is a file
  files::FileDescriptor file{};
  std::uint64_t file_bytes = 0;         // that are sent of it
  std::uint64_t file_first = 0;         // the first of these
  bool grows = false;                   // more will be there to be sent: `grow` and `end` follow
  std::shared_ptr<const void> place{};  // what the file takes, until it is sent
};

class Exchange {
 public:
  class Client {
   public:
    // At most once.
    virtual void answer(Answer answer) = 0;
    // So many bytes more are in the file of the answer.
    virtual void grow(std::uint64_t bytes) = 0;
    // The file is whole. nullopt: it never will be; the connection breaks off, so that nobody takes
    // it for whole.
    virtual void end(const std::optional<boost::beast::http::fields>& trailers) = 0;

   protected:
    ~Client() = default;
  };

  virtual ~Exchange() = default;
  virtual bool wants_body() const = 0;
  // The next bytes of the body. False: it has answered, and wants no more.
  virtual bool take(std::string_view bytes) = 0;
  virtual void body_ended() = 0;
  // The body has not ended in time.
  virtual void body_late() = 0;
  // Nobody waits for an answer any more. Ends what is at work for it.
  virtual void drop() = 0;
};

struct Visit {
  boost::beast::http::verb method{};
  std::string target;
  const Headers& headers;  // while the exchange is opened
  Metadata metadata;       // of a call that is made for this client
  std::string client;      // who has a share, as Caller::client
  std::shared_ptr<Exchange::Client> answers_to;
};

class Routes {
 public:
  virtual ~Routes() = default;
  virtual tl::expected<std::shared_ptr<Exchange>, Response> open(Visit visit) = 0;
};

}  // namespace weft::server
