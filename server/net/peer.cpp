// SPDX-License-Identifier: Apache-2.0
#include "server/net/peer.h"

#include <fmt/format.h>
#include <openssl/x509v3.h>

#include <array>
#include <cstddef>
#include <memory>

namespace weft::server {

namespace asio = boost::asio;
using boost::system::error_code;
using tcp = boost::asio::ip::tcp;

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

}  // namespace weft::server
