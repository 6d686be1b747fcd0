// SPDX-License-Identifier: Apache-2.0
// Rows that no store of ours has written: values of the wrong type, size and range in every column
// of weft.db, as a damaged or hostile database holds them. The bytes choose the tables and values;
// then every function of the store is called, and what it gives goes to the wire. Asserts, beyond
// that nothing crashes and no call hangs:
//   list    a list is no longer than was asked for
//   wire    a job that the store gives can be written to the wire, and read from there
#include <google/protobuf/stubs/logging.h>
#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/sqlite/sqlite_store.h"
#include "server/wire/job_wire.h"
#include "server/wire/translate.h"
#include "tests/files/support/temp_folder.h"
#include "tests/fuzz/byte_source.h"
#include "tests/fuzz/law.h"

namespace weft::fuzz {
namespace {

using namespace server;
using std::chrono::milliseconds;

constexpr std::string_view kIds[] = {"01ARZ3NDEKTSV4RRFFQ69G5FA0", "01ARZ3NDEKTSV4RRFFQ69G5FA1",
                                     "01ARZ3NDEKTSV4RRFFQ69G5FA2"};
constexpr std::string_view kOwners[] = {"", "ann"};
constexpr std::string_view kKeys[] = {"key of 32 bytes, or nearly so: 0",
                                      "key of 32 bytes, or nearly so: 1"};

struct Table {
  std::string name;
  std::vector<std::string> columns;
};

// A store, and a second connection that writes beside it whatever it likes.
class HostileStore {
 public:
  HostileStore() {
    const std::string path = (folder_ / "store").string();
    store_ = SqliteStore::open({.folder = path, .clock = [this] { return now_; }}).value();
    sqlite3_open((std::filesystem::path(path) / "weft.db").c_str(), &database_);
    run("PRAGMA synchronous = OFF; PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = "
        "ON");
    for (const char* name : {"task", "task_request", "served", "settled", "job", "mesh",
                             "mesh_summary", "chunk", "chunk_bytes", "mesh_chunk"})
      tables_.push_back({name, columns_of(name)});
  }

  JobStore& store() { return *store_; }
  void clear() {
    for (const Table& table : tables_) run("DELETE FROM " + table.name);
  }
  void begin() { run("BEGIN"); }
  void commit() { run("COMMIT"); }

  // One row; left out where a constraint of the table forbids it.
  void insert(ByteSource& bytes) {
    const Table& table = tables_[bytes.below(tables_.size())];
    std::string sql = "INSERT OR REPLACE INTO " + table.name + " VALUES (";
    for (std::size_t i = 0; i < table.columns.size(); ++i) sql += i == 0 ? "?" : ",?";
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database_, (sql + ")").c_str(), -1, &statement, nullptr);
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      bind(statement, static_cast<int>(i) + 1, table.columns[i], bytes);
    sqlite3_step(statement);
    sqlite3_finalize(statement);
  }

 private:
  std::vector<std::string> columns_of(const std::string& table) {
    std::vector<std::string> columns;
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database_, ("PRAGMA table_info(" + table + ")").c_str(), -1, &statement,
                       nullptr);
    while (sqlite3_step(statement) == SQLITE_ROW)
      columns.emplace_back(reinterpret_cast<const char*>(sqlite3_column_text(statement, 1)));
    sqlite3_finalize(statement);
    return columns;
  }

  void run(const std::string& sql) {
    sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr);
  }

  static void bind_blob(sqlite3_stmt* statement, int at, std::string_view bytes) {
    sqlite3_bind_blob(statement, at, bytes.data(), static_cast<int>(bytes.size()),
                      SQLITE_TRANSIENT);
  }
  static void bind_text(sqlite3_stmt* statement, int at, std::string_view bytes) {
    sqlite3_bind_text(statement, at, bytes.data(), static_cast<int>(bytes.size()),
                      SQLITE_TRANSIENT);
  }

  // Mostly what belongs there, so that rows are found and joined; otherwise anything.
  void bind(sqlite3_stmt* statement, int at, const std::string& column, ByteSource& bytes) {
    const std::size_t choice = bytes.byte();
    if (choice % 8 < 5) {
      const std::size_t which = choice / 8;
      if (column == "id" && sqlite3_bind_parameter_count(statement) == 19)  // of a job
        return bind_text(statement, at, kIds[which % 3]);
      if (column == "owner") return bind_text(statement, at, kOwners[which % 2]);
      if (column == "key" || column == "sha256") return bind_blob(statement, at, kKeys[which % 2]);
      if (column == "request_id" || column == "ended")
        return void(sqlite3_bind_null(statement, at));
      return void(sqlite3_bind_int64(statement, at, static_cast<std::int64_t>(which % 6)));
    }
    constexpr std::int64_t kNumbers[] = {std::numeric_limits<std::int64_t>::max(),
                                         std::numeric_limits<std::int64_t>::min(),
                                         -1,
                                         std::int64_t{1} << 32,
                                         99'999'999'999'999'999,
                                         -62'135'596'800'000'001};
    switch (choice / 8 % 6) {
      case 0:
        return void(sqlite3_bind_int64(statement, at, kNumbers[bytes.below(6)]));
      case 1:
        return void(sqlite3_bind_double(statement, at, bytes.flag() ? 1e300 : -0.5));
      case 2:
        return void(sqlite3_bind_null(statement, at));
      case 3:
        return bind_text(statement, at, bytes.take(bytes.below(20)));
      default:
        return bind_blob(statement, at, bytes.take(bytes.below(60)));
    }
  }

  const files::TempFolder folder_{std::filesystem::is_directory("/dev/shm")
                                      ? std::filesystem::path("/dev/shm")
                                      : std::filesystem::temp_directory_path()};
  const WallTime now_{std::chrono::seconds(1'700'000'000)};
  std::unique_ptr<JobStore> store_;
  sqlite3* database_ = nullptr;
  std::vector<Table> tables_;
};

// Calls everything. What is hostile gives errors, or nonsense that keeps its shape.
class Caller {
 public:
  Caller(JobStore& store, const std::uint8_t* data, std::size_t size)
      : store_(store), data_(data), size_(size) {}

  void look() {
    for (const std::string_view owner : kOwners) {
      const auto jobs = store_.list({.owner = std::string(owner), .limit = 2});
      if (jobs && jobs->size() > 2) broken("list", std::to_string(jobs->size()), data_, size_);
      if (jobs)
        for (const JobRecord& job : *jobs) tell(job);
      for (const std::string_view id : kIds) {
        const auto job = store_.get(std::string(owner), std::string(id));
        if (job && *job) tell(**job);
      }
    }
    for (const std::string_view key : kKeys) {
      const auto mesh = store_.mesh(std::string(key));
      if (mesh && *mesh) {
        (void)read_summary(**mesh);
        for (const StoredChunk& chunk : (*mesh)->chunks) (void)store_.chunk(chunk.sha256);
      }
      (void)store_.chunk(std::string(key));
    }
    (void)store_.stats();
  }

  void work() {
    const auto submitted = store_.submit({.owner = "ann",
                                          .request_id = "r",
                                          .key = std::string(kKeys[0]),
                                          .request = "bytes",
                                          .estimate = 1});
    if (submitted) tell(submitted->job);
    const auto claim = store_.claim("worker", milliseconds(1000), 1 << 20);
    if (claim && *claim) {
      const ClaimRef ref = (*claim)->ref;
      (void)read_request(**claim);
      (void)store_.renew(ref, milliseconds(1000), "progress");
      (void)store_.put_chunk(std::string(kKeys[1]), "chunk");
      (void)store_.finish(ref,
                          {.summary = "s", .brief = "b", .chunks = {{std::string(kKeys[1]), 5}}});
      (void)store_.fail(ref, "error");
      (void)store_.release(ref, milliseconds(10), true);
    }
    const auto callback = store_.claim_callback(milliseconds(1000), {"eve"}, {"eve:80"});
    if (callback && *callback) {
      tell(**callback);
      (void)store_.settle_callback(**callback, CallbackState::kPending, "error", milliseconds(10));
    }
    (void)store_.reap({});
    (void)store_.cancel("ann", std::string(kIds[0]));
    (void)store_.remove("ann", std::string(kIds[1]));
    (void)store_.collect({.age = std::chrono::seconds(10), .bytes = 3});
  }

 private:
  void tell(const JobRecord& record) {
    const v1::Job job = to_wire(record);
    v1::Job again;
    if (!again.ParseFromString(job.SerializeAsString()))
      broken("wire", job.ShortDebugString(), data_, size_);
    (void)state_name(record.state);
  }

  JobStore& store_;
  const std::uint8_t* data_;
  std::size_t size_;
};

void judge(const std::uint8_t* data, std::size_t size) {
  static HostileStore hostile;
  hostile.begin();
  hostile.clear();
  for (ByteSource bytes(data, size); bytes.left() > 0;) hostile.insert(bytes);
  hostile.commit();
  Caller caller(hostile.store(), data, size);
  caller.look();
  caller.work();
  caller.look();
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto silent = google::protobuf::SetLogHandler(nullptr);  // of strings, no UTF-8
  (void)silent;
  weft::fuzz::judge(data, size);
  return 0;
}
