// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/fleet.h"

#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>

#include "client/call/mesh_call.h"
#include "files/formats/domain_formats.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "tests/support/connected.h"

namespace weft::e2e {
namespace {

constexpr int kMaxJobs = 1000;  // of one test

std::string digest_of_mesh(v1::JobService::Stub& stub, const std::string& id) {
  v1::FetchMeshRequest request;
  request.set_id(id);
  grpc::ClientContext context;
  const auto reader = stub.FetchMesh(&context, request);
  v1::FetchMeshResponse message;
  std::string digest = digest_of_stream(*reader, message);
  EXPECT_TRUE(reader->Finish().ok());
  return digest;
}

int count(v1::JobService::Stub& stub) {
  v1::ListJobsRequest request;
  request.set_page_size(kMaxJobs);
  grpc::ClientContext context;
  v1::ListJobsResponse response;
  EXPECT_TRUE(stub.ListJobs(&context, request, &response).ok());
  return response.jobs_size();
}

}  // namespace

int few_or_many(int few, int many) {
  return std::getenv("WEFT_SOAK") == nullptr ? few : many;
}

std::shared_ptr<grpc::Channel> connect(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetInt("grpc.use_local_subchannel_pool", 1);
  return connected(
      grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
}

v1::GenerateMeshRequest repeated_request(int number) {
  static const auto domain = files::read_domain(model("cylinder.poly")).value();
  client::RequestOptions request_options;
  request_options.size = std::to_string(0.12 / (1 + number % 20));
  return client::make_request(domain, request_options);
}

v1::GenerateMeshRequest mixed_request(int number) {
  struct Kind {
    files::Domain domain;
    double largest;  // size
  };
  const auto kind = [](const char* name, double largest) {
    return Kind{files::read_domain(model(name)).value(), largest};
  };
  static const std::array kinds{kind("cylinder.poly", 0.4), kind("pipe.poly", 20),
                                kind("key.poly", 0.3), kind("us-east-coast.poly", 0.1)};
  const Kind& chosen = kinds[static_cast<std::size_t>(number) % kinds.size()];
  client::RequestOptions request_options;
  request_options.size = std::to_string(chosen.largest / (1 + number % 23 + 1e-3 * number));
  return client::make_request(chosen.domain, request_options);
}

v1::Summary Reference::summary(const v1::GenerateMeshRequest& request) {
  std::lock_guard lock(mutex_);
  v1::Summary& summary = summaries_[request.SerializeAsString()];
  if (!summary.sha256().empty()) return summary;
  const auto stub = v1::MeshService::NewStub(connect(server_.address()));
  grpc::ClientContext context;
  const auto reader = stub->GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  const std::string digest = digest_of_stream(*reader, message);
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_FALSE(digest.empty());
  return summary = message.summary();
}

bool is_full(const grpc::Status& status) {
  google::rpc::Status details;
  if (status.error_code() != grpc::RESOURCE_EXHAUSTED ||
      !details.ParseFromString(status.error_details()))
    return false;
  return std::any_of(
      details.details().begin(), details.details().end(),
      [](const google::protobuf::Any& detail) { return detail.Is<google::rpc::RetryInfo>(); });
}

std::optional<v1::Job> wait_for_job(v1::JobService::Stub& stub, const std::string& id) {
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

std::string sha256(const std::string& bytes) {
  std::string digest(32, '\0');
  EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(digest.data()), nullptr,
             EVP_sha256(), nullptr);
  return digest;
}

bool Jobs::submit(const std::string& address) {
  const int number = next_;
  const auto stub = v1::JobService::NewStub(connect(address));
  v1::SubmitJobRequest request;
  *request.mutable_mesh() = requests_(number);
  request.set_request_id("job " + std::to_string(number));
  v1::SubmitJobResponse response;
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
  if (!stub->SubmitJob(&context, request, &response).ok()) return false;
  ids_[number] = response.job().id();
  ++next_;
  return true;
}

std::optional<int> Jobs::ended(const std::string& address) {
  v1::ListJobsRequest request;
  for (const v1::JobState state :
       {v1::JOB_STATE_SUCCEEDED, v1::JOB_STATE_FAILED, v1::JOB_STATE_CANCELLED})
    request.add_states(state);
  request.set_page_size(kMaxJobs);
  grpc::ClientContext context;
  v1::ListJobsResponse response;
  const auto stub = v1::JobService::NewStub(connect(address));
  if (!stub->ListJobs(&context, request, &response).ok()) return std::nullopt;
  return response.jobs_size();
}

Tally Jobs::settle(const std::string& address, Reference& reference) {
  const auto stub = v1::JobService::NewStub(connect(address));
  Tally tally;
  tally.accepted = static_cast<int>(ids_.size());
  for (const auto& [number, id] : ids_) {
    const std::optional<v1::Job> job = wait_for_job(*stub, id);
    if (!job || job->state() != v1::JOB_STATE_SUCCEEDED) {
      ADD_FAILURE() << "job " << number << ": " << (job ? job->DebugString() : "is not there");
      ++tally.lost;
      continue;
    }
    tally.attempts += static_cast<int>(job->attempts());
    if (digest_of_mesh(*stub, id) != reference.digest(requests_(number))) ++tally.wrong;
  }
  tally.duplicated = count(*stub) - tally.accepted;
  std::printf("accepted %d, lost %d, duplicated %d, wrong %d; %d attempts\n", tally.accepted,
              tally.lost, tally.duplicated, tally.wrong, tally.attempts);
  return tally;
}

void expect_all_well(const Tally& tally, int accepted) {
  EXPECT_EQ(tally.accepted, accepted);
  EXPECT_EQ(tally.lost, 0);
  EXPECT_EQ(tally.duplicated, 0);
  EXPECT_EQ(tally.wrong, 0);
}

}  // namespace weft::e2e
