// SPDX-License-Identifier: Apache-2.0
// grpc.health.v1 and reflection, with requests and responses spelled in wire bytes.
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "grpc/reflection/v1/reflection.pb.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/harness.h"
#include "tests/server/logged_server.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

constexpr const char* kCheck = "/grpc.health.v1.Health/Check";
// HealthCheckResponse.status
const std::string kServing("\x08\x01", 2);
const std::string kNotServing("\x08\x02", 2);

EngineFn idle() {
  return [](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 0); };
}

TEST(Health, SaysServingForTheServerAndForTheService) {
  TestServer server(idle());
  const auto [whole, whole_answer] = raw_unary(server.channel(), kCheck, "");
  EXPECT_TRUE(whole.ok()) << whole.error_message();
  EXPECT_EQ(whole_answer, kServing);
  const std::string name = "weft.v1.MeshService";
  const auto [one, one_answer] =
      raw_unary(server.channel(), kCheck, std::string{'\x0a', char(name.size())} + name);
  EXPECT_TRUE(one.ok()) << one.error_message();
  EXPECT_EQ(one_answer, kServing);
}

TEST(Health, SaysNotServingWhileTheServerDrains) {
  Event release;
  Event started;
  TestServer server([&](const auto&, ChunkSink& sink, auto&) {
    started.set();
    EXPECT_TRUE(release.wait());
    return send_chunks(sink, 0);
  });
  auto stub = server.stub();
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, valid_request());
  ASSERT_TRUE(started.wait());
  const auto channel = server.channel();
  std::thread drainer([&] { server->drain(std::chrono::seconds(30)); });
  std::string answer;
  do answer = raw_unary(channel, kCheck, "").second;
  while (answer == kServing);
  EXPECT_EQ(answer, kNotServing);
  release.set();
  EXPECT_TRUE(read_all(*reader).status.ok());
  drainer.join();
}

TEST(Health, LetsNobodyTakeThePlacesOfAllWhoWatch) {
  constexpr const char* kWatch = "/grpc.health.v1.Health/Watch";
  const files::TempFolder folder;
  LoggedServer server(
      {.listen = {"127.0.0.1:0", "unix:" + (folder / "s").string()}, .service = {}});
  const auto from = [&](std::size_t address) {
    return channel_to(server->addresses()[address], grpc::InsecureChannelCredentials());
  };
  const auto channel = from(0);
  std::vector<std::unique_ptr<RawStream>> open;
  for (int i = 0; i < 64; ++i) {
    open.push_back(std::make_unique<RawStream>(channel, kWatch, ""));
    ASSERT_TRUE(open.back()->read()) << i;
  }
  const grpc::Status refused = RawStream(from(0), kWatch, "").end();
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED) << "another connection of that host";
  EXPECT_TRUE(RawStream(from(1), kWatch, "").read()) << "another host";
  open.pop_back();
  EXPECT_TRUE(eventually([&] { return RawStream(channel, kWatch, "").read(); }));
}

// A stream of reflection.
class Reflection {
 public:
  explicit Reflection(std::shared_ptr<grpc::Channel> channel)
      : channel_(std::move(channel)),
        rpc_("/grpc.reflection.v1.ServerReflection/ServerReflectionInfo",
             grpc::internal::RpcMethod::BIDI_STREAMING, channel_) {
    stream_.reset(
        grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, grpc::ByteBuffer>::Create(
            channel_.get(), rpc_, &context_));
  }

  // Nothing if the stream has ended.
  std::optional<std::string> ask(const std::string& request) {
    grpc::ByteBuffer answer;
    if (!stream_->Write(to_buffer(request)) || !stream_->Read(&answer)) return std::nullopt;
    return to_string(answer);
  }
  grpc::Status end() {
    stream_->WritesDone();
    grpc::ByteBuffer more;
    while (stream_->Read(&more)) continue;
    return stream_->Finish();
  }

 private:
  const std::shared_ptr<grpc::Channel> channel_;
  const grpc::internal::RpcMethod rpc_;
  grpc::ClientContext context_;
  std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>> stream_;
};

// ServerReflectionRequest, with one field of text.
std::string request(int field, const std::string& text) {
  return std::string{static_cast<char>(field << 3 | 2), static_cast<char>(text.size())} + text;
}
constexpr int kByName = 3;
constexpr int kBySymbol = 4;
constexpr int kListServices = 7;

bool holds(const std::optional<std::string>& answer, const std::string& text) {
  return answer && answer->find(text) != std::string::npos;
}

TEST(Reflection, ListsTheServices) {
  TestServer server(idle());
  Reflection reflection(server.channel());
  const auto answer = reflection.ask(request(kListServices, ""));
  EXPECT_TRUE(holds(answer, "weft.v1.MeshService"));
  EXPECT_TRUE(holds(answer, "grpc.health.v1.Health"));
  EXPECT_FALSE(holds(answer, "weft.v1.JobService"));  // no jobs are kept
  EXPECT_TRUE(reflection.end().ok());
}

TEST(Reflection, DescribesEveryServiceThatItLists) {
  TestServer server(idle());
  Reflection reflection(server.channel());
  grpc::reflection::v1::ServerReflectionResponse listed;
  ASSERT_TRUE(listed.ParseFromString(reflection.ask(request(kListServices, "")).value()));
  EXPECT_GE(listed.list_services_response().service_size(), 2);
  for (const auto& service : listed.list_services_response().service()) {
    grpc::reflection::v1::ServerReflectionResponse described;
    ASSERT_TRUE(
        described.ParseFromString(reflection.ask(request(kBySymbol, service.name())).value()));
    EXPECT_TRUE(described.has_file_descriptor_response()) << service.name();
  }
}

TEST(Reflection, AnswersOneRequestAfterAnotherWithAFileAndWhatItImports) {
  TestServer server(idle());
  Reflection reflection(server.channel());
  const auto by_symbol = reflection.ask(request(kBySymbol, "weft.v1.JobService.SubmitJob"));
  EXPECT_TRUE(holds(by_symbol, "weft/v1/job_service.proto"));
  EXPECT_TRUE(holds(by_symbol, "weft/v1/mesh_service.proto"));
  EXPECT_TRUE(holds(by_symbol, "google/protobuf/timestamp.proto"));
  EXPECT_TRUE(holds(reflection.ask(request(kByName, "google/rpc/status.proto")), "Status"));
  EXPECT_TRUE(holds(reflection.ask(request(kBySymbol, "weft.v1.None")),
                    "this server has no such file or symbol"));
  EXPECT_TRUE(reflection.end().ok());
}

TEST(Reflection, RefusesWhatIsNoRequest) {
  TestServer server(idle());
  Reflection reflection(server.channel());
  EXPECT_FALSE(reflection.ask("\x0a\xff"));
  EXPECT_EQ(reflection.end().error_code(), grpc::INVALID_ARGUMENT);
}

TEST(Reflection, BoundsTheStreamsThatAreOpen) {
  TestServer server(idle());
  const auto channel = server.channel();
  std::vector<std::unique_ptr<Reflection>> open;
  for (int i = 0; i < 64; ++i) {
    open.push_back(std::make_unique<Reflection>(channel));
    ASSERT_TRUE(open.back()->ask(request(kListServices, ""))) << i;
  }
  Reflection too_many(channel);
  EXPECT_FALSE(too_many.ask(request(kListServices, "")));
  EXPECT_EQ(too_many.end().error_code(), grpc::RESOURCE_EXHAUSTED);
  for (const auto& each : open) EXPECT_TRUE(each->end().ok());
}

}  // namespace
}  // namespace weft::server::testing
