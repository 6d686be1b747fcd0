// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace weft::server {
namespace {

constexpr std::chrono::milliseconds kPoll{20};

// By how much a run would exceed its estimate if it were granted what it wants.
std::uint64_t excess(std::uint64_t wanted, std::uint64_t estimate) {
  return wanted - std::min(wanted, estimate);
}

}  // namespace

std::optional<MemoryGate::Share> MemoryGate::take(const Ask& ask) {
  MutexLock lock(mutex_);
  const bool fits = ask.request ? entries_.empty() || ask.estimate <= free_for(false)
                                : ask.estimate <= room_for(ask.light);
  if (!fits) return std::nullopt;
  const auto held = of_clients_.find(ask.client);
  if (!ask.request && held != of_clients_.end() && held->second >= options_.of_client)
    return std::nullopt;
  const auto entry = entries_.insert(entries_.end(), Entry{.ask = ask, .bytes = 0});
  if (ask.is_run()) ++runs_;
  add(*entry, std::min(ask.estimate, options_.capacity - std::min(taken_, options_.capacity)));
  return Share(*this, entry);
}

std::uint64_t MemoryGate::room() const {
  return room(false);
}

std::uint64_t MemoryGate::room(bool light) const {
  MutexLock lock(mutex_);
  return room_for(light);
}

std::uint64_t MemoryGate::taken() const {
  MutexLock lock(mutex_);
  return taken_;
}

std::size_t MemoryGate::waiting() const {
  MutexLock lock(mutex_);
  return static_cast<std::size_t>(std::count_if(
      entries_.begin(), entries_.end(), [](const Entry& entry) { return entry.waiting > 0; }));
}

std::uint64_t MemoryGate::free_for(bool light) const {
  const std::uint64_t free = options_.capacity - std::min(taken_, options_.capacity);
  if (light) return free;
  return free - std::min(free, options_.for_light - std::min(options_.for_light, taken_by_light_));
}

std::uint64_t MemoryGate::room_for(bool light) const {
  if (runs_ == 0 && free_for(light) > 0) return std::numeric_limits<std::int64_t>::max();
  return free_for(light);
}

void MemoryGate::add(Entry& entry, std::uint64_t bytes) {
  entry.bytes += bytes;
  taken_ += bytes;
  if (entry.ask.light) taken_by_light_ += bytes;
  if (!entry.ask.request && bytes > 0) of_clients_[entry.ask.client] += bytes;
}

void MemoryGate::remove(Entry& entry, std::uint64_t bytes) {
  entry.bytes -= bytes;
  taken_ -= bytes;
  if (entry.ask.light) taken_by_light_ -= bytes;
  if (entry.ask.request || bytes == 0) return;
  const auto held = of_clients_.find(entry.ask.client);
  held->second -= bytes;
  if (held->second == 0) of_clients_.erase(held);
}

// Grants a step at a time; if a whole step does not fit, what is needed.
bool MemoryGate::try_grow(Entry& entry, std::uint64_t bytes) {
  if (bytes <= entry.bytes) return true;
  const std::uint64_t needed = bytes - entry.bytes;
  const std::uint64_t free = free_for(entry.ask.light);
  if (needed > free) return false;
  add(entry, std::min(std::max(needed, kStep), free));
  return true;
}

void MemoryGate::end_one_if_all_wait() {
  Entry* last = nullptr;
  for (Entry& entry : entries_) {
    if (!entry.ask.is_run() || entry.parked) continue;
    if (entry.waiting == 0 || entry.ended) return;
    if (entry.wanted - std::min(entry.wanted, entry.bytes) <= free_for(entry.ask.light))
      return;  // it has not woken yet
    if (last == nullptr ||
        excess(entry.wanted, entry.ask.estimate) >= excess(last->wanted, last->ask.estimate))
      last = &entry;
  }
  if (last == nullptr) return;
  last->ended = true;
  changed_.notify_all();
}

std::optional<Error> MemoryGate::grow(Entry& entry, std::uint64_t bytes,
                                      const std::function<std::optional<Error>()>& poll) {
  MutexLock lock(mutex_);
  if (try_grow(entry, bytes)) return std::nullopt;
  if (bytes > options_.capacity - std::min(options_.for_light, options_.capacity))
    return Error{ErrorCode::kLimitExceeded, "",
                 fmt::format("the mesh needs more than {} bytes; this server's limit for all of "
                             "its runs is {}",
                             bytes, options_.capacity)};
  ++entry.waiting;
  std::optional<Error> error;
  while (!error) {
    entry.wanted = std::max(entry.wanted, bytes);
    if (try_grow(entry, bytes)) break;
    end_one_if_all_wait();
    if (entry.ended) {
      error = Error{ErrorCode::kOutOfMemory, "",
                    fmt::format("the mesh needs {} bytes, and other runs hold what is left of the "
                                "{} of this server; it was expected to need {}",
                                bytes, options_.capacity, entry.ask.estimate)};
      break;
    }
    changed_.wait_for(lock.native(), kPoll);
    lock.unlock();
    error = poll();
    lock.lock();
  }
  if (--entry.waiting == 0) entry.wanted = 0;
  return error;
}

void MemoryGate::shrink(Entry& entry, std::uint64_t bytes) {
  {
    MutexLock lock(mutex_);
    if (entry.bytes <= bytes) return;
    remove(entry, entry.bytes - bytes);
  }
  changed_.notify_all();
  on_room_();
}

void MemoryGate::give_back(std::list<Entry>::iterator entry) {
  {
    MutexLock lock(mutex_);
    remove(*entry, entry->bytes);
    if (entry->ask.is_run()) --runs_;
    entries_.erase(entry);
  }
  changed_.notify_all();
  on_room_();
}

std::uint64_t MemoryGate::Share::bytes() const {
  if (gate_ == nullptr) return 0;
  MutexLock lock(gate_->mutex_);
  return entry_->bytes;
}

std::optional<Error> MemoryGate::Share::grow_to(std::uint64_t bytes,
                                                const std::function<std::optional<Error>()>& poll) {
  return gate_ == nullptr ? std::nullopt : gate_->grow(*entry_, bytes, poll);
}

void MemoryGate::Share::shrink_to(std::uint64_t bytes) {
  if (gate_ != nullptr) gate_->shrink(*entry_, bytes);
}

void MemoryGate::Share::turn_heavy() {
  if (gate_ == nullptr) return;
  MutexLock lock(gate_->mutex_);
  if (!std::exchange(entry_->ask.light, false)) return;
  gate_->taken_by_light_ -= entry_->bytes;
}

void MemoryGate::Share::turn_reader() {
  if (gate_ == nullptr) return;
  turn_heavy();
  {
    MutexLock lock(gate_->mutex_);
    if (entry_->ask.is_run()) --gate_->runs_;
    entry_->ask.reader = true;
  }
  gate_->changed_.notify_all();
  gate_->on_room_();
}

void MemoryGate::Share::set_parked(bool parked) {
  if (gate_ == nullptr) return;
  MutexLock lock(gate_->mutex_);
  entry_->parked = parked;
}

}  // namespace weft::server
