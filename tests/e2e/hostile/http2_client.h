// SPDX-License-Identifier: Apache-2.0
// A client of HTTP/2 that does what no library lets one do: begin streams and reset them, send half
// a message, headers that never end, any frame, never read. One connection on one thread; flow
// control is respected, since a peer ends a connection that breaks it.
//
//   Http2Client client("127.0.0.1:7421");
//   const std::uint32_t stream = client.open("/weft.v1.MeshService/GetServerInfo", {});
//   client.send(stream, message_prefix(100), false);
//   client.reset(stream);
//
// Source: RFC 9113 (frames), RFC 7541 6.2.2 (literal header fields without indexing).
// Errors: std::runtime_error if it cannot connect. Once the peer has closed, `alive` is false and
// whatever is sent is dropped.
#pragma once

#include <openssl/ssl.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weft::e2e {

class Http2Client {
 public:
  using Headers = std::vector<std::pair<std::string, std::string>>;

  // HOST:PORT of IPv4, or unix:PATH. Encrypted connections trust any certificate.
  explicit Http2Client(const std::string& address, bool encrypted = false);
  ~Http2Client();
  Http2Client(const Http2Client&) = delete;
  Http2Client& operator=(const Http2Client&) = delete;

  // Begins a call of a gRPC method: its headers, and no message. Returns the stream's number.
  std::uint32_t open(std::string_view path, const Headers& more = {});

  // Sends as much of the bytes as the peer's windows allow at once. Returns how many were sent.
  std::size_t send(std::uint32_t stream, std::string_view bytes, bool end = false);

  // RST_STREAM with CANCEL.
  void reset(std::uint32_t stream);

  // Any frame.
  void frame(std::uint8_t type, std::uint8_t flags, std::uint32_t stream, std::string_view payload);

  // Reads what the peer has sent, for this long at most, until one frame was read.
  void listen(std::chrono::milliseconds at_most);

  // Hands what was queued to the socket. False if the peer has closed, or takes nothing for 10 s.
  bool flush();

  bool alive() const { return alive_; }
  // The error of the peer's GOAWAY; nullopt if it has sent none.
  std::optional<std::uint32_t> goaway() const { return goaway_; }
  // The peer has ended the stream, by trailers or by a reset.
  bool ended(std::uint32_t stream) const;
  // Streams that the peer has ended.
  std::size_t ended_streams() const { return ended_; }

 private:
  void encrypt();
  // As ::send and ::recv do, but 0 if it must wait.
  ssize_t put(std::string_view bytes);
  ssize_t get(char* to, std::size_t most);
  void take(std::string_view payload, std::uint8_t type, std::uint8_t flags, std::uint32_t stream);
  bool read_some(std::chrono::milliseconds at_most);

  int fd_ = -1;
  std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context_{nullptr, &SSL_CTX_free};
  std::unique_ptr<SSL, decltype(&SSL_free)> ssl_{nullptr, &SSL_free};
  bool alive_ = true;
  std::optional<std::uint32_t> goaway_;
  std::string out_;
  std::string in_;
  std::uint32_t next_ = 1;
  std::size_t ended_ = 0;
  std::int64_t window_ = 65535;          // of the connection
  std::int64_t initial_window_ = 65535;  // of a new stream
  std::size_t largest_frame_ = 16384;
  std::map<std::uint32_t, std::int64_t> windows_;  // of open streams
};

inline constexpr std::uint32_t kEnhanceYourCalm = 0xb;

// A header field that the peer's table does not keep.
std::string literal_header(std::string_view name, std::string_view value);

// The five bytes before a message of gRPC.
std::string message_prefix(std::uint32_t bytes);

}  // namespace weft::e2e
