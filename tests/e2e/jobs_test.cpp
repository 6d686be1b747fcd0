// SPDX-License-Identifier: Apache-2.0
// Jobs through the real weft and the real weftd: submitted, left alone, found again, fetched.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <future>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "client/call/fetch_mesh.h"
#include "files/geo/projection.h"
#include "tests/client/support/torn_relay.h"
#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

class JobsByCommand : public ::testing::Test {
 protected:
  // The slowest machine renews its leases in time, so that no job begins again by itself.
  explicit JobsByCommand(const Words& leases = {"--lease", "60"}) : server_(with_data(leases)) {}

  Outcome weft(Words words) const {
    words.insert(words.end(), {"--server", server_.address()});
    return run_weft(words);
  }
  // The id of the job.
  std::string submit(const Words& more) const {
    Words words = {"submit"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = weft(words);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return outcome.out.substr(0, outcome.out.find('\n'));
  }
  json get(const std::string& id) const { return json::parse(weft({"get", id, "--json"}).out); }
  // Looks until the job is in this state.
  void wait_until(const std::string& id, const std::string& state) const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    while (get(id)["state"] != state) {
      ASSERT_LT(std::chrono::steady_clock::now(), end) << get(id).dump();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }

  Folder folder_;
  const std::string data_ = folder_ / "data";
  Server server_;
  const std::string pipe_ = model("pipe.poly");
  const Words large_ = {model("us-east-coast.poly"), "--size", "1e-5"};

 private:
  Words with_data(Words words) const {
    words.insert(words.end(), {"--data", data_});
    return words;
  }
};

TEST_F(JobsByCommand, MadeWhileNobodyWaitsAreTheFilesThatMeshWrites) {
  const Words request_options = {"--size", "0.4*hypot(x-200, y-200) + 1"};
  Words words = {pipe_};
  words.insert(words.end(), request_options.begin(), request_options.end());
  const std::string id = submit(words);
  const Outcome fetched = weft({"fetch", id, "--wait", "--domain", pipe_, "-o", folder_ / "f.vtu",
                                "-o", folder_ / "f.node"});
  ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
  Words mesh = {"mesh", pipe_, "-o", folder_ / "m.vtu", "-o", folder_ / "m.node"};
  mesh.insert(mesh.end(), request_options.begin(), request_options.end());
  ASSERT_EQ(weft(mesh).exit_code, 0);
  for (const char* extension : {".vtu", ".node", ".ele", ".poly"}) {
    const std::string made = files::contents_of(folder_ / (std::string("m") + extension));
    EXPECT_FALSE(made.empty());
    EXPECT_EQ(files::contents_of(folder_ / (std::string("f") + extension)), made) << extension;
  }
}

TEST_F(JobsByCommand, OfWhichSegmentsAreOutsideFailIfTheyAreStrict) {
  // Three sides of a square around a triangle.
  const std::string gap = folder_.write("gap.poly",
                                        "7 2\n1 0 0\n2 9 0\n3 9 9\n4 0 9\n5 3 3\n6 6 3\n7 6 6\n"
                                        "6\n1 1 2\n2 2 3\n3 3 4\n4 5 6\n5 6 7\n6 7 5\n0\n");
  const std::string told = "3 segments lie outside of what is meshed, the first at (0, 0)";
  const std::string mesh = folder_ / "gap.vtu";
  for (const Words& output : {Words{}, Words{"-o", mesh}}) {
    Words words = {"submit", gap, "--size", "1", "--wait"};
    words.insert(words.end(), output.begin(), output.end());
    const Outcome lenient = weft(words);
    EXPECT_EQ(lenient.exit_code, 0) << lenient.err;
    EXPECT_NE(lenient.err.find("WARNING: " + told), std::string::npos) << lenient.err;
    std::filesystem::remove(mesh);
    words.push_back("--strict");
    const Outcome strict = weft(words);
    EXPECT_EQ(strict.exit_code, 4);
    EXPECT_NE(strict.err.find("gap.poly: refused, because of --strict\n  " + told),
              std::string::npos)
        << strict.err;
    EXPECT_FALSE(std::filesystem::exists(mesh));
  }
}

TEST_F(JobsByCommand, InLongitudeAndLatitudeAreBroughtBackByTheDomain) {
  if (!files::Projection::available()) GTEST_SKIP() << "built without PROJ";
  const std::string coast = model("us-east-coast.geojson");
  const std::string id = submit({coast, "--lonlat", "--size", "1e9"});
  ASSERT_EQ(weft({"mesh", coast, "--lonlat", "--size", "1e9", "-o", folder_ / "m.vtu"}).exit_code,
            0);
  const Outcome unnamed = weft({"fetch", id, "--wait", "--lonlat", "-o", folder_ / "f.vtu"});
  EXPECT_EQ(unnamed.exit_code, 2);
  EXPECT_NE(unnamed.err.find("--domain INPUT"), std::string::npos) << unnamed.err;
  const Outcome fetched =
      weft({"fetch", id, "--wait", "--lonlat", "--domain", coast, "-o", folder_ / "f.vtu"});
  ASSERT_EQ(fetched.exit_code, 0) << fetched.err;
  EXPECT_EQ(files::contents_of(folder_ / "f.vtu"), files::contents_of(folder_ / "m.vtu"));
}

TEST_F(JobsByCommand, AskedForTwiceAreMadeOnce) {
  const Outcome first = weft({"submit", pipe_, "--wait", "--json"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const Outcome second = weft({"submit", pipe_, "--json"});
  const json made = json::parse(first.out);
  const json kept = json::parse(second.out);
  EXPECT_NE(made["id"], kept["id"]);
  EXPECT_FALSE(made["from_store"]);
  EXPECT_TRUE(kept["from_store"]);
  EXPECT_EQ(kept["state"], "succeeded");
  EXPECT_EQ(kept["summary"]["digest"], made["summary"]["digest"]);
  const Outcome anew = weft({"submit", pipe_, "--no-cache", "--wait", "--json"});
  EXPECT_FALSE(json::parse(anew.out)["from_store"]);
  EXPECT_EQ(json::parse(anew.out)["summary"]["digest"], made["summary"]["digest"]);
}

TEST_F(JobsByCommand, SubmittedAgainByARequestIdAreTheSameJob) {
  const std::string id = submit({pipe_, "--request-id", "nightly"});
  EXPECT_EQ(submit({pipe_, "--request-id", "nightly"}), id);
  EXPECT_EQ(weft({"submit", pipe_, "--request-id", "nightly", "--size", "9"}).exit_code, 70);
}

TEST_F(JobsByCommand, ThatFailSayWhyWhereverTheyAreAskedFor) {
  const Outcome waited = weft({"submit", pipe_, "--size", "x - 1000", "--wait"});
  EXPECT_EQ(waited.exit_code, 67) << waited.err;
  const std::string id = waited.out.substr(0, waited.out.find('\n'));
  EXPECT_NE(waited.err.find("the job " + id + " failed with INVALID_ARGUMENT (BAD_SIZE_VALUE)"),
            std::string::npos)
      << waited.err;
  EXPECT_EQ(weft({"watch", id}).exit_code, 67);
  EXPECT_EQ(get(id)["error"]["reason"], "BAD_SIZE_VALUE");
  EXPECT_EQ(weft({"fetch", id, "-o", folder_ / "f.vtu"}).exit_code, 67);
  const Outcome list = weft({"list", "--state", "failed"});
  EXPECT_NE(list.out.find("INVALID_ARGUMENT (BAD_SIZE_VALUE)"), std::string::npos) << list.out;
}

TEST_F(JobsByCommand, ThatAreCancelledEndAndAreForgottenWhenDeleted) {
  const std::string id = submit(large_);
  wait_until(id, "running");
  EXPECT_EQ(weft({"delete", id}).exit_code, 73);
  EXPECT_EQ(weft({"cancel", id}).out, id + " cancelled\n");
  EXPECT_EQ(weft({"watch", id}).exit_code, 65);
  EXPECT_EQ(weft({"delete", id}).out, id + " deleted\n");
  EXPECT_EQ(weft({"get", id}).exit_code, 69);
  EXPECT_EQ(weft({"list", "--json"}).out, "{\"jobs\":[]}\n");
}

// A worker that is killed counts as lost soon.
class JobsOfAServerThatDies : public JobsByCommand {
 protected:
  JobsOfAServerThatDies() : JobsByCommand({"--lease", "2", "--max-attempts", "100"}) {}
};

TEST_F(JobsOfAServerThatDies, AreWatchedThroughItsDeath) {
  const std::string id = submit({model("us-east-coast.poly"), "--size", "1e-4", "--threads", "1"});
  auto watched = std::async(std::launch::async, [&] { return weft({"watch", id, "--json"}); });
  wait_until(id, "running");
  server_.kill();
  server_.start();
  const Outcome outcome = watched.get();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  json last;
  for (std::string line; std::getline(lines, line);) last = json::parse(line);
  EXPECT_EQ(last["state"], "succeeded");
  EXPECT_GE(last["attempts"], 2) << "a slow machine loses leases, too";
}

TEST_F(JobsByCommand, AreListedOverAllPages) {
  Words ids;
  for (int i = 0; i < 5; ++i) ids.push_back(submit({pipe_}));
  std::ranges::reverse(ids);
  const json jobs = json::parse(weft({"list", "--json"}).out)["jobs"];
  ASSERT_EQ(jobs.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(jobs[i]["id"], ids[i]);
  EXPECT_EQ(json::parse(weft({"list", "--limit", "2", "--json"}).out)["jobs"].size(), 2u);
}

TEST_F(JobsByCommand, ShowThemselvesAtWork) {
  const std::string id = submit(large_);
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  Outcome top = weft({"top"});
  while (top.out.find("AT WORK\n" + id + "  refining [") == std::string::npos) {
    ASSERT_LT(std::chrono::steady_clock::now(), end) << top.out << top.err;
    top = weft({"top"});
  }
  EXPECT_NE(top.out.find("queued 0  running 1  "), std::string::npos) << top.out;
  EXPECT_EQ(weft({"cancel", id}).exit_code, 0);
  EXPECT_NE(weft({"top"}).out.find("ENDED\n" + id + "  cancelled"), std::string::npos);
}

// Every connection brings a chunk or two before it tears, in the middle of a message.
TEST_F(JobsByCommand, ArriveWholeOverAWireThatTearsAgainAndAgain) {
  const std::string id = submit({model("cylinder.poly"), "--size", "0.004", "--wait"});
  const auto arrive = [&](const std::string& address) {
    auto server = client::JobServer::connect({.server = {.server = address}}, {});
    server->on_away([](const std::string&) {});
    auto spool = client::MeshSpool::create(folder_.path()).value();
    const auto report = client::fetch_mesh(*server, id, *spool, {});
    EXPECT_TRUE(report) << report.error().message;
    const files::MeshView mesh = spool->view().value();
    return std::tuple(report ? report->summary.chunks() : 0,
                      std::vector(mesh.coordinates.begin(), mesh.coordinates.end()),
                      std::vector(mesh.triangles.begin(), mesh.triangles.end()),
                      std::vector(mesh.edges.begin(), mesh.edges.end()));
  };
  const std::string address = server_.address();
  const auto whole = arrive(address);
  const std::size_t chunks = std::get<0>(whole);
  EXPECT_GE(chunks, 4u);
  std::vector<std::size_t> tears(chunks);
  for (std::size_t i = 0; i < chunks; ++i) tears[i] = 1'150'000 + 10'007 * i;
  const client::TornRelay relay(folder_ / "wire", address.substr(std::string("unix:").size()),
                                tears);
  EXPECT_EQ(arrive(relay.address()), whole);
  EXPECT_GE(relay.torn(), 2u);
}

TEST(JobsOfAServerWithoutAStore, AreRefused) {
  const Server server;
  const Outcome outcome = run_weft({"submit", model("pipe.poly"), "--server", server.address()});
  EXPECT_EQ(outcome.exit_code, 76);
  EXPECT_NE(outcome.err.find("UNIMPLEMENTED"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace weft::e2e
