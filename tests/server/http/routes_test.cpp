// SPDX-License-Identifier: Apache-2.0
// Meshes over HTTP, from a socket to a real engine or one that does what the test says.
#include "server/http/routes.h"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "files/formats/mesh_formats.h"
#include "server/http/exchange_parts.h"
#include "server/http/mesh_wish.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/console/console_server.h"
#include "tests/server/raw_call.h"
#include "weft/weft.h"

namespace weft::server::testing {
namespace {

using Json = nlohmann::json;

constexpr const char* kSquare = "POLYGON ((0 0, 1 0, 1 1, 0 1, 0 0))";
// Meshes of it whose files are larger than what the kernel takes for a client that does not read.
constexpr const char* kLarge = "/v1/mesh?edge=0.004&format=geojson";
constexpr const char* kLargeStream = "/v1/mesh?edge=0.004&format=geojson&stream";
constexpr std::size_t kBytesOfLarge = std::size_t{12} << 20;  // at least

ServerOptions with_http() {
  ServerOptions options{.listen = {"127.0.0.1:0"}, .service = {}};
  options.console.http = "127.0.0.1:0";
  return options;
}

WebResponse send(const ConsoleServer& server, const std::string& method, const std::string& target,
                 const std::string& body = "", const Headers& headers = {}) {
  WebConnection client(server.http_address());
  client.send(request(method, target, headers, body));
  return client.read_response();
}

Json problem_in(const WebResponse& response, int status, const std::string& reason) {
  EXPECT_EQ(response.status, status) << response.body;
  EXPECT_EQ(response.header("content-type"), "application/problem+json");
  const Json problem = Json::parse(response.body, nullptr, false);
  EXPECT_EQ(problem.value("status", 0), status);
  EXPECT_EQ(problem.value("reason", ""), reason) << response.body;
  EXPECT_FALSE(problem.value("detail", "").empty());
  return problem;
}

files::Mesh mesh_in(const WebResponse& response, const std::string& extension) {
  const files::TempFolder folder;
  const auto mesh = files::read_mesh(folder.write("mesh" + extension, response.body));
  EXPECT_TRUE(mesh) << (mesh ? "" : mesh.error().message);
  return mesh.value_or(files::Mesh{});
}

TEST(HttpMesh, ComesOfAFile) {
  ConsoleServer server(stream, with_http());
  EXPECT_TRUE(server.log().contains("event=serving_http"));
  const WebResponse made = send(server, "PUT", "/v1/mesh?edge=0.1&format=msh", kSquare);
  ASSERT_EQ(made.status, 200) << made.body;
  EXPECT_EQ(made.header("content-disposition"), "attachment; filename=\"mesh.msh\"");
  const files::Mesh mesh = mesh_in(made, ".msh");
  EXPECT_EQ(std::to_string(mesh.triangles.size() / 3), made.header("weft-triangles"));
  EXPECT_EQ(std::to_string(mesh.coordinates.size() / 2), made.header("weft-vertices"));
  EXPECT_EQ(made.header("weft-sha256").size(), 64u);
  const WebResponse named =
      send(server, "POST", "/v1/mesh/b%22x.wkt?edge=0.1", kSquare, {{"Accept", "model/stl"}});
  ASSERT_EQ(named.status, 200) << named.body;
  EXPECT_EQ(named.header("content-disposition"), "attachment; filename=\"b_x.stl\"");
  EXPECT_EQ(named.header("content-type"), "model/stl");
}

TEST(HttpMesh, KeepsNamesAndMarkers) {
  ConsoleServer server(stream, with_http());
  const std::string poly =
      "4 2 0 1\n1 0 0 5\n2 1 0 5\n3 1 1 0\n4 0 1 0\n4 1\n1 1 2 2\n2 2 3 3\n3 3 4 3\n4 4 1 3\n0\n";
  const WebResponse made =
      send(server, "PUT",
           "/v1/mesh?from=poly&edge=0.5&edge_at=marker=inlet:0.1&names=marker=2:inlet", poly);
  ASSERT_EQ(made.status, 200) << made.body;
  const files::Mesh mesh = mesh_in(made, ".vtu");
  EXPECT_EQ(mesh.names.markers, (files::NameTable{{2, "inlet"}}));
  EXPECT_GE(std::ranges::count(mesh.edge_markers, 2), 10);
  EXPECT_LE(std::ranges::count(mesh.edge_markers, 3), 20);
}

TEST(HttpMesh, IsInDegreesOfItsDomain) {
  ConsoleServer server(stream, with_http());
  const std::string coast =
      R"({"type":"Polygon","coordinates":[[[-74,40],[-73,40],[-73,41],[-74,41],[-74,40]]]})";
  const WebResponse made = send(server, "PUT", "/v1/mesh?lonlat&edge=20000", coast);
  ASSERT_EQ(made.status, 200) << made.body;
  const files::Mesh mesh = mesh_in(made, ".vtu");
  EXPECT_GT(mesh.triangles.size(), 60u);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2) {
    EXPECT_GE(mesh.coordinates[i], -74.0);
    EXPECT_LE(mesh.coordinates[i], -73.0);
  }
  const WebResponse plane =
      send(server, "PUT", "/v1/mesh?crs=EPSG:32618&to_metres&edge=20000", coast);
  ASSERT_EQ(plane.status, 200) << plane.body;
  EXPECT_GT(mesh_in(plane, ".vtu").coordinates[0], 1000);
  const std::string system =
      R"({"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:OGC:1.3:CRS84"}},)";
  const WebResponse degrees = send(server, "PUT", "/v1/mesh?edge=0.5", system + coast.substr(1));
  ASSERT_EQ(degrees.status, 200);
  EXPECT_TRUE(has(degrees.header("weft-warning"), "longitudes and latitudes"));
  EXPECT_FALSE(has(degrees.header("weft-warning"), "/proc/"));
}

TEST(HttpMesh, SaysWhatItIsNot) {
  ConsoleServer server(stream, with_http());
  const std::string yard =
      "6 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n5 5 5\n6 6 6\n"
      "5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 5 6\n0\n";
  const WebResponse outside = send(server, "PUT", "/v1/mesh?edge=0.5&from=poly", yard);
  EXPECT_EQ(outside.header("weft-warning"),
            "segments outside of what is meshed: 1, the first at (5, 5)");
  const WebResponse more = send(server, "PUT", "/v1/mesh?edge=0.01&max_triangles=1", kSquare);
  EXPECT_TRUE(has(more.header("weft-warning"), "more than max_triangles")) << more.body;
  EXPECT_EQ(send(server, "PUT", "/v1/mesh?edge=0.5", kSquare).header("weft-warning"), "");
  const Json degrees =
      problem_in(send(server, "PUT", "/v1/mesh?crs=EPSG:4326&edge=9", kSquare), 400, "BAD_OPTION");
  EXPECT_EQ(degrees["errors"][0]["field"], "crs");
}

TEST(HttpMesh, SaysWhatIsWrongWithAFileAndWhere) {
  ConsoleServer server(stream, with_http());
  const Json file = problem_in(send(server, "PUT", "/v1/mesh/coast.geojson",
                                    "{\n\"type\":\"Polygon\",\n \"coordinates\": x}"),
                               400, "UNREADABLE_FILE");
  EXPECT_TRUE(has(file["detail"], "coast.geojson:3:")) << file;
  EXPECT_FALSE(has(file["detail"], "/proc/")) << file;
  EXPECT_EQ(file["errors"][0]["line"], 3);
  EXPECT_TRUE(
      server.log().contains("event=http_refused client=ipv4:127.0.0.1 status=400 "
                            "reason=UNREADABLE_FILE"));
  const Json far =
      problem_in(send(server, "PUT", "/v1/mesh?edge=0.1&from=poly",
                      "3 2 0 0\n1 0 0\n2 1 0\n3 0 1\n3 0\n1 1 2\n2 2 3\n3 3 1\n1\n1 9 9\n"),
                 400, "SEED_OUTSIDE_DOMAIN");
  EXPECT_EQ(far["errors"][0]["place"], "domain.poly:10") << far;
  EXPECT_EQ(far["errors"][0]["field"], "domain.holes[0]");
  const Json option =
      problem_in(send(server, "PUT", "/v1/mesh?min-angle=60", kSquare), 400, "BAD_OPTION");
  EXPECT_EQ(option["errors"][0]["field"], "min-angle");
  problem_in(send(server, "PUT", "/v1/mesh", "\x01\x02"), 400, "UNREADABLE_FILE");
  problem_in(send(server, "PUT", "/v1/mesh", ""), 415, "UNKNOWN_FORMAT");
  problem_in(send(server, "PUT", "/v1/mesh/a.gpkg", "SQLite format 3"), 415, "UNKNOWN_FORMAT");
  problem_in(send(server, "PUT", "/v1/mesh", kSquare, {{"Accept", "text/html"}}), 406,
             "UNKNOWN_FORMAT");
  problem_in(send(server, "PUT", "/v1/mesh?order=2&format=stl", kSquare), 400, "BAD_OPTION");
  problem_in(send(server, "PUT", "/v1/mesh?edge=0.01&max_bytes=1", kSquare), 400, "BAD_OPTION");
}

TEST(HttpMesh, MissesNoBoundUnnoticed) {
  ConsoleServer server(
      [](const auto&, auto&, auto&) -> Result<Summary> {
        return tl::unexpected(Error{ErrorCode::kBoundsNotMet, "", "3 triangles miss a bound"});
      },
      with_http());
  problem_in(send(server, "PUT", "/v1/mesh", kSquare), 422, "BOUNDS_NOT_MET");
}

TEST(HttpMesh, IsBoundedByTheLimitOfAMessage) {
  ServerOptions options = with_http();
  options.service.limits.max_request_bytes = 1000;
  ConsoleServer server(stream, options);
  problem_in(send(server, "PUT", "/v1/mesh", std::string(1001, ' ')), 413, "LIMIT_EXCEEDED");
  WebConnection announced(server.http_address());
  announced.send(
      request("PUT", "/v1/mesh", {{"Content-Length", "2000"}, {"Expect", "100-continue"}}));
  EXPECT_EQ(announced.read_response().status, 413);
  WebConnection chunked(server.http_address());
  chunked.send(request("PUT", "/v1/mesh", {{"Transfer-Encoding", "chunked"}}) + "3e9\r\n" +
               std::string(1001, ' '));
  EXPECT_EQ(chunked.read_response().status, 413);
  // A file within the limit may be a larger message.
  std::string line = "LINESTRING (0 0";
  for (int i = 1; i < 150; ++i) line += ",0 " + std::to_string(i % 10);
  problem_in(send(server, "PUT", "/v1/mesh", line + ")"), 413, "LIMIT_EXCEEDED");
}

TEST(HttpMesh, GoesOnAfterItsAnswerOnTheSameConnection) {
  ConsoleServer server(stream, with_http());
  WebConnection client(server.http_address());
  for (int i = 0; i < 3; ++i) {
    client.send(request("PUT", "/v1/mesh?edge=0.5", {{"Expect", "100-continue"}}, kSquare));
    EXPECT_EQ(client.read_head().status, 100);
    EXPECT_EQ(client.read_response().status, 200);
    client.send(request("PUT", "/v1/mesh?edge=-1", {}, kSquare));
    EXPECT_EQ(client.read_response().status, 400);
  }
}

TEST(HttpMesh, EndsWithItsClient) {
  Event working, stopped;
  ConsoleServer server(
      [&](const auto&, auto&, const weft::Run& run) {
        working.set();
        auto end = work_until_stopped(run);
        stopped.set();
        return end;
      },
      with_http());
  {
    WebConnection client(server.http_address());
    client.send(request("PUT", "/v1/mesh", {}, kSquare));
    ASSERT_TRUE(working.wait());
  }
  EXPECT_TRUE(stopped.wait());
  EXPECT_TRUE(eventually([&] { return server.log().contains("reason=CANCELLED"); }));
}

TEST(HttpMesh, EndsAtItsTimeout) {
  ConsoleServer server(
      [](const auto&, auto&, const weft::Run& run) { return work_until_stopped(run); },
      with_http());
  problem_in(send(server, "PUT", "/v1/mesh?timeout=0.05", kSquare), 504, "DEADLINE_EXCEEDED");
}

TEST(HttpMesh, WaitsForItsFileOnlySoLong) {
  ServerOptions options = with_http();
  options.admission.request_timeout = std::chrono::milliseconds(50);
  ConsoleServer server(stream, options);
  WebConnection client(server.http_address());
  client.send(request("PUT", "/v1/mesh", {{"Content-Length", "100"}}) + "POLY");
  problem_in(client.read_response(), 408, "DEADLINE_EXCEEDED");
}

TEST(HttpMesh, IsRefusedIfTheQueueIsFull) {
  Event go;
  std::atomic<int> working{0};
  ServerOptions options = with_http();
  options.service.jobs = 1;
  options.service.light_jobs = 0;
  options.service.queue = 0;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        ++working;
        EXPECT_TRUE(go.wait());
        return send_chunks(sink, 0);
      },
      options);
  WebConnection first(server.http_address());
  first.send(request("PUT", "/v1/mesh?no-cache", {}, kSquare));
  ASSERT_TRUE(eventually([&] { return working == 1; }));
  const WebResponse full = send(server, "PUT", "/v1/mesh?no-cache", kSquare);
  problem_in(full, 429, "QUEUE_FULL");
  EXPECT_EQ(full.header("retry-after"), "1");
  go.set();
  EXPECT_EQ(first.read_response().status, 200);
}

TEST(HttpMesh, OutlivesTheStartOfADrain) {
  Event working, go;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        working.set();
        EXPECT_TRUE(go.wait());
        return send_chunks(sink, 0);
      },
      with_http());
  WebConnection client(server.http_address());
  client.send(request("PUT", "/v1/mesh", {}, kSquare));
  WebConnection late(server.http_address());
  late.send(request("PUT", "/v1/mesh", {{"Content-Length", "100"}}));
  ASSERT_TRUE(working.wait());
  std::jthread drain([&] { server->drain(kPatience); });
  EXPECT_TRUE(eventually([&] {
    return raw_unary(server.channel(), "/grpc.health.v1.Health/Check", "").second == "\x08\x02";
  }));
  late.send(std::string(kSquare) + std::string(100 - std::string(kSquare).size(), ' '));
  problem_in(late.read_response(), 503, "STOPPING");
  go.set();
  EXPECT_EQ(client.read_response().status, 200);
}

TEST(HttpMesh, IsReadToItsEndWhileTheServerDrains) {
  ConsoleServer server(
      [](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 40, kMaxChunkBytes); },
      with_http());
  WebConnection client(server.http_address(), nullptr, 64 << 10);
  client.send(request("PUT", "/v1/mesh", {}, kSquare));
  const WebResponse head = client.read_head();
  ASSERT_EQ(head.status, 200);
  std::jthread drain([&] { server->drain(kPatience); });
  std::this_thread::sleep_for(std::chrono::milliseconds(400));  // more than others are given
  const std::string rest = client.read_body(std::stoul(head.header("content-length")));
  EXPECT_GT(rest.size(), 40u << 19);
}

// A part of a form.
std::string part(const std::string& disposition, const std::string& body,
                 const std::string& header = "") {
  return "--x\r\nContent-Disposition: form-data; " + disposition + "\r\n" + header + "\r\n" + body +
         "\r\n";
}

TEST(HttpForms, AreOneDomainWithHarmlessTexts) {
  ConsoleServer server(stream, with_http());
  const auto answer = [&](const std::string& parts, const std::string& path = "/v1/lint") {
    return send(server, "POST", path, parts + "--x--",
                {{"Content-Type", "multipart/form-data; boundary=x"}});
  };
  const std::string corners =
      part("name=domain; filename=\"../a b\"", "0,0\n1,0\n0,1\n", "Content-Type: text/csv\r\n");
  const WebResponse found = answer(corners);
  ASSERT_EQ(found.status, 200) << found.body;
  EXPECT_EQ(Json::parse(found.body)["file"], "a_b");
  EXPECT_EQ(answer(corners + part("name=snap", "0.01")).status, 200);
  problem_in(answer(corners + corners), 400, "MALFORMED_REQUEST");
  problem_in(answer(part("name=snap", "0.01")), 400, "MALFORMED_REQUEST");
  problem_in(answer(corners + part("name=snap", "0.01\x01")), 400, "MALFORMED_REQUEST");
  problem_in(answer(corners + part("name=\xff; filename=b.asc", "")), 400, "MALFORMED_REQUEST");
  const std::string grid = part("name=h; filename=\"/tmp/h h.asc\"", "x");
  const Json bad = problem_in(answer(corners + grid, "/v1/mesh"), 400, "UNREADABLE_FILE");
  EXPECT_EQ(bad["detail"].get<std::string>().substr(0, 8), "h_h.asc:") << bad;
  const std::string other =
      part("name=domain; filename=d", "0,0\n1,0\n0,1\n", "Content-Type: application/geo+json\r\n");
  problem_in(answer(other), 400, "UNREADABLE_FILE");  // as its type says
}

TEST(HttpStream, HasTheBytesOfTheFileThatIsMadeAtOnce) {
  ConsoleServer server(stream, with_http());
  const std::string coast =
      R"({"type":"Polygon","coordinates":[[[-74,40],[-73,40],[-73,41],[-74,41],[-74,40]]]})";
  const std::string target =
      "/v1/mesh?lonlat&edge=2000&names=region=1:sea&format=geojson&max_triangles=1000000";
  const WebResponse whole = send(server, "PUT", target, coast);
  const WebResponse streamed = send(server, "PUT", target + "&stream", coast);
  ASSERT_EQ(streamed.status, 200) << streamed.body;
  EXPECT_EQ(streamed.body, whole.body);
  EXPECT_EQ(streamed.header("content-length"), "");
  EXPECT_EQ(streamed.header("content-type"), whole.header("content-type"));
  ASSERT_EQ(streamed.trailers.size(), 3u);
  for (const auto& [name, text] : streamed.trailers) EXPECT_EQ(text, whole.header(name)) << name;
  EXPECT_FALSE(streamed.header("content-disposition").empty());
  problem_in(send(server, "PUT", "/v1/mesh?format=vtu&stream", kSquare), 400, "BAD_OPTION");
}

const std::string kFirstChunk = "28\r\n{\"type\":\"FeatureCollection\",\"features\":[\r\n";

TEST(HttpStream, BeginsBeforeTheMeshIsMade) {
  Event seen;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        auto summary = send_chunks(sink, 1);
        EXPECT_TRUE(seen.wait());
        return summary;
      },
      with_http());
  WebConnection client(server.http_address());
  const std::string asked = request("PUT", "/v1/mesh?format=geojson&stream", {}, kSquare);
  client.send(asked);
  ASSERT_EQ(client.read_head().status, 200);
  EXPECT_EQ(client.read_body(kFirstChunk.size()), kFirstChunk);
  seen.set();
}

TEST(HttpStream, GoesOnAfterItsAnswerOnTheSameConnection) {
  ConsoleServer server(stream, with_http());
  WebConnection client(server.http_address());
  for (int i = 0; i < 3; ++i) {
    client.send(request("PUT", "/v1/mesh?edge=0.5&format=geojson&stream", {}, kSquare));
    EXPECT_TRUE(Json::accept(client.read_response().body));
  }
}

TEST(HttpStream, BreaksOffIfTheMeshFails) {
  Event seen;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, auto&) -> Result<Summary> {
        if (auto sent = send_chunks(sink, 1); !sent) return sent;
        EXPECT_TRUE(seen.wait());
        return tl::unexpected(Error{ErrorCode::kBoundsNotMet, "", "3 triangles miss a bound"});
      },
      with_http());
  WebConnection client(server.http_address());
  client.send(request("PUT", "/v1/mesh?format=geojson&stream", {}, kSquare));
  ASSERT_EQ(client.read_head().status, 200);
  EXPECT_EQ(client.read_body(kFirstChunk.size()), kFirstChunk);
  seen.set();
  EXPECT_TRUE(client.ends());  // without the last chunk
}

TEST(HttpStream, IsAProblemIfTheMeshFailsBeforeItsFirstByte) {
  ConsoleServer server(
      [](const auto&, auto&, auto&) -> Result<Summary> {
        return tl::unexpected(Error{ErrorCode::kBoundsNotMet, "", "3 triangles miss a bound"});
      },
      with_http());
  problem_in(send(server, "PUT", "/v1/mesh?format=geojson&stream", kSquare), 422, "BOUNDS_NOT_MET");
}

TEST(HttpStream, EndsWithItsClient) {
  Event stopped;
  ConsoleServer server(
      [&](const auto&, ChunkSink& sink, const weft::Run& run) -> Result<Summary> {
        if (auto sent = send_chunks(sink, 1); !sent) return sent;
        auto end = work_until_stopped(run);
        stopped.set();
        return end;
      },
      with_http());
  {
    WebConnection client(server.http_address());
    client.send(request("PUT", "/v1/mesh?format=geojson&stream", {}, kSquare));
    ASSERT_EQ(client.read_head().status, 200);
  }
  EXPECT_TRUE(stopped.wait());
}

TEST(HttpMeshes, AreSharedByClients) {
  Workers workers(2);
  const auto meshes = std::make_shared<Meshes>(4, 0, 0.75, workers);
  std::vector<std::shared_ptr<Meshes::Place>> places;
  for (int i = 0; i < 3; ++i) places.push_back(meshes->enter("ann"));
  EXPECT_EQ(meshes->enter("ann"), nullptr);
  places.push_back(meshes->enter("bob"));
  ASSERT_NE(places.back(), nullptr);
  EXPECT_EQ(meshes->enter("cid"), nullptr);
  places.erase(places.begin());
  EXPECT_NE(meshes->enter("ann"), nullptr);
  // One of two threads is left to others, whatever ann's work is.
  EXPECT_EQ(places[0]->for_work(true), places[0]->for_work(true));
  EXPECT_NE(places[0]->for_work(true), places.back()->for_work(true));
  workers.finish();
  meshes->close();
}

TEST(HttpMeshes, AreOnTheirWayUntilTheyAreSent) {
  ServerOptions options = with_http();
  options.console.meshes = 1;
  ConsoleServer server(stream, options);
  {
    WebConnection slow(server.http_address(), nullptr, 1 << 16);
    slow.send(request("PUT", kLarge, {}, kSquare));
    ASSERT_EQ(slow.read_head().status, 200);
    problem_in(send(server, "PUT", "/v1/mesh", kSquare), 429, "QUEUE_FULL");
  }
  EXPECT_TRUE(eventually([&] { return send(server, "PUT", "/v1/mesh", kSquare).status == 200; }));
}

TEST(HttpMeshes, AreSentToWhoReads) {
  ServerOptions options = with_http();
  options.service.patience = {.stall_timeout = std::chrono::seconds(1),
                              .least_rate = 1'000'000'000};
  ConsoleServer server(stream, options);
  for (const char* target : {kLarge, kLargeStream}) {
    WebConnection slow(server.http_address(), nullptr, 1 << 16);
    slow.send(request("PUT", target, {}, kSquare));
    ASSERT_EQ(slow.read_head().status, 200);
    // Some bytes at a time, which are read to the end if nobody looks at the time.
    EXPECT_ANY_THROW(for (std::size_t read = 0; read < kBytesOfLarge; read += 1 << 14) {
      slow.read_body(1 << 14);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }) << target;
  }
}

TEST(HttpMeshes, HaveSoMuchRoomForTheirFiles) {
  ServerOptions options = with_http();
  options.console.file_bytes = 100'000;
  ConsoleServer server(stream, options);
  problem_in(send(server, "PUT", "/v1/mesh?edge=0.01", kSquare), 507, "STORE_FULL");
  // The arrays have room, but not with the file.
  problem_in(send(server, "PUT", "/v1/mesh?edge=0.05&format=geojson", kSquare), 507, "STORE_FULL");
  EXPECT_EQ(send(server, "PUT", "/v1/mesh?edge=0.2", kSquare).status, 200);
  WebConnection client(server.http_address());
  client.send(request("PUT", "/v1/mesh?edge=0.005&format=geojson&stream", {}, kSquare));
  EXPECT_ANY_THROW(client.read_response()) << "the file breaks off";
}

class HttpJobs : public ::testing::Test {
 protected:
  HttpJobs()
      : server_(stream, with_http(), SqliteStore::open({.folder = folder_.path()}).value()) {}

  const files::TempFolder folder_;
  ConsoleServer server_;
};

TEST_F(HttpJobs, AreMadeSeenReadAndDeleted) {
  const WebResponse made =
      send(server_, "POST", "/v1/jobs?edge=0.1&request_id=mine&from=poly&names=marker=2:inlet",
           "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 1\n1 1 2 2\n2 2 3 3\n3 3 4 3\n4 4 1 3\n0\n");
  ASSERT_EQ(made.status, 201) << made.body;
  const std::string path = made.header("location");
  EXPECT_EQ(path, "/v1/jobs/" + Json::parse(made.body)["job"]["id"].get<std::string>());
  EXPECT_TRUE(eventually([&] {
    return Json::parse(send(server_, "GET", path).body)["job"]["state"] == "JOB_STATE_SUCCEEDED";
  }));
  EXPECT_EQ(Json::parse(send(server_, "GET", "/v1/jobs").body)["jobs"][0]["request_id"], "mine");
  const WebResponse fetched = send(server_, "GET", path + "/mesh?format=msh");
  ASSERT_EQ(fetched.status, 200) << fetched.body;
  const files::Mesh mesh = mesh_in(fetched, ".msh");
  EXPECT_EQ(std::to_string(mesh.triangles.size() / 3), fetched.header("weft-triangles"));
  EXPECT_EQ(mesh.names.markers, (files::NameTable{{2, "inlet"}}));
  problem_in(send(server_, "GET", path + "/mesh?format=14&open_boundary=outlet"), 400,
             "BAD_OPTION");
  EXPECT_EQ(send(server_, "GET", path + "/mesh?format=14&open_boundary=inlet").status, 200);
  EXPECT_EQ(send(server_, "DELETE", path).status, 200);
  problem_in(send(server_, "GET", path), 404, "NO_SUCH_JOB");
  problem_in(send(server_, "GET", path + "/mesh"), 404, "NO_SUCH_JOB");
}

TEST_F(HttpJobs, HaveATagForEachMeshAndEachWayToWriteIt) {
  const auto made = [&](const std::string& edge) {
    const std::string path =
        send(server_, "POST", "/v1/jobs?edge=" + edge, kSquare).header("location");
    EXPECT_TRUE(
        eventually([&] { return send(server_, "GET", path + "/mesh?format=stl").status == 200; }));
    return path + "/mesh";
  };
  const std::string mesh = made("0.1");
  const WebResponse first = send(server_, "GET", mesh);
  std::set<std::string> tags{first.header("etag")};
  for (const std::string& other : {mesh + "?order=2", mesh + "?order=1", made("0.2")})
    tags.insert(send(server_, "GET", other).header("etag"));
  tags.insert(send(server_, "GET", mesh, "", {{"Accept", "model/stl"}}).header("etag"));
  EXPECT_EQ(tags.size(), 5u);
  EXPECT_EQ(send(server_, "GET", mesh).header("etag"), first.header("etag"));
  const Headers all{{"Range", "bytes=0-"}};
  EXPECT_EQ(send(server_, "GET", mesh, "", all).status, 200);
  const WebResponse rest = send(server_, "GET", mesh, "", {{"Range", "bytes=7-"}});
  EXPECT_EQ(rest.status, 206);
  EXPECT_EQ(rest.body, first.body.substr(7));
}

TEST_F(HttpJobs, SayWhatIsWrong) {
  problem_in(send(server_, "GET", "/v1/jobs/1"), 400, "BAD_OPTION");
  const Json option =
      problem_in(send(server_, "POST", "/v1/jobs?edge=-1", kSquare), 400, "BAD_SIZE_VALUE");
  EXPECT_EQ(option["errors"][0]["field"], "edge");
  for (const char* useless : {"format=vtu", "order=2", "timeout=5"})
    problem_in(send(server_, "POST", "/v1/jobs?" + std::string(useless), kSquare), 400,
               "BAD_OPTION");
  problem_in(send(server_, "POST", "/v1/jobs?lonlat&edge=9000", kSquare), 400, "BAD_OPTION");
  problem_in(send(server_, "GET", "/v1/jobs/1/mesh?edge=1"), 400, "BAD_OPTION");
  ConsoleServer without(stream, with_http());
  const Json none = problem_in(send(without, "POST", "/v1/jobs", kSquare), 501, "UNIMPLEMENTED");
  EXPECT_TRUE(has(none["detail"], "--store")) << none;
}

TEST(HttpLint, FindsFaults) {
  ConsoleServer server(stream, with_http());
  const std::string yard =
      "5 2 0 0\n1 0 0\n2 40 0\n3 40 40\n4 0 40\n5 0 0.01\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 5\n0\n";
  const WebResponse found = send(server, "POST", "/v1/lint?from=poly", yard);
  ASSERT_EQ(found.status, 200) << found.body;
  const Json lint = Json::parse(found.body);
  EXPECT_EQ(lint["file"], "domain.poly");
  EXPECT_EQ(lint["counts"]["gap"], 1) << lint;
  EXPECT_EQ(lint["findings"][0]["at"].size(), 2u);
  EXPECT_EQ(lint["findings"][0]["remedy"], "snap=0.011 closes it");
  EXPECT_FALSE(has(found.body, "/proc/"));
  EXPECT_EQ(Json::parse(send(server, "POST", "/v1/lint?from=poly&snap=0.02", yard).body)["faults"],
            0);
  problem_in(send(server, "POST", "/v1/lint?from=poly", "x"), 400, "UNREADABLE_FILE");
}

v1::Domain domain_in(const Json& answer) {
  const auto bytes = from_base64(answer.value("domain", ""));
  EXPECT_TRUE(bytes) << answer;
  v1::Domain domain;
  EXPECT_TRUE(domain.ParseFromString(bytes.value_or("x")));
  return domain;
}

TEST(HttpDomain, ComesWithItsFaults) {
  ConsoleServer server(stream, with_http());
  const std::string yard =
      "5 2 0 0\n1 0 0\n2 40 0\n3 40 40\n4 0 40\n5 0 0.01\n4 1\n1 1 2 3\n2 2 3 0\n3 3 4 0\n"
      "4 4 5 0\n0\n";
  const WebResponse found = send(server, "POST", "/v1/domain/my%20yard.poly", yard);
  ASSERT_EQ(found.status, 200) << found.body;
  EXPECT_EQ(found.header("content-type"), "application/json");
  EXPECT_FALSE(has(found.body, "/proc/"));
  const Json answer = Json::parse(found.body);
  EXPECT_EQ(answer["file"], "my_yard.poly");
  EXPECT_EQ(answer["counts"]["gap"], 1) << answer;
  const v1::Domain domain = domain_in(answer);
  EXPECT_EQ(domain.points_size(), 10);
  EXPECT_EQ(domain.segment_markers(0), 3);
  EXPECT_EQ(domain.fill(), v1::FILL_SEEDS);
  const Json ring = Json::parse(send(server, "POST", "/v1/domain?names=region=1:sea",
                                     R"({"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1]]]})")
                                    .body);
  ASSERT_EQ(ring["findings"].size(), 1u) << ring;
  EXPECT_EQ(ring["findings"][0]["kind"], "warning") << ring;
  EXPECT_EQ(ring["findings"][0]["warning"], "open-ring");
  EXPECT_EQ(domain_in(ring).region_names(0).name(), "sea");
  const Json bad =
      problem_in(send(server, "POST", "/v1/domain/b.poly", "3 2 0 0\n1 0 0\n2 1 zero\n3 0 1\n"),
                 400, "UNREADABLE_FILE");
  EXPECT_EQ(bad["errors"][0]["place"], "b.poly:3:5") << bad;
  problem_in(send(server, "POST", "/v1/domain/a.png", "\x89PNG"), 400, "UNREADABLE_FILE");
}

TEST(HttpDomain, IsAnAnswerOfAnySize) {
  ConsoleServer server(stream, with_http());
  std::string line = "LINESTRING (0 0";  // several blocks of base64, and the last has padding
  for (int i = 1; i < 10000; ++i) line += "," + std::to_string(i) + " " + std::to_string(i % 7);
  const v1::Domain domain =
      domain_in(Json::parse(send(server, "POST", "/v1/domain", line + ")").body));
  ASSERT_EQ(domain.points_size(), 20000);
  EXPECT_EQ(domain.points(19999), 9999 % 7);
  ServerOptions options = with_http();
  options.service.limits.max_request_bytes = line.size() + 1;
  ConsoleServer small(stream, options);
  problem_in(send(small, "POST", "/v1/domain", line + ")"), 413, "LIMIT_EXCEEDED");
}

TEST(HttpDomain, IsInThePlane) {
  ConsoleServer server(stream, with_http());
  const std::string coast =
      R"({"type":"Polygon","coordinates":[[[-74,40],[-73,40],[-73,41],[-74,41],[-74,40]]]})";
  const Json degrees = Json::parse(send(server, "POST", "/v1/domain", coast).body);
  EXPECT_EQ(domain_in(degrees).points(0), -74);
  problem_in(send(server, "POST", "/v1/domain?lonlat", coast), 400, "BAD_OPTION");
  const WebResponse found = send(server, "POST", "/v1/domain?crs=EPSG:3857&to_metres", coast);
  ASSERT_EQ(found.status, 200) << found.body;
  const Json metres = Json::parse(found.body);
  EXPECT_NEAR(domain_in(metres).points(0), -8237642, 1);
  ASSERT_EQ(metres["findings"].size(), 2u) << metres;
  EXPECT_EQ(metres["findings"][0]["warning"], "coordinates");  // lengths are stretched
  EXPECT_EQ(metres["counts"]["warning"], metres["faults"]);
}

std::string request_of_square() {
  v1::GenerateMeshRequest request;
  for (const double value : {0, 0, 1, 0, 1, 1, 0, 1}) request.mutable_domain()->add_points(value);
  for (const unsigned end : {0, 1, 1, 2, 2, 3, 3, 0}) request.mutable_domain()->add_segments(end);
  for (const int marker : {2, 0, 0, 0}) request.mutable_domain()->add_segment_markers(marker);
  v1::Name& name = *request.mutable_domain()->add_marker_names();
  name.set_id(2);
  name.set_name("inlet");
  request.mutable_size()->set_constant(0.01);
  return request.SerializeAsString();
}

TEST(HttpMesh, ComesOfARequestOfTheProtocol) {
  ConsoleServer server(stream, with_http());
  const Headers type = {{"Content-Type", "application/x-protobuf"}};
  const WebResponse made =
      send(server, "POST", "/v1/mesh/square.bin?format=msh", request_of_square(), type);
  ASSERT_EQ(made.status, 200) << made.body;
  const files::Mesh mesh = mesh_in(made, ".msh");
  EXPECT_EQ(std::to_string(mesh.triangles.size() / 3), made.header("weft-triangles"));
  EXPECT_EQ(mesh.names.markers, (files::NameTable{{2, "inlet"}}));
  EXPECT_EQ(
      send(server, "POST", "/v1/mesh?format=14&open_boundary=inlet", request_of_square(), type)
          .status,
      200);
  problem_in(
      send(server, "POST", "/v1/mesh?format=14&open_boundary=outlet", request_of_square(), type),
      400, "BAD_OPTION");
  problem_in(send(server, "POST", "/v1/mesh?edge=1", request_of_square(), type), 400, "BAD_OPTION");
  problem_in(send(server, "POST", "/v1/mesh", "\x0a\x63", type), 400, "MALFORMED_REQUEST");
  v1::GenerateMeshRequest samples;
  samples.add_sample_points(1);
  problem_in(
      send(server, "POST", "/v1/mesh", request_of_square() + samples.SerializeAsString(), type),
      400, "BAD_OPTION");
  v1::GenerateMeshRequest bad;
  bad.ParseFromString(request_of_square());
  bad.mutable_size()->set_constant(-1);
  const Json problem = problem_in(send(server, "POST", "/v1/mesh", bad.SerializeAsString(), type),
                                  400, "BAD_SIZE_VALUE");
  EXPECT_EQ(problem["errors"][0]["field"], "size.constant") << problem;
}

TEST(HttpTokens, AreAskedForBeforeAFileIsRead) {
  const files::TempFolder folder;
  ServerOptions options = with_http();
  options.tokens = folder.write("tokens", "ann secret-of-ann-16\n").string();
  ConsoleServer server(stream, options);
  WebConnection unknown(server.http_address());
  unknown.send(request("PUT", "/v1/mesh", {{"Content-Length", "200000000"}}));
  const WebResponse refused = unknown.read_response();
  problem_in(refused, 401, "UNAUTHENTICATED");
  EXPECT_EQ(refused.header("www-authenticate"), "Bearer");
  EXPECT_EQ(send(server, "GET", "/v1/info").status, 401);
  const Headers token = {{"Authorization", "Bearer secret-of-ann-16"}};
  EXPECT_EQ(send(server, "PUT", "/v1/mesh?edge=0.5", kSquare, token).status, 200);
  EXPECT_TRUE(eventually([&] { return server.log().contains("client=ann "); }));
}

TEST(HttpRoutes, AreOneTable) {
  ConsoleServer server(stream, with_http());
  problem_in(send(server, "GET", "/v2"), 404, "NOT_FOUND");
  problem_in(send(server, "PUT", "/v1/mesh/a/b", kSquare), 404, "NOT_FOUND");
  problem_in(send(server, "GET", "/%zz"), 400, "MALFORMED_REQUEST");
  const WebResponse wrong = send(server, "DELETE", "/v1/mesh");
  problem_in(wrong, 405, "METHOD_NOT_ALLOWED");
  EXPECT_EQ(wrong.header("allow"), "PUT, POST");
  EXPECT_EQ(send(server, "PUT", "/v1/mesh", kSquare, {{"Origin", "https://evil.example"}}).status,
            403);
  EXPECT_EQ(send(server, "GET", "/v1/info", "", {{"Host", "evil.example"}}).status, 421);
  const Json info = Json::parse(send(server, "GET", "/v1/info").body);
  EXPECT_FALSE(info["engine_version"].get<std::string>().empty());
}

TEST(HttpRoutes, AreDescribed) {
  ConsoleServer server(stream, with_http());
  const WebResponse described = send(server, "GET", "/");
  EXPECT_EQ(described.header("content-type"), "application/json");
  EXPECT_EQ(described.body, send(server, "GET", "/v1/openapi.json").body);
  const Json all = Json::parse(described.body);
  EXPECT_EQ(all["openapi"], "3.1.0");
  const Json& put = all["paths"]["/v1/mesh"]["put"];
  const auto names = [](const Json& operation) {
    std::set<std::string> all_names;
    for (const Json& parameter : operation["parameters"])
      all_names.insert(parameter["name"].get<std::string>());
    return all_names;
  };
  std::set<std::string> known;
  for (const Parameter& parameter : mesh_parameters())
    if (parameter.use != ParameterUse::kJob) known.insert(parameter.name);
  EXPECT_EQ(names(put), known);
  EXPECT_EQ(
      names(all["paths"]["/v1/jobs/{id}/mesh"]["get"]),
      (std::set<std::string>{"id", "format", "order", "msh_version", "open_boundary", "timeout"}));
  EXPECT_TRUE(put.contains("requestBody"));
  EXPECT_TRUE(all["paths"]["/v1/jobs/{id}"].contains("delete"));
}

TEST(HttpDoor, MayBeThatOfTheConsole) {
  ServerOptions options = with_http();
  options.console.address = options.console.http;
  ConsoleServer server(stream, options);
  EXPECT_EQ(server.address(), server.http_address());
  EXPECT_EQ(send(server, "PUT", "/v1/mesh?edge=0.5", kSquare).status, 200);
  EXPECT_TRUE(has(send(server, "GET", "/").header("content-type"), "text/"));
  EXPECT_TRUE(web_call(server.address(), kServerInfo, "").status().ok());
}

TEST(HttpDoor, LeadsToNoCallsAndNoPages) {
  ServerOptions options = with_http();
  options.console.address = "127.0.0.1:0";
  options.console.http = "localhost:0";
  ConsoleServer server(stream, options);
  EXPECT_NE(server.address(), server.http_address());
  problem_in(send(server, "GET", "/metrics"), 404, "NOT_FOUND");
  problem_in(send(server, "POST", kServerInfo, framed("")), 404, "NOT_FOUND");
}

TEST(HttpDoor, IsThatOfTheConsoleInAnyCase) {
  ConsoleServer server(stream);
  WebConnection client(server.address());
  client.send(request("POST", "/v1/domain", {}, kSquare));
  EXPECT_EQ(client.read_response().status, 200);
  client.send(request("POST", "/v1/domain", {{"Origin", "https://evil.example"}}, kSquare));
  EXPECT_EQ(client.read_response().status, 403);
}

TEST(HttpDoor, IsNotOpenedForOthersUnencrypted) {
  ServerOptions options = with_http();
  options.console.http = "0.0.0.0:0";
  const auto server = Server::start(options, stream, Log().logger());
  ASSERT_FALSE(server);
  EXPECT_TRUE(has(server.error(), "cannot serve HTTP on 0.0.0.0:0")) << server.error();
}

}  // namespace
}  // namespace weft::server::testing
