// SPDX-License-Identifier: GPL-3.0-or-later
// Servers that are killed, frozen and replaced at any moment while they make meshes: every job that
// was accepted succeeds, once, with the mesh that an undisturbed server makes.
#include <google/protobuf/util/message_differencer.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "client/formats/domain_formats.h"
#include "client/formats/mesh_formats.h"
#include "client/mesh_call.h"
#include "tests/e2e/programs.h"
#include "tests/support/postgres.h"
#include "weft/v1/job_service.grpc.pb.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::e2e {
namespace {

using std::chrono::milliseconds;

#ifdef WEFT_SANITIZED  // everything is ten times slower
constexpr int kRounds = 2;
#else
constexpr int kRounds = 8;
#endif
constexpr int kJobsARound = 4;

std::shared_ptr<grpc::Channel> connect(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt("grpc.use_local_subchannel_pool", 1);  // a connection of its own
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

// Meshes of 10,000 to 200,000 triangles, most of them asked for more than once.
v1::GenerateMeshRequest request_number(int number) {
  client::MeshWishes wishes;
  wishes.size = std::to_string(20.0 / (10'000 * (1 + number % 20)) * 60);
  return client::make_request(client::read_domain(model("cylinder.poly")).value(), wishes);
}

// The digest that an undisturbed server gives, by the request's number.
class Reference {
 public:
  const std::string& digest(int number) {
    std::string& digest = digests_[number % 20];
    if (!digest.empty()) return digest;
    const auto stub = v1::MeshService::NewStub(connect(server_.address()));
    grpc::ClientContext context;
    const auto reader = stub->GenerateMesh(&context, request_number(number));
    v1::GenerateMeshResponse message;
    while (reader->Read(&message)) continue;
    EXPECT_TRUE(reader->Finish().ok());
    return digest = message.summary().sha256();
  }

 private:
  Server server_;
  std::map<int, std::string> digests_;
};

std::string sha256(const std::string& bytes) {
  std::string digest(32, '\0');
  EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(digest.data()), nullptr,
             EVP_sha256(), nullptr);
  return digest;
}

// What became of all jobs.
struct Tally {
  int accepted = 0;
  int lost = 0;
  int duplicated = 0;
  int wrong = 0;
  int attempts = 0;
};

class Jobs {
 public:
  // Submits one more job, and once more where the answer is lost. False where no server answers.
  bool submit(const std::string& address) {
    const int number = next_;
    const auto stub = v1::JobService::NewStub(connect(address));
    v1::SubmitJobRequest request;
    *request.mutable_mesh() = request_number(number);
    request.set_request_id("job " + std::to_string(number));
    v1::SubmitJobResponse response;
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
    if (!stub->SubmitJob(&context, request, &response).ok()) return false;
    ids_[number] = response.job().id();
    ++next_;
    return true;
  }

  Tally settle(const std::string& address, Reference& reference) {
    const auto stub = v1::JobService::NewStub(connect(address));
    Tally tally;
    tally.accepted = static_cast<int>(ids_.size());
    for (const auto& [number, id] : ids_) {
      const std::optional<v1::Job> job = wait(*stub, id);
      if (!job || job->state() != v1::JOB_STATE_SUCCEEDED) {
        ADD_FAILURE() << "job " << number << ": " << (job ? job->DebugString() : "is not there");
        ++tally.lost;
        continue;
      }
      tally.attempts += static_cast<int>(job->attempts());
      if (digest_of_mesh(*stub, id) != reference.digest(number)) ++tally.wrong;
    }
    tally.duplicated = count(*stub) - tally.accepted;
    std::printf("accepted %d, lost %d, duplicated %d, wrong %d; %d attempts\n", tally.accepted,
                tally.lost, tally.duplicated, tally.wrong, tally.attempts);
    return tally;
  }

 private:
  static std::optional<v1::Job> wait(v1::JobService::Stub& stub, const std::string& id) {
    v1::WatchJobRequest request;
    request.set_id(id);
    v1::WatchJobResponse message;
    grpc::Status status;
    do {
      grpc::ClientContext context;
      const auto reader = stub.WatchJob(&context, request);
      while (reader->Read(&message)) continue;
      status = reader->Finish();
    } while (status.error_code() == grpc::UNAVAILABLE);
    if (!status.ok()) return std::nullopt;
    return message.job();
  }

  // Of the chunks as they arrive, so that what is stored is judged and not what is said of it.
  static std::string digest_of_mesh(v1::JobService::Stub& stub, const std::string& id) {
    v1::FetchMeshRequest request;
    request.set_id(id);
    grpc::ClientContext context;
    const auto reader = stub.FetchMesh(&context, request);
    v1::FetchMeshResponse message;
    std::string digests;
    while (reader->Read(&message))
      if (message.has_chunk()) digests += message.chunk().sha256();
    EXPECT_TRUE(reader->Finish().ok());
    EXPECT_EQ(sha256(digests), message.summary().sha256());
    return message.summary().sha256();
  }

  static int count(v1::JobService::Stub& stub) {
    v1::ListJobsRequest request;
    request.set_page_size(1000);
    grpc::ClientContext context;
    v1::ListJobsResponse response;
    EXPECT_TRUE(stub.ListJobs(&context, request, &response).ok());
    return response.jobs_size();
  }

  int next_ = 0;
  std::map<int, std::string> ids_;  // by number
};

void expect_all_well(const Tally& tally) {
  EXPECT_EQ(tally.accepted, kRounds * kJobsARound);
  EXPECT_EQ(tally.lost, 0);
  EXPECT_EQ(tally.duplicated, 0);
  EXPECT_EQ(tally.wrong, 0);
}

// Short, so that a test need not wait for long; as many attempts as there may be kills.
std::vector<std::string> with_store(const std::string& flag, const std::string& where) {
  return {flag, where, "--lease", "1", "--max-attempts", "100"};
}

// The moment at which the server is struck: anywhere in the life of the jobs at hand.
void let_work(std::mt19937_64& random) {
  std::this_thread::sleep_for(milliseconds(random() % 120));
}

TEST(JobCrash, AServerKilledAtAnyMomentLosesNoJob) {
  const Folder folder;
  const auto arguments = with_store("--data", folder / "data");
  std::mt19937_64 random(11);
  Jobs jobs;
  for (int round = 0; round < kRounds; ++round) {
    Server server(arguments);
    for (int i = 0; i < kJobsARound; ++i) ASSERT_TRUE(jobs.submit(server.address()));
    let_work(random);
    server.kill();
  }
  Server server(arguments);
  Reference reference;
  expect_all_well(jobs.settle(server.address(), reference));
}

TEST(JobCrash, ReplicasKilledAtAnyMomentLoseNoJob) {
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::mt19937_64 random(12);
  std::vector<std::unique_ptr<Server>> replicas;
  for (int i = 0; i < 2; ++i) replicas.push_back(std::make_unique<Server>(arguments));
  Jobs jobs;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kJobsARound; ++i)
      ASSERT_TRUE(jobs.submit(replicas[random() % 2]->address()));
    let_work(random);
    auto& struck = replicas[random() % 2];
    struck->kill();
    struck = std::make_unique<Server>(arguments);
  }
  Reference reference;
  expect_all_well(jobs.settle(replicas[0]->address(), reference));
}

TEST(JobCrash, AFrozenReplicaIsFencedOffWhenItComesBack) {
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::mt19937_64 random(13);
  Server frozen(arguments);
  Server other(arguments);
  Jobs jobs;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kJobsARound; ++i) ASSERT_TRUE(jobs.submit(other.address()));
    let_work(random);
    frozen.freeze();
    // Past its lease: what it held is another's then.
    std::this_thread::sleep_for(milliseconds(round % 4 == 0 ? 1500 : 50));
    frozen.thaw();
  }
  Reference reference;
  expect_all_well(jobs.settle(frozen.address(), reference));
}

TEST(JobCrash, ADatabaseThatRestartsLosesNoJob) {
  PostgresServer postgres;
  const auto arguments = with_store("--store", postgres.new_database());
  std::mt19937_64 random(14);
  Server server(arguments);
  Jobs jobs;
  for (int round = 0; round < kRounds; ++round) {
    for (int i = 0; i < kJobsARound; ++i)
      while (!jobs.submit(server.address())) continue;
    let_work(random);
    if (round % 2 == 0) {
      postgres.kill();
      postgres.start();
    } else {
      postgres.restart();
    }
  }
  Reference reference;
  expect_all_well(jobs.settle(server.address(), reference));
}

}  // namespace
}  // namespace weft::e2e
