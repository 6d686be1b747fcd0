// SPDX-License-Identifier: Apache-2.0
// weft and weftd with certificates and tokens, as their users give them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>

#include "tests/e2e/programs.h"
#include "tests/support/certificates.h"

namespace weft::e2e {
namespace {

using weft::testing::TestCa;
using weft::testing::TestCertificate;
using Words = std::vector<std::string>;

constexpr int kUnavailable = 64 + 14;
constexpr int kUnauthenticated = 64 + 16;

// Sets a variable for the programs that a test runs.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

// A server that is encrypted, and wants a certificate and a token.
class Secure : public ::testing::Test {
 protected:
  Secure() {
    const TestCertificate server =
        ca_.issue({.common_name = "weftd", .names = {"IP:127.0.0.1", "DNS:mesh.example.org"}});
    const TestCertificate ann = ca_.issue({.common_name = "ann"});
    ca_file_ = folder_.write("ca.pem", ca_.pem());
    cert_file_ = folder_.write("ann.pem", ann.pem);
    key_file_ = folder_.write("ann.key", ann.key);
    token_file_ = folder_.write("ann.token", "secret-of-ann-16\n");
    server_.emplace(Words{"--listen", "127.0.0.1:0",                                       //
                          "--tls-cert", folder_.write("server.pem", server.pem).string(),  //
                          "--tls-key", folder_.write("server.key", server.key).string(),   //
                          "--tls-client-ca", ca_file_,                                     //
                          "--tokens", folder_.write("tokens", "ann secret-of-ann-16\n").string()});
    address_ = server_->addresses().at(1);
  }

  Outcome weft(Words words, const Words& more) {
    words.insert(words.end(), {"--server", address_});
    words.insert(words.end(), more.begin(), more.end());
    return run_weft(words);
  }
  Words certificate() const {
    return {"--tls-ca", ca_file_, "--tls-cert", cert_file_, "--tls-key", key_file_};
  }
  Words certificate_and_token() const {
    Words words = certificate();
    words.insert(words.end(), {"--token-file", token_file_});
    return words;
  }

  const Folder folder_;
  const TestCa ca_{"a CA"};
  std::string ca_file_;
  std::string cert_file_;
  std::string key_file_;
  std::string token_file_;
  std::optional<Server> server_;
  std::string address_;  // TCP
};

TEST_F(Secure, MeshesForWhoeverHasACertificateAndAToken) {
  const std::string mesh = (folder_ / "key.vtu").string();
  const Outcome outcome = weft({"mesh", model("key.poly"), "-o", mesh}, certificate_and_token());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(run_weft({"check", mesh, "--domain", model("key.poly")}).exit_code, 0);
}

TEST_F(Secure, TakesTheTokenFromTheEnvironment) {
  const Variable token("WEFT_TOKEN", "secret-of-ann-16");
  EXPECT_EQ(weft({"server-info"}, certificate()).exit_code, 0);
}

TEST_F(Secure, EndsWith80WithoutTheRightToken) {
  const Outcome without = weft({"server-info"}, certificate());
  EXPECT_EQ(without.exit_code, kUnauthenticated);
  EXPECT_NE(without.err.find("UNAUTHENTICATED"), std::string::npos) << without.err;
  const Variable token("WEFT_TOKEN", "secret-of-bob-16");
  EXPECT_EQ(weft({"server-info"}, certificate()).exit_code, kUnauthenticated);
}

TEST_F(Secure, AnswersHealthWithoutAToken) {
  EXPECT_EQ(weft({"health"}, certificate()).exit_code, 0);
}

TEST_F(Secure, EndsWith78WhereTheTwoDoNotTrustEachOther) {
  const TestCa other("another CA");
  const std::string other_file = folder_.write("other.pem", other.pem()).string();
  EXPECT_EQ(weft({"health"}, {"--tls-ca", ca_file_}).exit_code, kUnavailable);
  const Outcome plain = weft({"health"}, {});
  EXPECT_EQ(plain.exit_code, kUnavailable);
  EXPECT_NE(plain.err.find("if it encrypts, give --tls or --tls-ca FILE"), std::string::npos)
      << plain.err;
  const Outcome outcome =
      weft({"health"}, {"--tls-ca", other_file, "--tls-cert", cert_file_, "--tls-key", key_file_});
  EXPECT_EQ(outcome.exit_code, kUnavailable);
  EXPECT_TRUE(outcome.err.starts_with("weft: the server " + address_)) << outcome.err;
  EXPECT_NE(outcome.err.find("--tls-ca FILE adds the CA"), std::string::npos) << outcome.err;
}

TEST_F(Secure, WantsTheNameThatItIsTold) {
  Words words = certificate();
  words.insert(words.end(), {"--tls-server-name", "mesh.example.org"});
  EXPECT_EQ(weft({"health"}, words).exit_code, 0);
  words.back() = "other.example.org";
  const Outcome outcome = weft({"health"}, words);
  EXPECT_EQ(outcome.exit_code, kUnavailable);
  EXPECT_NE(outcome.err.find("--tls-server-name NAME gives that name"), std::string::npos)
      << outcome.err;
}

TEST_F(Secure, TrustsWhomTheSystemTrustsWithTls) {
  const Variable roots("GRPC_DEFAULT_SSL_ROOTS_FILE_PATH", ca_file_);
  const Words words = {"--tls", "--tls-cert", cert_file_, "--tls-key", key_file_};
  EXPECT_EQ(weft({"health"}, words).exit_code, 0);
}

TEST(ConnectionFlags, NameTheFileThatIsNotThere) {
  for (const Words& flags : {Words{"--tls-ca", "/no/such"},
                             {"--token-file", "/no/such"},
                             {"--tls-cert", "/no/such", "--tls-key", "/no/such"}}) {
    Words words = {"health", "--server", "127.0.0.1:1"};
    words.insert(words.end(), flags.begin(), flags.end());
    const Outcome outcome = run_weft(words);
    EXPECT_EQ(outcome.exit_code, 4) << flags.front();
    EXPECT_NE(outcome.err.find("/no/such"), std::string::npos) << outcome.err;
  }
}

TEST(ConnectionFlags, RefuseWhatIsNoToken) {
  for (const char* token : {" ", "two words", "secr\xc3\xa4t"}) {
    const Variable variable("WEFT_TOKEN", token);
    EXPECT_EQ(run_weft({"health", "--server", "127.0.0.1:1"}).exit_code, 4) << token;
  }
}

TEST(ConnectionFlags, SendNoTokenUnencryptedToAnotherMachine) {
  const Variable token("WEFT_TOKEN", "secret-of-ann-16");
  for (const char* server : {"mesh.example.org:1", "127.example.org:1", "0.0.0.0:1", "[2::1]:1"}) {
    const Outcome outcome = run_weft({"health", "--server", server});
    EXPECT_EQ(outcome.exit_code, 2) << server;
    EXPECT_NE(outcome.err.find("--tls"), std::string::npos) << outcome.err;
  }
  // Nobody listens at port 1: these were tried.
  std::vector<Words> allowed{
      {"127.0.0.1:1"}, {"[::1]:1"}, {"unix:/no/such"}, {"0.0.0.0:1", "--insecure"}};
#ifndef WEFT_SANITIZED  // gRPC's resolver, c-ares, leaves a name behind when the process ends
  allowed.push_back({"localhost:1"});
#endif
  for (const Words& words : allowed) {
    Words all = {"health", "--server"};
    all.insert(all.end(), words.begin(), words.end());
    EXPECT_EQ(run_weft(all).exit_code, kUnavailable) << words.front();
  }
}

TEST(PrivateServers, KnowNothingOfWhatConfiguresOtherServers) {
  const Variable cert("WEFT_TLS_CERT", "/no/such");
  const Variable key("WEFT_TLS_KEY", "/no/such");
  const Variable tokens("WEFT_TOKENS", "/no/such");
  const Variable data("WEFT_DATA", "/proc/no/such");
  const Variable triangles("WEFT_MAX_TRIANGLES", "nonsense");
  EXPECT_EQ(run_weft({"health"}).exit_code, 0);
}

}  // namespace
}  // namespace weft::e2e
