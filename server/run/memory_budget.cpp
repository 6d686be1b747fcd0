// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_budget.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace weft::server {
namespace {

constexpr std::chrono::milliseconds kPollInterval{20};

// By how much a run would exceed its estimate if it were granted what it wants.
std::uint64_t excess(std::uint64_t wanted, std::uint64_t estimate) {
  return wanted - std::min(wanted, estimate);
}

}  // namespace

std::optional<MemoryBudget::Reservation> MemoryBudget::reserve(const Request& request) {
  MutexLock lock(mutex_);
  if (!fits(request)) return std::nullopt;
  const auto entry = entries_.insert(entries_.end(), Entry{.request = request, .bytes = 0});
  if (entry->is_run()) ++runs_;
  add(*entry,
      std::min(request.estimate, options_.capacity - std::min(reserved_, options_.capacity)));
  return Reservation(*this, entry);
}

std::optional<Error> MemoryBudget::check_fits(std::uint64_t bytes, std::uint64_t input) const {
  const std::uint64_t most =
      options_.capacity - std::min(options_.light_reserve, options_.capacity);
  if (input <= most && bytes <= most - input) return std::nullopt;
  const std::string beside =
      input > 0 ? fmt::format(" beside the {} of its request", input) : std::string();
  return Error{ErrorCode::kLimitExceeded, "",
               fmt::format("the mesh needs more than {} bytes{}; this server's limit for all of "
                           "its runs is {}",
                           bytes, beside, options_.capacity)};
}

bool MemoryBudget::has_share(const std::string& client) const {
  MutexLock lock(mutex_);
  return has_share_now(client);
}

std::uint64_t MemoryBudget::max_estimate(bool light) const {
  MutexLock lock(mutex_);
  return max_estimate_for(light);
}

std::uint64_t MemoryBudget::reserved() const {
  MutexLock lock(mutex_);
  return reserved_;
}

std::size_t MemoryBudget::waiting() const {
  MutexLock lock(mutex_);
  return static_cast<std::size_t>(
      std::count_if(entries_.begin(), entries_.end(),
                    [](const Entry& entry) { return entry.waiting_threads > 0; }));
}

bool MemoryBudget::has_share_now(const std::string& client) const {
  const auto found = of_clients_.find(client);
  return found == of_clients_.end() || found->second < options_.max_per_client;
}

bool MemoryBudget::fits(const Request& request) const {
  if (request.purpose == Purpose::kInput) {
    return entries_.empty() || request.estimate < free_for(false);
  }
  return request.estimate <= max_estimate_for(request.light) && has_share_now(request.client);
}

std::uint64_t MemoryBudget::free_for(bool light) const {
  const std::uint64_t free = options_.capacity - std::min(reserved_, options_.capacity);
  if (light) return free;
  return free - std::min(free, options_.light_reserve -
                                   std::min(options_.light_reserve, reserved_by_light_));
}

std::uint64_t MemoryBudget::max_estimate_for(bool light) const {
  if (runs_ == 0 && free_for(light) > 0) return std::numeric_limits<std::int64_t>::max();
  return free_for(light);
}

void MemoryBudget::add(Entry& entry, std::uint64_t bytes) {
  entry.bytes += bytes;
  reserved_ += bytes;
  if (entry.request.light) reserved_by_light_ += bytes;
  if (entry.is_of_client() && bytes > 0) of_clients_[entry.request.client] += bytes;
}

void MemoryBudget::remove(Entry& entry, std::uint64_t bytes) {
  entry.bytes -= bytes;
  reserved_ -= bytes;
  if (entry.request.light) reserved_by_light_ -= bytes;
  if (!entry.is_of_client() || bytes == 0) return;
  const auto of_client = of_clients_.find(entry.request.client);
  of_client->second -= bytes;
  if (of_client->second == 0) of_clients_.erase(of_client);
}

// Grants a step at a time; if a whole step does not fit, what is needed.
bool MemoryBudget::try_grow(Entry& entry, std::uint64_t bytes) {
  if (bytes <= entry.bytes) return true;
  const std::uint64_t needed = bytes - entry.bytes;
  const std::uint64_t free = free_for(entry.request.light);
  if (needed > free) return false;
  add(entry, std::min(std::max(needed, kStep), free));
  return true;
}

void MemoryBudget::cancel_one_if_all_wait() {
  Entry* last = nullptr;
  for (Entry& entry : entries_) {
    if (!entry.is_run() || entry.blocked) continue;
    if (entry.waiting_threads == 0 || entry.cancelled) return;
    if (entry.wanted - std::min(entry.wanted, entry.bytes) <= free_for(entry.request.light))
      return;  // it has not woken yet
    if (last == nullptr || excess(entry.wanted, entry.request.estimate) >=
                               excess(last->wanted, last->request.estimate))
      last = &entry;
  }
  if (last == nullptr) return;
  last->cancelled = true;
  changed_.notify_all();
}

std::optional<Error> MemoryBudget::grow(Entry& entry, std::uint64_t bytes,
                                        const std::function<std::optional<Error>()>& poll) {
  MutexLock lock(mutex_);
  if (try_grow(entry, bytes)) return std::nullopt;
  if (auto error = check_fits(bytes, entry.request.input)) return error;
  ++entry.waiting_threads;
  std::optional<Error> error;
  while (!error) {
    entry.wanted = std::max(entry.wanted, bytes);
    if (try_grow(entry, bytes)) break;
    cancel_one_if_all_wait();
    if (entry.cancelled) {
      error = Error{ErrorCode::kOutOfMemory, "",
                    fmt::format("the mesh needs {} bytes, and other runs hold what is left of the "
                                "{} of this server; it was expected to need {}",
                                bytes, options_.capacity, entry.request.estimate)};
      break;
    }
    changed_.wait_for(lock.native(), kPollInterval);
    lock.unlock();
    error = poll();
    lock.lock();
  }
  if (--entry.waiting_threads == 0) entry.wanted = 0;
  return error;
}

void MemoryBudget::shrink(Entry& entry, std::uint64_t bytes) {
  {
    MutexLock lock(mutex_);
    if (entry.bytes <= bytes) return;
    remove(entry, entry.bytes - bytes);
  }
  changed_.notify_all();
  on_release_();
}

void MemoryBudget::release(std::list<Entry>::iterator entry) {
  {
    MutexLock lock(mutex_);
    remove(*entry, entry->bytes);
    if (entry->is_run()) --runs_;
    entries_.erase(entry);
  }
  changed_.notify_all();
  on_release_();
}

std::uint64_t MemoryBudget::Reservation::bytes() const {
  if (budget_ == nullptr) return 0;
  MutexLock lock(budget_->mutex_);
  return entry_->bytes;
}

std::optional<Error> MemoryBudget::Reservation::grow_to(
    std::uint64_t bytes, const std::function<std::optional<Error>()>& poll) {
  return budget_ == nullptr ? std::nullopt : budget_->grow(*entry_, bytes, poll);
}

void MemoryBudget::Reservation::shrink_to(std::uint64_t bytes) {
  if (budget_ != nullptr) budget_->shrink(*entry_, bytes);
}

void MemoryBudget::Reservation::reclassify_as_heavy() {
  if (budget_ == nullptr) return;
  MutexLock lock(budget_->mutex_);
  if (!std::exchange(entry_->request.light, false)) return;
  budget_->reserved_by_light_ -= entry_->bytes;
}

void MemoryBudget::Reservation::reclassify_as_output() {
  if (budget_ == nullptr) return;
  reclassify_as_heavy();
  {
    MutexLock lock(budget_->mutex_);
    if (entry_->is_run()) --budget_->runs_;
    entry_->request.purpose = Purpose::kOutput;
  }
  budget_->changed_.notify_all();
  budget_->on_release_();
}

void MemoryBudget::Reservation::mark_blocked(bool blocked) {
  if (budget_ == nullptr) return;
  MutexLock lock(budget_->mutex_);
  entry_->blocked = blocked;
}

}  // namespace weft::server
