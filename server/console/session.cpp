// SPDX-License-Identifier: Apache-2.0
#include "server/console/session.h"

#include <netinet/tcp.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <exception>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "server/console/call_answer.h"
#include "server/console/call_body.h"
#include "server/console/call_headers.h"
#include "server/console/file_answer.h"
#include "server/console/pages.h"
#include "server/console/problem.h"
#include "server/console/transport.h"
#include "server/net/beast.h"
#include "server/net/peer.h"

namespace weft::server {
namespace {

constexpr std::uint32_t kMaxHeaderBytes = 16 << 10;  // the request line and all headers
constexpr std::size_t kWindow = std::size_t{64} << 10;
constexpr std::size_t kMaxMessagesAhead = 1;
// How long a browser may take to see the answer to a request that was not read to its end.
constexpr std::chrono::seconds kLinger{5};

class HttpSession final : public Session,
                          public BridgeCall::Listener,
                          public Exchange::Client,
                          public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, std::shared_ptr<asio::ssl::context> tls, const Door& door,
              SessionContext& context)
      : context_(context),
        door_(door),
        peer_(peer_of(socket)),
        host_(host_of_peer(peer_)),
        transport_(std::move(socket), std::move(tls)),
        timer_(context.io),
        place_(context.open.insert(context.open.end(), this)) {}
  ~HttpSession() override { context_.open.erase(place_); }

  void start() override;
  void close() override;
  void finish() override;
  const std::string& host() const override { return host_; }
  bool idle() const override { return state_ == State::kIdle || state_ == State::kHeader; }
  bool exchanging() const override { return exchange_ != nullptr || file_; }

 private:
  enum class State { kIdle, kHeader, kAnswering, kLingering, kClosed };
  using Parser = http::request_parser<http::buffer_body>;

  // The connection.
  void expire_in(ReadingRate::Clock::duration time);
  void watch();
  void next_request();
  void read_header();
  void linger();
  void discard();

  // One request.
  void judge();
  void dispatch();
  void answer_page();
  void answer_metrics();
  void respond(Response response);
  void refuse(http::status status, const std::string& why);
  std::string_view header(http::field name) const { return view(parser_->get()[name]); }
  // The only one; nullopt if there are none or several.
  std::optional<std::string_view> authorization() const;
  void response_written();

  // One exchange.
  void begin_exchange();
  void answer(Answer answer) override;
  void grow(std::uint64_t bytes) override;
  void end(const std::optional<http::fields>& trailers) override;
  void write_file();

  // One call.
  void begin_call();
  Metadata identity() const;
  // Who has a share, by the name of its token, if it has one.
  std::string client(const std::string& token_name) const {
    return Caller{.name = token_name.empty() ? certificate_name_ : token_name, .peer = peer_}
        .client();
  }
  void want_body();
  void continue_body();
  void read_body();
  void take_body();
  void body_failed(const Failure& failure);
  void body_ended();
  void wrote(bool ok) override;
  void received(grpc::ByteBuffer message) override;
  void ended(const grpc::Status& status, const Metadata& trailers) override;
  void end_call(const grpc::Status& status, const Metadata& trailers);
  void write_next();
  bool reads_on(std::size_t bytes);
  void write_out(std::vector<asio::const_buffer> buffers);
  std::string response_head() const;

  SessionContext& context_;
  const Door& door_;
  const std::string peer_, host_;
  Transport transport_;
  asio::steady_timer timer_;
  const std::list<Session*>::iterator place_;
  State state_ = State::kIdle;
  std::string certificate_name_;
  beast::flat_buffer buffer_{kMaxHeaderBytes + kWindow};
  bool watching_ = false;  // a read waits for the next request, or for the browser to close

  std::optional<Parser> parser_;
  std::optional<Response> response_;
  PageOrigin origin_ = PageOrigin::kOwn;
  bool keep_ = true;  // the connection, after this response

  std::shared_ptr<Exchange> exchange_;
  std::optional<FileAnswer> file_;  // that is being written

  std::shared_ptr<BridgeCall> call_;
  std::optional<CallBody> body_;
  std::optional<CallAnswer> answer_;
  std::vector<char> window_;  // for the body
  bool body_wanted_ = false;  // its rest is still to be read
  bool reading_body_ = false;
  bool writing_ = false;
  ReadingRate rate_;  // at which an answer is read
};

// ---- the connection ----

void HttpSession::start() {
  const auto self = shared_from_this();
  error_code error;
  transport_.socket().set_option(tcp::no_delay(true), error);
  // A browser that vanished without a word is noticed while its call is silent, too.
  transport_.socket().set_option(asio::socket_base::keep_alive(true), error);
  const int handle = transport_.socket().native_handle();
  for (const auto& [option, value] :
       {std::pair(TCP_KEEPIDLE, 30), {TCP_KEEPINTVL, 10}, {TCP_KEEPCNT, 3}})
    ::setsockopt(handle, IPPROTO_TCP, option, &value, sizeof value);
  if (!transport_.encrypted()) return next_request();
  expire_in(context_.times.header);
  transport_.tls().async_handshake(asio::ssl::stream_base::server, [self](error_code failed) {
    if (failed || self->state_ == State::kClosed) return self->close();
    self->certificate_name_ = name_in_certificate(self->transport_.tls().native_handle());
    self->next_request();
  });
}

void HttpSession::close() {
  if (state_ == State::kClosed) return;
  const auto self = shared_from_this();  // the call may hold the last reference
  state_ = State::kClosed;
  timer_.cancel();
  error_code ignored;
  transport_.socket().close(ignored);
  if (const auto call = std::exchange(call_, nullptr)) call->drop();
  if (const auto exchange = std::exchange(exchange_, nullptr)) exchange->drop();
  file_.reset();
}

void HttpSession::finish() {
  keep_ = false;
  if (state_ != State::kAnswering) close();
}

void HttpSession::expire_in(ReadingRate::Clock::duration time) {
  timer_.expires_after(time);
  timer_.async_wait([weak = weak_from_this()](error_code error) {
    if (const auto self = weak.lock(); self && !error) self->close();
  });
}

// Bytes that come while a response is written are the next request's.
void HttpSession::watch() {
  if (watching_ || state_ == State::kClosed || buffer_.size() > 0) return;
  watching_ = true;
  transport_.async_read_some(buffer_.prepare(4096),
                             [self = shared_from_this()](error_code error, std::size_t size) {
                               self->watching_ = false;
                               if (error) return self->close();  // the browser is gone
                               self->buffer_.commit(size);
                               if (self->state_ == State::kIdle) self->read_header();
                               if (self->state_ == State::kLingering) self->discard();
                             });
}

void HttpSession::next_request() {
  if (state_ == State::kClosed) return;
  if (context_.stopping) return close();
  state_ = State::kIdle;
  context_.open.splice(context_.open.end(), context_.open, place_);
  parser_.reset();
  if (buffer_.size() > 0) return read_header();
  expire_in(context_.times.idle);
  watch();
}

void HttpSession::read_header() {
  if (watching_) return;  // what that read returns comes first
  state_ = State::kHeader;
  keep_ = true;
  origin_ = PageOrigin::kOwn;
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // take_body counts
  expire_in(context_.times.header);
  http::async_read_header(
      transport_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
        if (self->state_ == State::kClosed) return;
        if (error == http::error::header_limit)
          return self->refuse(http::status::request_header_fields_too_large,
                              "the header is too long");
        if (error &&
            error.category() == http::make_error_code(http::error::bad_method).category() &&
            error != http::error::end_of_stream && error != http::error::partial_message)
          return self->refuse(http::status::bad_request, error.message());
        if (error) return self->close();
        self->judge();
      });
}

// The answer may have been sent before the request was read to its end: closing at once could make
// the browser lose the answer.
void HttpSession::linger() {
  if (state_ == State::kClosed) return;
  state_ = State::kLingering;
  expire_in(kLinger);
  error_code ignored;
  transport_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  window_.resize(kWindow);
  if (!reading_body_ && !watching_) discard();
}

void HttpSession::discard() {
  transport_.socket().async_read_some(asio::buffer(window_),
                                      [self = shared_from_this()](error_code error, std::size_t) {
                                        if (error) return self->close();
                                        self->discard();
                                      });
}

// ---- one request ----

void HttpSession::judge() {
  state_ = State::kAnswering;
  try {
    dispatch();
  } catch (const std::exception&) {
    close();  // out of memory
  }
}

void HttpSession::dispatch() {
  const auto& request = parser_->get();
  keep_ = request.keep_alive() && !context_.stopping;
  if (request.version() != 11)
    return refuse(http::status::http_version_not_supported, "this server speaks HTTP/1.1");
  if (request.count(http::field::host) != 1 || !door_.rules.knows_host(header(http::field::host)))
    return refuse(http::status::misdirected_request,
                  "the console is not known by this name: --console-origin can add it");
  origin_ = door_.rules.judge(header(http::field::origin), header(http::field::host));
  const http::verb method = request.method();
  const std::string_view target = view(request.target());
  if (origin_ == PageOrigin::kForeign)
    return refuse(http::status::forbidden,
                  "pages of other origins may not call: --console-origin can allow it");
  if (method == http::verb::options) return respond(preflight_answer(origin_, request));
  if (!door_.console || target.starts_with("/v1/")) return begin_exchange();
  if (method == http::verb::post) {
    if (!is_method_path(target)) return refuse(http::status::not_found, "there is no such method");
    return begin_call();
  }
  if (method != http::verb::get && method != http::verb::head)
    return refuse(http::status::method_not_allowed, "only GET, HEAD and POST are supported");
  if (target == "/metrics") return answer_metrics();
  answer_page();
}

std::optional<std::string_view> HttpSession::authorization() const {
  if (parser_->get().count(http::field::authorization) != 1) return std::nullopt;
  return header(http::field::authorization);
}

void HttpSession::refuse(http::status status, const std::string& why) {
  if (status == http::status::bad_request ||
      status == http::status::request_header_fields_too_large)
    keep_ = false;
  state_ = State::kAnswering;
  respond(refusal(status, why));
}

void HttpSession::answer_metrics() {
  if (const auto name = context_.authenticator.token_name(authorization()); !name)
    return refuse(http::status::unauthorized, name.error().message);
  Response response =
      make_page(http::status::ok, "text/plain; version=0.0.4; charset=utf-8", context_.metrics());
  response.set(http::field::cache_control, "no-store");
  respond(std::move(response));
}

void HttpSession::answer_page() {
  const auto& request = parser_->get();
  auto response = asset_page(context_.assets, view(request.target()), request);
  if (!response) return refuse(http::status::not_found, "there is no such page");
  respond(std::move(*response));
}

void HttpSession::respond(Response response) {
  secure(response);
  if (parser_ && parser_->is_header_done()) {
    allow_origin(door_.rules, origin_, parser_->get(), response);
    if (!parser_->is_done()) keep_ = false;
  }
  response.keep_alive(keep_);
  response.prepare_payload();
  if (parser_ && parser_->is_header_done() && parser_->get().method() == http::verb::head)
    response.body().clear();  // the headers describe it all the same
  response_ = std::move(response);
  expire_in(context_.patience.stall_timeout);
  http::async_write(transport_, *response_,
                    [self = shared_from_this()](error_code error, std::size_t) {
                      self->response_.reset();
                      if (error) return self->close();
                      self->response_written();
                    });
}

void HttpSession::response_written() {
  if (state_ == State::kClosed) return;
  rate_.rest();
  if (!keep_) return linger();
  next_request();
}

// ---- one exchange ----

void HttpSession::begin_exchange() {
  const auto& request = parser_->get();
  const auto name = context_.authenticator.token_name(authorization());
  if (!name)
    return respond(
        problem_page({.status = 401, .reason = "UNAUTHENTICATED", .detail = name.error().message}));
  auto metadata = metadata_in(request);
  if (!metadata) return refuse(http::status::bad_request, kNoMetadata);
  const Metadata mine = identity();
  metadata->insert(metadata->end(), mine.begin(), mine.end());
  auto opened = context_.routes->open({.method = request.method(),
                                       .target = std::string(view(request.target())),
                                       .headers = request,
                                       .metadata = std::move(*metadata),
                                       .client = client(*name),
                                       .answers_to = shared_from_this()});
  if (!opened) return respond(std::move(opened.error()));
  exchange_ = std::move(*opened);
  body_wanted_ = false;
  writing_ = false;
  if (!exchange_->wants_body()) {
    timer_.cancel();
    if (parser_->is_done()) watch();
    return exchange_->body_ended();
  }
  timer_.expires_after(context_.times.body);
  timer_.async_wait([weak = weak_from_this()](error_code error) {
    const auto self = weak.lock();
    if (self && !error && self->exchange_) self->exchange_->body_late();
  });
  want_body();
}

void HttpSession::answer(Answer answer) {
  if (state_ != State::kAnswering || !exchange_) return;
  if (!answer.grows) exchange_.reset();
  body_wanted_ = false;
  if (!answer.file.is_open()) return respond(std::move(answer.head));
  if (!parser_->is_done()) keep_ = false;
  secure(answer.head);
  allow_origin(door_.rules, origin_, parser_->get(), answer.head);
  answer.head.keep_alive(keep_);
  file_.emplace(std::move(answer));
  write_file();
}

void HttpSession::grow(std::uint64_t bytes) {
  if (!file_) return;
  file_->grow(bytes);
  if (!writing_) write_file();
}

void HttpSession::end(const std::optional<http::fields>& trailers) {
  if (!file_) return;
  exchange_.reset();
  if (!trailers) return close();
  file_->end(*trailers);
  if (!writing_) write_file();
}

void HttpSession::write_file() {
  if (file_->over()) {
    file_.reset();
    return response_written();
  }
  if (!file_->has_next()) return rate_.rest();  // `grow` and `end` go on
  auto next = file_->next();
  if (!next) return close();  // the disk's fault; the client sees that bytes are missing
  write_out(std::move(*next));
}

// ---- one call ----

Metadata HttpSession::identity() const {
  Metadata metadata{{std::string(kConsoleSecret), context_.secret},
                    {std::string(kConsolePeer), peer_}};
  if (!certificate_name_.empty())
    metadata.emplace_back(std::string(kConsoleName), certificate_name_);
  return metadata;
}

void HttpSession::want_body() {
  body_wanted_ = true;
  if (lower_case(header(http::field::expect)) == "100-continue") return continue_body();
  read_body();
}

void HttpSession::begin_call() {
  const auto& request = parser_->get();
  auto headers = read_call_headers(request);
  if (!headers) return refuse(headers.error().status, headers.error().why);
  Metadata& metadata = headers->metadata;
  const Metadata mine = identity();
  metadata.insert(metadata.end(), mine.begin(), mine.end());
  auto pass = context_.calls.enter();
  if (!pass) return close();
  timer_.cancel();  // from here on the call's own limits hold
  const auto name = context_.authenticator.token_name(authorization());
  body_.emplace(headers->is_text, context_.most_request_bytes, context_.budget,
                client(name.value_or("")));
  answer_.emplace(headers->is_text);
  writing_ = false;
  call_ = BridgeCall::start(context_.stub, std::string(view(request.target())), metadata,
                            headers->deadline, context_.io, std::move(*pass), shared_from_this());
  call_->read();
  // As over gRPC, the message of an unknown caller is not read: the server refuses the call by its
  // headers.
  if (name) return want_body();
  body_wanted_ = false;
  call_->end_writing();
}

void HttpSession::continue_body() {
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  writing_ = true;
  asio::async_write(transport_, asio::buffer(kContinue.data(), kContinue.size()),
                    [self = shared_from_this()](error_code error, std::size_t) {
                      self->writing_ = false;
                      if (error) return self->close();
                      if (!self->exchange_) self->write_next();
                      self->read_body();
                    });
}

void HttpSession::read_body() {
  if (!body_wanted_ || reading_body_ || state_ != State::kAnswering) return;
  if (parser_->is_done()) return body_ended();
  window_.resize(kWindow);
  auto& body = parser_->get().body();
  body.data = window_.data();
  body.size = window_.size();
  body.more = true;
  reading_body_ = true;
  http::async_read_some(
      transport_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
        self->reading_body_ = false;
        if (self->state_ == State::kLingering) return self->discard();
        if (!self->body_wanted_ || self->state_ == State::kClosed) return;
        if (error && error != http::error::need_buffer) return self->close();
        const std::size_t size = self->window_.size() - self->parser_->get().body().size;
        if (self->exchange_) {
          if (self->exchange_->take({self->window_.data(), size})) self->read_body();
          return;
        }
        if (const auto failure = self->body_->add({self->window_.data(), size}))
          return self->body_failed(*failure);
        self->take_body();
      });
}

void HttpSession::take_body() {
  auto message = body_->next();
  if (!message) return body_failed(message.error());
  if (*message) return call_->write(std::move(**message));  // goes on when the call has taken it
  read_body();
}

void HttpSession::wrote(bool) {
  if (!body_) return;
  body_->passed_on();
  if (body_wanted_) take_body();
}

void HttpSession::body_ended() {
  if (exchange_) {
    body_wanted_ = false;
    timer_.cancel();
    watch();
    return exchange_->body_ended();
  }
  if (const auto failure = body_->end()) return body_failed(*failure);
  body_wanted_ = false;
  call_->end_writing();
  watch();
}

void HttpSession::body_failed(const Failure& failure) {
  const auto call = std::exchange(call_, nullptr);
  call->drop();
  end_call(to_status(failure, ""), {});
}

void HttpSession::received(grpc::ByteBuffer message) {
  answer_->add(std::move(message));
  write_next();
}

void HttpSession::ended(const grpc::Status& status, const Metadata& trailers) {
  call_.reset();
  end_call(status, trailers);
}

void HttpSession::end_call(const grpc::Status& status, const Metadata& trailers) {
  if (!parser_->is_done()) keep_ = false;
  body_wanted_ = false;
  body_.reset();
  answer_->end(trailer_block(status, trailers));
  write_next();
}

std::string HttpSession::response_head() const {
  http::response<http::empty_body> response;
  response.version(11);
  response.result(http::status::ok);
  secure(response);
  response.set(http::field::content_type, answer_->is_text() ? "application/grpc-web-text+proto"
                                                             : "application/grpc-web+proto");
  response.set(http::field::transfer_encoding, "chunked");
  response.set(http::field::cache_control, "no-store");
  allow_origin(door_.rules, origin_, parser_->get(), response);
  response.keep_alive(keep_);
  std::ostringstream text;
  text << response.base();
  return text.str();
}

void HttpSession::write_next() {
  if (writing_ || state_ != State::kAnswering) return;
  if (!answer_->has_next()) return rate_.rest();
  write_out(answer_->next(answer_->begun() ? std::string() : response_head()));
  if (call_ != nullptr && answer_->waiting() < kMaxMessagesAhead) call_->read();
}

// The browser has taken so many bytes more.
bool HttpSession::reads_on(std::size_t bytes) {
  rate_.add(bytes);
  return !rate_.too_slow(ReadingRate::Clock::now(), context_.patience);
}

void HttpSession::write_out(std::vector<asio::const_buffer> buffers) {
  writing_ = true;
  rate_.start(ReadingRate::Clock::now());
  asio::async_write(
      transport_, std::move(buffers),
      [self = shared_from_this(), before = std::size_t{0}](error_code error,
                                                           std::size_t taken) mutable {
        constexpr std::size_t kAtOnce = std::size_t{256} << 10;
        if (error) return std::size_t{0};
        if (!self->reads_on(taken - std::exchange(before, taken))) {
          self->close();
          return std::size_t{0};
        }
        self->expire_in(self->context_.patience.stall_timeout);
        return kAtOnce;
      },
      [self = shared_from_this()](error_code error, std::size_t) {
        self->writing_ = false;
        if (self->state_ == State::kClosed) return;
        if (error) return self->close();
        self->timer_.cancel();
        if (self->file_) return self->write_file();
        if (!self->answer_->over()) return self->write_next();
        self->response_written();
      });
}

}  // namespace

std::shared_ptr<Session> make_session(tcp::socket socket, std::shared_ptr<asio::ssl::context> tls,
                                      const Door& door, SessionContext& context) {
  return std::make_shared<HttpSession>(std::move(socket), std::move(tls), door, context);
}

}  // namespace weft::server
