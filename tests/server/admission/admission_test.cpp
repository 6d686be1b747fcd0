// SPDX-License-Identifier: Apache-2.0
// How calls come in: who is asked what, how much and how long he may send, what is logged of it.
#include "server/admission/admission.h"

#include <thread>

#include "tests/files/support/temp_folder.h"
#include "tests/server/job_harness.h"
#include "tests/server/logged_server.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Bidi = grpc::ClientReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>;

constexpr const char* kInfo = "/weft.v1.MeshService/GetServerInfo";
constexpr const char* kCheck = "/grpc.health.v1.Health/Check";

ServerOptions local() {
  return {.listen = {"127.0.0.1:0"}, .service = {}};
}

std::shared_ptr<grpc::Channel> plain(const LoggedServer& server) {
  return channel_to(server.address(), grpc::InsecureChannelCredentials());
}

std::size_t times(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// A call whose message never comes.
grpc::Status never_ending(const LoggedServer& server, const char* method) {
  const auto channel = plain(server);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(30));
  const grpc::internal::RpcMethod rpc(method, grpc::internal::RpcMethod::BIDI_STREAMING, channel);
  const std::unique_ptr<Bidi> stream(
      grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, grpc::ByteBuffer>::Create(
          channel.get(), rpc, &context));
  grpc::ByteBuffer none;
  EXPECT_FALSE(stream->Read(&none));
  return stream->Finish();
}

TEST(Admission, GivesUpAMessageThatDoesNotCome) {
  ServerOptions options = local();
  options.admission.request_timeout = milliseconds(100);
  LoggedServer server(options);
  for (const char* method : {kInfo, "/weft.v1.MeshService/GenerateMesh", kCheck}) {
    const grpc::Status status = never_ending(server, method);
    EXPECT_EQ(status.error_code(), grpc::DEADLINE_EXCEEDED) << method;
    EXPECT_NE(status.error_message().find("did not arrive within 0.1 s"), std::string::npos)
        << status.error_message();
  }
  EXPECT_TRUE(ask(plain(server)).ok());
  server->drain(seconds(5));
  EXPECT_FALSE(server.log().contains("reason=STOPPING")) << "a call was kept";
}

TEST(Admission, RefusesAStrangerBeforeHisMessageComes) {
  const files::TempFolder folder;
  ServerOptions options = local();
  options.tokens = folder.write("tokens", "ann secret-of-ann-16\n").string();
  LoggedServer server(options);
  EXPECT_EQ(never_ending(server, kInfo).error_code(), grpc::UNAUTHENTICATED);
  EXPECT_EQ(never_ending(server, "/weft.v1.MeshService/GenerateMesh").error_code(),
            grpc::UNAUTHENTICATED);
}

TEST(Admission, TellsAStrangerOfTheWholeServerWithoutReadingHisMessage) {
  const files::TempFolder folder;
  ServerOptions options = local();
  options.tokens = folder.write("tokens", "ann secret-of-ann-16\n").string();
  LoggedServer server(options);
  const auto [status, answer] = raw_unary(plain(server), kCheck, std::string(100'000, '\xff'));
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_EQ(answer, std::string("\x08\x01", 2));
}

TEST(Admission, KeepsSmallRequestsSmall) {
  LoggedServer server(local());
  const std::string unknown(kSmallRequest / 2, '\x78');  // field 15, a number, of 0x78
  EXPECT_TRUE(raw_unary(plain(server), kInfo, unknown + unknown).first.ok());
  const grpc::Status status = raw_unary(plain(server), kInfo, unknown + unknown + "\x78\x78").first;
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_EQ(status.error_message(),
            "the request has 65538 bytes; the limit of GetServerInfo is 65536");
}

TEST(Admission, CountsRefusalsThatItDoesNotLog) {
  const files::TempFolder folder;
  ServerOptions options = local();
  options.tokens = folder.write("tokens", "ann secret-of-ann-16\n").string();
  options.admission.refusal_lines = 3;
  LoggedServer server(options);
  const auto channel = plain(server);
  for (int i = 0; i < 200; ++i) EXPECT_FALSE(ask(channel).ok());
  EXPECT_TRUE(eventually([&] { return server.log().contains("event=lines_left_out count="); }));
  EXPECT_LE(times(server.log().text(), "event=call_refused"), 100u);
}

grpc::Status mesh(const LoggedServer& server, const v1::GenerateMeshRequest& request) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + seconds(60));
  const auto stub = v1::MeshService::NewStub(plain(server));
  const auto reader = stub->GenerateMesh(&context, request);
  for (v1::GenerateMeshResponse response; reader->Read(&response);) continue;
  return reader->Finish();
}

TEST(Admission, CountsFailuresOfCallsThatItDoesNotLog) {
  ServerOptions options = local();
  options.admission.refusal_lines = 3;
  LoggedServer server(options);
  v1::GenerateMeshRequest request = valid_request();
  request.set_first_chunk(1);  // the mesh has none
  for (int i = 0; i < 100; ++i) EXPECT_EQ(mesh(server, request).error_code(), grpc::OUT_OF_RANGE);
  EXPECT_TRUE(eventually([&] { return server.log().contains("event=lines_left_out count="); }));
  EXPECT_LE(times(server.log().text(), "event=call_ended"), 60u);
}

TEST(Admission, HoldsMemoryForWhatIsParsedInsteadOfItsMessage) {
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
  Log log;
  Metrics metrics("", "");
  const Authenticator everybody(nullptr);
  MemoryBudget budget({.capacity = 100 * kMiB}, [] {});
  Admission admission({.request_bytes = 10 * kMiB, .memory = &budget}, everybody, metrics,
                      log.logger());
  AdmittedCall first{};
  AdmittedCall second{};
  EXPECT_FALSE(admission.reserve(first, 4 * kMiB, "domain"));
  EXPECT_FALSE(admission.reserve(first, 8 * kMiB, "domain"));
  EXPECT_EQ(budget.reserved(), 8 * kMiB);
  const auto failure = admission.reserve(second, 4 * kMiB, "domain");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->reason, Reason::kOutOfMemory);
  EXPECT_FALSE(admission.reserve(first, 2 * kMiB, "domain"));
  EXPECT_FALSE(admission.reserve(second, 4 * kMiB, "domain"));
  EXPECT_EQ(budget.reserved(), 6 * kMiB);
}

TEST(Admission, RefusesARequestThatIsLargerThanWhatThereIsForAllRuns) {
  Log log;
  Metrics metrics("", "");
  const Authenticator everybody(nullptr);
  MemoryBudget budget({.capacity = 1000'000}, [] {});
  Admission admission({.request_bytes = 2000'000, .memory = &budget}, everybody, metrics,
                      log.logger());
  AdmittedCall call{};
  const auto failure = admission.reserve(call, 1000'001, "size");
  ASSERT_TRUE(failure);
  EXPECT_EQ(failure->reason, Reason::kLimitExceeded);
  EXPECT_EQ(failure->field, "size");
  EXPECT_EQ(failure->message,
            "the request takes 1000001 bytes; this server's limit for requests and runs is "
            "1000000");
  EXPECT_FALSE(admission.reserve(call, 1000'000, "size"));
}

// Within all limits, but the raster and what is made of it take more than there is for runs.
v1::GenerateMeshRequest raster_of(int side) {
  v1::GenerateMeshRequest request = valid_request();
  v1::Raster& raster = *request.mutable_size()->mutable_raster();
  raster.set_dx(1);
  raster.set_dy(1);
  raster.set_columns(side);
  raster.set_rows(side);
  raster.mutable_values()->Resize(side * side, 1);
  return request;
}

ServerOptions of_160_mebibytes() {  // 59 for runs, 64 for messages
  ServerOptions options = local();
  options.memory = std::uint64_t{160} << 20;
  options.service.cache_bytes = 0;
  options.service.limits.max_request_bytes = std::size_t{32} << 20;
  return options;
}

TEST(Admission, RefusesACallThatCanNeverBegin) {
  LoggedServer server(of_160_mebibytes());
  const grpc::Status refused = mesh(server, raster_of(1800));
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED);
  const Details details = details_of(refused);
  EXPECT_EQ(details.error_info.reason(), "LIMIT_EXCEEDED") << refused.error_message();
  EXPECT_FALSE(details.retry_info);
  ASSERT_TRUE(details.bad_request);
  EXPECT_EQ(details.bad_request->field_violations(0).field(), "size");
  EXPECT_TRUE(mesh(server, valid_request()).ok()) << "others wait behind it";
  EXPECT_TRUE(mesh(server, raster_of(1000)).ok());
}

TEST(Admission, RefusesAJobThatCanNeverBegin) {
  const files::TempFolder folder;
  LoggedServer server(of_160_mebibytes(), *SqliteStore::open({.folder = folder.path().string()}));
  JobClient client(channel_to(server.address(), grpc::InsecureChannelCredentials()));
  v1::SubmitJobRequest submission;
  *submission.mutable_mesh() = raster_of(1400);
  const grpc::Status refused = client.submit(submission).status;
  EXPECT_EQ(details_of(refused).error_info.reason(), "LIMIT_EXCEEDED") << refused.error_message();
  ASSERT_TRUE(details_of(refused).bad_request);
  EXPECT_EQ(details_of(refused).bad_request->field_violations(0).field(), "size");
  const v1::Job job = client.wait(client.submit(raster_of(900)));
  EXPECT_EQ(job.state(), v1::JOB_STATE_SUCCEEDED);
}

// Two bytes of an empty region become 80.
TEST(Admission, RefusesAMessageWhoseParsedRegionsFindNoMemory) {
  Event works;
  Event may_end;
  ServerOptions options = local();
  options.memory = std::uint64_t{256} << 20;
  options.service.limits.max_request_bytes = std::size_t{4} << 20;  // 32 MiB for messages
  options.service.limits.max_seeds = 1'000'000;
  LoggedServer server(options, nullptr, [&](const auto&, ChunkSink& sink, auto&) {
    works.set();
    EXPECT_TRUE(may_end.wait());
    return send_chunks(sink, 0);
  });
  v1::GenerateMeshRequest many = valid_request();
  for (int i = 0; i < 900'000; ++i) many.mutable_domain()->add_regions();
  std::thread first([&] { EXPECT_TRUE(mesh(server, many).ok()); });
  EXPECT_TRUE(works.wait());
  v1::GenerateMeshRequest few = valid_request();
  for (int i = 0; i < 20'000; ++i) few.mutable_domain()->add_regions();
  ASSERT_LT(few.ByteSizeLong(), kSmallRequest);
  EXPECT_EQ(mesh(server, few).error_message(),
            "other large requests take the memory that there is for them");
  may_end.set();
  first.join();
}

}  // namespace
}  // namespace weft::server::testing
