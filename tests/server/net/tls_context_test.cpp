// SPDX-License-Identifier: Apache-2.0
// Encryption, and who is let in by certificates.
#include "server/net/tls_context.h"

#include <arpa/inet.h>
#include <grpcpp/security/credentials.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>

#include "tests/files/support/temp_folder.h"
#include "tests/server/logged_server.h"
#include "tests/server/raw_call.h"
#include "tests/support/certificates.h"

namespace weft::server::testing {
namespace {

using grpc::StatusCode;
using weft::testing::CertificateOptions;
using weft::testing::TestCa;
using weft::testing::TestCertificate;

const CertificateOptions kServer = {.common_name = "weftd", .names = {"IP:127.0.0.1"}};

class Tls : public ::testing::Test {
 protected:
  // Renamed into place, as whoever renews certificates does.
  std::string put(const std::string& name, const std::string& text) {
    std::filesystem::rename(folder_.write(name + ".new", text), folder_ / name);
    return (folder_ / name).string();
  }
  TlsOptions files(const TestCertificate& server, const std::string& client_ca = "") {
    TlsOptions options{.certificate = put("server.pem", server.pem),
                       .key = put("server.key", server.key)};
    if (!client_ca.empty()) options.client_ca = put("clients.pem", client_ca);
    return options;
  }
  static ServerOptions options(const TlsOptions& tls, const std::string& address = "127.0.0.1:0") {
    return {.listen = {address}, .service = {}, .tls = tls};
  }
  // As a client that trusts the CA and shows the certificate.
  static std::shared_ptr<grpc::Channel> connect(const LoggedServer& server, const TestCa& trusted,
                                                const TestCertificate& own = {}) {
    return channel_to(server.address(), grpc::SslCredentials({trusted.pem(), own.key, own.pem}));
  }

  files::TempFolder folder_;
  const TestCa ca_{"a CA"};
  const TestCa other_ca_{"another CA"};
};

TEST_F(Tls, ServesAClientThatTrustsTheCa) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  EXPECT_TRUE(ask(connect(server, ca_)).ok());
  EXPECT_TRUE(server.log().contains("event=listening security=tls")) << server.log().text();
}

TEST_F(Tls, IsRefusedByAClientThatTrustsAnotherCa) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  EXPECT_EQ(ask(connect(server, other_ca_)).error_code(), StatusCode::UNAVAILABLE);
}

TEST_F(Tls, IsRefusedByAClientThatWantsAnotherName) {
  LoggedServer server(
      options(files(ca_.issue({.common_name = "weftd", .names = {"DNS:mesh.example.org"}}))));
  EXPECT_EQ(ask(connect(server, ca_)).error_code(), StatusCode::UNAVAILABLE);
  grpc::ChannelArguments by_name;
  by_name.SetSslTargetNameOverride("mesh.example.org");
  EXPECT_TRUE(
      ask(channel_to(server.address(), grpc::SslCredentials({ca_.pem(), "", ""}), by_name)).ok());
}

TEST_F(Tls, IsRefusedByAClientOnceItsCertificateHasExpired) {
  CertificateOptions expired = kServer;
  expired.days = -1;
  LoggedServer server(options(files(ca_.issue(expired))));
  EXPECT_EQ(ask(connect(server, ca_)).error_code(), StatusCode::UNAVAILABLE);
}

TEST_F(Tls, ServesNobodyUnencrypted) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  EXPECT_EQ(ask(channel_to(server.address(), grpc::InsecureChannelCredentials())).error_code(),
            StatusCode::UNAVAILABLE);
}

TEST_F(Tls, LeavesUnixSocketsUnencrypted) {
  const std::string address = "unix:" + (folder_ / "s").string();
  LoggedServer server(options(files(ca_.issue(kServer), ca_.pem()), address));
  EXPECT_TRUE(ask(channel_to(address, grpc::InsecureChannelCredentials())).ok());
}

TEST_F(Tls, LetsInClientsWithACertificateOfTheirCaAndKnowsTheirNames) {
  LoggedServer server(options(files(ca_.issue(kServer), other_ca_.pem())));
  const auto name_in_log = [&](const CertificateOptions& request_options, const std::string& name) {
    const auto channel = connect(server, ca_, other_ca_.issue(request_options));
    EXPECT_EQ(raw_generate_mesh(channel, "").error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_TRUE(server.log().contains("client=" + name + " ")) << server.log().text();
  };
  name_in_log({.common_name = "ann", .names = {"DNS:not-this"}}, "ann");
  name_in_log({.names = {"DNS:bob.example.org"}}, "bob.example.org");
  EXPECT_FALSE(server.log().contains("not-this"));
}

TEST_F(Tls, ShutsOutClientsWithoutACertificateOfTheirCa) {
  LoggedServer server(options(files(ca_.issue(kServer), other_ca_.pem())));
  const auto code_of = [&](const TestCertificate& own) {
    return ask(connect(server, ca_, own)).error_code();
  };
  EXPECT_EQ(code_of({}), StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(ca_.issue({.common_name = "ann"})), StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(other_ca_.issue({.common_name = "ann", .days = -1})), StatusCode::UNAVAILABLE);
  EXPECT_EQ(code_of(other_ca_.issue({.common_name = "ann"})), StatusCode::OK);
}

TEST_F(Tls, TakesARenewedCertificateWithoutARestart) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  const auto open = connect(server, ca_);
  EXPECT_TRUE(ask(open).ok());
  files(other_ca_.issue(kServer));
  EXPECT_TRUE(eventually([&] { return ask(connect(server, other_ca_)).ok(); }));
  EXPECT_EQ(ask(connect(server, ca_)).error_code(), StatusCode::UNAVAILABLE);
  EXPECT_TRUE(ask(open).ok()) << "a connection that was open has to stay";
}

TEST_F(Tls, TakesAnotherCaOfClientsWithoutARestart) {
  LoggedServer server(options(files(ca_.issue(kServer), ca_.pem())));
  const TestCertificate ann = other_ca_.issue({.common_name = "ann"});
  EXPECT_EQ(ask(connect(server, ca_, ann)).error_code(), StatusCode::UNAVAILABLE);
  put("clients.pem", other_ca_.pem());
  EXPECT_TRUE(eventually([&] { return ask(connect(server, ca_, ann)).ok(); }));
}

TEST_F(Tls, SeesARenewalWhoseFileIsAsOldAsTheFileBefore) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  const auto time = std::filesystem::last_write_time(folder_ / "server.pem");
  ASSERT_TRUE(ask(connect(server, ca_)).ok());
  const TestCertificate renewed = other_ca_.issue(kServer);
  for (const auto& [file, text] :
       {std::pair("server.key", renewed.key), {"server.pem", renewed.pem}})
    std::filesystem::last_write_time(put(file, text), time);
  EXPECT_TRUE(eventually([&] { return ask(connect(server, other_ca_)).ok(); }));
}

TEST_F(Tls, OutlivesARenewalThatGoesWrongHalfWay) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  const TestCertificate renewed = other_ca_.issue(kServer);
  put("server.pem", renewed.pem);  // the key does not fit
  EXPECT_TRUE(eventually([&] {
    EXPECT_TRUE(ask(connect(server, ca_)).ok()) << "the last good ones serve";
    return server.log().contains("event=certificates_unreadable");
  }));
  put("server.key", renewed.key);
  EXPECT_TRUE(eventually([&] { return ask(connect(server, other_ca_)).ok(); }));
}

// The version that a client gets which speaks up to `latest` only; empty where it gets none.
std::string handshake(const std::string& address, int latest) {
  const std::unique_ptr<SSL_CTX, decltype(&SSL_CTX_free)> context(SSL_CTX_new(TLS_client_method()),
                                                                  &SSL_CTX_free);
  SSL_CTX_set_cipher_list(context.get(), "ALL:@SECLEVEL=0");  // or OpenSSL itself refuses TLS 1.1
  SSL_CTX_set_min_proto_version(context.get(), TLS1_VERSION);
  SSL_CTX_set_max_proto_version(context.get(), latest);
  const unsigned char h2[] = {2, 'h', '2'};
  SSL_CTX_set_alpn_protos(context.get(), h2, sizeof h2);
  sockaddr_in server{};
  server.sin_family = AF_INET;
  server.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  server.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1))));
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&server), sizeof server), 0);
  const std::unique_ptr<SSL, decltype(&SSL_free)> tls(SSL_new(context.get()), &SSL_free);
  SSL_set_fd(tls.get(), socket);
  const std::string version = SSL_connect(tls.get()) == 1 ? SSL_get_version(tls.get()) : "";
  ::close(socket);
  return version;
}

TEST_F(Tls, SpeaksNothingOlderThan12) {
  LoggedServer server(options(files(ca_.issue(kServer))));
  EXPECT_EQ(handshake(server.address(), TLS1_1_VERSION), "");
  EXPECT_EQ(handshake(server.address(), TLS1_2_VERSION), "TLSv1.2");
  EXPECT_EQ(handshake(server.address(), TLS1_3_VERSION), "TLSv1.3");
}

TEST_F(Tls, NamesTheFileAtFault) {
  const TestCertificate good = ca_.issue(kServer);
  const auto refusal = [](const TlsOptions& tls) { return refusal_to_start(options(tls)); };
  const auto names = [](const std::string& text, const std::string& file) {
    return text.find(file) != std::string::npos;
  };
  TlsOptions missing = files(good);
  missing.certificate = "/no/such.pem";
  EXPECT_TRUE(names(refusal(missing), "/no/such.pem: No such file")) << refusal(missing);

  TlsOptions unmatched = files(good);
  unmatched.key = put("unmatched.key", ca_.issue(kServer).key);
  EXPECT_TRUE(names(refusal(unmatched), "unmatched.key: ")) << refusal(unmatched);
  EXPECT_TRUE(names(refusal(unmatched), "mismatch")) << refusal(unmatched);

  const TlsOptions garbage = files(good, "no certificate");
  EXPECT_TRUE(names(refusal(garbage), "clients.pem: ")) << refusal(garbage);
}

TEST(Unencrypted, IsRefusedWhereOtherMachinesCanConnect) {
  for (const char* address : {"0.0.0.0:0", "[::]:0"}) {
    const ServerOptions plain = {.listen = {"127.0.0.1:0", address}, .service = {}};
    const std::string refusal = refusal_to_start(plain);
    if (refusal.find("Address family") != std::string::npos) continue;  // a machine without IPv6
    EXPECT_NE(refusal.find(address), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("--tls-cert"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("--insecure"), std::string::npos) << refusal;
  }
}

TEST(Unencrypted, IsServedWhereAskedFor) {
  EXPECT_EQ(refusal_to_start({.listen = {"0.0.0.0:0"}, .service = {}, .insecure = true}), "");
}

TEST(Unencrypted, IsServedOnLoopback) {
  for (const char* address : {"127.0.0.1:0", "127.0.0.2:0", "localhost:0"})
    EXPECT_EQ(refusal_to_start({.listen = {address}, .service = {}}), "") << address;
}

}  // namespace
}  // namespace weft::server::testing
