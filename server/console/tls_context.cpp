// SPDX-License-Identifier: Apache-2.0
#include "server/console/tls_context.h"

#include <fmt/format.h>
#include <openssl/ssl.h>

#include <utility>

namespace weft::server {
namespace {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

constexpr std::chrono::seconds kBetweenLooks{1};

tl::expected<std::shared_ptr<ssl::context>, std::string> load(const TlsOptions& options) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  const auto bad = [](const char* what, const std::string& file, const error_code& error) {
    return tl::unexpected(fmt::format("the {} in {}: {}", what, file, error.message()));
  };
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
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
  static constexpr unsigned char kSessions[] = "weft-console";
  SSL_CTX_set_session_id_context(context->native_handle(), kSessions, sizeof kSessions - 1);
  return context;
}

}  // namespace

tl::expected<TlsContext, std::string> TlsContext::open(const TlsOptions& options, Logger log) {
  auto context = load(options);
  if (!context) return tl::unexpected(context.error());
  return TlsContext(options, std::move(log), std::move(*context));
}

TlsContext::TlsContext(TlsOptions options, Logger log, std::shared_ptr<ssl::context> context)
    : options_(std::move(options)),
      log_(std::move(log)),
      context_(std::move(context)),
      seen_(times()) {}

std::vector<std::filesystem::file_time_type> TlsContext::times() const {
  std::vector<std::filesystem::file_time_type> times;
  std::error_code error;
  for (const std::string& file : {options_.certificate, options_.key, options_.client_ca})
    times.push_back(std::filesystem::last_write_time(file, error));
  return times;
}

std::shared_ptr<ssl::context> TlsContext::current() {
  const auto now = std::chrono::steady_clock::now();
  if (now < next_look_) return context_;
  next_look_ = now + kBetweenLooks;
  auto times = this->times();
  if (times == seen_) return context_;
  seen_ = std::move(times);
  if (auto context = load(options_))
    context_ = std::move(*context);
  else
    log_->warn("event=certificates_unreadable message={}", log_value(context.error()));
  return context_;
}

}  // namespace weft::server
