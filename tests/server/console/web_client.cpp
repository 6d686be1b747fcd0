// SPDX-License-Identifier: Apache-2.0
#include "tests/server/console/web_client.h"

#include <arpa/inet.h>
#include <openssl/evp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <stdexcept>

#include "tests/support/event.h"

namespace weft::server::testing {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool has(const Headers& headers, const std::string& name) {
  return std::any_of(headers.begin(), headers.end(),
                     [&](const auto& header) { return lower(header.first) == name; });
}

// NAME: VALUE
std::pair<std::string, std::string> split_header(const std::string& line) {
  const auto colon = line.find(": ");
  if (colon == std::string::npos) throw std::runtime_error("no header: " + line);
  return {lower(line.substr(0, colon)), line.substr(colon + 2)};
}

std::string percent_decoded(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      out += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string base64_decoded(std::string text) {
  while (text.size() % 4 != 0) text += '=';
  const auto padding = std::count(text.begin(), text.end(), '=');
  std::string out(text.size() / 4 * 3, '\0');
  if (EVP_DecodeBlock(reinterpret_cast<unsigned char*>(out.data()),
                      reinterpret_cast<const unsigned char*>(text.data()),
                      static_cast<int>(text.size())) < 0)
    throw std::runtime_error("not base64: " + text);
  out.resize(out.size() - static_cast<std::size_t>(padding));
  return out;
}

int connect_to(const std::string& address, int receive_buffer) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (receive_buffer > 0)
    ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
  sockaddr_in server{};
  server.sin_family = AF_INET;
  server.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  server.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&server), sizeof server) == 0)
    return socket;
  ::close(socket);
  throw std::runtime_error("nobody listens at " + address);
}

}  // namespace

std::string framed(const std::string& message, std::uint8_t flags) {
  std::string out(1, static_cast<char>(flags));
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(message.size() >> shift);
  return out + message;
}

std::string request(const std::string& method, const std::string& path, const Headers& headers,
                    const std::string& body) {
  std::string text = method + " " + path + " HTTP/1.1\r\n";
  if (!has(headers, "host")) text += "Host: localhost\r\n";
  for (const auto& [name, value] : headers) text += name + ": " + value + "\r\n";
  if (!body.empty() && !has(headers, "transfer-encoding") && !has(headers, "content-length"))
    text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

std::string call_request(const std::string& path, const std::string& body, const Headers& headers) {
  Headers all = headers;
  if (!has(all, "content-type")) all.emplace_back("Content-Type", "application/grpc-web+proto");
  return request("POST", path, all, body);
}

std::string WebResponse::header(const std::string& name) const {
  const auto found = headers.find(name);
  return found == headers.end() ? "" : found->second;
}

grpc::Status WebOutcome::status() const {
  const auto code = trailers.find("grpc-status");
  if (code == trailers.end()) return {grpc::StatusCode::UNKNOWN, "no trailers"};
  const auto text = [&](const char* name) {
    const auto found = trailers.find(name);
    return found == trailers.end() ? std::string() : found->second;
  };
  return {static_cast<grpc::StatusCode>(std::stoi(code->second)),
          percent_decoded(text("grpc-message")), base64_decoded(text("grpc-status-details-bin"))};
}

WebConnection::WebConnection(const std::string& address, SSL_CTX* tls, int receive_buffer)
    : socket_(connect_to(address, receive_buffer)),
      tls_(tls == nullptr ? nullptr : SSL_new(tls), &SSL_free) {
  const timeval patience{kPatience.count(), 0};
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  if (tls_ == nullptr) return;
  SSL_set_fd(tls_.get(), socket_);
  if (SSL_connect(tls_.get()) == 1) return;
  ::close(socket_);
  throw std::runtime_error("the handshake failed");
}

WebConnection::~WebConnection() {
  ::close(socket_);
}

void WebConnection::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = tls_ != nullptr
                             ? SSL_write(tls_.get(), bytes.data(), static_cast<int>(bytes.size()))
                             : ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

bool WebConnection::fill() {
  std::array<char, 65536> bytes;
  ssize_t count = 0;
  if (tls_ != nullptr) {
    count = SSL_read(tls_.get(), bytes.data(), bytes.size());
  } else {
    count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EAGAIN)
      throw std::runtime_error("the server neither answers nor closes");
  }
  if (count <= 0) return false;
  buffer_.append(bytes.data(), static_cast<std::size_t>(count));
  return true;
}

std::string WebConnection::take(std::size_t bytes) {
  while (buffer_.size() < bytes)
    if (!fill()) throw std::runtime_error("the response is cut off");
  std::string out = buffer_.substr(0, bytes);
  buffer_.erase(0, bytes);
  return out;
}

std::string WebConnection::take_line() {
  std::size_t end;
  while ((end = buffer_.find("\r\n")) == std::string::npos)
    if (!fill()) throw std::runtime_error("the response is cut off");
  std::string line = take(end + 2);
  line.resize(end);
  return line;
}

WebResponse WebConnection::read_head() {
  WebResponse response;
  chunks_over_ = false;
  if (buffer_.empty() && !fill()) return response;
  const std::string line = take_line();
  if (!line.starts_with("HTTP/1.1 ")) throw std::runtime_error("no response: " + line);
  response.status = std::stoi(line.substr(9, 3));
  for (std::string each = take_line(); !each.empty(); each = take_line())
    response.headers.insert(split_header(each));
  return response;
}

WebResponse WebConnection::read_response() {
  WebResponse response = read_head();
  if (response.header("transfer-encoding") == "chunked") {
    while (read_chunk()) {
    }
    response.body = std::exchange(decoded_, {});
    response.trailers = std::exchange(trailers_, {});
  } else if (!response.header("content-length").empty()) {
    response.body = take(std::stoul(response.header("content-length")));
  }
  return response;
}

bool WebConnection::read_chunk() {
  if (chunks_over_) return false;
  const std::size_t size = std::stoul(take_line(), nullptr, 16);
  decoded_ += take(size);
  chunks_over_ = size == 0;
  for (std::string line = take_line(); !line.empty(); line = take_line())
    trailers_.insert(split_header(line));
  return !chunks_over_;
}

std::optional<WebFrame> WebConnection::read_frame() {
  constexpr std::size_t kHeader = 5;
  std::size_t length = 0;
  const auto whole = [&] {
    if (decoded_.size() < kHeader) return false;
    length = 0;
    for (std::size_t i = 1; i < kHeader; ++i)
      length = length << 8 | static_cast<unsigned char>(decoded_[i]);
    return decoded_.size() >= kHeader + length;
  };
  while (!whole())
    if (!read_chunk()) return std::nullopt;
  WebFrame frame{static_cast<std::uint8_t>(decoded_[0]), decoded_.substr(kHeader, length)};
  decoded_.erase(0, kHeader + length);
  return frame;
}

WebOutcome WebConnection::read_call() {
  WebOutcome outcome;
  outcome.http = read_head().status;
  if (outcome.http != 200) return outcome;
  while (const auto frame = read_frame()) {
    if (frame->flags == 0) {
      outcome.messages.push_back(frame->bytes);
      continue;
    }
    for (std::size_t start = 0; start < frame->bytes.size();) {
      const auto end = frame->bytes.find("\r\n", start);
      outcome.trailers.insert(split_header(frame->bytes.substr(start, end - start)));
      start = end + 2;
    }
  }
  return outcome;
}

bool WebConnection::ends() {
  return buffer_.empty() && !fill();
}

std::string WebConnection::peer_name() const {
  const std::unique_ptr<X509, decltype(&X509_free)> certificate(
      SSL_get1_peer_certificate(tls_.get()), &X509_free);
  std::array<char, 256> name{};
  X509_NAME_get_text_by_NID(X509_get_subject_name(certificate.get()), NID_commonName, name.data(),
                            name.size());
  return name.data();
}

WebResponse get(const std::string& address, const std::string& path, const Headers& headers) {
  WebConnection browser(address);
  browser.send(request("GET", path, headers));
  return browser.read_response();
}

WebOutcome web_call(const std::string& address, const std::string& path, const std::string& message,
                    const Headers& headers) {
  WebConnection browser(address);
  browser.send(call_request(path, framed(message), headers));
  return browser.read_call();
}

}  // namespace weft::server::testing
