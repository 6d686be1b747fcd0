// SPDX-License-Identifier: Apache-2.0
// A crowd of clients at one server: each gets the right mesh, or its own cancellation or deadline,
// or hears that the server is full and when to come again. Nothing of them stays behind.
#include <grpcpp/client_context.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "tests/e2e/fleet.h"
#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

using std::chrono::milliseconds;

#ifdef WEFT_SANITIZED  // everything is ten times slower
constexpr int kClients = 24;
#else
constexpr int kClients = 200;
#endif

// How calls ended. All kinds are allowed except `wrong`.
struct Tally {
  std::atomic<int> meshes{0};
  std::atomic<int> cancelled{0};
  std::atomic<int> late{0};
  std::atomic<int> refused{0};
  std::atomic<int> wrong{0};
};

// A client of its own connection that wants one mesh, by one of the ways there are.
class Client {
 public:
  Client(const std::string& address, int number, Reference& reference, Tally& tally)
      : channel_(connect(address)),
        number_(number),
        random_(static_cast<std::uint64_t>(number)),
        request_(mixed_request(number)),
        reference_(reference),
        tally_(tally) {}

  void run() {
    switch (number_ % 5) {
      case 0:
        return generate();
      case 1:
        return generate_and_cancel();
      case 2:
        return generate_in_time();
      case 3:
        return generate_and_read_slowly();
      default:
        return number_ % 2 == 0 ? submit() : submit_and_cancel();
    }
  }

 private:
  void generate() {
    grpc::ClientContext context;
    judge(
        call(context), [](const grpc::Status&) { return false; }, tally_.wrong);
  }

  // After some messages.
  void generate_and_cancel() {
    grpc::ClientContext context;
    const int last = static_cast<int>(random_() % 4);
    judge(
        call(context,
             [&](int messages) {
               if (messages == last) context.TryCancel();
             }),
        [](const grpc::Status& status) { return status.error_code() == grpc::CANCELLED; },
        tally_.cancelled);
  }

  void generate_and_read_slowly() {
    grpc::ClientContext context;
    judge(
        call(context, [&](int) { std::this_thread::sleep_for(milliseconds(random_() % 20)); }),
        [](const grpc::Status&) { return false; }, tally_.wrong);
  }

  void generate_in_time() {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + milliseconds(1 + random_() % 250));
    judge(
        call(context),
        [](const grpc::Status& status) { return status.error_code() == grpc::DEADLINE_EXCEEDED; },
        tally_.late);
  }

  void submit() {
    const std::string id = submit_job();
    if (id.empty()) return;
    const auto job = wait_for_job(*jobs_, id);
    grpc::ClientContext context;
    v1::FetchMeshRequest fetch;
    fetch.set_id(id);
    v1::FetchMeshResponse message;
    const auto reader = jobs_->FetchMesh(&context, fetch);
    const std::string digest = digest_of_stream(*reader, message);
    const bool right = reader->Finish().ok() && digest == reference_.digest(request_);
    ++(right ? tally_.meshes : tally_.wrong);
  }

  void submit_and_cancel() {
    const std::string id = submit_job();
    if (id.empty()) return;
    std::this_thread::sleep_for(milliseconds(random_() % 200));
    grpc::ClientContext context;
    v1::CancelJobRequest cancel;
    cancel.set_id(id);
    v1::CancelJobResponse response;
    if (!jobs_->CancelJob(&context, cancel, &response).ok()) {
      ++tally_.wrong;
      return;
    }
    const v1::JobState state = response.job().state();
    ++(state == v1::JOB_STATE_CANCELLED   ? tally_.cancelled
       : state == v1::JOB_STATE_SUCCEEDED ? tally_.meshes
                                          : tally_.wrong);
  }

  // Empty if the server is full.
  std::string submit_job() {
    v1::SubmitJobRequest request;
    *request.mutable_mesh() = request_;
    request.set_request_id(std::to_string(number_));
    v1::SubmitJobResponse response;
    grpc::ClientContext context;
    const grpc::Status status = jobs_->SubmitJob(&context, request, &response);
    if (status.ok()) return response.job().id();
    ++(is_full(status) ? tally_.refused : tally_.wrong);
    return "";
  }

  struct Answer {
    grpc::Status status;
    std::string digest;
  };

  // `each` is told how many messages have come, from 0 on.
  template <class Each>
  Answer call(grpc::ClientContext& context, Each&& each) {
    const auto reader = v1::MeshService::NewStub(channel_)->GenerateMesh(&context, request_);
    v1::GenerateMeshResponse message;
    std::string digests;
    for (int messages = 0; each(messages), reader->Read(&message); ++messages)
      if (message.has_chunk()) digests += message.chunk().sha256();
    grpc::Status status = reader->Finish();
    if (!status.ok()) return {std::move(status), ""};
    return {grpc::Status::OK, sha256(digests) == message.summary().sha256() ? sha256(digests) : ""};
  }
  Answer call(grpc::ClientContext& context) {
    return call(context, [](int) {});
  }

  template <class IsOwnEnd>
  void judge(const Answer& answer, IsOwnEnd&& is_own_end, std::atomic<int>& own_ends) {
    const grpc::Status& status = answer.status;
    if (status.ok()) {
      ++(answer.digest == reference_.digest(request_) ? tally_.meshes : tally_.wrong);
    } else if (is_full(status)) {
      ++tally_.refused;
    } else {
      EXPECT_TRUE(is_own_end(status))
          << number_ << ": " << status.error_code() << " " << status.error_message();
      ++(is_own_end(status) ? own_ends : tally_.wrong);
    }
  }

  const std::shared_ptr<grpc::Channel> channel_;
  const std::unique_ptr<v1::JobService::Stub> jobs_ = v1::JobService::NewStub(channel_);
  const int number_;
  std::mt19937_64 random_;
  const v1::GenerateMeshRequest request_;
  Reference& reference_;
  Tally& tally_;
};

TEST(Load, OfManyClientsAtOnceGivesEachItsDueAndLeavesNothingBehind) {
  const Folder folder;
  // Few of each, so that some are refused.
  const Server server({"--data", folder / "data", "--metrics", "127.0.0.1:0", "--threads", "2",
                       "--queue", std::to_string(kClients / 3), "--max-queued",
                       std::to_string(kClients / 8)});
  Reference reference;
  Tally tally;
  std::vector<std::thread> clients;
  for (int i = 0; i < kClients; ++i)
    clients.emplace_back([&, i] { Client(server.address(), i, reference, tally).run(); });
  for (std::thread& client : clients) client.join();
  std::printf("%d clients: %d meshes, %d cancelled, %d past their deadline, %d refused, %d wrong\n",
              kClients, tally.meshes.load(), tally.cancelled.load(), tally.late.load(),
              tally.refused.load(), tally.wrong.load());
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_EQ(tally.meshes + tally.cancelled + tally.late + tally.refused, kClients);
  EXPECT_GT(tally.meshes, 0);

  // The tasks of jobs that nobody cancelled go on; in the end everything is given back.
  for (const char* queue : {"calls", "jobs"})
    for (const char* figure : {"weft_queue_length", "weft_running_jobs", "weft_admission_bytes"})
      EXPECT_TRUE(server.shows(std::string(figure) + "{queue=\"" + queue + "\"}", 0))
          << figure << " of " << queue;
  EXPECT_EQ(run_weft({"health", "--server", server.address()}).exit_code, 0);
  Tally after;
  Client(server.address(), 0, reference, after).run();
  EXPECT_EQ(after.meshes, 1);
}

}  // namespace
}  // namespace weft::e2e
