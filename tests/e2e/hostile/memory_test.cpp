// SPDX-License-Identifier: Apache-2.0
// Work that is far heavier than it looks: it takes no memory beyond --memory, and does not delay
// those whose work is light.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/e2e/fleet.h"

namespace weft::e2e {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

v1::GenerateMeshRequest square() {
  v1::GenerateMeshRequest request;
  request.set_no_cache(true);
  for (const double x : {0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0})
    request.mutable_domain()->add_points(x);
  for (const std::uint32_t i : {0u, 1u, 1u, 2u, 2u, 3u, 3u, 0u})
    request.mutable_domain()->add_segments(i);
  return request;
}

// A region that is finer than anything else suggests: 170 M triangles.
v1::GenerateMeshRequest region_of_crumbs() {
  v1::GenerateMeshRequest request = square();
  v1::Region& region = *request.mutable_domain()->add_regions();
  region.set_x(0.5);
  region.set_y(0.5);
  region.set_max_area(1e-8);
  return request;
}

// A spike between the middles of the picture's cells: 20 M triangles on a thousandth of the square.
v1::GenerateMeshRequest spike() {
  v1::GenerateMeshRequest request = square();
  request.mutable_size()->set_expression("hypot(x-0.5,y-0.5)<0.0065?4e-12:0.01");
  return request;
}

grpc::Status call(const std::string& address, const v1::GenerateMeshRequest& request) {
  const auto stub = v1::MeshService::NewStub(connect(address));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(2));
  const auto reader = stub->GenerateMesh(&context, request);
  v1::GenerateMeshResponse message;
  while (reader->Read(&message)) continue;
  return reader->Finish();
}

// What callers of that work do if they come six at a time, and what happens to others meanwhile.
void expect_bounds_against(const v1::GenerateMeshRequest& hostile) {
  const Server server({"--memory", "300MiB", "--cache-bytes", "0"});
  std::vector<std::thread> callers;
  std::vector<grpc::Status> statuses(6);
  std::atomic<int> at_work{0};
  for (grpc::Status& status : statuses) {
    ++at_work;
    callers.emplace_back([&] {
      status = call(server.address(), hostile);
      --at_work;
    });
  }
  v1::GenerateMeshRequest light = square();
  light.mutable_size()->set_constant(1e-3);
  std::vector<double> seconds;
  while (at_work > 0) {
    const auto begun = std::chrono::steady_clock::now();
    const grpc::Status status = call(server.address(), light);
    EXPECT_TRUE(status.ok()) << status.error_message();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
  }
  for (std::thread& caller : callers) caller.join();
  for (const grpc::Status& status : statuses)
    EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED) << status.error_message();
  std::sort(seconds.begin(), seconds.end());
  EXPECT_LT(seconds[seconds.size() / 2], 5.0) << "of " << seconds.size() << ", on a busy machine";
  EXPECT_LT(seconds.back(), 20.0) << seconds.size() << " light calls";
  if (kMemoryTells) {
    EXPECT_LT(server.peak_bytes(), 450 * kMiB);  // 250 MiB on two cores
  }
}

TEST(HostileWork, OfARegionOfCrumbsStaysWithinTheMemory) {
  expect_bounds_against(region_of_crumbs());
}

TEST(HostileWork, OfASpikeBetweenTheSamplesStaysWithinTheMemory) {
  expect_bounds_against(spike());
}

// Within all limits, and more than there is for runs.
v1::GenerateMeshRequest large_raster() {
  constexpr std::uint32_t kSide = 4096;
  v1::GenerateMeshRequest request = square();
  v1::Raster& raster = *request.mutable_size()->mutable_raster();
  raster.set_dx(1.0 / (kSide - 1));
  raster.set_dy(1.0 / (kSide - 1));
  raster.set_columns(kSide);
  raster.set_rows(kSide);
  raster.mutable_values()->Resize(kSide * kSide, 1e-3);
  return request;
}

TEST(HostileWork, ThatCanNeverBeginIsRefusedAndNobodyWaitsBehindIt) {
  const Folder folder;
  const Server server({"--memory", "512MiB", "--data", (folder.path() / "data").string()});
  const v1::GenerateMeshRequest large = large_raster();
  const grpc::Status refused = call(server.address(), large);
  EXPECT_EQ(refused.error_code(), grpc::RESOURCE_EXHAUSTED) << refused.error_message();
  EXPECT_NE(refused.error_message().find("limit"), std::string::npos) << refused.error_message();
  EXPECT_FALSE(is_full(refused)) << "it asks the client to come again";
  EXPECT_TRUE(call(server.address(), square()).ok());
  v1::SubmitJobRequest submission;
  *submission.mutable_mesh() = large;
  v1::SubmitJobResponse submitted;
  grpc::ClientContext context;
  const grpc::Status job = v1::JobService::NewStub(connect(server.address()))
                               ->SubmitJob(&context, submission, &submitted);
  EXPECT_EQ(job.error_code(), grpc::RESOURCE_EXHAUSTED) << job.error_message();
  EXPECT_FALSE(is_full(job));
  EXPECT_TRUE(call(server.address(), square()).ok());
}

}  // namespace
}  // namespace weft::e2e
