// SPDX-License-Identifier: Apache-2.0
// What a real weftd shows to those who watch it, and whether the dashboard and the alerts in
// deploy/ use it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/e2e/programs.h"
#include "tests/support/http.h"
#include "tests/support/paths.h"

namespace weft::e2e {
namespace {

using weft::testing::http;

// A weftd that has meshed something, and its scrape.
class Watched : public ::testing::Test {
 protected:
  Watched() : server_({"--metrics", "127.0.0.1:0"}) {
    const Folder folder;
    const Outcome outcome = run_weft(
        {"mesh", model("pipe.poly"), "-o", folder / "pipe.node", "--server", server_.address()});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string last = server_.addresses().back();
    EXPECT_TRUE(last.starts_with("metrics=127.0.0.1:")) << last;
    address_ = last.substr(last.find('=') + 1);
    // The last figures may come after the answer.
    do {
      const std::string answer = http(address_, "GET", "/metrics");
      scrape_ = answer.substr(answer.find("\r\n\r\n") + 4);
    } while (!shows("weft_running_jobs{queue=\"calls\"} 0\n"));
  }

  bool shows(const std::string& line) const { return scrape_.find(line) != std::string::npos; }

  const Server server_;
  std::string address_;
  std::string scrape_;
};

std::set<std::string> names_in(const std::string& text, const char* pattern) {
  std::set<std::string> names;
  const std::regex name(pattern);
  for (std::sregex_iterator each(text.begin(), text.end(), name), end; each != end; ++each)
    names.insert(each->str(1));
  return names;
}

TEST_F(Watched, ShowsEveryMetricThatDashboardAndAlertsLookAt) {
  const std::set<std::string> shown = names_in(scrape_, R"((?:^|\n)([a-z_]+)[ {])");
  for (const char* file : {"/grafana-dashboard.json", "/alerts.yaml"}) {
    const std::set<std::string> wanted =
        names_in(files::contents_of(std::string(testing::kDeploy) + file),
                 R"(\b((?:weft|process)_[a-z_]+)\b)");
    EXPECT_GE(wanted.size(), 8u) << file;
    for (const std::string& name : wanted)
      EXPECT_TRUE(shown.contains(name)) << file << " looks at " << name;
  }
}

TEST_F(Watched, HasADashboardThatLooksAtEveryMetricOfWeft) {
  const auto dashboard = nlohmann::json::parse(
      files::contents_of(std::string(testing::kDeploy) + "/grafana-dashboard.json"));
  std::string expressions;
  for (const auto& panel : dashboard.at("panels"))
    for (const auto& target : panel.at("targets"))
      expressions += target.at("expr").get<std::string>() + "\n";
  for (const std::string& name : names_in(scrape_, R"(# TYPE (weft_[a-z_]+) )"))
    EXPECT_NE(expressions.find(name), std::string::npos) << name;
}

TEST_F(Watched, FollowsTheFormThatPrometheusReads) {
  const std::regex comment(R"(# (HELP|TYPE) [a-z_]+ .+)");
  const std::regex sample(
      R"re([a-z_]+(\{[a-z_]+="[^"\\]*"(,[a-z_]+="[^"\\]*")*\})? ([-+0-9.e]+|\+Inf|NaN))re");
  std::istringstream lines(scrape_);
  int samples = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(std::regex_match(line, line.starts_with('#') ? comment : sample)) << line;
    samples += !line.starts_with('#');
  }
  EXPECT_GT(samples, 50);
}

TEST_F(Watched, TellsWhatItHasDone) {
  for (const char* line : {"weft_requests_total{code=\"OK\",method=\"GenerateMesh\"} 1\n",
                           "weft_first_chunk_seconds_count 1\n", "weft_refine_seconds_count 1\n",
                           "weft_queue_seconds_count 1\n"})
    EXPECT_TRUE(shows(line)) << line << "is not in\n" << scrape_;
  EXPECT_FALSE(shows("weft_triangles_total 0\n"));
  EXPECT_TRUE(http(address_, "GET", "/healthz").starts_with("HTTP/1.1 200"));
}

}  // namespace
}  // namespace weft::e2e
