// SPDX-License-Identifier: Apache-2.0
// What only the store in one file does.
#include "server/store/sqlite/sqlite_store.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <utility>

#include "server/store/sqlite/sqlite.h"
#include "tests/files/support/temp_folder.h"
#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

class SqliteTest : public testing::Test {
 protected:
  StoreResult<std::unique_ptr<JobStore>> open() { return SqliteStore::open({.folder = path()}); }
  std::string path() const { return (temp_ / "a/store").string(); }

  std::uintmax_t bytes_on_disk() const {
    std::uintmax_t bytes = 0;
    for (const auto& file : std::filesystem::directory_iterator(path()))
      if (file.path().filename() != "weft.reserve") bytes += file.file_size();
    return bytes;
  }

 private:
  const files::TempFolder temp_{folder_for_tests()};
};

TEST_F(SqliteTest, TheFolderIsMadeForItsOwnerAlone) {
  ASSERT_TRUE(open());
  struct stat status {};
  ASSERT_EQ(stat(path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0700U);
}

TEST_F(SqliteTest, AFolderInUseIsRefusedByName) {
  const auto first = open();
  ASSERT_TRUE(first) << first.error().message;
  const auto second = open();
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().kind, StoreErrorKind::kUnavailable);
  EXPECT_EQ(second.error().message, path() + " is in use by another weftd");
}

TEST_F(SqliteTest, AFolderThatCannotBeMadeIsNamed) {
  const auto opened = SqliteStore::open({.folder = "/dev/null/store"});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("/dev/null/store"), std::string::npos);
}

TEST_F(SqliteTest, AFileOfANewerVersionIsRefusedAndLeftAlone) {
  ASSERT_TRUE(open());
  const std::string file = path() + "/weft.db";
  {
    auto connection = sqlite::Connection::open(file, sqlite::Access::kWrite);
    ASSERT_TRUE((*connection)->execute("PRAGMA user_version = 99"));
  }
  const auto opened = open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, StoreErrorKind::kBroken);
  EXPECT_EQ(opened.error().message, file + " is of version 99; this weftd knows none after 5");
  auto connection = sqlite::Connection::open(file, sqlite::Access::kWrite);
  EXPECT_EQ((*connection)->pragma("PRAGMA user_version"), 99);
}

TEST_F(SqliteTest, AFileOfVersion1KeepsItsJobsAndMeshes) {
  std::string id;
  {
    const auto store = open();
    id = (*store)->submit({.owner = "ann", .key = key_of("k")})->job.id;
    const Claim claim = (*store)->claim("worker", hours(1), 1)->value();
    ASSERT_EQ((*store)->finish(claim.ref, {.summary = "all of it", .brief = "", .chunks = {}}),
              Held::kHeld);
    (*store)->submit({.owner = "ann", .key = key_of("other"), .request = "make it"});
  }
  {
    auto connection = sqlite::Connection::open(path() + "/weft.db", sqlite::Access::kWrite);
    ASSERT_TRUE((*connection)
                    ->execute("DROP VIEW job_now;"
                              "DROP INDEX job_open;"
                              "DROP INDEX job_callback;"
                              "DROP INDEX job_callback_owner;"
                              "ALTER TABLE job DROP COLUMN callback_url;"
                              "ALTER TABLE job DROP COLUMN callback_place;"
                              "ALTER TABLE job DROP COLUMN callback_state;"
                              "ALTER TABLE job DROP COLUMN callback_attempts;"
                              "ALTER TABLE job DROP COLUMN callback_error;"
                              "ALTER TABLE job DROP COLUMN callback_due;"
                              "ALTER TABLE mesh DROP COLUMN owner;"
                              "UPDATE mesh SET brief = (SELECT bytes FROM mesh_summary);"
                              "DROP TABLE mesh_summary;"
                              "ALTER TABLE mesh RENAME COLUMN brief TO summary;"
                              "ALTER TABLE task DROP COLUMN trace;"
                              "ALTER TABLE task DROP COLUMN max_bytes;"
                              "ALTER TABLE task DROP COLUMN max_micros;"
                              "CREATE VIEW job_now AS SELECT 1;"
                              "PRAGMA user_version = 1"));
  }
  const auto store = open();
  ASSERT_TRUE(store) << store.error().message;
  EXPECT_EQ((*store)->mesh(key_of("k")).value()->summary, "all of it");
  EXPECT_EQ((*store)->get("ann", id).value()->brief, "all of it");
  EXPECT_EQ((*store)->claim("worker", hours(1), 1).value()->request, "make it");
}

TEST_F(SqliteTest, AFileThatIsNoDatabaseIsBroken) {
  std::filesystem::create_directories(path());
  std::ofstream(path() + "/weft.db") << std::string(100'000, 'x');
  const auto opened = open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().kind, StoreErrorKind::kBroken) << opened.error().message;
  EXPECT_NE(opened.error().message.find(path()), std::string::npos) << opened.error().message;
}

TEST_F(SqliteTest, LeasesEndWhereTheStoreIsOpenedAnew) {
  ClaimRef claim;
  {
    const auto store = open();
    ASSERT_TRUE((*store)->submit({.key = std::string(32, 'k'), .request = "mesh"}));
    claim = (*(*store)->claim("gone", std::chrono::hours(1), 1))->ref;
    EXPECT_EQ((*store)->reap({})->requeued, 0);
  }
  const auto store = open();
  EXPECT_EQ((*store)->reap({})->requeued, 1);
  EXPECT_EQ((*store)->renew(claim, std::chrono::hours(1), ""), Held::kLost);
}

TEST_F(SqliteTest, LeasesOfTheServerBeforeHaveRunOut) {
  {
    const auto before = *open();
    ASSERT_TRUE(before->submit({.owner = "ann", .key = key_of("k")}));
    ASSERT_TRUE(*before->claim("worker", hours(1), 1));
    EXPECT_EQ(before->reap({})->requeued, 0U);
  }
  EXPECT_EQ((*open())->reap({})->requeued, 1U);
}

TEST_F(SqliteTest, ACallbackOfTheServerBeforeIsDueAtOnce) {
  {
    const auto before = *open();
    const auto job = before->submit(
        {.owner = "ann", .key = key_of("k"), .callback = {.url = "http://a/", .place = "a:80"}});
    ASSERT_TRUE(*before->cancel("ann", job->job.id));
    ASSERT_TRUE(*before->claim_callback(minutes(1), {}, {}));
    ASSERT_FALSE(*before->claim_callback(minutes(1), {}, {}));
  }
  EXPECT_TRUE(*(*open())->claim_callback(minutes(1), {}, {}));
}

TEST_F(SqliteTest, WhatIsCollectedIsGivenBackToTheDisk) {
  const auto store = *open();
  for (int i = 0; i < 24; ++i) {
    const std::string chunk(std::size_t{1} << 20, static_cast<char>('a' + i));
    ASSERT_TRUE(store->put_chunk(sha256_of(chunk), chunk));
  }
  EXPECT_GT(bytes_on_disk(), std::uintmax_t{24} << 20);
  const auto collected = store->collect({.loose_age = seconds(0)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_EQ(collected->chunks, 24U);
  EXPECT_LT(bytes_on_disk(), std::uintmax_t{2} << 20);
}

// Files grow no further than so many bytes, as under a quota.
class Quota {
 public:
  explicit Quota(std::uintmax_t bytes) {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~Quota() {
    setrlimit(RLIMIT_FSIZE, &before_);
    signal(SIGXFSZ, SIG_DFL);
  }
  Quota(const Quota&) = delete;
  Quota& operator=(const Quota&) = delete;

 private:
  rlimit before_{};
};

// A disk of its own, as large as it is told to be. Only this process sees it, and it goes with it.
class SmallDisk {
 public:
  explicit SmallDisk(std::string path, const char* size = "size=4m") : path_(std::move(path)) {
    std::filesystem::create_directories(path_);
    mounted_ = unshare(CLONE_NEWNS) == 0 &&
               mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
               mount("tmpfs", path_.c_str(), "tmpfs", 0, size) == 0;
  }
  ~SmallDisk() {
    if (mounted_) umount(path_.c_str());
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool mounted() const { return mounted_; }
  bool grow() const { return mount("tmpfs", path_.c_str(), "tmpfs", MS_REMOUNT, "size=64m") == 0; }

 private:
  const std::string path_;
  bool mounted_ = false;
};

class FullDiskTest : public SqliteTest {
 protected:
  // A job that is running, and a chunk of its mesh.
  void begin() {
    store_ = *open();
    ASSERT_TRUE(store_->put_chunk(sha256_of(kept_), kept_));
    const auto job = store_->submit({.owner = "ann", .key = key_of("k")});
    ASSERT_TRUE(job);
    id_ = job->job.id;
    claim_ = (*store_->claim("worker", hours(1), 1))->ref;
  }

  void expect_that_it_is_said_when_the_disk_is_full() {
    StoreResult<bool> put = false;
    for (char name = 'a'; name <= 'z' && put; ++name) {
      const std::string chunk(kChunk, name);
      put = store_->put_chunk(sha256_of(chunk), chunk);
    }
    ASSERT_FALSE(put);
    EXPECT_EQ(put.error().kind, StoreErrorKind::kFull) << put.error().message;
    EXPECT_EQ(*store_->chunk(sha256_of(kept_)), kept_) << "what is there can be read";
    EXPECT_EQ((*store_->get("ann", id_))->state, JobState::kRunning);
  }

  void expect_that_it_goes_on_once_there_is_room() {
    const std::string more(kChunk, 'M');
    ASSERT_TRUE(store_->put_chunk(sha256_of(more), more));
    const StoredMesh mesh{.summary = "",
                          .brief = {},
                          .chunks = {{sha256_of(kept_), kChunk}, {sha256_of(more), kChunk}}};
    EXPECT_EQ(store_->finish(claim_, mesh), Held::kHeld);
    EXPECT_EQ(*store_->chunk(sha256_of(more)), more);
    store_.reset();
  }

 private:
  static constexpr std::size_t kChunk = std::size_t{1} << 20;
  const std::string kept_ = std::string(kChunk, 'K');
  std::unique_ptr<JobStore> store_;
  std::string id_;
  ClaimRef claim_;
};

TEST_F(FullDiskTest, AQuotaThatIsUsedUpIsSaidAndSurvived) {
  begin();
  {
    const Quota quota(std::uintmax_t{2} << 20);
    expect_that_it_is_said_when_the_disk_is_full();
  }
  expect_that_it_goes_on_once_there_is_room();
}

TEST_F(FullDiskTest, ADiskThatIsFullIsSaidAndSurvived) {
  const SmallDisk disk(path());
  if (!disk.mounted()) GTEST_SKIP() << "only root can make a small disk";
  begin();
  expect_that_it_is_said_when_the_disk_is_full();
  ASSERT_TRUE(disk.grow());
  expect_that_it_goes_on_once_there_is_room();
}

TEST_F(SqliteTest, OnAFullDiskJobsAreStillDeletedAndGarbageCollected) {
  const SmallDisk disk(path(), "size=32m");
  if (!disk.mounted()) GTEST_SKIP() << "only root can make a small disk";
  auto store = *open();
  const auto job = store->submit({.owner = "ann", .key = key_of("k")});
  const auto waiting = store->submit({.owner = "ann", .key = key_of("w")});
  ASSERT_TRUE(job && waiting);
  StoredMesh mesh{.summary = "s", .brief = "b", .chunks = {}};
  const auto claim = *store->claim("worker", hours(1), 1);
  for (int i = 0; i < 8; ++i) {
    const std::string chunk(std::size_t{1} << 20, static_cast<char>('a' + i));
    ASSERT_TRUE(store->put_chunk(sha256_of(chunk), chunk));
    mesh.chunks.push_back({sha256_of(chunk), chunk.size()});
  }
  ASSERT_EQ(store->finish(claim->ref, mesh), Held::kHeld);
  StoreResult<bool> put = false;
  for (int i = 8; put; ++i) {
    const std::string chunk(std::size_t{1} << 20, static_cast<char>('a' + i));
    put = store->put_chunk(sha256_of(chunk), chunk);
  }
  EXPECT_EQ(put.error().kind, StoreErrorKind::kFull);
  {  // another program takes the rest
    std::ofstream rest(path() + "/rest", std::ios::binary);
    const std::string page(4096, 'x');
    while (rest.write(page.data(), 4096).flush()) continue;
  }
  while (store->submit({.owner = "bob", .key = key_of("b"), .request = std::string(1 << 20, 'r')}))
    continue;
  const auto cancelled = store->cancel("ann", waiting->job.id);
  ASSERT_TRUE(cancelled) << cancelled.error().message;
  const auto removed = store->remove("ann", job->job.id);
  ASSERT_TRUE(removed) << removed.error().message;
  EXPECT_FALSE(*store->get("ann", job->job.id));
  const std::uintmax_t before = bytes_on_disk();
  const auto collected = store->collect({.loose_age = seconds(0)});
  ASSERT_TRUE(collected) << collected.error().message;
  EXPECT_GT(collected->chunks, 8U);
  EXPECT_LT(bytes_on_disk() + (std::uintmax_t{8} << 20), before);
  EXPECT_EQ(std::filesystem::file_size(path() + "/weft.reserve"), std::uintmax_t{4} << 20)
      << "the next time needs it, too";
  EXPECT_TRUE(store->submit({.owner = "ann", .key = key_of("k")}));
  store.reset();
}

TEST_F(SqliteTest, AStoreThatWasCutOffIsNoNewOne) {
  {
    const auto store = *open();
    ASSERT_TRUE(store->submit({.owner = "ann", .key = key_of("k")}));
  }
  const std::string file = path() + "/weft.db";
  std::filesystem::resize_file(file, 0);
  for (int i = 0; i < 2; ++i) {
    const auto opened = open();
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().kind, StoreErrorKind::kBroken);
    EXPECT_NE(opened.error().message.find(file + " has 0 bytes"), std::string::npos)
        << opened.error().message;
  }
  std::filesystem::remove(file);
  EXPECT_TRUE(open()) << "that is how to begin anew";
}

}  // namespace
}  // namespace weft::server
