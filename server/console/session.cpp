// SPDX-License-Identifier: Apache-2.0
#include "server/console/session.h"

#include <fmt/format.h>
#include <grpc/grpc.h>
#include <netinet/tcp.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <cctype>
#include <deque>
#include <exception>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "server/console/transport.h"

namespace weft::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;
using Response = http::response<http::string_body>;

constexpr std::uint32_t kMostHeaderBytes = 16 << 10;  // the request line and all headers
constexpr std::size_t kWindow = std::size_t{64} << 10;
// A body of messages of the largest size may be a little larger.
constexpr std::uint64_t kMostFraming = 4096;
constexpr std::size_t kMostMessagesAhead = 1;
// How long a browser may take to notice that its request was answered before it was read.
constexpr std::chrono::seconds kLinger{5};

// Nothing but the application's own files runs, is shown or is asked, and no other site shows it in
// a frame. Pictures to download and to copy are made in the page.
constexpr std::string_view kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; worker-src 'self'; font-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

template <class Message>
void secure(Message& message) {
  message.set("Content-Security-Policy",
              beast::string_view(kContentSecurityPolicy.data(), kContentSecurityPolicy.size()));
  message.set("X-Content-Type-Options", "nosniff");
  message.set("Referrer-Policy", "no-referrer");
  message.set("X-Frame-Options", "DENY");
  message.set("Cross-Origin-Opener-Policy", "same-origin");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
}

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}
beast::string_view view(std::string_view text) {
  return {text.data(), text.size()};
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

// As gRPC spells it.
std::string peer_of(const tcp::socket& socket) {
  error_code error;
  const tcp::endpoint end = socket.remote_endpoint(error);
  if (error) return "unknown";
  const asio::ip::address& address = end.address();
  if (address.is_v6() && address.to_v6().is_v4_mapped())
    return fmt::format("ipv4:{}:{}",
                       asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string(),
                       end.port());
  return address.is_v4() ? fmt::format("ipv4:{}:{}", address.to_string(), end.port())
                         : fmt::format("ipv6:%5B{}%5D:{}", address.to_string(), end.port());
}

// The subject's common name, otherwise its first alternative name of a host; as gRPC reads them.
std::string name_in_certificate(SSL* connection) {
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(
      SSL_get1_peer_certificate(connection), &X509_free);
  if (certificate == nullptr || SSL_get_verify_result(connection) != X509_V_OK) return "";
  std::array<char, 256> name{};
  const int size = X509_NAME_get_text_by_NID(X509_get_subject_name(certificate.get()),
                                             NID_commonName, name.data(), name.size());
  if (size > 0) return {name.data(), static_cast<std::size_t>(size)};
  const std::unique_ptr<GENERAL_NAMES, decltype(&GENERAL_NAMES_free)> names(
      static_cast<GENERAL_NAMES*>(
          X509_get_ext_d2i(certificate.get(), NID_subject_alt_name, nullptr, nullptr)),
      &GENERAL_NAMES_free);
  for (int i = 0; names != nullptr && i < sk_GENERAL_NAME_num(names.get()); ++i) {
    const GENERAL_NAME* const each = sk_GENERAL_NAME_value(names.get(), i);
    if (each->type != GEN_DNS && each->type != GEN_EMAIL && each->type != GEN_URI) continue;
    const ASN1_STRING* const text = each->d.ia5;
    return {reinterpret_cast<const char*>(ASN1_STRING_get0_data(text)),
            static_cast<std::size_t>(ASN1_STRING_length(text))};
  }
  return "";
}

bool is_legal_metadata(const std::string& key, const std::string& value) {
  const auto slice = [](const std::string& text) {
    return grpc_slice_from_static_buffer(text.data(), text.size());
  };
  return grpc_header_key_is_legal(slice(key)) != 0 &&
         (key.ends_with("-bin") || grpc_header_nonbin_value_is_legal(slice(value)) != 0);
}

class HttpSession final : public Session,
                          public BridgeCall::Listener,
                          public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, std::shared_ptr<asio::ssl::context> tls, SessionContext& context)
      : context_(context),
        peer_(peer_of(socket)),
        transport_(std::move(socket), std::move(tls)),
        timer_(context.io),
        place_(context.open.insert(context.open.end(), this)) {}
  ~HttpSession() override { context_.open.erase(place_); }

  void start() override;
  void close() override;
  void finish() override;
  bool idle() const override { return state_ == State::kIdle || state_ == State::kHeader; }

 private:
  enum class State { kIdle, kHeader, kAnswering, kLingering, kClosed };
  using Parser = http::request_parser<http::buffer_body>;

  // The connection.
  void expire_in(std::chrono::milliseconds time);
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
  void answer_preflight();
  void respond(Response response);
  void refuse(http::status status, std::string why);
  Response page(http::status status, std::string_view type, std::string body) const;
  template <class Message>
  void allow_origin(Message& message) const;
  std::string_view header(std::string_view name) const { return view(parser_->get()[view(name)]); }
  void response_written();

  // One call.
  void begin_call();
  std::optional<Metadata> call_metadata() const;
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
  void write_out(std::vector<asio::const_buffer> buffers, bool last);
  std::string response_head() const;

  SessionContext& context_;
  const std::string peer_;
  Transport transport_;
  asio::steady_timer timer_;
  const std::list<Session*>::iterator place_;
  State state_ = State::kIdle;
  std::string certificate_name_;
  beast::flat_buffer buffer_{kMostHeaderBytes + kWindow};
  bool watching_ = false;  // a read waits for the next request, or for the browser to go

  std::optional<Parser> parser_;
  std::optional<Response> response_;
  PageOrigin origin_ = PageOrigin::kOwn;
  bool keep_ = true;  // the connection, after this response

  std::shared_ptr<BridgeCall> call_;
  std::optional<FrameReader> frames_;
  std::vector<char> window_;  // of the body
  std::string_view unread_;   // what is in it
  std::uint64_t body_bytes_ = 0;
  std::uint64_t passing_ = 0;  // length of the message that the call is taking
  bool body_wanted_ = false;   // its rest is still to be read
  bool reading_body_ = false;
  bool head_sent_ = false;
  bool writing_ = false;
  bool over_ = false;  // the trailers are queued
  std::deque<grpc::ByteBuffer> messages_;
  std::optional<std::string> trailers_;
  // What is being written.
  std::string head_;
  std::vector<grpc::Slice> slices_;
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
  const auto self = shared_from_this();  // the call may be the last that keeps it
  state_ = State::kClosed;
  timer_.cancel();
  error_code ignored;
  transport_.socket().close(ignored);
  if (const auto call = std::exchange(call_, nullptr)) call->drop();
}

void HttpSession::finish() {
  keep_ = false;
  if (state_ != State::kAnswering) close();
}

void HttpSession::expire_in(std::chrono::milliseconds time) {
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
  if (watching_) return;  // what it reads comes first
  state_ = State::kHeader;
  keep_ = true;
  origin_ = PageOrigin::kOwn;
  parser_.emplace();
  parser_->header_limit(kMostHeaderBytes);
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

// Answered before all was read, perhaps: closing at once would take the response from the browser.
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
  if (request.count(http::field::host) != 1 || !context_.rules.knows_host(header("Host")))
    return refuse(http::status::misdirected_request,
                  "the console is not known by this name: --console-origin can add it");
  origin_ = context_.rules.judge(header("Origin"), header("Host"));
  const http::verb method = request.method();
  const std::string_view target = view(request.target());
  if (origin_ == PageOrigin::kForeign)
    return refuse(http::status::forbidden,
                  "pages of other origins may not call: --console-origin can allow it");
  if (method == http::verb::options) return answer_preflight();
  if (method == http::verb::post) {
    if (!is_method_path(target)) return refuse(http::status::not_found, "there is no such method");
    return begin_call();
  }
  if (method != http::verb::get && method != http::verb::head)
    return refuse(http::status::method_not_allowed, "there are GET, HEAD and POST");
  if (target == "/metrics") return answer_metrics();
  answer_page();
}

Response HttpSession::page(http::status status, std::string_view type, std::string body) const {
  Response response;
  response.version(11);
  response.result(status);
  response.set(http::field::content_type, view(type));
  response.body() = std::move(body);
  return response;
}

template <class Message>
void HttpSession::allow_origin(Message& message) const {
  if (!context_.rules.origins.empty()) message.set(http::field::vary, "Origin, Accept-Encoding");
  if (origin_ != PageOrigin::kListed) return;
  message.set(http::field::access_control_allow_origin, view(header("Origin")));
  message.set(http::field::access_control_expose_headers,
              "grpc-status, grpc-message, grpc-status-details-bin");
  message.set("Cross-Origin-Resource-Policy", "cross-origin");
}

void HttpSession::refuse(http::status status, std::string why) {
  if (status == http::status::bad_request ||
      status == http::status::request_header_fields_too_large)
    keep_ = false;
  state_ = State::kAnswering;
  Response response = page(status, "text/plain; charset=utf-8", std::move(why) + "\n");
  if (status == http::status::method_not_allowed)
    response.set(http::field::allow, "GET, HEAD, POST, OPTIONS");
  respond(std::move(response));
}

void HttpSession::answer_preflight() {
  Response response = page(http::status::no_content, "text/plain; charset=utf-8", "");
  if (origin_ == PageOrigin::kListed) {
    response.set(http::field::access_control_allow_methods, "GET, HEAD, POST");
    response.set(http::field::access_control_allow_headers,
                 view(header("Access-Control-Request-Headers")));
    response.set(http::field::access_control_max_age, "7200");
  }
  respond(std::move(response));
}

void HttpSession::answer_metrics() {
  if (const auto name =
          context_.authenticator.token_name(parser_->get().count(http::field::authorization) == 1
                                                ? std::optional(header("Authorization"))
                                                : std::nullopt);
      !name)
    return refuse(http::status::unauthorized, name.error().message);
  Response response =
      page(http::status::ok, "text/plain; version=0.0.4; charset=utf-8", context_.metrics());
  response.set(http::field::cache_control, "no-store");
  respond(std::move(response));
}

void HttpSession::answer_page() {
  const std::string_view target = view(parser_->get().target());
  const std::string_view path = target.substr(0, target.find_first_of("?#"));
  if (context_.assets.empty() && path == "/")
    return respond(
        page(http::status::ok, "text/plain; charset=utf-8",
             "This weftd was built without the console's pages, and serves gRPC-Web only. "
             "A build with npm has them: see WEFT_CONSOLE of its CMake.\n"));
  const Asset* const asset = find_asset(context_.assets, path);
  if (asset == nullptr) return refuse(http::status::not_found, "there is no such page");
  const bool current = header("If-None-Match") == asset->etag;
  const bool gzip = accepts_gzip(header("Accept-Encoding"));
  Response response = page(current ? http::status::not_modified : http::status::ok, asset->type,
                           current ? std::string()
                           : gzip  ? std::string(asset->gzip)
                                   : inflated(*asset));
  response.set(http::field::etag, view(asset->etag));
  response.set(http::field::vary, "Accept-Encoding");
  response.set(http::field::cache_control,
               asset->immutable ? "public, max-age=31536000, immutable" : "no-cache");
  if (gzip && !current) response.set(http::field::content_encoding, "gzip");
  respond(std::move(response));
}

void HttpSession::respond(Response response) {
  secure(response);
  if (parser_ && parser_->is_header_done()) {
    allow_origin(response);
    if (!parser_->is_done()) keep_ = false;
  }
  response.keep_alive(keep_);
  response.prepare_payload();
  if (parser_ && parser_->is_header_done() && parser_->get().method() == http::verb::head)
    response.body().clear();  // what it would be is told nevertheless
  response_ = std::move(response);
  expire_in(context_.times.stall);
  http::async_write(transport_, *response_,
                    [self = shared_from_this()](error_code error, std::size_t) {
                      self->response_.reset();
                      if (error) return self->close();
                      self->response_written();
                    });
}

void HttpSession::response_written() {
  if (state_ == State::kClosed) return;
  if (!keep_) return linger();
  next_request();
}

// ---- one call ----

std::optional<Metadata> HttpSession::call_metadata() const {
  Metadata metadata{{std::string(kConsoleSecret), context_.secret},
                    {std::string(kConsolePeer), peer_}};
  if (!certificate_name_.empty()) metadata.emplace_back(kConsoleName, certificate_name_);
  for (const auto& field : parser_->get()) {
    std::string name = lower(view(field.name_string()));
    if (!is_metadata(name)) continue;
    std::string value(view(field.value()));
    if (name.ends_with("-bin")) {
      auto bytes = from_base64(value);
      if (!bytes) return std::nullopt;
      value = std::move(*bytes);
    }
    if (!is_legal_metadata(name, value)) return std::nullopt;
    metadata.emplace_back(std::move(name), std::move(value));
  }
  return metadata;
}

void HttpSession::begin_call() {
  const std::string type = lower(header("Content-Type"));
  if (type != "application/grpc-web" && type != "application/grpc-web+proto")
    return refuse(http::status::unsupported_media_type,
                  "calls are of the type application/grpc-web+proto");
  std::optional<std::chrono::system_clock::time_point> deadline;
  if (const std::string_view timeout = header("grpc-timeout"); !timeout.empty()) {
    const auto time = parse_timeout(timeout);
    if (!time) return refuse(http::status::bad_request, "grpc-timeout is malformed");
    deadline = std::chrono::system_clock::now() +
               std::chrono::duration_cast<std::chrono::system_clock::duration>(*time);
  }
  const auto metadata = call_metadata();
  if (!metadata) return refuse(http::status::bad_request, "a header cannot be metadata of a call");
  auto pass = context_.calls.enter();
  if (!pass) return close();
  timer_.cancel();  // from here on the call's own limits hold
  frames_.emplace(context_.most_request_bytes, context_.budget);
  body_bytes_ = 0;
  head_sent_ = writing_ = over_ = false;
  messages_.clear();
  trailers_.reset();
  call_ = BridgeCall::start(context_.stub, std::string(view(parser_->get().target())), *metadata,
                            deadline, context_.io, std::move(*pass), shared_from_this());
  call_->read();
  // The message of an unknown caller is not read, as over gRPC: the server refuses the call by its
  // headers.
  const auto& request = parser_->get();
  body_wanted_ = context_.authenticator
                     .token_name(request.count(http::field::authorization) == 1
                                     ? std::optional(header("Authorization"))
                                     : std::nullopt)
                     .has_value();
  if (!body_wanted_) return call_->end_writing();
  if (lower(header("Expect")) == "100-continue") return continue_body();
  read_body();
}

void HttpSession::continue_body() {
  static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
  writing_ = true;
  asio::async_write(transport_, asio::buffer(kContinue.data(), kContinue.size()),
                    [self = shared_from_this()](error_code error, std::size_t) {
                      self->writing_ = false;
                      if (error) return self->close();
                      self->write_next();
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
        self->unread_ = {self->window_.data(), size};
        self->body_bytes_ += size;
        self->take_body();
      });
}

void HttpSession::take_body() {
  if (body_bytes_ > context_.most_request_bytes + kMostFraming)
    return body_failed(
        {Reason::kLimitExceeded, "",
         fmt::format("the request has more than {} bytes", context_.most_request_bytes)});
  while (!unread_.empty()) {
    const auto used = frames_->feed(unread_);
    if (!used) return body_failed(used.error());
    unread_.remove_prefix(*used);
    if (auto message = frames_->next()) {
      passing_ = message->length;
      return call_->write(std::move(message->bytes));  // goes on when that was taken
    }
  }
  read_body();
}

void HttpSession::wrote(bool) {
  if (!frames_) return;
  frames_->give_back(std::exchange(passing_, 0));
  if (body_wanted_) take_body();
}

void HttpSession::body_ended() {
  if (!frames_->at_border())
    return body_failed({Reason::kMalformedRequest, "", "the request ends within a message"});
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
  messages_.push_back(std::move(message));
  write_next();
}

void HttpSession::ended(const grpc::Status& status, const Metadata& trailers) {
  call_.reset();
  end_call(status, trailers);
}

void HttpSession::end_call(const grpc::Status& status, const Metadata& trailers) {
  if (!parser_->is_done()) keep_ = false;
  body_wanted_ = false;
  frames_.reset();
  trailers_ = trailer_block(status, trailers);
  write_next();
}

std::string HttpSession::response_head() const {
  http::response<http::empty_body> response;
  response.version(11);
  response.result(http::status::ok);
  secure(response);
  response.set(http::field::content_type, "application/grpc-web+proto");
  response.set(http::field::transfer_encoding, "chunked");
  response.set(http::field::cache_control, "no-store");
  allow_origin(response);
  response.keep_alive(keep_);
  std::ostringstream text;
  text << response.base();
  return text.str();
}

void HttpSession::write_next() {
  if (writing_ || over_ || state_ != State::kAnswering) return;
  if (messages_.empty() && !trailers_) return;
  head_ = head_sent_ ? std::string() : response_head();
  head_sent_ = true;
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
  head_ += fmt::format("{:x}\r\n", length + kFrameHeader);
  const auto frame = frame_header(flags, length);
  head_.append(frame.data(), frame.size());
  slices_.emplace_back(tail);
  std::vector<asio::const_buffer> buffers{asio::buffer(head_)};
  for (const grpc::Slice& slice : slices_) buffers.emplace_back(slice.begin(), slice.size());
  write_out(std::move(buffers), over_);
  if (call_ != nullptr && messages_.size() < kMostMessagesAhead) call_->read();
}

void HttpSession::write_out(std::vector<asio::const_buffer> buffers, bool last) {
  writing_ = true;
  expire_in(context_.times.stall);
  asio::async_write(
      transport_, std::move(buffers),
      [self = shared_from_this()](error_code error, std::size_t) -> std::size_t {
        constexpr std::size_t kAtOnce = std::size_t{256} << 10;
        if (error) return 0;
        self->expire_in(self->context_.times.stall);
        return kAtOnce;
      },
      [self = shared_from_this(), last](error_code error, std::size_t) {
        self->writing_ = false;
        if (self->state_ == State::kClosed) return;
        if (error) return self->close();
        self->timer_.cancel();
        if (!last) return self->write_next();
        self->response_written();
      });
}

}  // namespace

std::shared_ptr<Session> make_session(tcp::socket socket, std::shared_ptr<asio::ssl::context> tls,
                                      SessionContext& context) {
  return std::make_shared<HttpSession>(std::move(socket), std::move(tls), context);
}

}  // namespace weft::server
