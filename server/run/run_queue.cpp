// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace weft::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMaxBypasses = 64;
// How often a run that waits for a heavy slot checks whether it was stopped.
constexpr std::chrono::milliseconds kStopPollInterval{50};
// How long a source that does not answer keeps its slot from other runs.
constexpr std::chrono::milliseconds kSourceTimeout{1'000};

// The part of `all` that one client may have: rounded down, but at least 1 unless `all` is 0.
std::size_t share_of(std::size_t all, double share) {
  const auto part = static_cast<std::size_t>(static_cast<double>(all) * std::min(share, 1.0));
  return std::max(part, std::min<std::size_t>(all, 1));
}

}  // namespace

RunQueue::RunQueue(const Options& options)
    : options_(options),
      capacity_of_client_(share_of(options.capacity, options.client_share)),
      heavy_{.count = options.slots, .of_client = share_of(options.slots, options.client_share)},
      light_{.count = options.light_slots,
             .of_client = share_of(options.light_slots, options.client_share)},
      distrust_(options.distrust) {
  MutexLock lock(mutex_);
  while (threads_.size() < heavy_.count + light_.count)
    threads_.emplace_back(&RunQueue::work, this);
}

void RunQueue::stop() {
  std::vector<std::thread> threads;
  std::list<Client> dropped;
  {
    MutexLock lock(mutex_);
    stopping_ = true;  // so that there are no more threads
    threads.swap(threads_);
    dropped.swap(round_robin_);
  }
  idle_.notify_all();
  heavy_slot_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

void RunQueue::add_thread_if_short() {
  const std::size_t wanted = heavy_.count + light_.count + (source_ != nullptr ? 1 : 0) +
                             stats_.pausing + promoted_.size();
  try {
    if (threads_.size() < wanted && !stopping_) threads_.emplace_back(&RunQueue::work, this);
  } catch (const std::exception&) {
    // No thread can be made: the slot stays empty until the run that left it goes on.
  }
}

// --- which runs may begin ---

// Another run may borrow the slot of a source that does not answer.
bool RunQueue::has_slot(PriorityClass priority) {
  const bool borrowed = asked_ != nullptr && asked_->priority_ == priority &&
                        Clock::now() - asked_since_ >= kSourceTimeout;
  return of(priority).running < of(priority).count + (borrowed ? 1 : 0);
}

bool RunQueue::has_share(PriorityClass priority, const std::string& client) {
  const auto found = of(priority).running_of.find(client);
  return found == of(priority).running_of.end() || found->second < of(priority).of_client;
}

void RunQueue::begin(Slot& slot) {
  Slots& slots = of(slot.priority_);
  if (!slot.client_.empty()) ++slots.running_of[slot.client_];  // may throw std::bad_alloc
  ++slots.running;
  if (slot.pushed_) ++stats_.running;
}

void RunQueue::end(const Slot& slot) {
  Slots& slots = of(slot.priority_);
  --slots.running;
  if (slot.pushed_) --stats_.running;
  slots.may_be_more |= !slot.pushed_ && asked_ != &slot;
  if (const auto found = slots.running_of.find(slot.client_); found != slots.running_of.end()) {
    slots.may_be_more |= slots.left_out && found->second >= slots.of_client;  // of this client
    if (--found->second == 0) slots.running_of.erase(found);
  }
}

// The promoted run that gets the next heavy slot, before all runs that have not begun.
const RunQueue::Slot* RunQueue::next_promoted() {
  for (const Slot* slot : promoted_)
    if (has_share(PriorityClass::kHeavy, slot->client_)) return slot;
  return nullptr;
}

// Gives the slot a run that may begin, or the source; returns false if there is none.
bool RunQueue::next(Slot& slot) {
  for (const PriorityClass priority : {PriorityClass::kLight, PriorityClass::kHeavy}) {
    if (!has_slot(priority)) continue;
    if (priority == PriorityClass::kHeavy && next_promoted() != nullptr) continue;
    slot.priority_ = priority;
    if (of(priority).last_was_pushed && ask_source(slot)) return true;
    if (next_pushed(slot) || ask_source(slot)) return true;
  }
  return false;
}

bool RunQueue::ask_source(Slot& slot) {
  Slots& slots = of(slot.priority_);
  if (source_ == nullptr || asked_ != nullptr || !slots.may_be_more) return false;
  if (slot.priority_ == PriorityClass::kHeavy && somebody_starves(slot)) return false;
  slots.may_be_more = false;  // until there is one, or it says so again
  asked_ = &slot;
  asked_since_ = Clock::now();
  ++of_source_;
  begin(slot);
  return true;
}

// The client of a run that begins goes to the end of the round.
bool RunQueue::next_pushed(Slot& slot) {
  const bool only_starving = slot.priority_ == PriorityClass::kHeavy && somebody_starves(slot);
  for (auto client = round_robin_.begin(); client != round_robin_.end(); ++client) {
    if (!may_try(slot, *client) || !begin_one_of(*client, slot, only_starving)) continue;
    --stats_.waiting;
    if (client->runs.empty())
      round_robin_.erase(client);
    else
      round_robin_.splice(round_robin_.end(), round_robin_, client);
    of(slot.priority_).last_was_pushed = true;
    begin(slot);
    return true;
  }
  return false;
}

// Whether the client's share allows another run; memory apart from that is not looked at.
bool RunQueue::may_try(const Slot& slot, const Client& client) {
  if (!has_share(slot.priority_, client.name)) return false;
  if (slot.priority_ == PriorityClass::kLight && distrust_.holds_for(client.name, Clock::now()))
    return false;
  return options_.memory == nullptr || options_.memory->has_share(client.name);
}

// Gives the slot the client's first run for which there is memory.
bool RunQueue::begin_one_of(Client& client, Slot& slot, bool only_starving) {
  for (auto run = client.runs.begin(); run != client.runs.end(); ++run) {
    if (slot.priority_ == PriorityClass::kLight && !is_light(run->ticket.estimate)) continue;
    if (only_starving && run->bypass_count < kMaxBypasses) continue;
    run->lacks_memory = !assign(slot, run->ticket);
    if (run->lacks_memory) continue;
    slot.work_ = std::move(run->work);
    slot.pushed_ = true;
    client.runs.erase(run);
    count_bypass();
    return true;
  }
  return false;
}

// A run begins while others lack memory.
void RunQueue::count_bypass() {
  for (Client& client : round_robin_)
    for (Waiting& run : client.runs) run.bypass_count += run.lacks_memory ? 1 : 0;
}

// Whether a run was bypassed so often that no other may begin before it. One that its client's
// share keeps from the slot is not waited for.
bool RunQueue::somebody_starves(const Slot& slot) {
  const auto starves = [](const Waiting& run) { return run.bypass_count >= kMaxBypasses; };
  for (const Client& client : round_robin_)
    if (std::ranges::any_of(client.runs, starves) && may_try(slot, client)) return true;
  return false;
}

// Reserves memory for a run in the slot; returns false if not enough is free.
bool RunQueue::assign(Slot& slot, const Ticket& ticket) const {
  const bool light = is_light(ticket.estimate);
  if (options_.memory != nullptr) {
    auto reservation = options_.memory->reserve({.estimate = ticket.estimate,
                                                 .client = ticket.client,
                                                 .light = light,
                                                 .input = ticket.input});
    if (!reservation) return false;
    slot.reservation_ = std::move(*reservation);
  }
  slot.is_light_ = light;
  slot.client_ = ticket.client;
  return true;
}

// --- runs that wait here ---

std::optional<Failure> RunQueue::push(Ticket ticket, Work work) {
  if (options_.memory != nullptr)
    if (auto error = options_.memory->check_fits(ticket.least, ticket.input))
      return Failure{Reason::kLimitExceeded, "", std::move(error->message)};
  MutexLock lock(mutex_);
  const std::size_t idle = heavy_.count - std::min(heavy_.running, heavy_.count);
  auto client = std::ranges::find(round_robin_, ticket.client, &Client::name);
  std::size_t of_client = client != round_robin_.end() ? client->runs.size() : 0;
  for (const Slot* slot : promoted_) of_client += slot->pushed_ && slot->client_ == ticket.client;
  const bool has_room_of_its_own = options_.client_share < 1 && of_client == 0;
  const std::size_t all = options_.capacity;
  if (stats_.waiting >= idle + all * (has_room_of_its_own ? 2 : 1))
    return Failure{Reason::kQueueFull, "",
                   fmt::format("{} calls wait already; this server's limit is {}", all, all)};
  if (of_client >= std::min(idle, heavy_.of_client) + capacity_of_client_)
    return Failure{
        Reason::kQueueFull, "",
        fmt::format("{} calls of yours wait already; this server's limit for one client is {}",
                    capacity_of_client_, capacity_of_client_)};
  if (client == round_robin_.end())
    client = round_robin_.insert(round_robin_.end(), Client{ticket.client, {}});
  client->runs.push_back({std::move(ticket), std::move(work)});
  ++stats_.waiting;
  idle_.notify_one();
  return std::nullopt;
}

bool RunQueue::remove(const void* owner) {
  MutexLock lock(mutex_);
  for (auto client = round_robin_.begin(); client != round_robin_.end(); ++client) {
    const auto found = std::ranges::find_if(
        client->runs, [owner](const Waiting& run) { return run.ticket.owner == owner; });
    if (found == client->runs.end()) continue;
    client->runs.erase(found);
    --stats_.waiting;
    if (client->runs.empty()) round_robin_.erase(client);
    idle_.notify_one();  // others may have waited for this one
    return true;
  }
  return false;
}

void RunQueue::memory_released() {
  { MutexLock lock(mutex_); }  // so that no thread is between its check and its wait
  idle_.notify_all();
}

RunQueue::Stats RunQueue::stats() const {
  MutexLock lock(mutex_);
  return stats_;
}

// --- runs of the source ---

void RunQueue::attach(Source& source) {
  MutexLock lock(mutex_);
  source_ = &source;
  add_thread_if_short();  // so that a thread that waits for the source delays no run
}

void RunQueue::wake() {
  {
    MutexLock lock(mutex_);
    heavy_.may_be_more = light_.may_be_more = true;
  }
  idle_.notify_one();
}

void RunQueue::detach() {
  MutexLock lock(mutex_);
  source_ = nullptr;
  while (of_source_ > 0) left_by_source_.wait(lock.native());
}

std::uint64_t RunQueue::Slot::max_estimate() const {
  const bool light = priority_ == PriorityClass::kLight;
  const std::uint64_t estimate = queue_.options_.memory->max_estimate(light);
  return light ? std::min(estimate, queue_.options_.max_light_estimate) : estimate;
}

std::vector<std::string> RunQueue::Slot::full_clients() {
  MutexLock lock(queue_.mutex_);
  std::vector<std::string> full;
  if (priority_ == PriorityClass::kLight) full = queue_.distrust_.clients(Clock::now());
  Slots& slots = queue_.of(priority_);
  for (const auto& [client, count] : slots.running_of)
    if (count >= slots.of_client) full.push_back(client);
  slots.left_out = !full.empty();
  return full;
}

bool RunQueue::Slot::admit(const Ticket& ticket) {
  MutexLock lock(queue_.mutex_);
  Slots& slots = queue_.of(priority_);
  if (slots.running > slots.count || !queue_.has_share(priority_, ticket.client)) return false;
  if (!queue_.assign(*this, ticket)) return false;
  if (!ticket.client.empty()) ++slots.running_of[ticket.client];
  queue_.count_bypass();
  slots.last_was_pushed = false;
  slots.may_be_more = true;
  queue_.asked_ = nullptr;
  queue_.idle_.notify_one();  // the source may be asked for the next one
  return true;
}

// --- runs that leave their slot ---

void RunQueue::leave(const Slot& slot) {
  end(slot);
  add_thread_if_short();
  heavy_slot_.notify_all();
  idle_.notify_one();
}

RunQueue::Pause::Pause(Slot& slot) : slot_(slot) {
  MutexLock lock(slot.queue_.mutex_);
  ++slot.queue_.stats_.pausing;
  slot.queue_.leave(slot);
}

RunQueue::Pause::~Pause() {
  MutexLock lock(slot_.queue_.mutex_);
  --slot_.queue_.stats_.pausing;
  slot_.queue_.begin(slot_);
}

void RunQueue::Slot::promote(const std::function<bool()>& stopped) {
  reservation_.reclassify_as_heavy();
  is_light_ = false;
  if (priority_ == PriorityClass::kHeavy) return;
  MutexLock lock(queue_.mutex_);
  if (queue_.options_.client_share < 1 && !client_.empty())
    queue_.distrust_.turned_out_heavy(client_, Clock::now());
  const auto self = queue_.promoted_.insert(queue_.promoted_.end(), this);
  if (pushed_) ++queue_.stats_.waiting;
  queue_.leave(*this);
  priority_ = PriorityClass::kHeavy;
  reservation_.mark_blocked(true);  // the runs in the slots may wait for this one's memory
  while (!queue_.stopping_ &&
         (queue_.next_promoted() != this || !queue_.has_slot(PriorityClass::kHeavy))) {
    queue_.heavy_slot_.wait_for(lock.native(), kStopPollInterval);
    lock.unlock();
    const bool stop = stopped();
    lock.lock();
    if (stop) break;
  }
  reservation_.mark_blocked(false);
  queue_.promoted_.erase(self);
  if (pushed_) --queue_.stats_.waiting;
  queue_.begin(*this);
  queue_.heavy_slot_.notify_all();  // a further slot may be free: other runs let this one go first
  queue_.idle_.notify_one();
}

// --- threads ---

void RunQueue::work() {
  MutexLock lock(mutex_);
  while (!stopping_) {
    Slot slot(*this);
    if (!next(slot)) {
      idle_.wait_for(lock.native(), kSourceTimeout);
      continue;
    }
    if (stats_.waiting > 0) idle_.notify_one();  // this thread may have been woken for another run
    Source* const source = slot.pushed_ ? nullptr : source_;
    lock.unlock();
    source != nullptr ? source->run_next(slot) : slot.work_(slot);
    slot.work_ = nullptr;
    slot.reservation_ = {};
    lock.lock();
    end(slot);
    heavy_slot_.notify_all();
    if (slot.pushed_) continue;
    if (asked_ == &slot) asked_ = nullptr;
    if (--of_source_ == 0) left_by_source_.notify_all();
  }
}

}  // namespace weft::server
