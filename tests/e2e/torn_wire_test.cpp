// SPDX-License-Identifier: Apache-2.0
// A connection that tears after each single chunk, and a client that comes back for the next one:
// what it puts together is byte for byte what an undisturbed client gets.
#include <grpc/grpc.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/client/support/torn_relay.h"
#include "tests/e2e/fleet.h"
#include "tests/e2e/programs.h"
#include "tests/files/support/temp_folder.h"

namespace weft::e2e {
namespace {

// Chunks as they are on the wire, and the digest of the whole.
struct Mesh {
  std::vector<std::string> chunks;
  std::string digest;
};

// A client that takes little ahead of what it reads, so that there is something left to tear.
std::shared_ptr<grpc::Channel> connect_closely(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);
  arguments.SetInt(GRPC_ARG_HTTP2_STREAM_LOOKAHEAD_BYTES, 1 << 16);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

// Opens GenerateMesh or FetchMesh from a chunk on.
template <class Open>
class Torn {
 public:
  Torn(const Server& server, Open open) : server_(server), open_(open) {}

  Mesh whole() const {
    Mesh mesh;
    grpc::ClientContext context;
    const auto reader = open_(server_.address(), context, 0);
    while (read(*reader, mesh)) continue;
    EXPECT_TRUE(reader->Finish().ok());
    return mesh;
  }

  Mesh in_pieces(std::size_t chunks) const {
    const Folder folder;
    client::TornRelay relay(folder / "wire", server_.address().substr(5), {});
    Mesh mesh;
    for (std::size_t i = 0; i < chunks; ++i) {
      grpc::ClientContext context;
      const auto reader = open_(relay.address(), context, static_cast<std::uint32_t>(i));
      while (mesh.chunks.size() == i && read(*reader, mesh)) continue;
      relay.tear();
      Mesh lost;  // what was under way
      while (read(*reader, lost)) continue;
      const grpc::Status status = reader->Finish();
      EXPECT_TRUE(status.ok() || status.error_code() == grpc::UNAVAILABLE)
          << status.error_message();
      torn_ += !status.ok();
    }
    grpc::ClientContext context;
    const auto reader = open_(relay.address(), context, static_cast<std::uint32_t>(chunks));
    while (read(*reader, mesh)) continue;
    EXPECT_TRUE(reader->Finish().ok());
    return mesh;
  }

  // Calls that ended before their last message.
  std::size_t torn() const { return torn_; }

 private:
  template <class Reader>
  static bool read(Reader& reader, Mesh& mesh) {
    decltype(message_of(reader)) message;
    if (!reader.Read(&message)) return false;
    if (message.has_chunk()) mesh.chunks.push_back(message.chunk().SerializeAsString());
    if (message.has_summary()) mesh.digest = message.summary().sha256();
    return true;
  }
  template <class Message>
  static Message message_of(grpc::ClientReader<Message>&);

  const Server& server_;
  const Open open_;
  mutable std::size_t torn_ = 0;
};

// A dozen chunks.
v1::GenerateMeshRequest request() {
  return repeated_request(2);
}

template <class Open>
void expect_the_same_in_pieces(const Server& server, Open open) {
  const Torn torn(server, open);
  const Mesh whole = torn.whole();
  ASSERT_GE(whole.chunks.size(), 10u);
  const Mesh pieces = torn.in_pieces(whole.chunks.size());
  EXPECT_EQ(pieces.chunks, whole.chunks);
  EXPECT_EQ(pieces.digest, whole.digest);
  EXPECT_GE(torn.torn(), whole.chunks.size() - 1) << "the wire did not tear in time";
}

// Whether the work is repeated, or the mesh is still in the server's memory.
class TornAfterEachChunk : public ::testing::TestWithParam<bool> {};

TEST_P(TornAfterEachChunk, GenerateMeshIsResumedByteForByte) {
  const Server server;
  expect_the_same_in_pieces(server, [](const std::string& address, grpc::ClientContext& context,
                                       std::uint32_t first_chunk) {
    v1::GenerateMeshRequest mesh = request();
    mesh.set_no_cache(GetParam());
    mesh.set_first_chunk(first_chunk);
    return v1::MeshService::NewStub(connect_closely(address))->GenerateMesh(&context, mesh);
  });
}

INSTANTIATE_TEST_SUITE_P(From, TornAfterEachChunk, ::testing::Values(true, false),
                         [](const auto& info) { return info.param ? "TheEngine" : "Memory"; });

TEST(TornWire, FetchMeshIsResumedByteForByte) {
  const Folder folder;
  const Server server({"--data", folder / "data"});
  const auto stub = v1::JobService::NewStub(connect(server.address()));
  v1::SubmitJobRequest submission;
  *submission.mutable_mesh() = request();
  v1::SubmitJobResponse submitted;
  grpc::ClientContext submitting;
  ASSERT_TRUE(stub->SubmitJob(&submitting, submission, &submitted).ok());
  const std::string id = submitted.job().id();
  ASSERT_TRUE(wait_for_job(*stub, id));
  expect_the_same_in_pieces(server, [&id](const std::string& address, grpc::ClientContext& context,
                                          std::uint32_t first_chunk) {
    v1::FetchMeshRequest fetch;
    fetch.set_id(id);
    fetch.set_first_chunk(first_chunk);
    return v1::JobService::NewStub(connect_closely(address))->FetchMesh(&context, fetch);
  });
}

TEST(TornWire, WeftMeshGoesOnAsOftenAsTheWireTears) {
  const Folder folder;
  const Server server;
  client::TornRelay relay(folder / "wire", server.address().substr(5), {100'000, 400'000, 900'000});
  const auto mesh = [&](const std::string& address, const std::string& file) {
    return run_weft({"mesh", model("cylinder.poly"), "--size", "5e-3", "--no-cache", "--quiet",
                     "--server", address, "-o", folder / file});
  };
  const Outcome whole = mesh(server.address(), "whole.npz");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const Outcome torn = mesh(relay.address(), "torn.npz");
  ASSERT_EQ(torn.exit_code, 0) << torn.err;
  EXPECT_EQ(relay.torn(), 3u);
  EXPECT_NE(torn.err.find("trying again"), std::string::npos) << torn.err;
  EXPECT_EQ(files::contents_of(folder / "torn.npz"), files::contents_of(folder / "whole.npz"));
}

}  // namespace
}  // namespace weft::e2e
