// SPDX-License-Identifier: Apache-2.0
#include "client/call/connection.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>
#include <grpcpp/support/client_interceptor.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "client/call/address.h"
#include "files/bytes/file_contents.h"

namespace weft::client {
namespace {

constexpr std::uint64_t kLargestFile = std::uint64_t{1} << 20;

// Empty for an empty path.
Result<std::string> contents(const std::filesystem::path& path) {
  if (path.empty()) return std::string();
  const auto file = read_file(path, kLargestFile);
  if (!file) return tl::unexpected(file.error());
  return std::string(file->text());
}

Result<std::string> read_token(const std::filesystem::path& path) {
  std::string source = path.string();
  std::string text;
  if (!path.empty()) {
    const auto file = contents(path);
    if (!file) return tl::unexpected(file.error());
    text = *file;
  } else if (const char* given = std::getenv("WEFT_TOKEN")) {
    source = "WEFT_TOKEN";
    text = given;
    if (text.empty()) return text;  // as if it were not set
  } else {
    return text;
  }
  constexpr std::string_view kSpace = " \t\r\n";
  text.erase(0, std::min(text.find_first_not_of(kSpace), text.size()));
  text.erase(text.find_last_not_of(kSpace) + 1);
  const auto visible = [](char c) { return c > ' ' && c < 0x7f; };
  if (text.empty() || !std::all_of(text.begin(), text.end(), visible))
    return fail(ExitCode::kUnreadableInput,
                source + ": not a token, which is one word of visible ASCII characters");
  return text;
}

bool wants_tls(const ConnectOptions& options) {
  return options.tls || !options.tls_ca.empty() || !options.tls_cert.empty() ||
         !options.tls_server_name.empty();
}

Result<std::shared_ptr<grpc::ChannelCredentials>> credentials(const ConnectOptions& options) {
  if (!wants_tls(options)) return grpc::InsecureChannelCredentials();
  const auto ca = contents(options.tls_ca);
  if (!ca) return tl::unexpected(ca.error());
  const auto certificate = contents(options.tls_cert);
  if (!certificate) return tl::unexpected(certificate.error());
  const auto key = contents(options.tls_key);
  if (!key) return tl::unexpected(key.error());
  return grpc::SslCredentials({*ca, *key, *certificate});
}

// Adds the token to every call, even if the connection is not encrypted: gRPC's own call
// credentials refuse to travel unencrypted even over a unix socket.
class AddToken final : public grpc::experimental::Interceptor {
 public:
  explicit AddToken(const std::string& token) : token_(token) {}

  void Intercept(grpc::experimental::InterceptorBatchMethods* batch) override {
    using Hook = grpc::experimental::InterceptionHookPoints;
    if (batch->QueryInterceptionHookPoint(Hook::PRE_SEND_INITIAL_METADATA))
      batch->GetSendInitialMetadata()->emplace("authorization", "Bearer " + token_);
    batch->Proceed();
  }

 private:
  const std::string& token_;  // the factory's, which lives as long as the channel
};

class AddTokenToAll final : public grpc::experimental::ClientInterceptorFactoryInterface {
 public:
  explicit AddTokenToAll(std::string token) : token_(std::move(token)) {}
  grpc::experimental::Interceptor* CreateClientInterceptor(
      grpc::experimental::ClientRpcInfo*) override {
    return new AddToken(token_);
  }

 private:
  const std::string token_;
};

Result<std::shared_ptr<grpc::Channel>> open_channel(const ConnectOptions& options) {
  auto token = read_token(options.token_file);
  if (!token) return tl::unexpected(token.error());
  if (!token->empty() && !wants_tls(options) && !is_local(options.server) && !options.insecure)
    return fail(ExitCode::kUsage, "the token would travel unencrypted to " + options.server +
                                      ": give --tls or --tls-ca, or --insecure to send it anyway");
  const auto encryption = credentials(options);
  if (!encryption) return tl::unexpected(encryption.error());

  grpc::ChannelArguments arguments;
  // Notices a server that vanished without closing its connection.
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  // Finds a server that restarts soon, because calls are repeated for some seconds only (retry.h).
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1'000);
  if (is_local(options.server)) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  if (!options.tls_server_name.empty()) arguments.SetSslTargetNameOverride(options.tls_server_name);
  std::vector<std::unique_ptr<grpc::experimental::ClientInterceptorFactoryInterface>> interceptors;
  if (!token->empty()) interceptors.push_back(std::make_unique<AddTokenToAll>(std::move(*token)));
  return grpc::experimental::CreateCustomChannelWithInterceptors(
      options.server, *encryption, arguments, std::move(interceptors));
}

Result<Connection> connect_to(const ConnectOptions& options,
                              const PrivateServerOptions& private_options, std::stop_token stop) {
  Connection connection;
  connection.address = options.server;
  if (!options.server.empty()) {
    auto channel = open_channel(options);
    if (!channel) return tl::unexpected(channel.error());
    connection.channel = std::move(*channel);
    return connection;
  }
  // gRPC starts while the server does.
  auto server = PrivateServer::start(
      private_options, std::move(stop), [&connection](const std::string& address) {
        connection.address = address;
        connection.channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
      });
  if (!server) return tl::unexpected(server.error());
  connection.server = std::move(*server);
  return connection;
}

}  // namespace

Result<Connection> connect(const ConnectOptions& options, std::stop_token stop) {
  return connect_to(options, {}, std::move(stop));
}

Result<Connection> connect_for_mesh(const ConnectOptions& options, std::stop_token stop) {
  return connect_to(options, {.jobs = 1}, std::move(stop));
}

}  // namespace weft::client
