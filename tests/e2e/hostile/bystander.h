// SPDX-License-Identifier: Apache-2.0
// An honest client that goes on while another one is hostile: it asks again and again, on a
// connection of its own, and remembers how long each answer took.
#pragma once

#include <grpcpp/channel.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace weft::e2e {

class Bystander {
 public:
  // Asks GetServerInfo with this token until it is destroyed, or `stop` is called.
  Bystander(std::shared_ptr<grpc::Channel> channel, std::string token);
  ~Bystander() { stop(); }
  Bystander(const Bystander&) = delete;
  Bystander& operator=(const Bystander&) = delete;

  void stop();

  // REQUIRES: stopped.
  std::size_t answers() const { return seconds_.size(); }
  std::size_t failures() const { return failures_; }
  // The time that this share of the answers took at most. REQUIRES: there are answers.
  double seconds_of(double share) const;

 private:
  void ask(const std::shared_ptr<grpc::Channel>& channel, const std::string& token);

  std::atomic<bool> stopping_{false};
  std::vector<double> seconds_;  // sorted once it is stopped
  std::size_t failures_ = 0;
  std::thread thread_;
};

}  // namespace weft::e2e
