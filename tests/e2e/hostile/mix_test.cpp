// SPDX-License-Identifier: Apache-2.0
// One hostile client of each kind and ten honest ones at a server, all at once. How long the honest
// ones wait is printed beside what they wait for alone: bench/README.md has the figures of ten
// minutes.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "client/call/mesh_request.h"
#include "files/formats/domain_formats.h"
#include "tests/e2e/fleet.h"
#include "tests/e2e/hostile/kinds.h"
#include "tests/e2e/programs.h"
#include "tests/support/event.h"
#include "tests/support/paths.h"

namespace weft::e2e {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kHonest = 10;
constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kMemory = 1024 * kMiB;  // of the server, by --memory
// Up to half a megabyte a minute is what is measured on two cores.
constexpr double kMaxLogPerSecond = 3'000'000 / 60.0;

// The grading of the paper's pipe: some milliseconds of work.
const v1::GenerateMeshRequest& pipe() {
  static const v1::GenerateMeshRequest request = [] {
    client::RequestOptions options;
    options.size = "0.4*hypot(x-200, y-200) + 1";
    options.asked.set_no_cache(true);
    return client::make_request(files::read_domain(model("pipe.poly")).value(), options);
  }();
  return request;
}

class Honest {
 public:
  Honest(std::string address, std::string name, std::string digest)
      : address_(std::move(address)), name_(std::move(name)), digest_(std::move(digest)) {}

  // Until then, one request after the other, on one connection.
  void ask(steady_clock::time_point end) {
    const auto stub = v1::MeshService::NewStub(connect(address_));
    while (steady_clock::now() < end) {
      const auto begin = steady_clock::now();
      grpc::ClientContext context;
      identify(context, name_, kPatience);
      const auto reader = stub->GenerateMesh(&context, pipe());
      v1::GenerateMeshResponse message;
      const std::string digest = digest_of_stream(*reader, message);
      const grpc::Status status = reader->Finish();
      seconds.push_back(std::chrono::duration<double>(steady_clock::now() - begin).count());
      if (!status.ok())
        ++refusals[std::to_string(status.error_code()) + " " + status.error_message()];
      else if (digest != digest_)
        ++wrong;
      std::this_thread::sleep_for(milliseconds(100));
    }
  }

  std::vector<double> seconds;  // of each answer
  std::map<std::string, int> refusals;
  int wrong = 0;

 private:
  const std::string address_;
  const std::string name_;
  const std::string digest_;
};

struct Waits {
  std::size_t answers = 0;
  double median = 0;
  double p99 = 0;
  double longest = 0;
};

// Ten of them for so long: none is refused, and no mesh is wrong.
Waits ask_honestly(const std::string& address, const std::string& digest, int time) {
  std::vector<Honest> clients;
  for (int i = 0; i < kHonest; ++i)
    clients.emplace_back(address, "honest" + std::to_string(i), digest);
  std::vector<std::thread> threads;
  const auto end = steady_clock::now() + std::chrono::seconds(time);
  for (Honest& client : clients) threads.emplace_back([&client, end] { client.ask(end); });
  for (std::thread& thread : threads) thread.join();
  std::vector<double> all;
  for (const Honest& client : clients) {
    all.insert(all.end(), client.seconds.begin(), client.seconds.end());
    EXPECT_EQ(client.wrong, 0);
    for (const auto& [refusal, times] : client.refusals)
      ADD_FAILURE() << times << " times " << refusal;
  }
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  return {all.size(), at(0.5), at(0.99), all.back()};
}

std::string tokens() {
  std::string lines;
  const auto add = [&lines](const std::string& name) {
    lines += name + " " + token_of(name) + "\n";
  };
  for (int i = 0; i < kHonest; ++i) add("honest" + std::to_string(i));
  for (const char* const kind : kHostileKinds) add(kind);
  return lines;
}

TEST(HostileMix, HarmsNoHonestClient) {
  const Folder folder;
  const Server server({"--listen", "127.0.0.1:0", "--data", folder / "data", "--threads", "2",
                       "--memory", std::to_string(kMemory), "--tokens",
                       folder.write("tokens", tokens()).string()});
  const std::string address = server.addresses().at(1);
  Reference reference;
  const std::string digest = reference.digest(pipe());
  const int seconds = few_or_many(10, 600);
  const Waits alone = ask_honestly(address, digest, std::min(seconds, 60));
  const double log_of_answer =
      static_cast<double>(server.logged_bytes()) / static_cast<double>(alone.answers);

  const std::uint64_t logged = server.logged_bytes();
  Outcome hostile;
  std::thread at_work([&] {
    hostile = run_program(testing::kHostileClients, {address, std::to_string(seconds)});
  });
  const Waits beside = ask_honestly(address, digest, seconds);
  const double log = static_cast<double>(server.logged_bytes() - logged) -
                     log_of_answer * static_cast<double>(beside.answers);
  at_work.join();
  EXPECT_EQ(hostile.exit_code, 0) << hostile.err;

  const auto print = [](const char* when, const Waits& waits) {
    std::printf("%s: %zu answers, median %.1f ms, 99 %% within %.1f ms, all within %.1f ms\n", when,
                waits.answers, 1e3 * waits.median, 1e3 * waits.p99, 1e3 * waits.longest);
  };
  print("alone", alone);
  print("beside hostile clients", beside);
  std::printf("%.0f MiB at most of %.0f MiB; %.0f kB of log a minute of hostile calls\n%s",
              static_cast<double>(server.peak_bytes()) / kMiB, static_cast<double>(kMemory) / kMiB,
              log / seconds * 60 / 1000, hostile.out.c_str());
  EXPECT_LT(log / seconds, kMaxLogPerSecond);
  if (kMemoryTells) {
    EXPECT_LT(server.peak_bytes(), kMemory + kMemory / 10);
  }
}

}  // namespace
}  // namespace weft::e2e
