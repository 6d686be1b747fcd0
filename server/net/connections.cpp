// SPDX-License-Identifier: Apache-2.0
#include "server/net/connections.h"

#include <fmt/format.h>

#include "server/net/listen.h"

namespace weft::server {

tl::expected<void, std::string> check_encryption(const std::vector<std::string>& addresses,
                                                 const TlsOptions& tls, bool insecure) {
  if (insecure || !tls.certificate.empty()) return {};
  for (const std::string& address : addresses)
    if (!is_local(address))
      return tl::unexpected(
          fmt::format("will not listen on {} unencrypted, where other machines can connect: give "
                      "--tls-cert and --tls-key, or --insecure to do it anyway",
                      address));
  return {};
}

const char* security_of(const std::string& address, const TlsOptions& tls) {
  if (tls.certificate.empty() || is_unix(address)) return "none";
  return tls.client_ca.empty() ? "tls" : "mtls";
}

void limit_connections(grpc::ServerBuilder& builder) {
  // Notices a client that vanished without closing its connection, even if no call is open.
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 30'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  // Clients may ping this often and no more, because a ping costs a client less than the server.
  // Three early pings in a row, with nothing sent in between, end the connection.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, 10'000);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PING_STRIKES, 2);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, static_cast<int>(kMaxStreams));
  // A call may send HTTP/2's own 64 KiB before its caller is known. Probes of the bandwidth would
  // let gRPC raise that to megabytes. Once a message is wanted, the window is opened for it.
  builder.AddChannelArgument(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  // Bounds how long a connection that makes no call keeps a descriptor.
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, 600'000);
}

}  // namespace weft::server
