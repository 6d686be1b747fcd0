// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/hostile/http2_client.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <stdexcept>

namespace weft::e2e {
namespace {

enum Type : std::uint8_t {
  kData = 0,
  kHeaders = 1,
  kReset = 3,
  kSettings = 4,
  kPing = 6,
  kGoAway = 7,
  kWindowUpdate = 8
};
constexpr std::uint8_t kEndStream = 0x1;
constexpr std::uint8_t kAck = 0x1;
constexpr std::uint8_t kEndHeaders = 0x4;
constexpr std::uint16_t kInitialWindowSize = 4;
constexpr std::uint16_t kMaxFrameSize = 5;
constexpr std::size_t kFrameHeader = 9;

std::string big_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}

std::uint32_t number(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

// A length of RFC 7541 5.1 with a prefix of 7 bits, no Huffman code.
std::string text_of(std::string_view text) {
  std::string out;
  std::size_t length = text.size();
  if (length < 127) {
    out += static_cast<char>(length);
  } else {
    out += static_cast<char>(127);
    for (length -= 127; length >= 128; length /= 128) out += static_cast<char>(128 + length % 128);
    out += static_cast<char>(length);
  }
  return out.append(text);
}

int connected(const std::string& address) {
  sockaddr_storage where{};
  socklen_t length = 0;
  if (address.starts_with("unix:")) {
    auto& local = reinterpret_cast<sockaddr_un&>(where);
    local.sun_family = AF_UNIX;
    address.copy(local.sun_path, sizeof(local.sun_path) - 1, 5);
    length = sizeof(local);
  } else {
    const std::size_t colon = address.rfind(':');
    auto& v4 = reinterpret_cast<sockaddr_in&>(where);
    v4.sin_family = AF_INET;
    v4.sin_port = htons(static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1))));
    ::inet_pton(AF_INET, address.substr(0, colon).c_str(), &v4.sin_addr);
    length = sizeof(v4);
  }
  const int fd = ::socket(where.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr*>(&where), length) != 0)
    throw std::runtime_error("cannot connect to " + address + ": " + std::strerror(errno));
  const int on = 1;
  ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return fd;
}

}  // namespace

std::string literal_header(std::string_view name, std::string_view value) {
  return std::string(1, '\0') + text_of(name) + text_of(value);
}

std::string message_prefix(std::uint32_t bytes) {
  return std::string(1, '\0') + big_endian(bytes, 4);
}

Http2Client::Http2Client(const std::string& address, bool encrypted) : fd_(connected(address)) {
  if (encrypted) encrypt();
  out_ = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
  frame(kSettings, 0, 0, "");
  listen(std::chrono::seconds(5));  // its settings
}

void Http2Client::encrypt() {
  std::signal(SIGPIPE, SIG_IGN);  // OpenSSL writes to what the peer has closed
  context_.reset(SSL_CTX_new(TLS_client_method()));
  SSL_CTX_set_mode(context_.get(),
                   SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  ssl_.reset(SSL_new(context_.get()));
  constexpr unsigned char kHttp2[] = {2, 'h', '2'};
  SSL_set_alpn_protos(ssl_.get(), kHttp2, sizeof kHttp2);
  SSL_set_fd(ssl_.get(), fd_);
  if (SSL_connect(ssl_.get()) != 1) {
    ::close(fd_);
    throw std::runtime_error("the handshake failed");
  }
  ::fcntl(fd_, F_SETFL, ::fcntl(fd_, F_GETFL) | O_NONBLOCK);
}

ssize_t Http2Client::put(std::string_view bytes) {
  if (ssl_ == nullptr) {
    const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return sent < 0 && errno == EAGAIN ? 0 : sent;
  }
  const int sent = SSL_write(ssl_.get(), bytes.data(), static_cast<int>(bytes.size()));
  const int error = SSL_get_error(ssl_.get(), sent);
  if (sent > 0) return sent;
  return error == SSL_ERROR_WANT_WRITE || error == SSL_ERROR_WANT_READ ? 0 : -1;
}

ssize_t Http2Client::get(char* to, std::size_t most) {
  if (ssl_ == nullptr) {
    const ssize_t got = ::recv(fd_, to, most, MSG_DONTWAIT);
    return got < 0 && errno == EAGAIN ? 0 : got == 0 ? -1 : got;
  }
  const int got = SSL_read(ssl_.get(), to, static_cast<int>(most));
  if (got > 0) return got;
  return SSL_get_error(ssl_.get(), got) == SSL_ERROR_WANT_READ ? 0 : -1;
}

Http2Client::~Http2Client() {
  ::close(fd_);
}

std::uint32_t Http2Client::open(std::string_view path, const Headers& more) {
  const auto header = literal_header;
  std::string block = header(":method", "POST") + header(":scheme", "http") +
                      header(":path", path) + header(":authority", "weft") +
                      header("te", "trailers") + header("content-type", "application/grpc");
  for (const auto& [name, value] : more) block += header(name, value);
  const std::uint32_t stream = std::exchange(next_, next_ + 2);
  windows_[stream] = initial_window_;
  frame(kHeaders, kEndHeaders, stream, block);
  return stream;
}

std::size_t Http2Client::send(std::uint32_t stream, std::string_view bytes, bool end) {
  const auto found = windows_.find(stream);
  if (found == windows_.end()) return 0;
  std::size_t sent = 0;
  do {
    const auto room =
        static_cast<std::size_t>(std::max<std::int64_t>(0, std::min(window_, found->second)));
    const std::size_t now = std::min({bytes.size() - sent, room, largest_frame_});
    if (now == 0 && !(end && bytes.empty())) break;
    const bool last = end && sent + now == bytes.size();
    frame(kData, last ? kEndStream : 0, stream, bytes.substr(sent, now));
    window_ -= static_cast<std::int64_t>(now);
    found->second -= static_cast<std::int64_t>(now);
    sent += now;
  } while (sent < bytes.size());
  return sent;
}

void Http2Client::reset(std::uint32_t stream) {
  windows_.erase(stream);
  frame(kReset, 0, stream, big_endian(8, 4));
}

bool Http2Client::ended(std::uint32_t stream) const {
  return !windows_.contains(stream);
}

void Http2Client::frame(std::uint8_t type, std::uint8_t flags, std::uint32_t stream,
                        std::string_view payload) {
  out_ += big_endian(payload.size(), 3);
  out_ += static_cast<char>(type);
  out_ += static_cast<char>(flags);
  out_ += big_endian(stream, 4);
  out_ += payload;
}

bool Http2Client::flush() {
  std::string_view left = out_;
  while (alive_ && !left.empty()) {
    const ssize_t sent = put(left);
    if (sent > 0) {
      left.remove_prefix(static_cast<std::size_t>(sent));
    } else if (sent == 0) {
      pollfd waits{fd_, POLLOUT | POLLIN, 0};
      if (::poll(&waits, 1, 10'000) <= 0) return false;
      // A peer that waits for us to read takes nothing meanwhile.
      if ((waits.revents & POLLIN) != 0) read_some(std::chrono::milliseconds(0));
    } else {
      read_some(std::chrono::milliseconds(0));  // its last word
      alive_ = false;
    }
  }
  out_.erase(0, out_.size() - left.size());
  return alive_;
}

bool Http2Client::read_some(std::chrono::milliseconds at_most) {
  pollfd waits{fd_, POLLIN, 0};
  const bool ready = ssl_ != nullptr && SSL_pending(ssl_.get()) > 0;
  if (!alive_ || (!ready && ::poll(&waits, 1, static_cast<int>(at_most.count())) <= 0))
    return false;
  char bytes[65536];
  const ssize_t got = get(bytes, sizeof bytes);
  if (got < 0) alive_ = false;
  if (got > 0) in_.append(bytes, static_cast<std::size_t>(got));
  return got > 0;
}

void Http2Client::listen(std::chrono::milliseconds at_most) {
  flush();
  read_some(at_most);
  std::string_view left = in_;
  while (left.size() >= kFrameHeader) {
    const std::size_t length = number(left.substr(0, 3));
    if (left.size() < kFrameHeader + length) break;
    take(left.substr(kFrameHeader, length), static_cast<std::uint8_t>(left[3]),
         static_cast<std::uint8_t>(left[4]), number(left.substr(5, 4)) & 0x7fffffff);
    left.remove_prefix(kFrameHeader + length);
  }
  in_.erase(0, in_.size() - left.size());
  flush();
}

void Http2Client::take(std::string_view payload, std::uint8_t type, std::uint8_t flags,
                       std::uint32_t stream) {
  const auto end_stream = [&] { ended_ += windows_.erase(stream); };
  switch (type) {
    case kSettings:
      if ((flags & kAck) != 0) return;
      for (; payload.size() >= 6; payload.remove_prefix(6)) {
        const std::uint32_t value = number(payload.substr(2, 4));
        if (number(payload.substr(0, 2)) == kMaxFrameSize) largest_frame_ = value;
        if (number(payload.substr(0, 2)) != kInitialWindowSize) continue;
        for (auto& [open, window] : windows_) window += value - initial_window_;
        initial_window_ = value;
      }
      return frame(kSettings, kAck, 0, "");
    case kPing:
      if ((flags & kAck) == 0) frame(kPing, kAck, 0, payload);
      return;
    case kWindowUpdate:
      if (stream == 0) window_ += number(payload);
      if (const auto found = windows_.find(stream); found != windows_.end())
        found->second += number(payload);
      return;
    case kReset:
      return end_stream();
    case kData:
    case kHeaders:
      if ((flags & kEndStream) != 0) end_stream();
      return;
    case kGoAway:
      goaway_ = number(payload.substr(4, 4));
      alive_ = false;
      return;
    default:
      return;
  }
}

}  // namespace weft::e2e
