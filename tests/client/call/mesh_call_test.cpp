// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_call.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tests/client/support/fake_service.h"
#include "tests/client/support/sample_stream.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

class ClientMeshCall : public ::testing::Test {
 protected:
  Result<MeshReport> call(Script script, const MeshCallOptions& options = {},
                          std::stop_token stop = {}) {
    FakeServer server(std::move(script), address_);
    EXPECT_TRUE(server.listens());
    auto report = call_server(options, std::move(stop));
    return report;
  }
  Result<MeshReport> call_server(const MeshCallOptions& options, std::stop_token stop) {
    const auto connection = connect({.server = address_}, {}).value();
    spool_ = MeshSpool::create(folder_.path()).value();
    return call_generate_mesh(connection, square_domain(4), {}, options, *spool_, std::move(stop));
  }
  static int exit_of(const Result<MeshReport>& report) {
    return report ? 0 : static_cast<int>(report.error().exit);
  }

  TempFolder folder_;
  std::string address_ = "unix:" + (folder_ / "s").string();
  std::unique_ptr<MeshSpool> spool_;
};

TEST_F(ClientMeshCall, BringsTheMeshAndTheReport) {
  std::vector<std::uint64_t> progress;
  const auto report = call(
      {stream_of(square_mesh(4), 3)},
      {.on_progress = [&progress](const v1::Progress& p) { progress.push_back(p.triangles()); }});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->summary.triangles(), 32u);
  EXPECT_EQ(report->accepted.job_id(), "job-1");
  EXPECT_EQ(spool_->triangles(), 32u);
  EXPECT_EQ(progress, std::vector<std::uint64_t>{10});
  EXPECT_GT(report->first_chunk_seconds, 0);
  EXPECT_LE(report->first_chunk_seconds, report->stream_seconds);
  EXPECT_GT(report->bytes_received, 0u);
}

TEST_F(ClientMeshCall, RefusesADamagedStream) {
  Script script{stream_of(square_mesh(4), 3)};
  script.messages[3].mutable_chunk()->set_coordinates(0, 0.5);
  const auto report = call(std::move(script));
  EXPECT_EQ(exit_of(report), 79);
  EXPECT_EQ(report.error().message, "the stream is damaged: chunk 1 does not match its SHA-256");
}

TEST_F(ClientMeshCall, RefusesAStreamThatEndsEarly) {
  Script script{stream_of(square_mesh(4), 3)};
  script.messages.pop_back();
  EXPECT_EQ(exit_of(call(std::move(script))), 79);
}

TEST_F(ClientMeshCall, GivesTheStatusOfARefusal) {
  const auto report = call({{}, [](grpc::ServerContext&) {
                              return grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "no");
                            }});
  EXPECT_EQ(exit_of(report), 67);
}

TEST_F(ClientMeshCall, SaysThatTheServerIsAbsent) {
  const auto report = call_server({.retries = 0}, {});
  EXPECT_EQ(exit_of(report), 78);
  EXPECT_NE(report.error().message.find(address_), std::string::npos);
}

TEST_F(ClientMeshCall, EndsAtItsDeadline) {
  const auto report = call({{},
                            [](grpc::ServerContext& context) {
                              while (!context.IsCancelled()) std::this_thread::yield();
                              return grpc::Status::CANCELLED;
                            }},
                           {.timeout_seconds = 0.1});
  EXPECT_EQ(exit_of(report), 68);
}

TEST_F(ClientMeshCall, EndsWhenAskedToStop) {
  std::stop_source stop;
  const auto report = call({{},
                            [&stop](grpc::ServerContext& context) {
                              stop.request_stop();
                              while (!context.IsCancelled()) std::this_thread::yield();
                              return grpc::Status::CANCELLED;
                            }},
                           {}, stop.get_token());
  EXPECT_EQ(exit_of(report), 65);
}

// A server that goes away in the middle of the mesh.
Script broken_script(std::size_t messages = 4) {  // accepted, progress, two chunks of three
  Script script{stream_of(square_mesh(4), 3)};
  script.messages.resize(messages);
  script.end = [](grpc::ServerContext&) {
    return grpc::Status(grpc::StatusCode::UNAVAILABLE, "gone");
  };
  return script;
}

TEST_F(ClientMeshCall, AsksForTheChunksThatAreMissingAsOftenAsSomeCome) {
  std::vector<std::string> told;
  FakeServer server(
      std::vector{broken_script(), broken_script(5), Script{stream_of(square_mesh(4), 3)}},
      address_);
  const auto report = call_server(
      {.retries = 1, .on_away = [&told](const std::string& what) { told.push_back(what); }}, {});
  ASSERT_TRUE(report) << report.error().message;
  const auto view = spool_->view();
  ASSERT_TRUE(view);
  const Mesh whole = square_mesh(4);
  EXPECT_TRUE(std::ranges::equal(view->triangles, whole.triangles));
  EXPECT_TRUE(std::ranges::equal(view->coordinates, whole.coordinates));
  ASSERT_EQ(server.service().requests().size(), 3u);
  EXPECT_EQ(server.service().requests()[0].first_chunk(), 0u);
  EXPECT_EQ(server.service().requests()[1].first_chunk(), 2u);
  EXPECT_EQ(server.service().requests()[2].first_chunk(), 3u);
  ASSERT_FALSE(told.empty());
  EXPECT_NE(told[0].find("trying again"), std::string::npos) << told[0];
}

TEST_F(ClientMeshCall, GivesUpOnAServerThatBringsNothingNew) {
  FakeServer server(broken_script(2), address_);
  EXPECT_EQ(exit_of(call_server({.retries = 2}, {})), 78);
  EXPECT_EQ(server.service().requests().size(), 3u);
}

TEST_F(ClientMeshCall, WaitsForAServerThatIsBusy) {
  Script busy;
  busy.end = [](grpc::ServerContext&) {
    google::rpc::Status rich;
    google::rpc::RetryInfo info;
    info.mutable_retry_delay()->set_nanos(1'000'000);
    rich.set_code(grpc::StatusCode::RESOURCE_EXHAUSTED);
    rich.set_message("8 wait already");
    rich.add_details()->PackFrom(info);
    return grpc::Status(grpc::StatusCode::RESOURCE_EXHAUSTED, rich.message(),
                        rich.SerializeAsString());
  };
  FakeServer server(std::vector{busy, Script{stream_of(square_mesh(4), 3)}}, address_);
  EXPECT_TRUE(call_server({}, {}));
}

TEST_F(ClientMeshCall, DoesNotGoOnWithAnotherEngine) {
  Script other{stream_of(square_mesh(4), 3)};
  other.messages[0].mutable_accepted()->set_engine_version("2");
  FakeServer server(std::vector{broken_script(), std::move(other)}, address_);
  const auto report = call_server({}, {});
  ASSERT_EQ(exit_of(report), 79);
  EXPECT_EQ(report.error().message,
            "the stream is damaged: it was resumed by engine 2, engine 1 had begun it");
}

TEST(MeshRequest, CarriesTheDomainAndTheWishes) {
  Domain domain = square_domain(2);
  domain.holes = {{1, 1.5}};
  domain.regions = {{{0.5, 0.25}, -3, 0.125}, {{1, 1}, 4, std::nullopt}};
  domain.fill = Domain::Fill::kUnion;
  domain.segments[2].area = 1;
  domain.areas = {{5, 0.5}, {std::nullopt, std::nullopt, true}};
  RequestOptions options{.size = "x + 1"};
  options.asked.mutable_quality()->set_min_angle_deg(0);
  options.asked.mutable_domain()->set_snap(0.25);
  options.asked.mutable_size()->set_gradation(0.5);
  const auto request = make_request(domain, options);
  EXPECT_EQ(request.domain().points_size(), 8);
  EXPECT_EQ(request.domain().points(4), 2);
  EXPECT_EQ(request.domain().segments(7), 0u);
  EXPECT_EQ(request.domain().segment_markers(3), 4);
  EXPECT_EQ(request.domain().holes(1), 1.5);
  EXPECT_EQ(request.domain().regions(0).id(), -3);
  EXPECT_EQ(request.domain().regions(0).max_area(), 0.125);
  EXPECT_FALSE(request.domain().regions(1).has_max_area());
  EXPECT_EQ(request.domain().fill(), v1::FILL_UNION);
  EXPECT_EQ(request.domain().areas(0).region(), 5);
  EXPECT_EQ(request.domain().areas(0).max_area(), 0.5);
  EXPECT_FALSE(request.domain().areas(1).has_region());
  EXPECT_TRUE(request.domain().areas(1).hole());
  EXPECT_EQ(request.domain().segment_areas_size(), 4);
  EXPECT_EQ(request.domain().segment_areas(2), 1u);
  EXPECT_EQ(request.size().expression(), "x + 1");
  EXPECT_EQ(request.size().gradation(), 0.5);
  EXPECT_TRUE(request.quality().has_min_angle_deg());
  EXPECT_EQ(request.domain().snap(), 0.25);
}

TEST(MeshRequest, TakesANumberAsAConstantSizeAndLeavesDefaultsToTheServer) {
  const auto request = make_request(square_domain(1), {.size = "-1e-3"});
  EXPECT_EQ(request.size().constant(), -1e-3);
  EXPECT_FALSE(request.has_quality());
  EXPECT_FALSE(request.has_budget());
  EXPECT_FALSE(make_request(square_domain(1), {}).has_size());
  EXPECT_EQ(make_request(square_domain(1), {.size = "nan"}).size().expression(), "nan");
}

}  // namespace
}  // namespace weft::client
