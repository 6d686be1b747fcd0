// SPDX-License-Identifier: Apache-2.0
// The real program: flags, signals, exit codes, the port file.
#include <fcntl.h>
#include <grpcpp/create_channel.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/files/support/temp_folder.h"
#include "tests/server/harness.h"
#include "tests/server/logged_server.h"
#include "tests/support/paths.h"

namespace weft::server {
namespace {

namespace fs = std::filesystem;
using Environment = std::map<std::string, std::string>;

// A running weftd with pipes on its standard input, output and error.
class Weftd {
 public:
  explicit Weftd(std::vector<std::string> flags, const Environment& environment = {}) {
    int in[2];
    int out[2];
    if (::pipe2(in, O_CLOEXEC) != 0 || ::pipe2(out, O_CLOEXEC) != 0) std::abort();
    flags.insert(flags.begin(), "weftd");
    std::vector<char*> argv;
    for (std::string& flag : flags) argv.push_back(flag.data());
    argv.push_back(nullptr);
    std::vector<std::string> settings;
    for (const auto& [name, value] : environment) settings.push_back(name + "=" + value);
    for (char** each = environ; *each != nullptr; ++each) {
      const std::string setting = *each;
      if (!environment.contains(setting.substr(0, setting.find('=')))) settings.push_back(setting);
    }
    std::vector<char*> envp;
    for (std::string& setting : settings) envp.push_back(setting.data());
    envp.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(in[0], STDIN_FILENO);
      ::dup2(out[1], STDOUT_FILENO);
      ::dup2(out[1], STDERR_FILENO);
      ::alarm(30);  // a server that should have ended fails the test instead of hanging it
      ::execve(weft::testing::kWeftd, argv.data(), envp.data());
      ::_exit(127);
    }
    ::close(in[0]);
    ::close(out[1]);
    input_ = in[1];
    output_ = ::fdopen(out[0], "r");
  }
  ~Weftd() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    close_input();
    std::fclose(output_);
  }

  // Reads the log up to a line that contains the text, and returns that line; empty if the
  // output ends before.
  std::string read_until(const std::string& text) {
    char* line = nullptr;
    std::size_t size = 0;
    std::string found;
    while (found.empty() && ::getline(&line, &size, output_) > 0) {
      log_ += line;
      if (std::string(line).find(text) != std::string::npos) found = line;
    }
    std::free(line);
    return found;
  }
  std::string address() {
    const std::string line = read_until("event=listening");
    const auto start = line.find("address=") + 8;
    return line.substr(start, line.find_last_not_of('\n') - start + 1);
  }
  void signal(int number) { ::kill(pid_, number); }
  void close_input() {
    if (input_ >= 0) ::close(input_);
    input_ = -1;
  }
  // The exit code, 1000 + signal where one killed it.
  int wait() {
    while (!read_until("\n").empty()) {
    }
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  const std::string& log() const { return log_; }

 private:
  pid_t pid_ = 0;
  int input_ = -1;
  std::FILE* output_ = nullptr;
  std::string log_;
};

std::unique_ptr<v1::MeshService::Stub> connect(const std::string& address) {
  return v1::MeshService::NewStub(grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
}

v1::GetServerInfoResponse info_of(const std::string& address) {
  grpc::ClientContext context;
  v1::GetServerInfoResponse info;
  const grpc::Status status = connect(address)->GetServerInfo(&context, {}, &info);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return info;
}

// Its call does not end while nobody reads.
v1::GenerateMeshRequest endless_request() {
  v1::GenerateMeshRequest request = testing::valid_request();
  request.mutable_size()->set_constant(1e-5);  // more than fits between it and an idle reader
  return request;
}

class TemporaryFolder : public ::testing::Test {
 protected:
  files::TempFolder folder_;
};

const std::vector<std::string> kAnyPort = {"--listen", "127.0.0.1:0"};

TEST(Process, ServesAMeshOfARealDomain) {
  Weftd weftd(kAnyPort);
  const testing::Outcome outcome =
      testing::call(*connect(weftd.address()), testing::valid_request());
  ASSERT_TRUE(outcome.status.ok()) << outcome.status.error_message();
  EXPECT_NEAR(outcome.messages.back().summary().area(), 16, 1e-12);
  weftd.signal(SIGTERM);
  EXPECT_EQ(weftd.wait(), 0);
  EXPECT_NE(weftd.log().find("event=call_ended"), std::string::npos);
  EXPECT_NE(weftd.log().find("status=OK"), std::string::npos);
}

TEST(Process, LogsLinesOfJsonWhereAsked) {
  Weftd weftd({"--listen", "127.0.0.1:0", "--log-format", "json"});
  const auto listening = nlohmann::json::parse(weftd.read_until("listening"));
  EXPECT_TRUE(
      testing::call(*connect(listening.at("address")), testing::valid_request()).status.ok());
  weftd.signal(SIGTERM);
  EXPECT_EQ(weftd.wait(), 0);
  std::istringstream lines(weftd.log());
  std::set<std::string> events;
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json.at("level"), "info") << line;
    EXPECT_EQ(json.at("time").get<std::string>().size(), 24u) << line;
    events.insert(json.at("event"));
    if (json.at("event") == "call_ended") {
      EXPECT_GT(json.at("triangles"), 0) << line;
    }
  }
  for (const char* event : {"starting", "listening", "call_queued", "call_started", "call_ended",
                            "draining", "stopped"})
    EXPECT_TRUE(events.contains(event)) << event;
}

TEST(Process, EndsWithZeroOnSigtermAndOnSigint) {
  for (const int signal : {SIGTERM, SIGINT}) {
    Weftd weftd(kAnyPort);
    weftd.address();
    weftd.signal(signal);
    EXPECT_EQ(weftd.wait(), 0);
  }
}

TEST_F(TemporaryFolder, ASecondSignalEndsItAtOnceAndLeavesNoSocketFile) {
  const std::string address = "unix:" + (folder_ / "s").string();
  Weftd weftd({"--listen", address, "--drain", "1000"});
  weftd.address();
  auto stub = connect(address);
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, endless_request());
  v1::GenerateMeshResponse accepted;
  ASSERT_TRUE(reader->Read(&accepted));
  weftd.signal(SIGTERM);
  EXPECT_NE(weftd.read_until("event=draining"), "");
  weftd.signal(SIGTERM);
  EXPECT_EQ(weftd.wait(), 128 + SIGTERM);
  EXPECT_FALSE(fs::exists(folder_ / "s"));
}

TEST_F(TemporaryFolder, ReadsTokensAgainOnSighupAndGoesOn) {
  const std::string tokens = folder_.write("tokens", "ann secret-of-ann-16\n").string();
  Weftd weftd({"--listen", "127.0.0.1:0", "--tokens", tokens, "--drain", "1000"});
  const std::string address = weftd.address();
  weftd.signal(SIGHUP);
  EXPECT_NE(weftd.read_until("event=reloaded cause=SIGHUP"), "");
  folder_.write("tokens", "ann secret-of-ann-16\nbob secret-of-bob-16\n");
  weftd.signal(SIGHUP);
  EXPECT_NE(weftd.read_until("event=tokens_read"), "");
  auto stub = connect(address);
  grpc::ClientContext context;
  context.AddMetadata("authorization", "Bearer secret-of-bob-16");
  auto reader = stub->GenerateMesh(&context, endless_request());
  v1::GenerateMeshResponse accepted;
  ASSERT_TRUE(reader->Read(&accepted));
  weftd.signal(SIGTERM);
  EXPECT_NE(weftd.read_until("event=draining"), "");
  weftd.signal(SIGHUP);  // does not cut the draining short
  context.TryCancel();
  EXPECT_EQ(weftd.wait(), 0);
}

TEST(Process, EndsWithStandardInputWhereAsked) {
  Weftd weftd({"--listen", "127.0.0.1:0", "--exit-with-stdin"});
  weftd.address();
  weftd.close_input();
  EXPECT_EQ(weftd.wait(), 0);
}

TEST(Process, OutlivesStandardInputWhereNotAsked) {
  Weftd weftd(kAnyPort);
  const std::string address = weftd.address();
  weftd.close_input();
  EXPECT_FALSE(info_of(address).version().empty());
}

TEST_F(TemporaryFolder, WritesTheBoundAddressesToThePortFile) {
  const fs::path file = folder_ / "ports";
  const std::string socket = "unix:" + (folder_ / "s").string();
  Weftd weftd({"--listen", "127.0.0.1:0", "--listen", socket, "--port-file", file.string()});
  const std::string tcp = weftd.address();
  EXPECT_EQ(weftd.address(), socket);
  weftd.signal(SIGTERM);  // the file is written by the time signals are heard
  EXPECT_EQ(weftd.wait(), 0);
  std::ifstream in(file);
  std::string first;
  std::string second;
  std::getline(in, first);
  std::getline(in, second);
  EXPECT_EQ(first, tcp);
  EXPECT_EQ(second, socket);
}

// Both streams are one pipe here, so that the lines' order says when it was written.
TEST(Process, WritesTheBoundAddressesToTheStandardOutputOnceItListens) {
  Weftd weftd({"--listen", "127.0.0.1:0", "--port-file", "-"});
  const std::string address = weftd.address();
  EXPECT_EQ(weftd.read_until(""), address + "\n");
}

// A file that is no library stands in for one that is missing: the loader looks there first.
TEST_F(TemporaryFolder, NamesThePackageOfALibraryThatItCannotLoad) {
  std::ofstream(folder_ / "libpq.so.5") << "no library";
  const Environment environment{{"LD_LIBRARY_PATH", folder_.path().string()}};
  Weftd without(kAnyPort, environment);
  EXPECT_FALSE(without.address().empty());
  Weftd weftd({"--listen", "127.0.0.1:0", "--store", "postgresql:///nowhere"}, environment);
  const std::string line = weftd.read_until("event=cannot_open_store");
  EXPECT_NE(line.find(" (Debian's package libpq5); weftd needs it for PostgreSQL"),
            std::string::npos)
      << line;
  EXPECT_EQ(weftd.wait(), 4);
}

TEST_F(TemporaryFolder, WritesTheConsolesAddressToThePortFile) {
  const fs::path file = folder_ / "ports";
  Weftd weftd({"--listen", "127.0.0.1:0", "--port-file", file.string()},
              {{"WEFT_CONSOLE", "127.0.0.1:0"}});
  weftd.address();
  weftd.signal(SIGTERM);
  EXPECT_EQ(weftd.wait(), 0);
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::getline(in, line);
  EXPECT_EQ(line.rfind("console=127.0.0.1:", 0), 0u) << line;
}

TEST(Process, ReadsFlagsFromTheEnvironmentAndFlagsWin) {
  Weftd weftd({"--max-segments", "11"}, {{"WEFT_LISTEN", "127.0.0.1:0"},
                                         {"WEFT_MAX_POINTS", "10"},
                                         {"WEFT_MAX_RASTER_VALUES", "7"},
                                         {"WEFT_MAX_SEGMENTS", "99"},
                                         {"WEFT_MAX_REQUEST_BYTES", "2MiB"},
                                         {"WEFT_THREADS", "3"}});
  const v1::GetServerInfoResponse info = info_of(weftd.address());
  EXPECT_EQ(info.limits().max_points(), 10u);
  EXPECT_EQ(info.limits().max_segments(), 11u);
  EXPECT_EQ(info.limits().max_raster_values(), 7u);
  EXPECT_EQ(info.limits().max_request_bytes(), 2u << 20);
  EXPECT_EQ(info.threads(), 3u);
  EXPECT_EQ(info.limits().max_concurrent_jobs(), 4u);
}

TEST(Process, RunsAsManyJobsAtOnceAsThreadsButAtLeastFour) {
  const auto jobs = [](const char* threads) {
    Weftd weftd({"--listen", "127.0.0.1:0", "--threads", threads});
    return info_of(weftd.address()).limits().max_concurrent_jobs();
  };
  EXPECT_EQ(jobs("1"), 4u);
  EXPECT_EQ(jobs("6"), 6u);
}

TEST(Process, EndsWith3WhereItCannotListenAndSaysWhy) {
  Weftd first(kAnyPort);
  const std::string address = first.address();
  Weftd second({"--listen", address});
  EXPECT_EQ(second.wait(), 3);
  EXPECT_NE(second.log().find(address), std::string::npos) << second.log();
  EXPECT_NE(second.log().find("in use"), std::string::npos) << second.log();
}

TEST(Process, EndsWith3WhereItWouldListenToOtherMachinesUnencrypted) {
  Weftd weftd({"--listen", "0.0.0.0:0"});
  EXPECT_EQ(weftd.wait(), 3);
  EXPECT_NE(weftd.log().find("--insecure"), std::string::npos) << weftd.log();
}

TEST(Process, EndsWith2OnWrongFlags) {
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--no-such-flag"},
                                                {"--queue", "-1"},
                                                {"--max-bytes", "many"},
                                                {"--threads", "0"},
                                                {"--log-level", "loud"},
                                                {"--log-format", "xml"},
                                                {"--tls-cert", "a.pem"},
                                                {"--tls-key", "a.key"},
                                                {"--tls-client-ca", "ca.pem"},
                                                {"--max-seconds", "nan"}})
    EXPECT_EQ(Weftd(flags, {{"WEFT_LISTEN", "127.0.0.1:0"}}).wait(), 2) << flags.front();
}

TEST(Process, EndsWith2OnFlagsOfAStoreWithoutOne) {
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--role", "worker"},
                                                {"--keep", "60"},
                                                {"--max-queued", "9"},
                                                {"--notify-secrets", "f"}}) {
    Weftd weftd(flags, {{"WEFT_LISTEN", "127.0.0.1:0"}});
    EXPECT_EQ(weftd.wait(), 2) << flags.front();
    EXPECT_NE(weftd.log().find(flags.front() + " requires --data or --store"), std::string::npos)
        << weftd.log();
  }
}

TEST_F(TemporaryFolder, HealthAsksTheServerOfTheSameVariables) {
  const std::string socket = "unix:" + (folder_ / "s").string();
  const fs::path tokens = folder_ / "tokens";
  std::ofstream(tokens) << "somebody " << std::string(32, 'x') << '\n';
  fs::permissions(tokens, fs::perms::owner_read);
  const Environment environment = {{"WEFT_LISTEN", "127.0.0.1:0," + socket},
                                   {"WEFT_TOKENS", tokens.string()}};
  Weftd nobody({"--health"}, environment);
  EXPECT_EQ(nobody.wait(), 1);
  EXPECT_NE(nobody.log().find(socket), std::string::npos) << nobody.log();
  Weftd weftd({}, environment);
  weftd.address();
  ASSERT_EQ(weftd.address(), socket);
  EXPECT_EQ(Weftd({"--health"}, environment).wait(), 0);
}

TEST_F(TemporaryFolder, HealthFailsWhileTheServerDrains) {
  const std::string socket = "unix:" + (folder_ / "s").string();
  Weftd weftd({"--listen", socket, "--drain", "1000"});
  ASSERT_EQ(weftd.address(), socket);
  auto stub = connect(socket);
  grpc::ClientContext context;
  auto reader = stub->GenerateMesh(&context, endless_request());
  v1::GenerateMeshResponse accepted;
  ASSERT_TRUE(reader->Read(&accepted));
  weftd.signal(SIGTERM);
  EXPECT_NE(weftd.read_until("event=draining"), "");
  std::string answer;
  EXPECT_TRUE(testing::eventually([&] {  // the line comes just before
    Weftd health({"--health", "--listen", socket});
    const bool fails = health.wait() == 1;
    answer = health.log();
    return fails;
  }));
  EXPECT_NE(answer.find("is not serving"), std::string::npos) << answer;
}

TEST(Process, HealthEndsWith2WithoutASocketToAskAt) {
  Weftd health({"--health", "--listen", "127.0.0.1:0"});
  EXPECT_EQ(health.wait(), 2);
  EXPECT_NE(health.log().find("no unix: address"), std::string::npos) << health.log();
}

TEST(Process, TellsItsVersion) {
  Weftd weftd({"--version"});
  EXPECT_EQ(weftd.wait(), 0);
  EXPECT_EQ(weftd.log().find("weftd " WEFT_VERSION), 0u) << weftd.log();
}

}  // namespace
}  // namespace weft::server
