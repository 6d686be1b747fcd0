// SPDX-License-Identifier: Apache-2.0
#include "server/net/tls_context.h"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <cstring>
#include <utility>

#include "server/net/watched_file.h"

namespace weft::server {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

constexpr std::chrono::seconds kBetweenLooks{1};

// Asio gives errors of the system that OpenSSL passes on no text of their own.
std::string why(const error_code& error) {
  const auto code = static_cast<unsigned long>(error.value());
  return ERR_SYSTEM_ERROR(code) ? std::strerror(ERR_GET_REASON(code)) : error.message();
}

// HTTP/2, if it is among what the client speaks; otherwise the handshake fails.
int choose_http2(SSL*, const unsigned char** chosen, unsigned char* chosen_bytes,
                 const unsigned char* offered, unsigned offered_bytes, void*) {
  static constexpr unsigned char kHttp2[] = {2, 'h', '2'};
  const int found = SSL_select_next_proto(const_cast<unsigned char**>(chosen), chosen_bytes, kHttp2,
                                          sizeof kHttp2, offered, offered_bytes);
  return found == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

tl::expected<std::shared_ptr<ssl::context>, std::string> load(const TlsOptions& options,
                                                              TlsProtocol protocol) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  const auto bad = [](const char* what, const std::string& file, const error_code& error) {
    return tl::unexpected(fmt::format("the {} in {}: {}", what, file, why(error)));
  };
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  if (protocol == TlsProtocol::kHttp2)
    SSL_CTX_set_alpn_select_cb(context->native_handle(), choose_http2, nullptr);
  error_code error;
  // A key with a passphrase is refused; OpenSSL would ask the terminal for it.
  context->set_password_callback(
      [](std::size_t, ssl::context::password_purpose) { return std::string(); }, error);
  context->use_certificate_chain_file(options.certificate, error);
  if (error) return bad("certificate", options.certificate, error);
  context->use_private_key_file(options.key, ssl::context::pem, error);
  if (error) return bad("key", options.key, error);
  if (options.client_ca.empty()) return context;
  context->load_verify_file(options.client_ca, error);
  if (error) return bad("CA for clients", options.client_ca, error);
  context->set_verify_mode(ssl::verify_peer | ssl::verify_fail_if_no_peer_cert, error);
  // Without it OpenSSL does not resume sessions of clients with certificates.
  static constexpr unsigned char kSessions[] = "weft";
  SSL_CTX_set_session_id_context(context->native_handle(), kSessions, sizeof kSessions - 1);
  return context;
}

}  // namespace

tl::expected<TlsContext, std::string> TlsContext::open(const TlsOptions& options,
                                                       TlsProtocol protocol, Logger log) {
  auto context = load(options, protocol);
  if (!context) return tl::unexpected(context.error());
  return TlsContext(options, protocol, std::move(log), std::move(*context));
}

TlsContext::TlsContext(TlsOptions options, TlsProtocol protocol, Logger log,
                       std::shared_ptr<ssl::context> context)
    : options_(std::move(options)),
      protocol_(protocol),
      log_(std::move(log)),
      context_(std::move(context)) {}

std::string TlsContext::digests() const {
  return digest_of(options_.certificate) + digest_of(options_.key) +
         (options_.client_ca.empty() ? "" : digest_of(options_.client_ca));
}

std::shared_ptr<ssl::context> TlsContext::current() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_look_) return context_;
  next_look_ = now + kBetweenLooks;
  std::string digests = this->digests();
  if (digests == seen_) return context_;
  seen_ = std::move(digests);
  if (auto context = load(options_, protocol_))
    context_ = std::move(*context);
  else
    log_->warn("event=certificates_unreadable message={}", log_value(context.error()));
  return context_;
}

}  // namespace weft::server
