// SPDX-License-Identifier: Apache-2.0
// Who may call, and by which name the server knows a caller.
#include "server/net/caller.h"

#include <google/protobuf/descriptor.h>

#include <filesystem>

#include "server/store/sqlite/sqlite_store.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/logged_server.h"
#include "tests/server/raw_call.h"
#include "weft/v1/job_service.grpc.pb.h"

namespace weft::server::testing {
namespace {

using grpc::StatusCode;

// A server that knows the tokens of ann and bob.
class Tokens : public ::testing::Test {
 protected:
  const files::TempFolder folder_;
  LoggedServer server_{
      {.listen = {"127.0.0.1:0"},
       .service = {},
       .tokens = folder_.write("tokens", "ann secret-of-ann-16\nbob secret-of-bob-16\n").string()},
      std::move(*SqliteStore::open({.folder = folder_ / "data"}))};
  const std::shared_ptr<grpc::Channel> channel_ =
      channel_to(server_.address(), grpc::InsecureChannelCredentials());
};

// "/package.Service/Method" of all that weft.v1 declares.
std::vector<std::string> all_methods() {
  v1::SubmitJobRequest::descriptor();  // registers the files
  std::vector<std::string> methods;
  for (const auto* file :
       {v1::GenerateMeshRequest::descriptor()->file(), v1::SubmitJobRequest::descriptor()->file()})
    for (int s = 0; s < file->service_count(); ++s)
      for (int m = 0; m < file->service(s)->method_count(); ++m)
        methods.push_back("/" + file->service(s)->full_name() + "/" +
                          file->service(s)->method(m)->name());
  return methods;
}

TEST_F(Tokens, AreWantedByEveryMethod) {
  EXPECT_EQ(all_methods().size(), 9);
  for (const std::string& method : all_methods()) {
    const auto code = [&](const char* authorization) {
      return raw_unary(channel_, method.c_str(), "", authorization).first.error_code();
    };
    EXPECT_NE(code("Bearer secret-of-ann-16"), StatusCode::UNIMPLEMENTED) << method;
    EXPECT_NE(code("Bearer secret-of-ann-16"), StatusCode::UNAUTHENTICATED) << method;
    EXPECT_EQ(code(""), StatusCode::UNAUTHENTICATED) << method;
    EXPECT_EQ(code("Bearer secret-c"), StatusCode::UNAUTHENTICATED) << method;
  }
}

TEST_F(Tokens, ShowAJobToItsOwnerAlone) {
  v1::SubmitJobRequest submit;
  *submit.mutable_mesh() = valid_request();
  const auto call = [&](const char* method, const google::protobuf::MessageLite& request,
                        const char* token) {
    const std::string path = std::string("/weft.v1.JobService/") + method;
    return raw_unary(channel_, path.c_str(), request.SerializeAsString(), token);
  };
  const auto [status, answer] = call("SubmitJob", submit, "Bearer secret-of-ann-16");
  ASSERT_TRUE(status.ok()) << status.error_message();
  v1::SubmitJobResponse submitted;
  submitted.ParseFromString(answer);
  v1::GetJobRequest named;  // as the other requests for one job
  named.set_id(submitted.job().id());
  for (const char* method : {"GetJob", "WatchJob", "CancelJob", "DeleteJob", "FetchMesh"})
    EXPECT_EQ(call(method, named, "Bearer secret-of-bob-16").first.error_code(),
              StatusCode::NOT_FOUND)
        << method;
  EXPECT_TRUE(call("GetJob", named, "Bearer secret-of-ann-16").first.ok());
  EXPECT_EQ(call("ListJobs", v1::ListJobsRequest(), "Bearer secret-of-bob-16").second, "");
  v1::ListJobsResponse listed;
  listed.ParseFromString(call("ListJobs", v1::ListJobsRequest(), "Bearer secret-of-ann-16").second);
  ASSERT_EQ(listed.jobs_size(), 1);
  EXPECT_EQ(submitted.job().client(), "ann");
  EXPECT_EQ(listed.jobs(0).client(), "ann");
}

// A server whose clients share work and meshes, or do not: then a client does not see what another
// one has made.
class SharedOrNot : public ::testing::TestWithParam<bool> {
 protected:
  bool cached(const char* token) {
    grpc::ClientContext context;
    context.AddMetadata("authorization", token);
    const Outcome outcome = read_all(*mesh_stub_->GenerateMesh(&context, valid_request()));
    EXPECT_TRUE(outcome.status.ok()) << outcome.status.error_message();
    return !outcome.messages.empty() && outcome.messages.back().summary().cached();
  }
  // The job that a submission makes, once it has ended.
  v1::Job ended(const char* token) {
    v1::SubmitJobRequest request;
    *request.mutable_mesh() = valid_request();
    v1::SubmitJobResponse submitted;
    submitted.ParseFromString(call("SubmitJob", request, token));
    v1::GetJobRequest named;
    named.set_id(submitted.job().id());
    v1::GetJobResponse got;
    EXPECT_TRUE(eventually([&] {
      got.ParseFromString(call("GetJob", named, token));
      return got.job().state() == v1::JOB_STATE_SUCCEEDED;
    }));
    return got.job();
  }

 private:
  std::string call(const char* method, const google::protobuf::MessageLite& request,
                   const char* token) {
    const std::string path = std::string("/weft.v1.JobService/") + method;
    return raw_unary(channel_, path.c_str(), request.SerializeAsString(), token).second;
  }

  const files::TempFolder folder_;
  LoggedServer server_{
      {.listen = {"127.0.0.1:0"},
       .service = {.cache_bytes = 1 << 20, .share_across_clients = GetParam()},
       .tokens = folder_.write("tokens", "ann secret-of-ann-16\nbob secret-of-bob-16\n").string()},
      std::move(*SqliteStore::open({.folder = folder_ / "data"}))};
  const std::shared_ptr<grpc::Channel> channel_ =
      channel_to(server_.address(), grpc::InsecureChannelCredentials());
  const std::unique_ptr<v1::MeshService::Stub> mesh_stub_ = v1::MeshService::NewStub(channel_);
};

TEST_P(SharedOrNot, AMeshOfACallIsAtHandForItsOwnClientAndForOthersIfTheyShare) {
  EXPECT_FALSE(cached("Bearer secret-of-ann-16"));
  EXPECT_TRUE(cached("Bearer secret-of-ann-16"));
  EXPECT_EQ(cached("Bearer secret-of-bob-16"), GetParam());
}

TEST_P(SharedOrNot, AMeshOfAJobIsKeptForItsOwnClientAndForOthersIfTheyShare) {
  EXPECT_FALSE(ended("Bearer secret-of-ann-16").from_store());
  EXPECT_TRUE(ended("Bearer secret-of-ann-16").from_store());
  EXPECT_EQ(ended("Bearer secret-of-bob-16").from_store(), GetParam());
  EXPECT_TRUE(ended("Bearer secret-of-bob-16").from_store());
}

INSTANTIATE_TEST_SUITE_P(Clients, SharedOrNot, ::testing::Bool());

TEST_F(Tokens, AreTakenFromABearerHeaderOnly) {
  EXPECT_TRUE(ask(channel_, "Bearer secret-of-ann-16").ok());
  EXPECT_TRUE(ask(channel_, "bearer secret-of-bob-16").ok());
  for (const char* wrong :
       {"secret-of-ann-16", "Bearer", "Bearer ", "Bearersecret-of-ann-16", "Basic secret-of-ann-16",
        "Bearer  secret-of-ann-16", "Bearer secret-of-ann-16,Bearer secret-of-bob-16"})
    EXPECT_EQ(ask(channel_, wrong).error_code(), StatusCode::UNAUTHENTICATED) << wrong;
}

TEST_F(Tokens, AreNotTriedOneAfterTheOther) {
  grpc::ClientContext context;
  context.AddMetadata("authorization", "Bearer wrong");
  context.AddMetadata("authorization", "Bearer secret-of-ann-16");
  v1::GetServerInfoResponse info;
  EXPECT_EQ(v1::MeshService::NewStub(channel_)->GetServerInfo(&context, {}, &info).error_code(),
            StatusCode::UNAUTHENTICATED);
}

TEST_F(Tokens, ThatAreMissingGiveAReasonForMachines) {
  const grpc::Status status = ask(channel_);
  EXPECT_EQ(details_of(status).error_info.reason(), "UNAUTHENTICATED");
  EXPECT_FALSE(details_of(status).retry_info);
  EXPECT_NE(status.error_message().find("authorization: Bearer"), std::string::npos);
}

TEST_F(Tokens, AreNotWantedByHealth) {
  const auto [status, answer] = raw_unary(channel_, "/grpc.health.v1.Health/Check", "");
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(answer, std::string("\x08\x01", 2));
}

TEST_F(Tokens, AreAskedForByReflection) {
  const char* method = "/grpc.reflection.v1.ServerReflection/ServerReflectionInfo";
  const std::string list_services("\x3a\x00", 2);
  EXPECT_EQ(raw_unary(channel_, method, list_services).first.error_code(),
            StatusCode::UNAUTHENTICATED);
  const auto [status, answer] =
      raw_unary(channel_, method, list_services, "Bearer secret-of-ann-16");
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_NE(answer.find("weft.v1.MeshService"), std::string::npos);
}

TEST_F(Tokens, LeaveMethodsThatNobodyHasUnimplemented) {
  for (const char* method : {"/weft.v1.MeshService/None", "/none.Service/None", "/", "none"})
    EXPECT_EQ(raw_unary(channel_, method, "").first.error_code(), StatusCode::UNIMPLEMENTED)
        << method;
}

TEST_F(Tokens, NameTheClientInTheLogAndNeverAppearThere) {
  grpc::ClientContext context;
  context.AddMetadata("authorization", "Bearer secret-of-ann-16");
  context.AddMetadata("traceparent", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01");
  const auto stub = v1::MeshService::NewStub(channel_);
  EXPECT_TRUE(read_all(*stub->GenerateMesh(&context, valid_request())).status.ok());
  // The last line may come after the answer.
  EXPECT_TRUE(eventually([&] { return server_.log().contains("event=call_ended"); }));
  for (const char* event : {"event=call_queued", "event=call_started", "event=call_ended"}) {
    const std::string log = server_.log().text();
    const std::string line = log.substr(log.find(event), log.find('\n', log.find(event)));
    EXPECT_NE(line.find(" client=ann "), std::string::npos) << line;
    EXPECT_NE(line.find(" trace=4bf92f3577b34da6a3ce929d0e0e4736 "), std::string::npos) << line;
  }
  EXPECT_EQ(raw_generate_mesh(channel_, "").error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_TRUE(server_.log().contains("reason=UNAUTHENTICATED")) << server_.log().text();
  EXPECT_FALSE(server_.log().contains("secret")) << server_.log().text();
}

TEST(Callers, AreNotToldApartWithoutTokensAndCertificates) {
  LoggedServer server({.listen = {"127.0.0.1:0"}, .service = {}});
  const auto channel = channel_to(server.address(), grpc::InsecureChannelCredentials());
  EXPECT_TRUE(ask(channel, "Bearer whatever").ok());
  EXPECT_EQ(raw_generate_mesh(channel, "").error_code(), StatusCode::INVALID_ARGUMENT);
  EXPECT_FALSE(server.log().contains("client=")) << server.log().text();
}

TEST(TraceId, IsThatOfAWellFormedHeader) {
  const std::string trace = "4bf92f3577b34da6a3ce929d0e0e4736";
  EXPECT_EQ(trace_id("00-" + trace + "-00f067aa0ba902b7-01"), trace);
  EXPECT_EQ(trace_id("cc-" + trace + "-00f067aa0ba902b7-01"), trace);
  EXPECT_EQ(trace_id("cc-" + trace + "-00f067aa0ba902b7-01-what-comes-later"), trace);
}

TEST(TraceId, IsEmptyWhereTheHeaderIsMalformed) {
  const std::string zeros(32, '0');
  const std::string trace = "4bf92f3577b34da6a3ce929d0e0e4736";
  for (const std::string& header : std::vector<std::string>{
           "", "00", trace, "ff-" + trace + "-00f067aa0ba902b7-01",
           "00-" + zeros + "-00f067aa0ba902b7-01", "00-" + trace + "-0000000000000000-01",
           "00-" + trace + "-00f067aa0ba902b7-0x", "00-" + trace + "-00f067aa0ba902b7-01-more",
           "cc-" + trace + "-00f067aa0ba902b7-01more", "00_" + trace + "-00f067aa0ba902b7-01",
           "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01",
           "00-" + trace + "-00f067aa0ba902b7"})
    EXPECT_EQ(trace_id(header), "") << header;
}

TEST(RevokedTokens, EndTheStreamsOfTheirCallers) {
  const files::TempFolder folder;
  const auto tokens = folder.write("tokens", "ann secret-of-ann-16\nbob secret-of-bob-16\n");
  LoggedServer server(
      {.listen = {"127.0.0.1:0"}, .service = {}, .tokens = tokens.string()},
      std::move(*SqliteStore::open({.folder = folder / "data"})),
      [](const auto&, ChunkSink&, weft::Run& run) { return work_until_stopped(run); });
  const auto channel = channel_to(server.address(), grpc::InsecureChannelCredentials());
  const std::string mesh = valid_request().SerializeAsString();
  constexpr const char* kHealth = "/grpc.health.v1.Health/Watch";
  constexpr const char* kMesh = "/weft.v1.MeshService/GenerateMesh";
  const std::string of_ann = "Bearer secret-of-ann-16";
  const std::string of_bob = "Bearer secret-of-bob-16";
  v1::SubmitJobRequest submission;
  *submission.mutable_mesh() = valid_request();
  const auto [status, bytes] =
      raw_unary(channel, "/weft.v1.JobService/SubmitJob", submission.SerializeAsString(), of_bob);
  ASSERT_TRUE(status.ok()) << status.error_message();
  v1::SubmitJobResponse submitted;
  submitted.ParseFromString(bytes);
  v1::WatchJobRequest watch;
  watch.set_id(submitted.job().id());

  RawStream health(channel, kHealth, "", of_bob);
  RawStream job(channel, "/weft.v1.JobService/WatchJob", watch.SerializeAsString(), of_bob);
  RawStream call(channel, kMesh, mesh, of_bob);
  RawStream of_another(channel, kHealth, "", of_ann);
  RawStream of_nobody(channel, kHealth, "");
  for (RawStream* const each : {&health, &job, &call, &of_another, &of_nobody})
    ASSERT_TRUE(each->read());
  std::filesystem::rename(folder.write("new", "ann secret-of-ann-16\n"), tokens);
  server->reload();
  for (RawStream* const each : {&health, &job, &call}) {
    const grpc::Status ended = each->end();
    EXPECT_EQ(ended.error_code(), StatusCode::UNAUTHENTICATED) << ended.error_message();
  }
  EXPECT_EQ(raw_unary(channel, "/weft.v1.MeshService/GetServerInfo", "", of_ann).first.error_code(),
            StatusCode::OK);
  server->drain(std::chrono::seconds(0));
  EXPECT_NE(of_another.end().error_code(), StatusCode::UNAUTHENTICATED);
  EXPECT_NE(of_nobody.end().error_code(), StatusCode::UNAUTHENTICATED);
}

}  // namespace
}  // namespace weft::server::testing
