// SPDX-License-Identifier: Apache-2.0
#include "server/connections.h"

#include <fmt/format.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/impl/server_builder_option.h>

#include "server/listen.h"

namespace weft::server {
namespace {

class WithoutReflection final : public grpc::ServerBuilderOption {
 public:
  void UpdateArguments(grpc::ChannelArguments*) override {}
  void UpdatePlugins(std::vector<std::unique_ptr<grpc::ServerBuilderPlugin>>* plugins) override {
    const std::string name = grpc::reflection::ProtoServerReflectionPlugin().name();
    std::erase_if(*plugins, [&name](const auto& plugin) { return plugin->name() == name; });
  }
};

}  // namespace

tl::expected<std::vector<std::shared_ptr<grpc::ServerCredentials>>, std::string> credentials_for(
    const std::vector<std::string>& addresses, const TlsOptions& tls, bool insecure) {
  const bool encrypts = !tls.certificate.empty();
  std::shared_ptr<grpc::ServerCredentials> encrypted;
  if (encrypts) {
    auto made = tls_credentials(tls);
    if (!made) return tl::unexpected(made.error());
    encrypted = std::move(*made);
  }
  std::vector<std::shared_ptr<grpc::ServerCredentials>> credentials;
  for (const std::string& address : addresses) {
    const bool plain = !encrypts || is_unix(address);
    if (plain && !insecure && !is_local(address))
      return tl::unexpected(
          fmt::format("will not listen on {} unencrypted, where other machines can connect: give "
                      "--tls-cert and --tls-key, or --insecure to do it anyway",
                      address));
    credentials.push_back(plain ? grpc::InsecureServerCredentials() : encrypted);
  }
  return credentials;
}

const char* security_of(const std::string& address, const TlsOptions& tls) {
  if (tls.certificate.empty() || is_unix(address)) return "none";
  return tls.client_ca.empty() ? "tls" : "mtls";
}

void limit_connections(grpc::ServerBuilder& builder) {
  // A client that vanished without a word is noticed, also where no call is open.
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  // Clients may ping as often as that, and not more: a ping costs them less than us. Three that
  // come too early, with nothing sent in between, end the connection.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PING_STRIKES, 2);
  // Calls beyond these wait at the client. A message is held in memory before it is looked at.
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, 256);
  // A descriptor is not held by one who never finishes his handshake, or makes no call.
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, 20'000);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, 600'000);
}

void leave_out_reflection(grpc::ServerBuilder& builder) {
  builder.SetOption(std::make_unique<WithoutReflection>());
}

}  // namespace weft::server
