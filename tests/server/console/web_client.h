// SPDX-License-Identifier: Apache-2.0
// A browser's half of HTTP/1.1 and gRPC-Web, which can misbehave. Everything waits for kPatience at
// most, and then throws.
//
//   WebConnection browser(address);
//   browser.send(call_request(kGenerateMesh, framed(bytes)));
//   EXPECT_EQ(browser.read_head().status, 200);
//   while (auto frame = browser.read_frame()) ...
#pragma once

#include <grpcpp/support/status.h>
#include <openssl/ssl.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weft::server::testing {

using Headers = std::vector<std::pair<std::string, std::string>>;

inline constexpr const char* kServerInfo = "/weft.v1.MeshService/GetServerInfo";
inline constexpr const char* kGenerateMesh = "/weft.v1.MeshService/GenerateMesh";

// A frame of gRPC-Web.
std::string framed(const std::string& message, std::uint8_t flags = 0);

// A request as it goes over the wire, with `Host: localhost` unless the headers have one.
std::string request(const std::string& method, const std::string& path, const Headers& headers = {},
                    const std::string& body = "");
// A POST of the type application/grpc-web+proto, unless the headers have another.
std::string call_request(const std::string& path, const std::string& body,
                         const Headers& headers = {});

struct WebResponse {
  int status = 0;                              // 0: the server closed the connection instead
  std::map<std::string, std::string> headers;  // by names in lower case
  std::string body;
  std::map<std::string, std::string> trailers{};  // of a chunked body; the same

  std::string header(const std::string& name) const;  // empty if there is none
};

struct WebFrame {
  std::uint8_t flags = 0;
  std::string bytes;
};

// A call read to its end.
struct WebOutcome {
  int http = 0;
  std::vector<std::string> messages;
  std::map<std::string, std::string> trailers;

  grpc::Status status() const;  // UNKNOWN if there are no trailers
};

class WebConnection {
 public:
  // `address` is 127.0.0.1:PORT. Encrypted if `tls` is given; then a handshake that fails throws.
  // `receive_buffer`: bytes that the kernel takes for a browser that does not read; 0: as usual.
  explicit WebConnection(const std::string& address, SSL_CTX* tls = nullptr,
                         int receive_buffer = 0);
  ~WebConnection();
  WebConnection(const WebConnection&) = delete;
  WebConnection& operator=(const WebConnection&) = delete;

  // What the server no longer wants to read is lost.
  void send(std::string_view bytes);
  // Status line and headers; a status of 0 if the server closed the connection.
  WebResponse read_head();
  // So many bytes of the response whose head has been read.
  std::string read_body(std::size_t bytes) { return take(bytes); }
  // With its body. REQUIRES: the response is not one to HEAD.
  WebResponse read_response();
  // A frame of the response whose head has been read; nullopt after the last.
  std::optional<WebFrame> read_frame();
  WebOutcome read_call();
  // Whether the server closes the connection without another byte.
  bool ends();
  // The common name in the server's certificate. REQUIRES: encrypted.
  std::string peer_name() const;

 private:
  bool fill();  // false at the end
  std::string take(std::size_t bytes);
  std::string take_line();
  bool read_chunk();  // false after the last

  const int socket_;
  const std::unique_ptr<SSL, decltype(&SSL_free)> tls_;
  std::string buffer_;   // received, and not taken yet
  std::string decoded_;  // of a chunked body, and no frame yet
  bool chunks_over_ = false;
  std::map<std::string, std::string> trailers_;
};

// On a connection of its own.
WebResponse get(const std::string& address, const std::string& path, const Headers& headers = {});
WebOutcome web_call(const std::string& address, const std::string& path, const std::string& message,
                    const Headers& headers = {});

}  // namespace weft::server::testing
