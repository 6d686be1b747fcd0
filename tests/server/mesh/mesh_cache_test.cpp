// SPDX-License-Identifier: Apache-2.0
// The same request again, with a scripted engine.
#include "server/mesh/mesh_cache.h"

#include <atomic>

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

std::shared_ptr<const FinishedMesh> mesh_of(std::uint64_t bytes, std::uint64_t largest = kMiB) {
  MeshRecording recording(largest);
  const grpc::Slice slice(std::string(bytes, 'x'));
  recording.add(grpc::ByteBuffer(&slice, 1));
  return std::move(recording).finish({});
}

TEST(MeshCache, FindsWhatWasKeptAndNothingElse) {
  MeshCache cache(kMiB);
  cache.keep("a", mesh_of(100));
  ASSERT_TRUE(cache.find("a"));
  EXPECT_EQ(cache.find("a")->chunks.size(), 1u);
  EXPECT_FALSE(cache.find("b"));
}

TEST(MeshCache, DropsTheMeshThatWasAskedForLongestAgo) {
  MeshCache cache(kMiB);
  for (const char* key : {"a", "b", "c"}) cache.keep(key, mesh_of(kMiB / 4));
  EXPECT_TRUE(cache.find("a"));
  cache.keep("d", mesh_of(kMiB / 4));
  EXPECT_FALSE(cache.find("b"));
  for (const char* key : {"a", "c", "d"}) EXPECT_TRUE(cache.find(key)) << key;
}

TEST(MeshCache, CountsWhatASummaryHolds) {
  Summary summary;
  summary.sampled_bounds.resize(1000);
  summary.leaves.resize(1000);
  const auto mesh = MeshRecording(kMiB).finish(summary);
  ASSERT_TRUE(mesh);
  EXPECT_GE(mesh->bytes, 1000 * (sizeof(double) + sizeof(Box)));
}

TEST(MeshCache, NeverHoldsMoreThanItsCapacity) {
  MeshCache cache(kMiB);
  for (int i = 0; i < 100; ++i) {
    cache.keep(std::to_string(i), mesh_of(10'000 + static_cast<std::uint64_t>(i) * 2'000));
    EXPECT_LE(cache.bytes(), kMiB);
  }
  EXPECT_GT(cache.bytes(), kMiB / 2);
}

TEST(MeshCache, KeepsWhatIsReadAndNothingForWhichThereIsNoRoomBesides) {
  MeshCache cache(kMiB);
  for (const char* key : {"a", "b", "c"}) cache.keep(key, mesh_of(kMiB / 4));
  auto reader_of_a = cache.find("a");
  auto reader_of_b = cache.find("b");
  auto reader_of_c = cache.find("c");
  cache.keep("large", mesh_of(kMiB * 3 / 8));
  EXPECT_FALSE(cache.find("large"));
  for (const char* key : {"a", "b", "c"}) EXPECT_TRUE(cache.find(key)) << key;
  reader_of_b.reset();
  cache.keep("large", mesh_of(kMiB * 3 / 8));
  EXPECT_TRUE(cache.find("large"));
  EXPECT_TRUE(cache.find("a"));
  EXPECT_FALSE(cache.find("b"));
}

TEST(MeshCache, CountsAMeshThatIsKeptTwiceOnce) {
  MeshCache cache(kMiB);
  cache.keep("a", mesh_of(100));
  const std::uint64_t bytes = cache.bytes();
  cache.keep("a", mesh_of(100));
  EXPECT_EQ(cache.bytes(), bytes);
}

TEST(MeshRecording, GivesUpOnAMeshThatIsTooLarge) {
  EXPECT_FALSE(mesh_of(1000, 999));
  EXPECT_TRUE(mesh_of(1000, 4000));
}

// A server that counts how often its engine works; its meshes have twenty chunks.
class CachingServer {
 public:
  explicit CachingServer(std::uint64_t bytes = 64 * kMiB) : server_(engine(), options(bytes)) {}

  Outcome ask(const v1::GenerateMeshRequest& request) { return call(*stub_, request); }
  int runs() const { return runs_; }

 private:
  static ServiceOptions options(std::uint64_t bytes) {
    ServiceOptions options;
    options.cache_bytes = bytes;
    return options;
  }
  EngineFn engine() {
    return [this](const MeshRequest&, ChunkSink& sink, weft::Run&) -> Result<Summary> {
      if (++runs_ == failing_) return fail(ErrorCode::kInternal, "", "broken");
      auto summary = send_chunks(sink, 20);
      if (summary) summary->leaves.resize(3);
      return summary;
    };
  }

  std::atomic<int> runs_{0};
  TestServer server_;
  std::unique_ptr<Stub> stub_ = server_.stub();

 public:
  int failing_ = 0;  // this run of the engine
};

std::vector<std::string> chunks_of(const Outcome& outcome) {
  std::vector<std::string> chunks;
  for (const auto& message : outcome.messages)
    if (message.has_chunk()) chunks.push_back(message.SerializeAsString());
  return chunks;
}

TEST(GenerateMeshAgain, SendsTheSameBytesWithoutTheEngine) {
  CachingServer server;
  const Outcome made = server.ask(valid_request());
  const Outcome again = server.ask(valid_request());
  ASSERT_TRUE(again.status.ok()) << again.status.error_message();
  EXPECT_EQ(server.runs(), 1);
  EXPECT_EQ(chunks_of(again), chunks_of(made));
  EXPECT_TRUE(again.messages.front().has_accepted());
  EXPECT_FALSE(made.messages.back().summary().cached());
  EXPECT_TRUE(again.messages.back().summary().cached());
  EXPECT_EQ(again.messages.back().summary().sha256(), made.messages.back().summary().sha256());
}

TEST(GenerateMeshAgain, ResumesAtAnyChunk) {
  CachingServer server;
  const std::vector<std::string> made = chunks_of(server.ask(valid_request()));
  v1::GenerateMeshRequest request = valid_request();
  for (std::uint32_t first = 0; first <= made.size(); ++first) {
    request.set_first_chunk(first);
    EXPECT_EQ(chunks_of(server.ask(request)),
              std::vector<std::string>(made.begin() + first, made.end()));
  }
  request.set_first_chunk(21);
  EXPECT_EQ(server.ask(request).status.error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(server.runs(), 1);
}

TEST(GenerateMeshAgain, TellsTheQuadtreeToWhoeverWantsIt) {
  CachingServer server;
  v1::GenerateMeshRequest request = valid_request();
  EXPECT_EQ(server.ask(request).messages.back().summary().leaf_boxes_size(), 0);
  request.set_want_quadtree(true);
  EXPECT_EQ(server.ask(request).messages.back().summary().leaf_boxes_size(), 12);
  EXPECT_EQ(server.runs(), 1);
}

TEST(GenerateMeshAgain, MakesTheMeshAnewWhereAsked) {
  CachingServer server;
  server.ask(valid_request());
  v1::GenerateMeshRequest request = valid_request();
  request.set_no_cache(true);
  EXPECT_FALSE(server.ask(request).messages.back().summary().cached());
  EXPECT_EQ(server.runs(), 2);
}

TEST(GenerateMeshAgain, MakesAnotherMeshForAnotherRequest) {
  CachingServer server;
  server.ask(valid_request());
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_quality()->set_min_angle_deg(21);
  server.ask(request);
  EXPECT_EQ(server.runs(), 2);
}

TEST(GenerateMeshAgain, DoesNotAnswerWithAFailure) {
  CachingServer server;
  server.failing_ = 1;
  EXPECT_FALSE(server.ask(valid_request()).status.ok());
  EXPECT_TRUE(server.ask(valid_request()).status.ok());
  EXPECT_EQ(server.runs(), 2);
}

TEST(GenerateMeshAgain, DoesNotGiveAMeshThatMissesItsBoundsToWhoeverDidNotAllowIt) {
  std::atomic<int> runs = 0;
  ServiceOptions options;
  options.cache_bytes = 64 * kMiB;
  TestServer server(
      [&](const MeshRequest& request, ChunkSink& sink, auto&) -> Result<Summary> {
        ++runs;
        auto summary = send_chunks(sink, 3);
        if (!request.allow_unrefined)
          return fail(ErrorCode::kBoundsNotMet, "", "12 triangles miss");
        return summary;
      },
      options);
  const auto stub = server.stub();
  v1::GenerateMeshRequest allowed = valid_request();
  allowed.set_allow_unrefined(true);
  EXPECT_TRUE(call(*stub, allowed).status.ok());
  EXPECT_TRUE(call(*stub, allowed).messages.back().summary().cached());
  for (int attempt = 0; attempt < 2; ++attempt) {
    const Outcome outcome = call(*stub, valid_request());
    EXPECT_EQ(outcome.status.error_code(), grpc::FAILED_PRECONDITION);
    EXPECT_EQ(details_of(outcome.status).error_info.reason(), "BOUNDS_NOT_MET");
    EXPECT_FALSE(details_of(outcome.status).retry_info);
  }
  EXPECT_EQ(runs, 3);
}

TEST(GenerateMeshAgain, MakesTheMeshAnewWhereNothingIsKept) {
  CachingServer server(0);
  server.ask(valid_request());
  server.ask(valid_request());
  EXPECT_EQ(server.runs(), 2);
}

}  // namespace
}  // namespace weft::server::testing
