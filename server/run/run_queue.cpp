// SPDX-License-Identifier: Apache-2.0
#include "server/run/run_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

namespace weft::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMostPasses = 64;
// How often a run that waits for another slot asks whether it is to end.
constexpr std::chrono::milliseconds kAsk{50};
// How long a slot is kept for a source that does not answer.
constexpr std::chrono::milliseconds kTurn{1'000};

// What one client may have of a number: rounded down, but one at least, if there is any.
std::size_t share_of(std::size_t all, double share) {
  const auto part = static_cast<std::size_t>(static_cast<double>(all) * std::min(share, 1.0));
  return std::max(part, std::min<std::size_t>(all, 1));
}

class Function final : public RunQueue::Item {
 public:
  explicit Function(std::function<void()> function) : function_(std::move(function)) {}
  void run(RunQueue::Slot&) noexcept override { function_(); }

 private:
  std::function<void()> function_;
};

}  // namespace

RunQueue::RunQueue(const Options& options)
    : options_(options),
      capacity_of_client_(share_of(options.capacity, options.client_share)),
      heavy_{.count = options.slots, .of_client = share_of(options.slots, options.client_share)},
      light_{.count = options.light_slots,
             .of_client = share_of(options.light_slots, options.client_share)},
      distrust_(options.distrust) {
  MutexLock lock(mutex_);
  while (threads_.size() < heavy_.count + light_.count) add_thread();
}

void RunQueue::stop() {
  std::vector<std::thread> threads;
  std::list<Client> dropped;
  {
    MutexLock lock(mutex_);
    stopping_ = true;  // so that there are no more threads
    threads.swap(threads_);
    dropped.swap(turns_);
  }
  idle_.notify_all();
  heavy_slot_.notify_all();
  for (std::thread& thread : threads) thread.join();
}

void RunQueue::add_thread() {
  threads_.emplace_back([this] { work(); });
}

void RunQueue::add_thread_if_short() {
  const std::size_t wanted = heavy_.count + light_.count + (source_ != nullptr ? 1 : 0) +
                             figures_.pausing + promoted_.size();
  try {
    if (threads_.size() < wanted && !stopping_) add_thread();
  } catch (const std::exception&) {
    // No thread, or no memory for one: the slot stays empty until the run that waits goes on.
  }
}

void RunQueue::slot_is_free() {
  heavy_slot_.notify_all();
  idle_.notify_one();
}

// --- which runs may begin ---

// A source that does not answer keeps a slot from nobody.
bool RunQueue::has_slot(Priority priority) {
  const bool lent =
      asked_ != nullptr && asked_->priority_ == priority && Clock::now() - asked_since_ >= kTurn;
  return of(priority).running < of(priority).count + (lent ? 1 : 0);
}

bool RunQueue::has_share(Priority priority, const std::string& client) {
  const auto found = of(priority).running_of.find(client);
  return found == of(priority).running_of.end() || found->second < of(priority).of_client;
}

void RunQueue::begin(Slot& slot) {
  Slots& slots = of(slot.priority_);
  if (!slot.client_.empty()) ++slots.running_of[slot.client_];  // may find no memory
  ++slots.running;
  if (slot.pushed_) ++figures_.running;
}

void RunQueue::end(const Slot& slot) {
  Slots& slots = of(slot.priority_);
  --slots.running;
  if (slot.pushed_) --figures_.running;
  slots.may_be_more |= !slot.pushed_ && asked_ != &slot;
  if (const auto found = slots.running_of.find(slot.client_); found != slots.running_of.end()) {
    slots.may_be_more |= slots.left_out && found->second >= slots.of_client;  // of this client
    if (--found->second == 0) slots.running_of.erase(found);
  }
}

// The run that has the next heavy slot, before all that have not begun.
const RunQueue::Slot* RunQueue::next_promoted() {
  for (const Slot* slot : promoted_)
    if (has_share(Priority::kHeavy, slot->client_)) return slot;
  return nullptr;
}

// Gives the slot a run, or the source, if there is one that may begin.
bool RunQueue::next(Slot& slot) {
  for (const Priority priority : {Priority::kLight, Priority::kHeavy}) {
    if (!has_slot(priority)) continue;
    if (priority == Priority::kHeavy && next_promoted() != nullptr) continue;
    slot.priority_ = priority;
    if (of(priority).last_was_pushed && ask_source(slot)) return true;
    if (next_pushed(slot) || ask_source(slot)) return true;
  }
  return false;
}

bool RunQueue::ask_source(Slot& slot) {
  Slots& slots = of(slot.priority_);
  if (source_ == nullptr || asked_ != nullptr || !slots.may_be_more) return false;
  slots.may_be_more = false;  // until there is one, or it says so again
  asked_ = &slot;
  asked_since_ = Clock::now();
  ++of_source_;
  begin(slot);
  return true;
}

bool RunQueue::next_pushed(Slot& slot) {
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    if (!has_share(slot.priority_, client->name)) continue;
    std::size_t index = 0;
    if (slot.priority_ == Priority::kLight) {
      if (distrust_.holds_for(client->name, Clock::now())) continue;
      const auto light = std::ranges::find_if(
          client->items, [this](const Waiting& each) { return is_light(each.estimate); });
      if (light == client->items.end()) continue;
      index = static_cast<std::size_t>(light - client->items.begin());
    }
    if (take(slot, client, index)) return true;
    if (++client->items[index].passed_over > kMostPasses) break;
  }
  return false;
}

// Gives the slot to the client's item of this index if there is memory for it. The client's next
// turn is then the last one.
bool RunQueue::take(Slot& slot, Turn client, std::size_t index) {
  const Waiting& waiting = client->items[index];
  auto share = reserve({client->name, waiting.estimate});
  if (!share) return false;
  slot.share_ = std::move(*share);
  slot.is_light_ = is_light(waiting.estimate);
  slot.item_ = waiting.item;
  slot.pushed_ = true;
  slot.client_ = client->name;
  client->items.erase(client->items.begin() + static_cast<std::ptrdiff_t>(index));
  --figures_.waiting;
  if (client->items.empty())
    turns_.erase(client);
  else
    turns_.splice(turns_.end(), turns_, client);
  of(slot.priority_).last_was_pushed = true;
  begin(slot);
  return true;
}

std::optional<MemoryGate::Share> RunQueue::reserve(const Ticket& ticket) const {
  if (options_.gate == nullptr) return MemoryGate::Share();
  return options_.gate->take(
      {.estimate = ticket.estimate, .client = ticket.client, .light = is_light(ticket.estimate)});
}

// --- runs that wait here ---

std::optional<Failure> RunQueue::push(std::shared_ptr<Item> item, Ticket ticket) {
  MutexLock lock(mutex_);
  const std::size_t idle = heavy_.count - std::min(heavy_.running, heavy_.count);
  auto client = std::ranges::find(turns_, ticket.client, &Client::name);
  std::size_t of_client = client != turns_.end() ? client->items.size() : 0;
  for (const Slot* slot : promoted_) of_client += slot->pushed_ && slot->client_ == ticket.client;
  const bool has_room_of_its_own = options_.client_share < 1 && of_client == 0;
  const std::size_t all = options_.capacity;
  if (figures_.waiting >= idle + all * (has_room_of_its_own ? 2 : 1))
    return Failure{Reason::kQueueFull, "",
                   fmt::format("{} calls wait already; this server's limit is {}", all, all)};
  if (of_client >= std::min(idle, heavy_.of_client) + capacity_of_client_)
    return Failure{
        Reason::kQueueFull, "",
        fmt::format("{} calls of yours wait already; this server's limit for one client is {}",
                    capacity_of_client_, capacity_of_client_)};
  if (client == turns_.end())
    client = turns_.insert(turns_.end(), Client{std::move(ticket.client), {}});
  client->items.push_back({std::move(item), ticket.estimate});
  ++figures_.waiting;
  if (has_slot(Priority::kHeavy) || has_slot(Priority::kLight)) idle_.notify_one();
  return std::nullopt;
}

std::optional<Failure> RunQueue::push(std::string client, std::function<void()> function) {
  return push(std::make_shared<Function>(std::move(function)), {.client = std::move(client)});
}

bool RunQueue::remove(const Item& item) {
  MutexLock lock(mutex_);
  for (auto client = turns_.begin(); client != turns_.end(); ++client) {
    const auto found = std::ranges::find_if(
        client->items, [&](const Waiting& waiting) { return waiting.item.get() == &item; });
    if (found == client->items.end()) continue;
    client->items.erase(found);
    --figures_.waiting;
    if (client->items.empty()) turns_.erase(client);
    return true;
  }
  return false;
}

void RunQueue::notify() {
  { MutexLock lock(mutex_); }  // no thread is between its check and its wait now
  idle_.notify_all();
}

RunQueue::Figures RunQueue::figures() const {
  MutexLock lock(mutex_);
  return figures_;
}

// --- runs of the source ---

void RunQueue::attach(Source& source) {
  MutexLock lock(mutex_);
  source_ = &source;
  add_thread_if_short();  // one that waits for the source holds up no other run
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

std::uint64_t RunQueue::Slot::room() const {
  const bool light = priority_ == Priority::kLight;
  const std::uint64_t room = queue_.options_.gate->room(light);
  return light ? std::min(room, queue_.options_.light) : room;
}

std::vector<std::string> RunQueue::Slot::full_clients() {
  MutexLock lock(queue_.mutex_);
  std::vector<std::string> full;
  if (priority_ == Priority::kLight) full = queue_.distrust_.clients(Clock::now());
  Slots& slots = queue_.of(priority_);
  for (const auto& [client, count] : slots.running_of)
    if (count >= slots.of_client) full.push_back(client);
  slots.left_out = !full.empty();
  return full;
}

bool RunQueue::Slot::admit(const Ticket& ticket) {
  auto share = queue_.reserve(ticket);
  MutexLock lock(queue_.mutex_);
  Slots& slots = queue_.of(priority_);
  if (!share || slots.running > slots.count || !queue_.has_share(priority_, ticket.client))
    return false;
  if (!ticket.client.empty()) ++slots.running_of[ticket.client];
  client_ = ticket.client;
  share_ = std::move(*share);
  is_light_ = queue_.is_light(ticket.estimate);
  slots.last_was_pushed = false;
  slots.may_be_more = true;
  queue_.asked_ = nullptr;
  queue_.idle_.notify_one();  // the source may be asked for the next one
  return true;
}

// --- runs that leave their slot ---

RunQueue::Pause::Pause(Slot& slot) : slot_(slot) {
  RunQueue& queue = slot.queue_;
  MutexLock lock(queue.mutex_);
  queue.end(slot);
  ++queue.figures_.pausing;
  queue.add_thread_if_short();
  queue.slot_is_free();
}

RunQueue::Pause::~Pause() {
  MutexLock lock(slot_.queue_.mutex_);
  --slot_.queue_.figures_.pausing;
  slot_.queue_.begin(slot_);
}

void RunQueue::Slot::promote(const std::function<bool()>& stopped) {
  share_.turn_heavy();
  is_light_ = false;
  if (priority_ == Priority::kHeavy) return;
  MutexLock lock(queue_.mutex_);
  if (queue_.options_.client_share < 1 && !client_.empty())
    queue_.distrust_.turned_out_heavy(client_, Clock::now());
  const auto self = queue_.promoted_.insert(queue_.promoted_.end(), this);
  queue_.end(*this);
  priority_ = Priority::kHeavy;
  if (pushed_) ++queue_.figures_.waiting;
  queue_.add_thread_if_short();
  queue_.slot_is_free();
  share_.set_parked(true);  // those in the slots may wait for the memory of this one
  while (!queue_.stopping_ &&
         (queue_.next_promoted() != this || !queue_.has_slot(Priority::kHeavy))) {
    queue_.heavy_slot_.wait_for(lock.native(), kAsk);
    lock.unlock();
    const bool stop = stopped();
    lock.lock();
    if (stop) break;
  }
  share_.set_parked(false);
  queue_.promoted_.erase(self);
  if (pushed_) --queue_.figures_.waiting;
  queue_.begin(*this);
  queue_.slot_is_free();  // another one may be, which nobody looked at because of this run
}

// --- threads ---

void RunQueue::work() {
  MutexLock lock(mutex_);
  while (!stopping_) {
    Slot slot(*this);
    if (!next(slot)) {
      idle_.wait_for(lock.native(), kTurn);
      continue;
    }
    // There may be another run that can begin, which this thread was woken for.
    if (figures_.waiting > 0 && (has_slot(Priority::kHeavy) || has_slot(Priority::kLight)))
      idle_.notify_one();
    Source* const source = slot.pushed_ ? nullptr : source_;
    lock.unlock();
    source != nullptr ? source->run_next(slot) : slot.item_->run(slot);
    slot.item_.reset();
    slot.share_ = {};
    lock.lock();
    end(slot);
    heavy_slot_.notify_all();
    if (slot.pushed_) continue;
    if (asked_ == &slot) asked_ = nullptr;
    if (--of_source_ == 0) left_by_source_.notify_all();
  }
}

}  // namespace weft::server
