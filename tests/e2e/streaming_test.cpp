// SPDX-License-Identifier: Apache-2.0
// The stream of a real weftd as a client of weft.v1 sees it: chunks that come again byte for byte,
// progress, and several jobs on one server.
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>

#include "client/call/mesh_call.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "tests/e2e/programs.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::e2e {
namespace {

using Stub = v1::MeshService::Stub;

std::unique_ptr<Stub> stub_of(const Server& server) {
  grpc::ChannelArguments arguments;
  arguments.SetInt("grpc.use_local_subchannel_pool", 1);  // a connection of its own
  return v1::MeshService::NewStub(
      grpc::CreateCustomChannel(server.address(), grpc::InsecureChannelCredentials(), arguments));
}

v1::GenerateMeshRequest request_for(const std::string& domain,
                                    const client::RequestOptions& request_options) {
  return client::make_request(files::read_domain(model(domain)).value(), request_options);
}

// A call read to its end.
struct Stream {
  std::map<std::uint32_t, std::string> chunks;  // bytes by index
  v1::Accepted accepted;
  v1::Summary summary;
  grpc::Status status;
};

Stream call(Stub& stub, const v1::GenerateMeshRequest& request) {
  Stream stream;
  grpc::ClientContext context;
  const auto reader = stub.GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  while (reader->Read(&message)) {
    if (message.has_accepted()) stream.accepted = message.accepted();
    if (message.has_chunk())
      stream.chunks[message.chunk().index()] = message.chunk().SerializeAsString();
    if (message.has_summary()) stream.summary = message.summary();
  }
  stream.status = reader->Finish();
  return stream;
}

TEST(FirstChunkOfAStream, GivesTheRestOfTheSameMeshByteForByteOnOtherThreads) {
  const Server server({"--threads", "3"});
  const auto stub = stub_of(server);
  v1::GenerateMeshRequest request = request_for("us-east-coast.poly", {.size = "1e-3"});
  const Stream whole = call(*stub, request);
  ASSERT_TRUE(whole.status.ok()) << whole.status.error_message();
  ASSERT_GE(whole.chunks.size(), 20u);
  const auto chunks = static_cast<std::uint32_t>(whole.chunks.size());
  for (const std::uint32_t first : {1u, chunks / 2, chunks - 1, chunks}) {
    request.set_first_chunk(first);
    request.set_threads(1 + first % 3);
    const Stream rest = call(*stub, request);
    ASSERT_TRUE(rest.status.ok()) << rest.status.error_message();
    EXPECT_EQ(rest.chunks, (std::map(whole.chunks.lower_bound(first), whole.chunks.end())));
    EXPECT_EQ(rest.summary.chunks(), chunks);
    EXPECT_EQ(rest.summary.triangles(), whole.summary.triangles());
    EXPECT_EQ(rest.summary.sha256(), whole.summary.sha256());
    EXPECT_EQ(rest.accepted.threads(), 1 + first % 3);
    EXPECT_EQ(rest.summary.threads(), 1 + first % 3);
  }
  request.set_first_chunk(chunks + 1);
  const Stream beyond = call(*stub, request);
  EXPECT_EQ(beyond.status.error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_TRUE(beyond.chunks.empty());
}

// Reads up to `last` chunks of a mesh and leaves, with a stall before each that `stalls` names.
void read_with_stalls(Stub& stub, const v1::GenerateMeshRequest& request, std::uint32_t last,
                      const std::function<bool()>& stalls, Stream& stream) {
  grpc::ClientContext context;
  const auto reader = stub.GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  while (reader->Read(&message)) {
    if (message.has_summary()) stream.summary = message.summary();
    if (!message.has_chunk()) continue;
    stream.chunks[message.chunk().index()] = message.chunk().SerializeAsString();
    if (message.chunk().index() + 1 == last) context.TryCancel();
    if (stalls()) std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  (void)reader->Finish();
}

// Meanwhile the run pauses: the buffer is smaller than a chunk.
TEST(Readers, ThatStallAtRandomAndComeBackInTheMiddleGetTheSameMesh) {
  const auto request_of = [](std::uint32_t threads) {
    v1::GenerateMeshRequest request = request_for("us-east-coast.poly", {.size = "5e-4"});
    request.set_no_cache(true);
    request.set_threads(threads);
    return request;
  };
  const Server server({"--threads", "3", "--stream-buffer", "256KiB"});
  const auto stub = stub_of(server);
  const Stream whole = call(*stub, request_of(3));
  ASSERT_TRUE(whole.status.ok()) << whole.status.error_message();
  ASSERT_TRUE(whole.summary.streamed());
  ASSERT_GE(whole.chunks.size(), 20u);
  std::mt19937 random(7);
  for (const std::uint32_t threads : {1u, 2u, 3u}) {
    const auto stalls = [&] { return random() % 6 == 0; };
    const auto half = static_cast<std::uint32_t>(whole.chunks.size() / 2);
    Stream pieces;
    read_with_stalls(*stub, request_of(threads), half, stalls, pieces);
    ASSERT_GE(pieces.chunks.size(), half);
    ASSERT_FALSE(pieces.summary.has_timings()) << "it left in the middle";
    v1::GenerateMeshRequest rest = request_of(4 - threads);
    rest.set_first_chunk(static_cast<std::uint32_t>(pieces.chunks.size()));
    read_with_stalls(*stub, rest, UINT32_MAX, stalls, pieces);
    EXPECT_TRUE(pieces.chunks == whole.chunks) << threads << " threads";
    EXPECT_EQ(pieces.summary.sha256(), whole.summary.sha256()) << threads << " threads";
  }
}

TEST(StreamedQuadtree, IsSentWhereItIsWantedAndCoversTheDomain) {
  const Server server;
  const auto stub = stub_of(server);
  const Stream without = call(*stub, request_for("us-east-coast.poly", {.size = "1e-3"}));
  v1::GenerateMeshRequest wanted = request_for("us-east-coast.poly", {.size = "1e-3"});
  wanted.set_want_quadtree(true);
  const Stream with = call(*stub, wanted);
  EXPECT_GT(without.summary.leaves(), 20u);
  EXPECT_EQ(without.summary.leaf_boxes_size(), 0);
  EXPECT_EQ(with.summary.leaves(), without.summary.leaves());
  EXPECT_EQ(with.summary.sha256(), without.summary.sha256());
  ASSERT_EQ(static_cast<std::uint32_t>(with.summary.leaf_boxes_size()), 4 * with.summary.leaves());
  const auto& side = with.summary.leaf_boxes();
  double area = 0;
  double min_x = side[0];
  double max_x = side[2];
  for (int i = 0; i < side.size(); i += 4) {
    area += (side[i + 2] - side[i]) * (side[i + 3] - side[i + 1]);
    min_x = std::min(min_x, side[i]);
    max_x = std::max(max_x, side[i + 2]);
  }
  EXPECT_NEAR(area, (max_x - min_x) * (max_x - min_x), 1e-9 * area);
}

// A mesh of more triangles than two threads make in a few seconds, read on a thread of its own.
class HugeJob {
 public:
  explicit HugeJob(const Server& server)
      : stub_(stub_of(server)), reader_thread_([this] { read(); }) {}
  ~HugeJob() { end(); }

  bool wait_for_chunks() {
    while (!has_chunks_ && !ended_) std::this_thread::yield();
    return has_chunks_;
  }
  // Whether it was still at work.
  bool is_at_work() const { return !ended_; }
  grpc::Status end() {
    context_.TryCancel();
    if (reader_thread_.joinable()) reader_thread_.join();
    return status_;
  }

 private:
  void read() {
    const auto reader =
        stub_->GenerateMesh(&context_, request_for("cylinder.poly", {.size = "1e-5"}));
    v1::GenerateMeshResponse message;
    while (reader->Read(&message)) has_chunks_ = has_chunks_ || message.has_chunk();
    status_ = reader->Finish();
    ended_ = true;
  }

  const std::unique_ptr<Stub> stub_;
  grpc::ClientContext context_;
  grpc::Status status_;
  std::atomic<bool> has_chunks_{false};
  std::atomic<bool> ended_{false};
  std::thread reader_thread_;
};

TEST(SmallJobs, AreDoneWhileHugeOnesAreStillAtWork) {
  const Server server({"--threads", "2"});
  HugeJob first(server);
  HugeJob second(server);
  ASSERT_TRUE(first.wait_for_chunks());
  ASSERT_TRUE(second.wait_for_chunks());
  const auto stub = stub_of(server);
  for (int i = 0; i < 3; ++i) {
    const Stream small = call(*stub, request_for("key.poly", {.size = "0.1"}));
    EXPECT_TRUE(small.status.ok()) << small.status.error_message();
    EXPECT_GT(small.summary.triangles(), 0u);
  }
  EXPECT_TRUE(first.is_at_work());
  EXPECT_TRUE(second.is_at_work());
  EXPECT_EQ(first.end().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_EQ(second.end().error_code(), grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(call(*stub, request_for("key.poly", {.size = "0.1"})).status.ok());
}

TEST(StreamedProgress, TellsFractionsThatRiseWhileChunksCome) {
  const Server server({"--threads", "2"});
  const auto stub = stub_of(server);
  grpc::ClientContext context;
  const auto reader = stub->GenerateMesh(&context, request_for("cylinder.poly", {.size = "1e-5"}));
  v1::GenerateMeshResponse message;
  double last = 0;
  int risen = 0;
  bool chunks = false;
  while (risen < 3 && reader->Read(&message)) {
    chunks = chunks || message.has_chunk();
    if (!message.has_progress()) continue;
    const double fraction = message.progress().fraction();
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    risen += chunks && fraction > last;
    last = fraction;
  }
  EXPECT_EQ(risen, 3) << "the mesh was done before progress was told three times";
  context.TryCancel();
  while (reader->Read(&message)) continue;
  reader->Finish();
}

}  // namespace
}  // namespace weft::e2e
