// SPDX-License-Identifier: Apache-2.0
// Encryption of TCP addresses: TLS 1.2 and 1.3, and client certificates if a CA for them is named.
#pragma once

#include <string>

namespace weft::server {

// Names of PEM files.
struct TlsOptions {
  std::string certificate{};  // the server's, then intermediate ones; empty: no encryption
  std::string key{};          // of the server's certificate
  std::string client_ca{};    // clients need a certificate of one of these; empty: they need none
};

}  // namespace weft::server
