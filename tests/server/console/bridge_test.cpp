// SPDX-License-Identifier: Apache-2.0
// Calls by gRPC-Web: they do as over gRPC, whoever makes them and however they end.
#include <atomic>
#include <cstdio>
#include <deque>
#include <thread>

#include "server/console/frames.h"
#include "tests/server/console/console_server.h"
#include "tests/server/raw_call.h"
#include "tests/support/http.h"

namespace weft::server::testing {
namespace {

using grpc::StatusCode;
using std::chrono::milliseconds;

const std::string& mesh_request() {
  static const std::string bytes = valid_request().SerializeAsString();
  return bytes;
}

std::vector<std::uint32_t> chunk_indices(const WebOutcome& outcome) {
  std::vector<std::uint32_t> indices;
  for (const std::string& bytes : outcome.messages) {
    v1::GenerateMeshResponse message;
    EXPECT_TRUE(message.ParseFromString(bytes));
    if (message.has_chunk()) indices.push_back(message.chunk().index());
  }
  return indices;
}

TEST(Bridge, AnswersAUnaryCallWithTheBytesOfGrpc) {
  ConsoleServer server;
  const WebOutcome outcome = web_call(server.address(), kServerInfo, "");
  EXPECT_TRUE(outcome.status().ok()) << outcome.status().error_message();
  const auto [status, answer] = raw_unary(server.channel(), kServerInfo, "");
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(outcome.messages, std::vector{answer});
}

TEST(Bridge, CallsEveryServiceOfTheServer) {
  ConsoleServer server;
  const WebOutcome health = web_call(server.address(), "/grpc.health.v1.Health/Check", "");
  EXPECT_EQ(health.messages, std::vector{std::string("\x08\x01", 2)});
  const WebOutcome reflection =
      web_call(server.address(), "/grpc.reflection.v1.ServerReflection/ServerReflectionInfo",
               std::string("\x3a\x00", 2));
  EXPECT_TRUE(reflection.status().ok()) << reflection.status().error_message();
  ASSERT_EQ(reflection.messages.size(), 1u);
  EXPECT_TRUE(has(reflection.messages[0], "weft.v1.MeshService"));
}

TEST(Bridge, StreamsEveryMessageOfALargeMesh) {
  constexpr std::uint32_t kChunks = 40;
  ConsoleServer server([](const auto&, ChunkSink& sink, auto&) {
    return send_chunks(sink, kChunks, kMaxChunkBytes);
  });
  const WebOutcome outcome = web_call(server.address(), kGenerateMesh, mesh_request());
  EXPECT_TRUE(outcome.status().ok()) << outcome.status().error_message();
  const auto indices = chunk_indices(outcome);
  ASSERT_EQ(indices.size(), kChunks);
  for (std::uint32_t i = 0; i < kChunks; ++i) EXPECT_EQ(indices[i], i);
}

TEST(Bridge, HandsMessagesOverWhileTheCallWorks) {
  Event read;
  ConsoleServer server([&](const auto&, ChunkSink& sink, auto&) {
    EXPECT_TRUE(sink.accept(make_chunk(0)));
    EXPECT_TRUE(read.wait());
    return send_chunks(sink, 0);
  });
  WebConnection browser(server.address());
  browser.send(call_request(kGenerateMesh, framed(mesh_request())));
  EXPECT_EQ(browser.read_head().header("content-type"), "application/grpc-web+proto");
  v1::GenerateMeshResponse message;
  do {
    const auto frame = browser.read_frame();
    ASSERT_TRUE(frame);
    ASSERT_TRUE(message.ParseFromString(frame->bytes));
  } while (!message.has_chunk());
  read.set();
  while (browser.read_frame()) {
  }
}

TEST(Bridge, EndsAFailedCallWithTheDetailsOfGrpc) {
  ConsoleServer server;
  v1::GenerateMeshRequest wrong = valid_request();
  wrong.mutable_size()->set_expression("1 + é");
  const WebOutcome outcome = web_call(server.address(), kGenerateMesh, wrong.SerializeAsString());
  EXPECT_EQ(outcome.http, 200);
  const grpc::Status status = outcome.status();
  const grpc::Status plain = raw_generate_mesh(server.channel(), wrong.SerializeAsString());
  EXPECT_EQ(status.error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(status.error_message(), plain.error_message());
  EXPECT_EQ(reason_of(outcome), "EXPRESSION_SYNTAX");
  ASSERT_TRUE(details_of(status).bad_request);
  EXPECT_EQ(details_of(status).bad_request->field_violations(0).field(),
            details_of(plain).bad_request->field_violations(0).field());
}

TEST(Bridge, SaysWhichMethodsThereAreNot) {
  ConsoleServer server;
  EXPECT_EQ(web_call(server.address(), "/none.Service/None", "").status().error_code(),
            StatusCode::UNIMPLEMENTED);
  WebConnection browser(server.address());
  browser.send(call_request("/no-method", framed("")));
  EXPECT_EQ(browser.read_response().status, 404);
}

TEST(Bridge, RefusesMalformedFrames) {
  ConsoleServer server;
  for (const std::string& body :
       std::vector<std::string>{framed("x", 1), framed("grpc-status: 0\r\n", 0x80), framed("x", 2),
                                framed("message").substr(0, 8), framed("message").substr(0, 3),
                                framed(mesh_request()) + "x"}) {
    WebConnection browser(server.address());
    browser.send(call_request(kGenerateMesh, body));
    const WebOutcome outcome = browser.read_call();
    EXPECT_EQ(outcome.status().error_code(), StatusCode::INVALID_ARGUMENT);
    EXPECT_EQ(reason_of(outcome), "MALFORMED_REQUEST");
  }
}

TEST(Bridge, RefusesAnOversizedMessageByItsHeader) {
  ServerOptions options = with_console();
  options.service.limits.max_request_bytes = 1000;
  ConsoleServer server(empty_mesh(), options);
  WebConnection browser(server.address());
  browser.send(call_request(kGenerateMesh, framed(std::string(1001, 'x')).substr(0, 5),
                            {{"Content-Length", "1006"}}));
  const WebOutcome outcome = browser.read_call();
  EXPECT_EQ(outcome.status().error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(reason_of(outcome), "LIMIT_EXCEEDED");
}

TEST(Bridge, BoundsABodyOfManySmallMessages) {
  ServerOptions options = with_console();
  options.service.limits.max_request_bytes = 1000;
  ConsoleServer server(empty_mesh(), options);
  std::string body;
  while (body.size() < 10'000) body += framed(std::string("\x3a\x00", 2));
  WebConnection browser(server.address());
  browser.send(call_request("/grpc.reflection.v1.ServerReflection/ServerReflectionInfo", body));
  EXPECT_EQ(reason_of(browser.read_call()), "LIMIT_EXCEEDED");
}

// Text mode: its frames in base64, here in segments that are padded each.
std::string text_request(const std::string& path, const std::string& text) {
  return call_request(path, text, {{"Content-Type", "application/grpc-web-text"}});
}

TEST(Bridge, AnswersACallInText) {
  ConsoleServer server;
  WebConnection browser(server.address());
  browser.send(text_request(kServerInfo, "AAA=AAAA"));  // an empty message
  const WebResponse response = browser.read_response();
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.header("content-type"), "application/grpc-web-text+proto");
  const std::string bytes = Base64Reader().feed(response.body).value_or("");
  ASSERT_GT(bytes.size(), kFrameHeader);
  const auto length =
      std::size_t{static_cast<unsigned char>(bytes[3])} << 8 | static_cast<unsigned char>(bytes[4]);
  v1::GetServerInfoResponse info;
  EXPECT_TRUE(info.ParseFromString(bytes.substr(kFrameHeader, length)));
  EXPECT_FALSE(info.engine_version().empty());
  EXPECT_EQ(bytes.substr(kFrameHeader + length), framed("grpc-status: 0\r\n", kTrailerFlag));
}

TEST(Bridge, RefusesTextThatIsNotBase64) {
  ConsoleServer server;
  for (const char* text : {"AAA*AAAA", "****AAAAAAA=", "====", "AAA=AAA", "AAAAAAE=", "AAAA A=="}) {
    WebConnection browser(server.address());
    browser.send(text_request(kServerInfo, text));
    const WebResponse response = browser.read_response();
    const std::string bytes = Base64Reader().feed(response.body).value_or("");
    ASSERT_GT(bytes.size(), kFrameHeader) << text;
    EXPECT_EQ(bytes.substr(kFrameHeader, 16), "grpc-status: 3\r\n") << text;
  }
}

// gRPC reports the end of a call that was dropped a little later, perhaps after the last connection
// was closed.
TEST(Bridge, StopsAtOnceAfterCallsWereDropped) {
  for (int round = 0; round < 40; ++round) {
    ConsoleServer server;
    for (int call = 0; call < 8; ++call) {
      WebConnection browser(server.address());
      browser.send(text_request(kServerInfo, "===="));
      browser.read_response();
    }
  }
}

TEST(Bridge, TakesCallsOfItsOwnTypeOnly) {
  ConsoleServer server;
  for (const char* type : {"", "application/json", "text/plain", "application/grpc",
                           "application/grpc-web-texts", "application/x-www-form-urlencoded"}) {
    WebConnection browser(server.address());
    browser.send(call_request(kServerInfo, framed(""), {{"Content-Type", type}}));
    EXPECT_EQ(browser.read_response().status, 415) << type;
  }
  EXPECT_TRUE(
      web_call(server.address(), kServerInfo, "", {{"Content-Type", "application/grpc-web"}})
          .status()
          .ok());
}

TEST(Bridge, TakesOneCallAfterTheOtherOnAConnection) {
  ConsoleServer server;
  WebConnection browser(server.address());
  for (int i = 0; i < 3; ++i) {
    browser.send(call_request(kServerInfo, framed("")));
    EXPECT_TRUE(browser.read_call().status().ok());
  }
  const std::string call = call_request(kServerInfo, framed(""));
  browser.send(call + call);
  EXPECT_TRUE(browser.read_call().status().ok());
  EXPECT_TRUE(browser.read_call().status().ok());
}

TEST(Bridge, TakesABodyInChunksAndOneThatIsAskedFor) {
  ConsoleServer server;
  WebConnection browser(server.address());
  const std::string body = framed(mesh_request());
  const auto chunk = [](const std::string& bytes) {
    std::string size(8, '\0');
    size.resize(
        static_cast<std::size_t>(std::snprintf(size.data(), size.size(), "%zx", bytes.size())));
    return size + "\r\n" + bytes + "\r\n";
  };
  browser.send(call_request(kGenerateMesh,
                            chunk(body.substr(0, 7)) + chunk(body.substr(7)) + "0\r\n\r\n",
                            {{"Transfer-Encoding", "chunked"}}));
  EXPECT_TRUE(browser.read_call().status().ok());
  const std::string whole = call_request(kGenerateMesh, body, {{"Expect", "100-continue"}});
  browser.send(whole.substr(0, whole.size() - body.size()));
  EXPECT_EQ(browser.read_head().status, 100);
  browser.send(body);
  EXPECT_TRUE(browser.read_call().status().ok());
}

TEST(Bridge, KeepsTheDeadlineOfACall) {
  Event begun;
  Event stopped;
  ConsoleServer server([&](const auto&, auto&, const weft::Run& run) {
    begun.set();
    auto result = work_until_stopped(run);
    stopped.set();
    return result;
  });
  // A deadline may pass before the engine has begun: the next one leaves it twice as long.
  for (int timeout = 50; !begun.happened() && timeout < 100'000; timeout *= 2) {
    const WebOutcome outcome = web_call(server.address(), kGenerateMesh, mesh_request(),
                                        {{"grpc-timeout", std::to_string(timeout) + "m"}});
    EXPECT_EQ(outcome.status().error_code(), StatusCode::DEADLINE_EXCEEDED);
  }
  EXPECT_TRUE(stopped.wait());
  WebConnection browser(server.address());
  browser.send(call_request(kServerInfo, framed(""), {{"grpc-timeout", "soon"}}));
  EXPECT_EQ(browser.read_response().status, 400);
}

TEST(Bridge, CancelsTheCallOfABrowserThatGoesAway) {
  Event started;
  Event stopped;
  ServerOptions options = with_console();
  options.service.tick = std::chrono::hours(1);  // no progress, whose writing would fail
  ConsoleServer server(
      [&](const auto&, auto&, const weft::Run& run) {
        started.set();
        auto result = work_until_stopped(run);
        stopped.set();
        return result;
      },
      options);
  {
    WebConnection browser(server.address());
    browser.send(call_request(kGenerateMesh, framed(mesh_request())));
    ASSERT_TRUE(started.wait());
  }
  EXPECT_TRUE(stopped.wait());
  EXPECT_TRUE(eventually([&] { return server.log().contains("status=CANCELLED"); }))
      << server.log().text();
}

// What lies between the engine and the browser: two messages in the console, the server's own
// buffer, and what the kernel takes.
TEST(Bridge, ABrowserThatStopsReadingStopsTheEngine) {
  constexpr std::uint32_t kMax = 40;
  std::atomic<std::uint32_t> sent{0};
  Event begun;  // the engine is at work for the slow one
  Event refused;
  std::atomic<bool> first{true};
  ServerOptions options = with_console();
  options.service.jobs = 2;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        if (!first.exchange(false)) return send_chunks(sink, 50, kMaxChunkBytes);
        begun.set();
        auto result = send_until_refused(sink, sent);
        refused.set();
        return result;
      },
      options);
  {
    WebConnection slow(server.address(), nullptr, 1 << 16);
    slow.send(call_request(kGenerateMesh, framed(mesh_request())));
    EXPECT_EQ(slow.read_head().status, 200);
    ASSERT_TRUE(begun.wait()) << "the answer begins before the engine does";
    for (int i = 0; i < 3; ++i) {
      const WebOutcome other = web_call(server.address(), kGenerateMesh, mesh_request());
      EXPECT_TRUE(other.status().ok()) << other.status().error_message();
      EXPECT_EQ(chunk_indices(other).size(), 50u);
    }
    EXPECT_LT(sent, kMax) << "150 MiB went to the others meanwhile";
  }
  EXPECT_TRUE(refused.wait());
}

TEST(Bridge, ABrowserThatReadsNothingIsCutOff) {
  std::atomic<std::uint32_t> sent{0};
  Event refused;
  ServerOptions options = with_console();
  options.service.tick = milliseconds(10);
  options.service.patience.stall_timeout = milliseconds(200);
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        auto result = send_until_refused(sink, sent);
        refused.set();
        return result;
      },
      options);
  WebConnection browser(server.address(), nullptr, 1 << 16);
  browser.send(call_request(kGenerateMesh, framed(mesh_request())));
  EXPECT_TRUE(refused.wait());
  // The response is cut off, unless the service notices first and ends it with an error.
  try {
    EXPECT_FALSE(browser.read_call().status().ok());
  } catch (const std::exception&) {
  }
}

TEST(Bridge, ServesTwoHundredTabsAtOnce) {
  constexpr int kTabs = 200;
  ServerOptions options = with_console();
  options.service.queue = kTabs;
  ConsoleServer server(
      [](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 3, 1000); }, options);
  std::deque<WebConnection> tabs;
  for (int i = 0; i < kTabs; ++i) {
    tabs.emplace_back(server.address());
    tabs.back().send(call_request(kGenerateMesh, framed(mesh_request())));
  }
  for (WebConnection& tab : tabs) {
    const WebOutcome outcome = tab.read_call();
    EXPECT_TRUE(outcome.status().ok()) << outcome.status().error_message();
    EXPECT_EQ(chunk_indices(outcome).size(), 3u);
  }
}

TEST(Bridge, EndsOpenStreamsWithAReasonWhenTheServerStops) {
  Event started;
  ConsoleServer server([&](const auto&, auto&, const weft::Run& run) {
    started.set();
    return work_until_stopped(run);
  });
  WebConnection idle(server.address());
  WebConnection browser(server.address());
  browser.send(call_request(kGenerateMesh, framed(mesh_request())));
  ASSERT_TRUE(started.wait());
  std::jthread drainer([&] { server->drain(std::chrono::seconds(0)); });
  const WebOutcome outcome = browser.read_call();
  EXPECT_EQ(outcome.status().error_code(), StatusCode::UNAVAILABLE);
  EXPECT_EQ(reason_of(outcome), "STOPPING");
  EXPECT_TRUE(browser.ends());
  EXPECT_TRUE(idle.ends());
  drainer.join();
  EXPECT_ANY_THROW(WebConnection{server.address()});
}

TEST(Bridge, StopsWhileABrowserReadsNothing) {
  std::atomic<std::uint32_t> sent{0};
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) { return send_until_refused(sink, sent); });
  WebConnection browser(server.address(), nullptr, 1 << 16);
  browser.send(call_request(kGenerateMesh, framed(mesh_request())));
  EXPECT_EQ(browser.read_head().status, 200);
  server->drain(std::chrono::seconds(0));  // returns
}

TEST(Bridge, CallsAreCountedAndLoggedAsThoseOfTheBrowser) {
  ServerOptions options = with_console();
  options.metrics = "127.0.0.1:0";
  ConsoleServer server(empty_mesh(), options);
  EXPECT_TRUE(web_call(server.address(), kGenerateMesh, mesh_request()).status().ok());
  EXPECT_TRUE(eventually([&] {
    return weft::testing::value_of(
               weft::testing::http(server->metrics_address(), "GET", "/metrics"),
               R"(weft_requests_total{code="OK",method="GenerateMesh"})") == 1;
  }));
  EXPECT_TRUE(has(server.log().text(), "peer=ipv4:127.0.0.1:")) << server.log().text();
  EXPECT_FALSE(has(server.log().text(), "inproc")) << server.log().text();
}

}  // namespace
}  // namespace weft::server::testing
