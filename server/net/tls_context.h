// SPDX-License-Identifier: Apache-2.0
// The certificates of tls.h for connections: TLS 1.2 and 1.3, client certificates if a CA for them
// is named.
//
// The files are read again when they change, within two seconds: a renewed certificate needs no
// restart, and open connections stay open. Rename new files into place, the key first or both at
// once by a link to their folder. While they cannot be read, or certificate and key do not match,
// the last good ones serve.
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <tl/expected.hpp>

#include "server/net/tls.h"
#include "server/observe/log.h"

namespace weft::server {

// What is spoken on the encrypted connections. Clients that name no protocol of their own (ALPN)
// are served, too.
enum class TlsProtocol { kHttp1, kHttp2 };

// Not thread-safe.
class TlsContext {
 public:
  // REQUIRES: certificate and key are named. The error names the file at fault.
  static tl::expected<TlsContext, std::string> open(const TlsOptions& options, TlsProtocol protocol,
                                                    Logger log);

  // Reads the files for the next connection, whether they seem to have changed or not.
  void reload() {
    seen_.clear();
    next_look_ = {};
  }
  // For the next connection. Looks for changes of the files at most once per second.
  std::shared_ptr<boost::asio::ssl::context> current();

 private:
  TlsContext(TlsOptions options, TlsProtocol protocol, Logger log,
             std::shared_ptr<boost::asio::ssl::context> context);
  // Of all files.
  std::string digests() const;

  TlsOptions options_;
  TlsProtocol protocol_;
  Logger log_;
  std::shared_ptr<boost::asio::ssl::context> context_;
  std::string seen_;  // digests; empty before the first look
  std::chrono::steady_clock::time_point next_look_{};
};

}  // namespace weft::server
