// SPDX-License-Identifier: Apache-2.0
// What is shown over HTTP, and what strangers cannot do to it.
#include "server/services/metrics_endpoint.h"

#include <gtest/gtest.h>

#include <atomic>
#include <deque>
#include <thread>

#include "tests/server/logged_server.h"
#include "tests/support/http.h"

namespace weft::server::testing {
namespace {

using weft::testing::http;
using weft::testing::HttpConnection;

class Endpoint : public ::testing::Test {
 protected:
  std::string get(const std::string& path) { return http(endpoint_->address(), "GET", path); }

  std::atomic<bool> healthy_{true};
  std::string page_ = "weft_figure 1\n";
  const std::unique_ptr<MetricsEndpoint> endpoint_ =
      MetricsEndpoint::start("127.0.0.1:0", {.metrics = [this] { return page_; },
                                             .healthy = [this] { return healthy_.load(); }})
          .value();
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST_F(Endpoint, ShowsMetricsInTheFormThatPrometheusReads) {
  const std::string answer = get("/metrics");
  EXPECT_EQ(answer.rfind("HTTP/1.1 200 ", 0), 0u) << answer;
  EXPECT_TRUE(has(answer, "Content-Type: text/plain; version=0.0.4")) << answer;
  EXPECT_TRUE(has(answer, "\r\n\r\nweft_figure 1\n")) << answer;
}

TEST_F(Endpoint, TellsWhetherTheServerTakesCalls) {
  EXPECT_EQ(get("/healthz").rfind("HTTP/1.1 200 ", 0), 0u);
  healthy_ = false;
  EXPECT_EQ(get("/healthz").rfind("HTTP/1.1 503 ", 0), 0u);
}

TEST_F(Endpoint, AnswersHeadWithoutABody) {
  const std::string answer = http(endpoint_->address(), "HEAD", "/metrics");
  EXPECT_TRUE(has(answer, "Content-Length: 14\r\n")) << answer;
  EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << answer;
}

TEST_F(Endpoint, HasNothingElse) {
  EXPECT_EQ(get("/").rfind("HTTP/1.1 404 ", 0), 0u);
  EXPECT_EQ(get("/metrics/../../etc/passwd").rfind("HTTP/1.1 404 ", 0), 0u);
  EXPECT_EQ(http(endpoint_->address(), "DELETE", "/metrics").rfind("HTTP/1.1 405 ", 0), 0u);
}

TEST_F(Endpoint, SendsALargePageWhole) {
  page_ = std::string(std::size_t{4} << 20, 'x');
  const std::string answer = get("/metrics");
  EXPECT_EQ(answer.size() - answer.find("\r\n\r\n") - 4, page_.size());
}

TEST_F(Endpoint, ClosesOnWhatIsNotARequest) {
  for (const std::string& bytes :
       std::vector<std::string>{"\r\n\r\n\r\n", "\x16\x03\x01 TLS", "GET\r\n\r\n",
                                "GET /metrics HTTP/1.1\r\nX: " + std::string(100'000, 'x'),
                                "POST /metrics HTTP/1.1\r\nContent-Length: 9\r\n\r\n123456789",
                                std::string(10'000, '\0')}) {
    HttpConnection connection(endpoint_->address());
    connection.send(bytes);
    const std::string answer = connection.read_all();
    EXPECT_FALSE(has(answer, " 200 ")) << answer;
  }
  EXPECT_TRUE(has(get("/metrics"), "weft_figure"));
}

TEST_F(Endpoint, ServesOthersWhileSomeSayNothing) {
  std::deque<HttpConnection> silent;
  for (int i = 0; i < 30; ++i) {
    silent.emplace_back(endpoint_->address());
    silent.back().send("GET /met");
  }
  EXPECT_TRUE(has(get("/metrics"), "weft_figure"));
}

TEST_F(Endpoint, ClosesTheOldestOfConnectionsThatAreTooMany) {
  std::deque<HttpConnection> silent;
  for (int i = 0; i < 200; ++i) silent.emplace_back(endpoint_->address());
  EXPECT_TRUE(has(get("/metrics"), "weft_figure"));
  EXPECT_EQ(silent.front().read_all(), "");
  silent.back().send("GET /healthz HTTP/1.1\r\n\r\n");
  EXPECT_TRUE(has(silent.back().read_all(), " 200 "));
}

TEST(EndpointPatience, EndsWithWhoNeverEndsHisRequest) {
  const auto endpoint =
      MetricsEndpoint::start("127.0.0.1:0", {}, {.patience = std::chrono::milliseconds(50)})
          .value();
  HttpConnection connection(endpoint->address());
  connection.send("GET /metrics HTTP/1.1\r\n");
  EXPECT_EQ(connection.read_all(), "");  // throws where it lasts too long
}

TEST(EndpointPatience, EndsWithWhoNeverReadsHisAnswer) {
  const auto endpoint =
      MetricsEndpoint::start("127.0.0.1:0",
                             {.metrics = [] { return std::string(std::size_t{16} << 20, 'x'); },
                              .healthy = [] { return true; }},
                             {.patience = std::chrono::milliseconds(50), .connections = 2})
          .value();
  std::deque<HttpConnection> idle;
  for (int i = 0; i < 2; ++i) {
    idle.emplace_back(endpoint->address());
    idle.back().send("GET /metrics HTTP/1.1\r\n\r\n");
  }
  EXPECT_TRUE(eventually([&] { return has(http(endpoint->address(), "GET", "/healthz"), "200"); }));
}

TEST(EndpointAddress, IsNamedWhereItIsNotToBeHad) {
  const auto refusal = [](const std::string& address) {
    const auto endpoint = MetricsEndpoint::start(address, {});
    return endpoint ? "" : endpoint.error();
  };
  EXPECT_TRUE(has(refusal("nonsense"), "nonsense: not of the form HOST:PORT"));
  const auto first = MetricsEndpoint::start("127.0.0.1:0", {}).value();
  EXPECT_TRUE(has(refusal(first->address()), first->address() + ": Address already in use"));
}

TEST(EndpointOfAServer, SaysSoWhileItDrains) {
  Event begun;
  Event release;
  const EngineFn engine = [&](const auto&, ChunkSink& sink, auto&) {
    begun.set();
    EXPECT_TRUE(release.wait());
    return send_chunks(sink, 0);
  };
  auto server = Server::start({.listen = {"127.0.0.1:0"}, .service = {}, .metrics = "127.0.0.1:0"},
                              engine, make_logger("off"))
                    .value();
  const auto status = [&] {
    return http(server->metrics_address(), "GET", "/healthz").substr(0, 12);
  };
  EXPECT_EQ(status(), "HTTP/1.1 200");
  const auto stub = v1::MeshService::NewStub(
      channel_to(server->addresses().front(), grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  const auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(begun.wait());
  std::thread drainer([&] { server->drain(std::chrono::seconds(30)); });
  EXPECT_TRUE(eventually([&] { return status() == "HTTP/1.1 503"; }));
  release.set();
  EXPECT_TRUE(read_all(*reader).status.ok());
  drainer.join();
}

}  // namespace
}  // namespace weft::server::testing
