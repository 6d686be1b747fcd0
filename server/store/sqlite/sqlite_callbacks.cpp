// SPDX-License-Identifier: Apache-2.0
// The SQLite store for callbacks: they are claimed, and settled.
#include <algorithm>

#include "server/store/sql_values.h"
#include "server/store/sqlite/sqlite_jobs.h"

namespace weft::server {

using sqlite::Rows;
using sqlite::Transaction;

namespace {

constexpr std::string_view kClaimCallback = R"sql(
UPDATE job SET callback_state = ?4, callback_attempts = callback_attempts + 1, callback_due = ?5
WHERE id = (
  SELECT id FROM job WHERE callback_due <= ?1 AND ended IS NOT NULL
  AND instr(?2, ',' || lower(hex(owner)) || ',') = 0
  AND instr(?3, ',' || lower(hex(callback_place)) || ',') = 0
  ORDER BY callback_due LIMIT 1)
RETURNING owner, id)sql";

}  // namespace

StoreResult<std::optional<JobRecord>> SqliteJobs::claim_callback(
    std::chrono::milliseconds lease, const std::vector<std::string>& except_owners,
    const std::vector<std::string>& except_places) {
  return core_->write_quietly(Durability::kLater, [&](Transaction& transaction) {
    const std::int64_t now = to_micros(core_->now());
    const std::string owners = list_of(except_owners);
    const std::string places = list_of(except_places);
    std::string owner;
    std::string id;
    {
      Rows rows = transaction.run(kClaimCallback, now, owners, places,
                                  static_cast<int>(CallbackState::kClaimed),
                                  now + to_micros(std::min(lease, kLongestCallbackDelay)));
      if (!rows.next()) return std::optional<JobRecord>();
      owner = rows.bytes(0);
      id = rows.bytes(1);
    }
    return find_job(transaction, owner, id);
  });
}

StoreResult<Held> SqliteJobs::settle_callback(const JobRecord& claimed, CallbackState state,
                                              const std::string& error,
                                              std::chrono::milliseconds delay) {
  return core_->write_quietly(Durability::kWait, [&](Transaction& transaction) {
    std::optional<std::int64_t> due;
    if (state == CallbackState::kPending)
      due = to_micros(core_->now()) + to_micros(std::min(delay, kLongestCallbackDelay));
    const std::int64_t settled = transaction.change(
        "UPDATE job SET callback_state = ?4, callback_error = ?5, callback_due = ?6 "
        "WHERE id = ?1 AND callback_attempts = ?2 AND callback_state = ?3",
        claimed.id, claimed.callback.attempts, static_cast<int>(CallbackState::kClaimed),
        static_cast<int>(state), error, due);
    return settled == 1 ? Held::kHeld : Held::kLost;
  });
}

}  // namespace weft::server
