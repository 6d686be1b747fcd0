// SPDX-License-Identifier: Apache-2.0
#include "server/net/tls.h"

#include <fmt/format.h>
#include <grpcpp/security/tls_certificate_provider.h>
#include <grpcpp/security/tls_certificate_verifier.h>
#include <grpcpp/security/tls_credentials_options.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <cstring>

namespace weft::server {
namespace {

constexpr unsigned kSecondsBetweenLooks = 1;

std::string why() {
  const unsigned long code = ERR_peek_error();
  const char* reason =
      ERR_SYSTEM_ERROR(code) ? std::strerror(ERR_GET_REASON(code)) : ERR_reason_error_string(code);
  ERR_clear_error();
  return reason == nullptr ? "unknown reason" : reason;
}

// A key with a passphrase is refused; OpenSSL would ask the terminal for it.
int no_passphrase(char*, int, int, void*) {
  return -1;
}

// gRPC reports only that a handshake failed. This checks the pair beforehand, and says what is
// wrong.
tl::expected<void, std::string> check(const TlsOptions& options) {
  const auto bad = [](const char* what, const std::string& file) {
    return tl::unexpected(fmt::format("the {} in {}: {}", what, file, why()));
  };
  ERR_clear_error();
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_server_method()),
                                                                  &SSL_CTX_free);
  if (context == nullptr) return tl::unexpected("OpenSSL: " + why());
  SSL_CTX_set_default_passwd_cb(context.get(), no_passphrase);
  if (SSL_CTX_use_certificate_chain_file(context.get(), options.certificate.c_str()) != 1)
    return bad("certificate", options.certificate);
  if (SSL_CTX_use_PrivateKey_file(context.get(), options.key.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_check_private_key(context.get()) != 1)
    return bad("key", options.key);
  if (!options.client_ca.empty() &&
      SSL_CTX_load_verify_file(context.get(), options.client_ca.c_str()) != 1)
    return bad("CA for clients", options.client_ca);
  return {};
}

}  // namespace

tl::expected<std::shared_ptr<grpc::ServerCredentials>, std::string> tls_credentials(
    const TlsOptions& options) {
  if (auto good = check(options); !good) return tl::unexpected(good.error());
  grpc::experimental::TlsServerCredentialsOptions tls(
      std::make_shared<grpc::experimental::FileWatcherCertificateProvider>(
          options.key, options.certificate, options.client_ca, kSecondsBetweenLooks));
  tls.watch_identity_key_cert_pairs();
  if (!options.client_ca.empty()) {
    tls.watch_root_certs();
    tls.set_cert_request_type(GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  }
  // A client's certificate has a name, but no address to compare it with.
  tls.set_certificate_verifier(std::make_shared<grpc::experimental::NoOpCertificateVerifier>());
  tls.set_check_call_host(false);
  return grpc::experimental::TlsServerCredentials(tls);
}

}  // namespace weft::server
