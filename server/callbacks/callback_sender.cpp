// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callback_sender.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

#include "server/wire/job_wire.h"
#include "server/wire/json.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

// Between two looks for callbacks that nothing announced, such as those that were put off.
constexpr milliseconds kBetweenLooks{1'000};
// Longer than anything is sent: another server then takes the callback of one that is gone.
constexpr milliseconds kMargin{30'000};
constexpr unsigned kGone = 410;

std::string body_of(const JobRecord& job) {
  v1::GetJobResponse message;
  *message.mutable_job() = to_wire(job);
  message.mutable_job()->clear_callback();  // is not yet what it will be
  return json_of(message);
}

std::vector<std::string> full(const std::map<std::string, std::size_t>& counts, std::size_t most) {
  std::vector<std::string> names;
  for (const auto& [name, count] : counts)
    if (count >= most) names.push_back(name);
  return names;
}

void leave(std::map<std::string, std::size_t>& counts, const std::string& name) {
  const auto found = counts.find(name);
  if (--found->second == 0) counts.erase(found);
}

std::string place_of(const JobRecord& job) {
  const auto url = CallbackUrl::parse(job.callback.url);
  return url ? url->place() : "";
}

}  // namespace

milliseconds callback_delay(milliseconds first, std::uint32_t attempt, double part) {
  constexpr std::uint32_t kMaxDoublings = 20;
  const std::uint32_t doublings = std::min(std::max(attempt, 1u) - 1, kMaxDoublings);
  const milliseconds longest =
      std::min(first * (std::int64_t{1} << doublings), kLongestCallbackDelay);
  return longest / 2 + milliseconds(std::llround(part * static_cast<double>(longest.count()) / 2));
}

CallbackSender::CallbackSender(Parts parts, const SenderOptions& options)
    : parts_(std::move(parts)),
      options_(options),
      poster_(parts_.callbacks.rules(), options.limits),
      threads_(options.at_once),
      claimer_([this] { claim_until_stopped(); }) {}

void CallbackSender::wake() {
  {
    MutexLock lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

void CallbackSender::stop() {
  {
    MutexLock lock(mutex_);
    if (std::exchange(stopping_, true)) return;
  }
  changed_.notify_all();
  poster_.stop();
  claimer_.join();
  threads_.join();
}

void CallbackSender::claim_until_stopped() {
  while (true) {
    try {
      while (claim_next()) continue;
    } catch (const std::exception& error) {
      parts_.log->error("event=callbacks_not_claimed message={}", log_value(error.what()));
    }
    const auto next = Clock::now() + kBetweenLooks;
    MutexLock lock(mutex_);
    while (!stopping_ && !woken_)
      if (changed_.wait_until(lock.native(), next) == std::cv_status::timeout) break;
    if (stopping_) return;
    woken_ = false;
  }
}

bool CallbackSender::claim_next() {
  std::vector<std::string> clients;
  std::vector<std::string> places;
  {
    MutexLock lock(mutex_);
    if (stopping_ || sending_ == options_.at_once) return false;
    clients = full(of_clients_, options_.of_client);
    places = full(of_places_, options_.of_place);
  }
  auto claimed = parts_.store.claim_callback(options_.limits.total + kMargin, clients, places);
  if (!claimed)
    parts_.log->warn("event=callbacks_not_claimed message={}", log_value(claimed.error().message));
  if (!claimed || !*claimed) return false;
  const std::string place = place_of(**claimed);
  {
    MutexLock lock(mutex_);
    ++sending_;
    ++of_clients_[(*claimed)->owner];
    ++of_places_[place];
  }
  boost::asio::post(threads_, [this, job = std::move(**claimed), place] { send(job, place); });
  return true;
}

void CallbackSender::send(const JobRecord& job, const std::string& place) {
  const auto began = Clock::now();
  try {
    const Posted posted = post(job);
    settle(job, place, posted, std::chrono::duration<double>(Clock::now() - began).count());
  } catch (const std::exception& error) {  // it is claimed again once its lease has run out
    parts_.log->error("event=callback_broken_off job={} message={}", job.id,
                      log_value(error.what()));
  }
  {
    MutexLock lock(mutex_);
    --sending_;
    leave(of_clients_, job.owner);
    leave(of_places_, place);
    woken_ = true;
  }
  changed_.notify_all();
}

Posted CallbackSender::post(const JobRecord& job) {
  const auto url = CallbackUrl::parse(job.callback.url);
  if (!url) return {.refused = true, .error = "the URL " + url.error()};
  PostRequest request{.url = *url, .body = body_of(job)};
  const std::string timestamp =
      fmt::to_string(std::chrono::duration_cast<std::chrono::seconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                         .count());
  const std::string signatures =
      parts_.callbacks.signatures(job.owner, job.id, timestamp, request.body);
  if (signatures.empty()) return {.error = "the server has no secret for the client"};
  request.headers = {
      {"webhook-id", job.id}, {"webhook-timestamp", timestamp}, {"webhook-signature", signatures}};
  return poster_.post(request);
}

void CallbackSender::settle(const JobRecord& job, const std::string& place, const Posted& posted,
                            double seconds) {
  const std::uint32_t attempt = job.callback.attempts;
  const std::string error =
      posted.status == 0 ? posted.error : fmt::format("the answer has status {}", posted.status);
  milliseconds delay{0};
  bool stopping = false;
  {
    MutexLock lock(mutex_);
    stopping = stopping_;
    if (!stopping)
      delay = callback_delay(options_.first_delay, attempt,
                             std::uniform_real_distribution<>()(random_));
  }
  CallbackState state = CallbackState::kPending;
  const char* outcome = "put_off";
  if (posted.status / 100 == 2) {
    state = CallbackState::kDelivered;
    outcome = "delivered";
  } else if (posted.refused || posted.status == kGone ||
             (attempt >= kMaxCallbackAttempts && !stopping)) {
    state = CallbackState::kFailed;
    outcome = "failed";
  }
  const bool delivered = state == CallbackState::kDelivered;
  const auto settled = parts_.store.settle_callback(job, state, delivered ? "" : error, delay);
  parts_.count(outcome);
  parts_.log->info(
      "event=callback_sent job={} client={} place={} attempt={} outcome={} status={} settled={} "
      "seconds={:.3f} message={}",
      job.id, log_value(job.owner), log_value(place), attempt, outcome, posted.status,
      settled && *settled == Held::kHeld ? "yes" : "no", seconds,
      log_value(delivered ? "" : error));
}

}  // namespace weft::server
