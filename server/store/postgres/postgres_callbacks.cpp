// SPDX-License-Identifier: Apache-2.0
// The PostgreSQL store for callbacks: they are claimed, and settled.
#include <algorithm>

#include "server/store/postgres/postgres_jobs.h"
#include "server/store/sql_values.h"

namespace weft::server {

using postgres::Begin;
using postgres::Rows;
using postgres::Transaction;

namespace {

constexpr const char* kClaimCallback = R"sql(
UPDATE weft_job SET callback_state = $3, callback_attempts = callback_attempts + 1,
  callback_due = clock_timestamp() + $4 * interval '1 microsecond'
WHERE id = (
  SELECT id FROM weft_job WHERE callback_due <= now() AND ended IS NOT NULL
  AND strpos($1, ',' || encode(convert_to(owner, 'UTF8'), 'hex') || ',') = 0
  AND strpos($2, ',' || encode(convert_to(callback_place, 'UTF8'), 'hex') || ',') = 0
  ORDER BY callback_due LIMIT 1 FOR UPDATE SKIP LOCKED)
RETURNING owner, id)sql";

}  // namespace

StoreResult<std::optional<JobRecord>> PostgresJobs::claim_callback(
    std::chrono::milliseconds lease, const std::vector<std::string>& except_owners,
    const std::vector<std::string>& except_places) {
  // Not repeated if the outcome is unclear: a lease that nobody knows of runs out by itself. One
  // that a crash of the database forgets lets the callback be sent twice, with the same id.
  return core_->run(Begin::kLater, Repeat::kNever, [&](Transaction& transaction) {
    const std::string owners = list_of(except_owners);
    const std::string places = list_of(except_places);
    Rows rows =
        transaction.run(kClaimCallback, owners, places, static_cast<int>(CallbackState::kClaimed),
                        to_micros(std::min(lease, kLongestCallbackDelay)));
    if (!rows.next()) return std::optional<JobRecord>();
    return find_job(transaction, rows.bytes(0), rows.bytes(1));
  });
}

StoreResult<Held> PostgresJobs::settle_callback(const JobRecord& claimed, CallbackState state,
                                                const std::string& error,
                                                std::chrono::milliseconds delay) {
  return core_->run(Begin::kDurable, Repeat::kNever, [&](Transaction& transaction) {
    std::optional<std::int64_t> pause;
    if (state == CallbackState::kPending) pause = to_micros(std::min(delay, kLongestCallbackDelay));
    const std::int64_t settled = transaction.change(
        "UPDATE weft_job SET callback_state = $4, callback_error = $5, "
        "callback_due = clock_timestamp() + $6 * interval '1 microsecond' "
        "WHERE id = $1 AND callback_attempts = $2 AND callback_state = $3",
        claimed.id, claimed.callback.attempts, static_cast<int>(CallbackState::kClaimed),
        static_cast<int>(state), error, pause);
    return settled == 1 ? Held::kHeld : Held::kLost;
  });
}

}  // namespace weft::server
