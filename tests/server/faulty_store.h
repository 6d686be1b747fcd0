// SPDX-License-Identifier: Apache-2.0
// A store that fails when the test says so, and is a real one otherwise.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/store/job_store.h"

namespace weft::server::testing {

class FaultyStore final : public JobStore {
 public:
  // Asked before each call, by its name; an error is the call's answer.
  using Fault = std::function<std::optional<StoreError>(std::string_view call)>;

  FaultyStore(std::unique_ptr<JobStore> store, Fault fault)
      : store_(std::move(store)), fault_(std::move(fault)) {}

  StoreResult<Submitted> submit(const Submission& submission) override {
    return unless<Submitted>("submit", [&] { return store_->submit(submission); });
  }
  StoreResult<std::optional<JobRecord>> get(const std::string& owner,
                                            const std::string& id) override {
    return unless<std::optional<JobRecord>>("get", [&] { return store_->get(owner, id); });
  }
  StoreResult<std::vector<JobRecord>> list(const ListQuery& query) override {
    return unless<std::vector<JobRecord>>("list", [&] { return store_->list(query); });
  }
  StoreResult<std::optional<JobRecord>> cancel(const std::string& owner,
                                               const std::string& id) override {
    return unless<std::optional<JobRecord>>("cancel", [&] { return store_->cancel(owner, id); });
  }
  StoreResult<std::optional<JobRecord>> remove(const std::string& owner,
                                               const std::string& id) override {
    return unless<std::optional<JobRecord>>("remove", [&] { return store_->remove(owner, id); });
  }
  StoreResult<std::optional<StoredMesh>> mesh(const std::string& key) override {
    return unless<std::optional<StoredMesh>>("mesh", [&] { return store_->mesh(key); });
  }
  StoreResult<std::optional<std::string>> chunk(const std::string& sha256) override {
    return unless<std::optional<std::string>>("chunk", [&] { return store_->chunk(sha256); });
  }
  StoreResult<std::optional<Claim>> claim(const std::string& worker,
                                          std::chrono::milliseconds lease,
                                          std::uint64_t max_estimate,
                                          const std::vector<std::string>& except) override {
    return unless<std::optional<Claim>>(
        "claim", [&] { return store_->claim(worker, lease, max_estimate, except); });
  }
  StoreResult<Held> renew(const ClaimRef& claim, std::chrono::milliseconds lease,
                          const std::string& progress) override {
    return unless<Held>("renew", [&] { return store_->renew(claim, lease, progress); });
  }
  StoreResult<std::uint64_t> drop_damaged(const std::string& sha256,
                                          std::string_view bytes) override {
    return unless<std::uint64_t>("drop_damaged",
                                 [&] { return store_->drop_damaged(sha256, bytes); });
  }
  StoreResult<bool> put_chunk(const std::string& sha256, std::string_view bytes) override {
    return unless<bool>("put_chunk", [&] { return store_->put_chunk(sha256, bytes); });
  }
  StoreResult<Held> finish(const ClaimRef& claim, const StoredMesh& mesh) override {
    return unless<Held>("finish", [&] { return store_->finish(claim, mesh); });
  }
  StoreResult<Held> fail(const ClaimRef& claim, const std::string& error) override {
    return unless<Held>("fail", [&] { return store_->fail(claim, error); });
  }
  StoreResult<Held> release(const ClaimRef& claim, std::chrono::milliseconds delay,
                            bool counts) override {
    return unless<Held>("release", [&] { return store_->release(claim, delay, counts); });
  }
  StoreResult<std::optional<JobRecord>> claim_callback(
      std::chrono::milliseconds lease, const std::vector<std::string>& except_owners,
      const std::vector<std::string>& except_places) override {
    return unless<std::optional<JobRecord>>("claim_callback", [&] {
      return store_->claim_callback(lease, except_owners, except_places);
    });
  }
  StoreResult<Held> settle_callback(const JobRecord& claimed, CallbackState state,
                                    const std::string& error,
                                    std::chrono::milliseconds delay) override {
    return unless<Held>("settle_callback",
                        [&] { return store_->settle_callback(claimed, state, error, delay); });
  }
  StoreResult<Reaped> reap(const RetryPolicy& policy) override {
    return unless<Reaped>("reap", [&] { return store_->reap(policy); });
  }
  StoreResult<Collected> collect(const KeepPolicy& policy) override {
    return unless<Collected>("collect", [&] { return store_->collect(policy); });
  }
  StoreResult<StoreStats> stats() override {
    return unless<StoreStats>("stats", [&] { return store_->stats(); });
  }
  void on_change(std::function<void()> listener) override {
    store_->on_change(std::move(listener));
  }

 private:
  template <class T, class F>
  StoreResult<T> unless(std::string_view name, F&& call) {
    if (auto error = fault_(name)) return tl::unexpected(*error);
    return call();
  }

  std::unique_ptr<JobStore> store_;
  Fault fault_;
};

}  // namespace weft::server::testing
