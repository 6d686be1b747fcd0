// SPDX-License-Identifier: Apache-2.0
// Who may use the console: tokens, certificates, pages of other origins, other machines.
#include "server/console/console.h"

#include "server/net/caller.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/console/console_server.h"
#include "tests/server/raw_call.h"
#include "tests/support/certificates.h"
#include "tests/support/http.h"

namespace weft::server::testing {
namespace {

using grpc::StatusCode;
using weft::testing::TestCa;
using weft::testing::TestCertificate;

class ConsoleTokens : public ::testing::Test {
 protected:
  static ServerOptions options(const files::TempFolder& folder) {
    ServerOptions options = with_console();
    options.tokens = folder.write("tokens", "ann secret-of-ann-16\n").string();
    return options;
  }
  const files::TempFolder folder_;
  ConsoleServer server_{empty_mesh(), options(folder_)};
  const std::string mesh_ = valid_request().SerializeAsString();
};

TEST_F(ConsoleTokens, AreAskedForAndNameTheCaller) {
  const WebOutcome unknown = web_call(server_.address(), kGenerateMesh, mesh_);
  EXPECT_EQ(unknown.status().error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(reason_of(unknown), "UNAUTHENTICATED");
  for (const char* wrong : {"Bearer wrong", "Basic secret-of-ann-16", "secret-of-ann-16"})
    EXPECT_EQ(web_call(server_.address(), kGenerateMesh, mesh_, {{"Authorization", wrong}})
                  .status()
                  .error_code(),
              StatusCode::UNAUTHENTICATED)
        << wrong;
  EXPECT_TRUE(web_call(server_.address(), kGenerateMesh, mesh_,
                       {{"Authorization", "Bearer secret-of-ann-16"}})
                  .status()
                  .ok());
  EXPECT_TRUE(eventually([&] { return server_.log().contains("client=ann "); }));
  EXPECT_FALSE(server_.log().contains("secret")) << server_.log().text();
}

TEST_F(ConsoleTokens, AreNotTriedOneAfterTheOther) {
  EXPECT_EQ(
      web_call(server_.address(), kServerInfo, "",
               {{"Authorization", "Bearer wrong"}, {"Authorization", "Bearer secret-of-ann-16"}})
          .status()
          .error_code(),
      StatusCode::UNAUTHENTICATED);
}

TEST_F(ConsoleTokens, AreAskedForBeforeAMessageIsRead) {
  WebConnection browser(server_.address());
  browser.send(call_request(kGenerateMesh, "", {{"Content-Length", "200000000"}}));
  EXPECT_EQ(browser.read_call().status().error_code(), StatusCode::UNAUTHENTICATED);
}

TEST_F(ConsoleTokens, AreAskedForByTheMetricsAndNotByPages) {
  EXPECT_EQ(get(server_.address(), "/metrics").status, 401);
  EXPECT_EQ(get(server_.address(), "/metrics", {{"Authorization", "Bearer wrong"}}).status, 401);
  const WebResponse shown =
      get(server_.address(), "/metrics", {{"Authorization", "Bearer secret-of-ann-16"}});
  EXPECT_EQ(shown.status, 200);
  EXPECT_TRUE(has(shown.body, "weft_build_info{")) << shown.body;
  EXPECT_EQ(get(server_.address(), "/").status, 200);
}

TEST(ConsoleMetrics, AreShownToEverybodyIfThereAreNoTokens) {
  ConsoleServer server;
  EXPECT_EQ(get(server.address(), "/metrics").status, 200);
}

TEST(ConsoleIdentity, IsNotBelievedOfOthers) {
  ConsoleServer server;
  const Headers lie = {{"weft-console-name", "ann"},
                       {"weft-console-peer", "ipv4:10.9.8.7:1"},
                       {"weft-console-secret", ""}};
  const std::string mesh = valid_request().SerializeAsString();
  EXPECT_TRUE(web_call(server.address(), kGenerateMesh, mesh, lie).status().ok());
  grpc::ClientContext context;
  for (const auto& [name, value] : lie) context.AddMetadata(name, value);
  EXPECT_TRUE(
      read_all(*v1::MeshService::NewStub(server.channel())->GenerateMesh(&context, valid_request()))
          .status.ok());
  EXPECT_TRUE(eventually([&] {
    const std::string log = server.log().text();
    const auto first = log.find("event=call_ended");
    return first != std::string::npos && log.find("event=call_ended", first + 1) != first &&
           log.find("event=call_ended", first + 1) != std::string::npos;
  }));
  EXPECT_FALSE(server.log().contains("10.9.8.7")) << server.log().text();
  EXPECT_FALSE(server.log().contains("client=ann")) << server.log().text();
}

WebResponse preflight(const std::string& address, const std::string& origin) {
  WebConnection browser(address);
  browser.send(request("OPTIONS", kServerInfo,
                       {{"Origin", origin},
                        {"Access-Control-Request-Method", "POST"},
                        {"Access-Control-Request-Headers", "content-type,x-grpc-web"}}));
  return browser.read_response();
}

TEST(ConsoleOrigins, OfOthersAreRefused) {
  ConsoleServer server;
  const WebResponse asked = preflight(server.address(), "https://app.example.org");
  EXPECT_EQ(asked.status, 403);
  EXPECT_EQ(asked.header("access-control-allow-origin"), "");
  for (const char* origin : {"https://app.example.org", "null"}) {
    WebConnection browser(server.address());
    browser.send(call_request(kServerInfo, framed(""), {{"Origin", origin}}));
    EXPECT_EQ(browser.read_response().status, 403);
    EXPECT_EQ(get(server.address(), "/metrics", {{"Origin", origin}}).status, 403);
  }
  EXPECT_TRUE(web_call(server.address(), kServerInfo, "",
                       {{"Host", server.address()}, {"Origin", "http://" + server.address()}})
                  .status()
                  .ok());
}

TEST(ConsoleOrigins, ThatAreNamedMayCall) {
  ServerOptions options = with_console();
  options.console.origins = {"https://app.example.org"};
  ConsoleServer server(empty_mesh(), options);
  const WebResponse asked = preflight(server.address(), "https://app.example.org");
  EXPECT_EQ(asked.status, 204);
  EXPECT_EQ(asked.header("access-control-allow-origin"), "https://app.example.org");
  EXPECT_EQ(asked.header("access-control-allow-headers"), "content-type,x-grpc-web");
  EXPECT_EQ(asked.header("access-control-allow-credentials"), "");
  WebConnection browser(server.address());
  browser.send(call_request(kServerInfo, framed(""), {{"Origin", "https://app.example.org"}}));
  const WebResponse head = browser.read_head();
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("access-control-allow-origin"), "https://app.example.org");
  EXPECT_TRUE(has(head.header("vary"), "Origin"));
  EXPECT_EQ(preflight(server.address(), "https://other.example.org").status, 403);
}

TEST(ConsoleNames, OfOthersAreRefused) {
  ConsoleServer server;
  EXPECT_EQ(get(server.address(), "/", {{"Host", "evil.example.org"}}).status, 421);
  EXPECT_EQ(get(server.address(), "/metrics", {{"Host", "evil.example.org:80"}}).status, 421);
  EXPECT_EQ(get(server.address(), "/", {{"Host", server.address()}}).status, 200);
}

class ConsoleTls : public ::testing::Test {
 protected:
  ServerOptions options(const std::string& client_ca = "") {
    const TestCertificate own = ca_.issue({.common_name = "weftd", .names = {"IP:127.0.0.1"}});
    ServerOptions options = with_console();
    options.tls = {.certificate = folder_.write("server.pem", own.pem).string(),
                   .key = folder_.write("server.key", own.key).string()};
    if (!client_ca.empty()) options.tls.client_ca = folder_.write("ca.pem", client_ca).string();
    return options;
  }
  // Trusts the CA, and shows the certificate.
  std::shared_ptr<SSL_CTX> browser(const TestCertificate& own = {}) {
    const std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_client_method()), &SSL_CTX_free);
    SSL_CTX_load_verify_file(context.get(), folder_.write("trusted.pem", ca_.pem()).c_str());
    SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
    if (own.pem.empty()) return context;
    SSL_CTX_use_certificate_file(context.get(), folder_.write("own.pem", own.pem).c_str(),
                                 SSL_FILETYPE_PEM);
    SSL_CTX_use_PrivateKey_file(context.get(), folder_.write("own.key", own.key).c_str(),
                                SSL_FILETYPE_PEM);
    return context;
  }

  const files::TempFolder folder_;
  const TestCa ca_{"a CA"};
  const TestCa clients_{"a CA of clients"};
};

TEST_F(ConsoleTls, EncryptsWithTheCertificateOfTheServer) {
  ConsoleServer server(
      [](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 5, kMaxChunkBytes); },
      options());
  EXPECT_TRUE(has(server.log().text(), "event=serving_console security=tls"));
  const auto context = browser();
  WebConnection connection(server.address(), context.get());
  connection.send(
      call_request(kGenerateMesh, framed(valid_request().SerializeAsString()),
                   {{"Host", "mesh.example.org"}, {"Origin", "https://mesh.example.org"}}));
  const WebOutcome outcome = connection.read_call();
  EXPECT_TRUE(outcome.status().ok()) << outcome.status().error_message();
  EXPECT_GE(outcome.messages.size(), 6u);
}

TEST_F(ConsoleTls, ServesNobodyUnencrypted) {
  ConsoleServer server(empty_mesh(), options());
  EXPECT_FALSE(has(weft::testing::http(server.address(), "GET", "/"), "HTTP"));
}

TEST_F(ConsoleTls, KnowsClientsByTheirCertificates) {
  ConsoleServer server(empty_mesh(), options(clients_.pem()));
  const auto ann = browser(clients_.issue({.common_name = "ann"}));
  WebConnection connection(server.address(), ann.get());
  connection.send(call_request(kGenerateMesh, framed(valid_request().SerializeAsString())));
  EXPECT_TRUE(connection.read_call().status().ok());
  EXPECT_TRUE(eventually([&] { return server.log().contains("client=ann "); }))
      << server.log().text();
}

TEST_F(ConsoleTls, ShutsOutClientsWithoutACertificate) {
  ConsoleServer server(empty_mesh(), options(clients_.pem()));
  const auto refused = [&](const TestCertificate& own) {
    const auto context = browser(own);
    try {
      WebConnection connection(server.address(), context.get());
      connection.send(request("GET", "/metrics"));
      return connection.read_head().status == 0;  // TLS 1.3 says it after the handshake
    } catch (const std::exception&) {
      return true;
    }
  };
  EXPECT_TRUE(refused({}));
  EXPECT_TRUE(refused(ca_.issue({.common_name = "ann"})));
  EXPECT_FALSE(refused(clients_.issue({.common_name = "ann"})));
}

TEST_F(ConsoleTls, TakesARenewedCertificateWithoutARestart) {
  ConsoleServer server(empty_mesh(), options());
  const auto subject = [&] {
    const auto context = browser();
    SSL_CTX_set_verify(context.get(), SSL_VERIFY_NONE, nullptr);
    WebConnection connection(server.address(), context.get());
    return connection.peer_name();
  };
  EXPECT_EQ(subject(), "weftd");
  const TestCertificate renewed = clients_.issue({.common_name = "renewed"});
  folder_.write("server.pem", renewed.pem);
  folder_.write("server.key", renewed.key);
  EXPECT_TRUE(eventually([&] { return subject() == "renewed"; }));
}

TEST(ConsoleAddress, IsRefusedUnencryptedIfOtherMachinesCanConnect) {
  ServerOptions options = with_console();
  options.console.address = "0.0.0.0:0";
  const std::string refusal = refusal_to_start(options);
  EXPECT_TRUE(has(refusal, "console")) << refusal;
  EXPECT_TRUE(has(refusal, "0.0.0.0:0")) << refusal;
  EXPECT_TRUE(has(refusal, "--insecure")) << refusal;
  options.insecure = true;
  EXPECT_EQ(refusal_to_start(options), "");
}

TEST(ConsoleAddress, IsNamedIfItIsNotToBeHad) {
  ServerOptions options = with_console();
  options.console.address = "nonsense";
  EXPECT_TRUE(has(refusal_to_start(options), "nonsense: not of the form HOST:PORT"));
  ConsoleServer server;
  options.console.address = server.address();
  EXPECT_TRUE(has(refusal_to_start(options), server.address() + ": Address already in use"));
}

}  // namespace
}  // namespace weft::server::testing
