// SPDX-License-Identifier: Apache-2.0
#include "tests/e2e/hostile/bystander.h"

#include <grpcpp/client_context.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::e2e {

Bystander::Bystander(std::shared_ptr<grpc::Channel> channel, std::string token)
    : thread_([this, channel = std::move(channel), token = std::move(token)] {
        ask(channel, token);
      }) {}

void Bystander::stop() {
  stopping_ = true;
  if (!thread_.joinable()) return;
  thread_.join();
  std::sort(seconds_.begin(), seconds_.end());
}

double Bystander::seconds_of(double share) const {
  return seconds_[static_cast<std::size_t>(share * static_cast<double>(seconds_.size() - 1))];
}

void Bystander::ask(const std::shared_ptr<grpc::Channel>& channel, const std::string& token) {
  using Clock = std::chrono::steady_clock;
  const auto stub = v1::MeshService::NewStub(channel);
  while (!stopping_) {
    const Clock::time_point begin = Clock::now();
    grpc::ClientContext context;
    context.AddMetadata("authorization", "Bearer " + token);
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1));
    v1::GetServerInfoResponse info;
    if (!stub->GetServerInfo(&context, {}, &info).ok()) ++failures_;
    seconds_.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace weft::e2e
