// SPDX-License-Identifier: Apache-2.0
// GenerateMesh and GetServerInfo as a client sees them.
#include "server/mesh/mesh_service.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "engine/base/context.h"
#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

TEST(GenerateMesh, SendsAcceptedFirstThenTheChunksInOrderThenTheSummary) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 100); });
  const Outcome outcome = call(*server.stub(), valid_request());
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.error_message();
  EXPECT_TRUE(outcome.messages.front().has_accepted());
  EXPECT_TRUE(outcome.messages.back().has_summary());
  EXPECT_EQ(outcome.messages.back().summary().chunks(), 100u);
  std::vector<std::uint32_t> expected(100);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(outcome.chunk_indices(), expected);
}

TEST(GenerateMesh, TellsWhichEngineWorksAndOnHowManyThreads) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 0); });
  const Outcome outcome = call(*server.stub(), valid_request());
  const v1::Accepted& accepted = outcome.messages.front().accepted();
  EXPECT_FALSE(accepted.job_id().empty());
  EXPECT_EQ(accepted.engine_version(), kEngineVersion);
  EXPECT_EQ(accepted.threads(), 1u);
}

TEST(GenerateMesh, CarriesLargeChunksWhole) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) {
    return send_chunks(sink, 40, kMaxChunkBytes);  // more than the hand-over holds
  });
  const Outcome outcome = call(*server.stub(), valid_request());
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.error_message();
  for (const auto& message : outcome.messages) {
    if (!message.has_chunk()) continue;
    const auto& coordinates = message.chunk().coordinates();
    ASSERT_EQ(static_cast<std::size_t>(coordinates.size()), kMaxChunkBytes / sizeof(double));
    EXPECT_TRUE(std::all_of(coordinates.begin(), coordinates.end(),
                            [&](double c) { return c == message.chunk().index(); }));
  }
}

TEST(GenerateMesh, TellsProgressThatNeverGoesBack) {
  Event seen;
  Event seen_after;
  ServiceOptions options;
  options.tick = std::chrono::milliseconds(5);
  TestServer server(
      [&](const auto&, ChunkSink& sink, weft::Run& run) {
        run.context().enter(Stage::kRefine);
        run.context().report_expected(1000);
        run.context().add_triangles(500);
        EXPECT_TRUE(seen.wait());
        run.context().enter(Stage::kTriangulate);  // an engine that errs
        run.context().add_triangles(-490);
        EXPECT_TRUE(seen_after.wait());
        return send_chunks(sink, 50);
      },
      options);
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  v1::Progress last;
  v1::GenerateMeshResponse message;
  bool summary_is_last = false;
  int told_at_500 = 0;
  while (reader->Read(&message)) {
    summary_is_last = message.has_summary();
    if (!message.has_progress()) continue;
    const v1::Progress& now = message.progress();
    EXPECT_GE(now.stage(), last.stage());
    EXPECT_GE(now.triangles(), last.triangles());
    EXPECT_GE(now.elapsed_seconds(), last.elapsed_seconds());
    last = now;
    if (now.stage() != v1::STAGE_REFINE || now.triangles() != 500) continue;
    seen.set();
    if (++told_at_500 == 10) seen_after.set();
  }
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(last.expected_triangles(), 1000u);
  EXPECT_TRUE(summary_is_last);
}

TEST(GenerateMesh, TellsAWaitingJobThatItIsQueued) {
  Event release;
  ServiceOptions options;
  options.tick = std::chrono::milliseconds(5);
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        release.wait();
        return send_chunks(sink, 1);
      },
      options);
  auto stub = server.stub();
  grpc::ClientContext first_context;
  auto first = stub->GenerateMesh(&first_context, valid_request());
  v1::GenerateMeshResponse message;
  do ASSERT_TRUE(first->Read(&message));
  while (!message.has_progress() || message.progress().stage() == v1::STAGE_QUEUED);
  grpc::ClientContext second_context;
  auto second = stub->GenerateMesh(&second_context, valid_request());
  do ASSERT_TRUE(second->Read(&message));
  while (!message.has_progress());
  EXPECT_EQ(message.progress().stage(), v1::STAGE_QUEUED);
  release.set();
  EXPECT_TRUE(read_all(*first).status.ok());
  EXPECT_TRUE(read_all(*second).status.ok());
}

TEST(GenerateMesh, RunsWaitingJobsFirstComeFirstServed) {
  Event release;
  std::mutex mutex;
  std::vector<std::size_t> order;
  TestServer server([&](const MeshRequest& request, ChunkSink& sink, auto&) {
    const bool first = request.pslg.points.size() == 1;
    EXPECT_TRUE(!first || release.wait());
    std::lock_guard lock(mutex);
    order.push_back(request.pslg.points.size());
    return send_chunks(sink, 1);
  });
  auto stub = server.stub();
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<Reader> readers;
  for (int points = 1; points <= 5; ++points) {
    v1::GenerateMeshRequest request;
    for (int i = 0; i < 2 * points; ++i) request.mutable_domain()->add_points(i);
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    readers.push_back(stub->GenerateMesh(contexts.back().get(), request));
    v1::GenerateMeshResponse accepted;
    ASSERT_TRUE(readers.back()->Read(&accepted));  // it waits in the queue now
  }
  release.set();
  for (auto& reader : readers) EXPECT_TRUE(read_all(*reader).status.ok());
  std::lock_guard lock(mutex);
  EXPECT_EQ(order, (std::vector<std::size_t>{1, 2, 3, 4, 5}));
}

TEST(GenerateMesh, RefusesWhatExceedsTheQueueAndSaysWhenToRetry) {
  Event release;
  ServiceOptions options;
  options.queue = 2;
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        release.wait();
        return send_chunks(sink, 1);
      },
      options);
  auto stub = server.stub();
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<Reader> readers;
  for (int i = 0; i < 3; ++i) {  // one at work, two that wait
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    readers.push_back(stub->GenerateMesh(contexts.back().get(), valid_request()));
    v1::GenerateMeshResponse accepted;
    ASSERT_TRUE(readers.back()->Read(&accepted));
  }
  const Outcome refused = call(*stub, valid_request());
  EXPECT_EQ(refused.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(refused.messages.empty());
  const Details details = details_of(refused.status);
  EXPECT_EQ(details.error_info.reason(), "QUEUE_FULL");
  ASSERT_TRUE(details.retry_info);
  EXPECT_GT(details.retry_info->retry_delay().seconds(), 0);
  release.set();
  for (auto& reader : readers) EXPECT_TRUE(read_all(*reader).status.ok());
}

TEST(GenerateMesh, FreesAPlaceInTheQueueWhenAWaitingClientCancels) {
  Event release;
  ServiceOptions options;
  options.queue = 1;
  TestServer server(
      [&](const auto&, ChunkSink& sink, auto&) {
        release.wait();
        return send_chunks(sink, 1);
      },
      options);
  auto stub = server.stub();
  v1::GenerateMeshResponse accepted;
  grpc::ClientContext working_context;
  auto working = stub->GenerateMesh(&working_context, valid_request());
  ASSERT_TRUE(working->Read(&accepted));
  grpc::ClientContext waiting_context;
  auto waiting = stub->GenerateMesh(&waiting_context, valid_request());
  ASSERT_TRUE(waiting->Read(&accepted));
  waiting_context.TryCancel();
  EXPECT_EQ(read_all(*waiting).status.error_code(), grpc::StatusCode::CANCELLED);
  Outcome next;
  do {  // the server learns of the cancellation when it does
    grpc::ClientContext context;
    auto reader = stub->GenerateMesh(&context, valid_request());
    if (reader->Read(&accepted)) {
      release.set();
      next = read_all(*reader);
      break;
    }
    next.status = reader->Finish();
  } while (next.status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_TRUE(next.status.ok());
  EXPECT_TRUE(read_all(*working).status.ok());
}

TEST(GenerateMesh, ReportsAnEngineErrorWithItsReasonFieldAndJob) {
  TestServer server([](const auto&, auto&, auto&) -> Result<Summary> {
    return fail(ErrorCode::kIndexOutOfRange, "domain.segments[17].b", "point 99 of 4");
  });
  const Outcome outcome = call(*server.stub(), valid_request());
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(outcome.status.error_message(), "point 99 of 4");
  const Details details = details_of(outcome.status);
  EXPECT_EQ(details.status.code(), static_cast<int>(grpc::StatusCode::INVALID_ARGUMENT));
  EXPECT_EQ(details.error_info.reason(), "INDEX_OUT_OF_RANGE");
  EXPECT_EQ(details.error_info.domain(), "weft");
  EXPECT_FALSE(details.error_info.metadata().at("job_id").empty());
  ASSERT_TRUE(details.bad_request);
  EXPECT_EQ(details.bad_request->field_violations(0).field(), "domain.segments[17].b");
  EXPECT_FALSE(details.retry_info);
}

TEST(GenerateMesh, DeliversErrorsWhoseMessagesAreTooLongForATrailer) {
  TestServer server([](const auto&, auto&, auto&) -> Result<Summary> {
    std::string long_message = "x";
    for (int i = 0; i < 100'000; ++i) long_message += "\xC3\xA9";  // é, two bytes
    return fail(ErrorCode::kExpressionSyntax, "size.expression", long_message);
  });
  const Outcome outcome = call(*server.stub(), valid_request());
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(details_of(outcome.status).error_info.reason(), "EXPRESSION_SYNTAX");
}

TEST(GenerateMesh, TurnsAnExceptionIntoInternalAndServesTheNextCall) {
  std::atomic<int> calls{0};
  TestServer server([&](const auto&, ChunkSink& sink, auto&) {
    switch (calls++) {
      case 0:
        throw std::runtime_error("boom");
      case 1:
        throw 42;
      case 2:
        throw std::bad_alloc();
      default:
        return send_chunks(sink, 1);
    }
  });
  auto stub = server.stub();
  const Outcome thrown = call(*stub, valid_request());
  EXPECT_EQ(thrown.status.error_code(), grpc::StatusCode::INTERNAL);
  EXPECT_NE(thrown.status.error_message().find("boom"), std::string::npos);
  EXPECT_EQ(call(*stub, valid_request()).status.error_code(), grpc::StatusCode::INTERNAL);
  const Outcome starved = call(*stub, valid_request());
  EXPECT_EQ(starved.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_EQ(details_of(starved.status).error_info.reason(), "OUT_OF_MEMORY");
  EXPECT_TRUE(call(*stub, valid_request()).status.ok());
}

TEST(GenerateMesh, HandsTheWholeRequestToTheEngine) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->add_holes(1.5);
  request.mutable_domain()->add_holes(2.5);
  v1::Region& region = *request.mutable_domain()->add_regions();
  region.set_x(3);
  region.set_y(3.5);
  region.set_id(-7);
  region.set_max_area(0.25);
  request.mutable_domain()->set_fill(v1::FILL_EVEN_ODD);
  request.mutable_size()->set_expression("1 + x");
  request.mutable_quality()->set_min_angle_deg(0);
  request.mutable_quality()->set_min_edge(1e-3);
  request.mutable_quality()->set_placement(v1::PLACEMENT_CIRCUMCENTRE);
  request.mutable_quality()->set_optimise(5);
  request.mutable_domain()->set_snap(0.125);
  request.set_simplify(0.375);
  request.set_allow_unrefined(true);
  request.mutable_budget()->set_max_triangles(1000);
  request.mutable_budget()->set_max_bytes(1 << 20);
  Event called;
  TestServer server([&](const MeshRequest& got, ChunkSink& sink, weft::Run& run) {
    EXPECT_EQ(got.pslg.points, (std::vector<Point>{{0, 0}, {4, 0}, {4, 4}, {0, 4}}));
    EXPECT_EQ(got.pslg.segments.size(), 4u);
    EXPECT_EQ(got.pslg.segments[3].a, 3u);
    EXPECT_EQ(got.pslg.segments[3].b, 0u);
    EXPECT_EQ(got.pslg.segments[3].marker, 4);
    EXPECT_EQ(got.pslg.holes, (std::vector<Point>{{1.5, 2.5}}));
    EXPECT_EQ(got.pslg.regions.at(0).at, (Point{3, 3.5}));
    EXPECT_EQ(got.pslg.regions.at(0).id, -7);
    EXPECT_EQ(got.pslg.regions.at(0).max_area, 0.25);
    EXPECT_EQ(got.pslg.fill, Fill::kEvenOdd);
    EXPECT_EQ(std::get<std::string>(got.size.value), "1 + x");
    EXPECT_EQ(got.min_angle_deg, 0);
    EXPECT_EQ(got.min_edge, 1e-3);
    EXPECT_EQ(got.placement, Placement::kCircumcentre);
    EXPECT_EQ(got.sweeps, 5u);
    EXPECT_EQ(got.pslg.snap, 0.125);
    EXPECT_EQ(got.simplify, 0.375);
    EXPECT_TRUE(got.allow_unrefined);
    EXPECT_EQ(run.context().budget().max_triangles, 1000u);
    EXPECT_EQ(run.context().budget().max_bytes, 1u << 20);
    EXPECT_EQ(run.context().budget().triangle_limit, Limits{}.max_triangles);
    called.set();
    return send_chunks(sink, 1);
  });
  EXPECT_TRUE(call(*server.stub(), request).status.ok());
  EXPECT_TRUE(called.wait());
}

TEST(GetServerInfo, TellsVersionsThreadsAndLimits) {
  ServiceOptions options;
  options.threads = 3;
  options.jobs = 2;
  options.limits.max_points = 123;
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 1); },
                    options);
  grpc::ClientContext context;
  v1::GetServerInfoResponse info;
  ASSERT_TRUE(server.stub()->GetServerInfo(&context, {}, &info).ok());
  EXPECT_FALSE(info.version().empty());
  EXPECT_EQ(info.engine_version(), kEngineVersion);
  EXPECT_EQ(info.threads(), 3u);
  EXPECT_EQ(info.limits().max_points(), 123u);
  EXPECT_EQ(info.limits().max_concurrent_jobs(), 2u);
  EXPECT_EQ(info.limits().max_min_angle_deg(), 36);
  EXPECT_EQ(info.limits().max_expression_bytes(), 65536u);
  EXPECT_EQ(info.limits().max_raster_values(), 16777216u);
  EXPECT_FALSE(info.has_jobs()) << "there is no store";
}

}  // namespace
}  // namespace weft::server::testing
