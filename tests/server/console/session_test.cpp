// SPDX-License-Identifier: Apache-2.0
// Pages, and what strangers cannot do to a connection.
#include <zlib.h>

#include <array>
#include <deque>

#include "server/console/assets.h"
#include "tests/server/console/console_server.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;

std::string gzipped(const std::string& bytes) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

class Pages : public ::testing::Test {
 protected:
  ServerOptions options() {
    ServerOptions options = with_console();
    options.console.assets = assets_;
    return options;
  }
  WebResponse get(const std::string& path, const Headers& headers = {}) {
    return testing::get(server_.address(), path, headers);
  }

  const std::string index_ = "<!doctype html><title>weft</title>";
  const std::string script_ = std::string(100'000, 'x');
  const std::string index_gzip_ = gzipped(index_);
  const std::string script_gzip_ = gzipped(script_);
  const std::array<Asset, 2> assets_ = {{
      {"/index.html", "text/html; charset=utf-8", index_gzip_, "\"1\"", false},
      {"/assets/main-1a2b.js", "text/javascript; charset=utf-8", script_gzip_, "\"2\"", true},
  }};
  ConsoleServer server_{empty_mesh(), options()};
};

TEST_F(Pages, AreCompressedForWhoTakesThem) {
  const WebResponse packed = get("/assets/main-1a2b.js", {{"Accept-Encoding", "gzip, br"}});
  EXPECT_EQ(packed.status, 200);
  EXPECT_EQ(packed.header("content-encoding"), "gzip");
  EXPECT_EQ(packed.body, script_gzip_);
  const WebResponse plain = get("/assets/main-1a2b.js");
  EXPECT_EQ(plain.header("content-encoding"), "");
  EXPECT_EQ(plain.body, script_);
  for (const WebResponse& response : {packed, plain}) {
    EXPECT_EQ(response.header("content-type"), "text/javascript; charset=utf-8");
    EXPECT_TRUE(has(response.header("vary"), "Accept-Encoding"));
    EXPECT_TRUE(has(response.header("cache-control"), "immutable"));
  }
}

TEST_F(Pages, AreSentOnceIfTheyStayTheSame) {
  const WebResponse first = get("/");
  EXPECT_EQ(first.header("etag"), "\"1\"");
  EXPECT_EQ(first.header("cache-control"), "no-cache");
  const WebResponse again = get("/", {{"If-None-Match", first.header("etag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(get("/", {{"If-None-Match", "\"other\""}}).status, 200);
}

TEST_F(Pages, OfTheApplicationAreAllIndexHtml) {
  for (const char* path : {"/", "/index.html", "/jobs", "/jobs/", "/server", "/job/01J9ZC", "/?x=1",
                           "/mesh/0123abcd", "/compare/a/b"})
    EXPECT_EQ(get(path).body, index_) << path;
}

TEST_F(Pages, ThatThereAreNotAreNotFound) {
  for (const char* path : {"/none", "/assets/", "/assets/none.js", "/../etc/passwd", "/index.html/",
                           "/assets/../index.html", "//index.html", "*", "http://x/"})
    EXPECT_EQ(get(path).status, 404) << path;
}

TEST_F(Pages, AnswerHeadWithoutABody) {
  WebConnection browser(server_.address());
  browser.send(request("HEAD", "/assets/main-1a2b.js"));
  EXPECT_EQ(browser.read_head().header("content-length"), "100000");
  browser.send(request("GET", "/"));
  EXPECT_EQ(browser.read_response().body, index_);
}

TEST_F(Pages, AndAllElseRunNothingButTheirOwnFiles) {
  WebConnection call(server_.address());
  call.send(call_request(kServerInfo, framed("")));
  for (const WebResponse& response :
       {get("/"), get("/assets/main-1a2b.js"), get("/none"), get("/metrics"), call.read_head()}) {
    const std::string policy = response.header("content-security-policy");
    EXPECT_TRUE(policy.starts_with("default-src 'none'; ")) << policy;
    EXPECT_FALSE(has(policy, "unsafe")) << policy;
    EXPECT_FALSE(has(policy, "*")) << policy;
    EXPECT_TRUE(has(policy, "frame-ancestors 'none'")) << policy;
    EXPECT_EQ(response.header("x-content-type-options"), "nosniff");
    EXPECT_EQ(response.header("referrer-policy"), "no-referrer");
    EXPECT_EQ(response.header("access-control-allow-origin"), "");
  }
}

TEST(PagesOfAServerWithoutTheApplication, SaySo) {
  ConsoleServer server;
  const WebResponse response = get(server.address(), "/");
  EXPECT_TRUE(has(response.body, "built without the console's pages")) << response.body;
  EXPECT_TRUE(has(server.log().text(), "event=serving_console")) << server.log().text();
  EXPECT_TRUE(has(server.log().text(), "application=no")) << server.log().text();
}

TEST(HttpOfTheConsole, IsRefusedIfItIsMalformed) {
  ConsoleServer server;
  for (const std::string& bytes : std::vector<std::string>{
           "\r\n\r\n\r\n", "\x16\x03\x01 TLS\r\n\r\n", "GET\r\n\r\n", "GET / HTTP/1.1\r\n\r\n",
           "GET / HTTP/1.0\r\nHost: localhost\r\n\r\n", "GET / HTTP/2.0\r\nHost: localhost\r\n\r\n",
           "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", std::string(10'000, '\0'),
           "GET / HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n",
           "POST " + std::string(kServerInfo) + " HTTP/1.1\r\nHost: localhost\r\n" +
               "Content-Type: application/grpc-web\r\nContent-Length: 5\r\n" +
               "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n"}) {
    WebConnection stranger(server.address());
    stranger.send(bytes);
    const int status = stranger.read_head().status;
    EXPECT_TRUE(status == 0 || status >= 400) << status << ": " << bytes;
  }
  EXPECT_EQ(get(server.address(), "/").status, 200);
}

TEST(HttpOfTheConsole, IsRefusedIfItsHeaderIsTooLong) {
  ConsoleServer server;
  EXPECT_EQ(get(server.address(), "/", {{"X", std::string(20'000, 'x')}}).status, 431);
  EXPECT_EQ(get(server.address(), "/" + std::string(20'000, 'x')).status, 431);
  WebConnection endless(server.address());
  endless.send(call_request(kServerInfo, "5;" + std::string(300'000, 'x'),
                            {{"Transfer-Encoding", "chunked"}}));
  EXPECT_FALSE(endless.read_call().status().ok());
  EXPECT_EQ(get(server.address(), "/").status, 200);
}

TEST(HttpOfTheConsole, HasFewMethods) {
  ConsoleServer server;
  for (const char* method : {"PUT", "DELETE", "TRACE", "CONNECT", "PATCH"}) {
    WebConnection browser(server.address());
    browser.send(request(method, "/"));
    EXPECT_EQ(browser.read_response().status, 405) << method;
  }
}

TEST(ConnectionsOfTheConsole, EndIfAHeaderNeverEnds) {
  ServerOptions options = with_console();
  options.console.header_timeout = milliseconds(50);
  ConsoleServer server(empty_mesh(), options);
  WebConnection slow(server.address());
  slow.send("GET / HTTP/1.1\r\nHost: local");
  EXPECT_TRUE(slow.ends());
}

TEST(ConnectionsOfTheConsole, EndIfTheyAreIdle) {
  // The machine may be too slow for a request in this time: the next server gives it twice as long.
  bool answered = false;
  for (milliseconds idle(50); !answered && idle < kPatience / 2; idle *= 2) {
    ServerOptions options = with_console();
    options.console.idle_timeout = idle;
    ConsoleServer server(empty_mesh(), options);
    WebConnection silent(server.address());
    EXPECT_TRUE(silent.ends());
    WebConnection done(server.address());
    done.send(request("GET", "/metrics"));
    answered = done.read_response().status == 200;
    EXPECT_TRUE(done.ends());
  }
  EXPECT_TRUE(answered);
}

TEST(ConnectionsOfTheConsole, EndIfAMessageNeverEnds) {
  ServerOptions options = with_console();
  options.admission.request_timeout = milliseconds(50);
  ConsoleServer server(empty_mesh(), options);
  WebConnection slow(server.address());
  slow.send(
      call_request(kGenerateMesh, framed("message").substr(0, 6), {{"Content-Length", "12"}}));
  EXPECT_EQ(slow.read_call().status().error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  EXPECT_TRUE(slow.ends());
}

TEST(ConnectionsOfTheConsole, ThatAreTooManyCloseTheOneThatHasBeenIdleLongest) {
  ServerOptions options = with_console();
  options.console.connections = 3;
  options.console.header_timeout = std::chrono::minutes(10);
  Event release;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        EXPECT_TRUE(sink.accept(make_chunk(0)));
        EXPECT_TRUE(release.wait());
        return send_chunks(sink, 0);
      },
      options);
  WebConnection busy(server.address());
  busy.send(call_request(kGenerateMesh, framed(valid_request().SerializeAsString())));
  EXPECT_EQ(busy.read_head().status, 200);
  std::deque<WebConnection> silent;
  for (int i = 0; i < 3; ++i) {
    silent.emplace_back(server.address());
    silent.back().send("GET / HT");
  }
  EXPECT_TRUE(silent.front().ends());
  EXPECT_EQ(get(server.address(), "/metrics").status, 200);
  release.set();
  while (busy.read_frame()) {
  }
}

TEST(ConnectionsOfTheConsole, AreSharedByHosts) {
  constexpr int kOfHost = 16;
  ServerOptions options = with_console();
  options.console.connections = 2 * kOfHost;
  options.service.client_share = 0.5;
  ConsoleServer server(empty_mesh(), options);
  std::deque<WebConnection> busy;
  for (int i = 0; i < kOfHost; ++i) {
    busy.emplace_back(server.address());
    busy.back().send(
        call_request(kGenerateMesh, "", {{"Content-Length", "12"}, {"Expect", "100-continue"}}));
    ASSERT_EQ(busy.back().read_head().status, 100);
  }
  EXPECT_TRUE(WebConnection(server.address()).ends());
}

TEST(ConnectionsOfTheConsole, ThatAreTooManyAreClosedIfAllAreBusy) {
  ServerOptions options = with_console();
  options.console.connections = 1;
  Event release;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        EXPECT_TRUE(sink.accept(make_chunk(0)));
        EXPECT_TRUE(release.wait());
        return send_chunks(sink, 0);
      },
      options);
  WebConnection busy(server.address());
  busy.send(call_request(kGenerateMesh, framed(valid_request().SerializeAsString())));
  EXPECT_EQ(busy.read_head().status, 200);
  EXPECT_TRUE(WebConnection(server.address()).ends());
  release.set();
  while (busy.read_frame()) {
  }
}

}  // namespace
}  // namespace weft::server::testing
