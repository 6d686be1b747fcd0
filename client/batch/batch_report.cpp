// SPDX-License-Identifier: Apache-2.0
#include "client/batch/batch_report.h"

#include <algorithm>
#include <cstdio>
#include <pugixml.hpp>
#include <sstream>

#include "files/base/text.h"

namespace weft::client {
namespace {

std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

// Escapes what would end a cell of a table, or begin a tag.
std::string in_cell(const std::string& text) {
  std::string safe;
  for (const char c : harmless(text)) {
    if (c == '|' || c == '<' || c == '`') safe += '\\';
    safe += c == '\n' ? ' ' : c;
  }
  return safe;
}

std::string verdict(const BatchOutcome& outcome) {
  if (outcome.passed()) return "passed";
  std::string text = outcome.error ? "error: " + outcome.error->message : "failed: ";
  for (std::size_t i = 0; i < outcome.failures.size(); ++i)
    text += (i == 0 ? "" : "; ") + outcome.failures[i];
  return text;
}

}  // namespace

std::string junit_xml(const std::vector<BatchOutcome>& outcomes) {
  pugi::xml_document document;
  auto suites = document.append_child("testsuites");
  auto suite = suites.append_child("testsuite");
  suite.append_attribute("name") = "weft";
  suite.append_attribute("tests") = outcomes.size();
  suite.append_attribute("failures") =
      std::count_if(outcomes.begin(), outcomes.end(),
                    [](const BatchOutcome& o) { return !o.error && !o.failures.empty(); });
  suite.append_attribute("errors") = std::count_if(
      outcomes.begin(), outcomes.end(), [](const BatchOutcome& o) { return o.error.has_value(); });
  double seconds = 0;
  for (const BatchOutcome& outcome : outcomes) {
    seconds += outcome.seconds;
    auto test = suite.append_child("testcase");
    test.append_attribute("classname") = "weft";
    test.append_attribute("name") = harmless(outcome.name).c_str();
    char time[32];
    std::snprintf(time, sizeof time, "%.3f", outcome.seconds);
    test.append_attribute("time") = time;
    if (outcome.error) {
      auto error = test.append_child("error");
      error.append_attribute("message") = harmless(outcome.error->message).c_str();
    }
    for (const std::string& failure : outcome.failures)
      test.append_child("failure").append_attribute("message") = harmless(failure).c_str();
  }
  suite.append_attribute("time") = two_digits(seconds).c_str();
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

std::string markdown_summary(const std::vector<BatchOutcome>& outcomes,
                             const std::filesystem::path& folder) {
  const auto passed =
      std::count_if(outcomes.begin(), outcomes.end(), [](const auto& o) { return o.passed(); });
  std::string text = "# Meshes\n\n" + std::to_string(passed) + " of " +
                     std::to_string(outcomes.size()) + " passed.\n\n" +
                     "| mesh | verdict | triangles | vertices | angles | seconds | digest |\n" +
                     "|---|---|---:|---:|---|---:|---|\n";
  for (const BatchOutcome& outcome : outcomes) {
    text += "| " + in_cell(outcome.name) + " | " + in_cell(verdict(outcome)) + " | ";
    if (outcome.summary) {
      const v1::Summary& summary = *outcome.summary;
      text += with_separators(summary.triangles()) + " | " + with_separators(summary.vertices()) +
              " | " + two_digits(summary.min_angle_deg()) + " to " +
              two_digits(summary.max_angle_deg()) + " | ";
    } else {
      text += "| | | ";
    }
    text += two_digits(outcome.seconds) + " | " +
            (outcome.summary ? "`" + hex(outcome.summary->sha256()).substr(0, 12) + "`" : "") +
            " |\n";
  }
  for (const BatchOutcome& outcome : outcomes) {
    if (outcome.drawing.empty() || !outcome.summary) continue;
    std::error_code ignored;
    const auto relative = std::filesystem::relative(outcome.drawing, folder, ignored);
    text += "\n## " + in_cell(outcome.name) + "\n\n![" + in_cell(outcome.name) + "](<" +
            relative.generic_string() + ">)\n";
  }
  return text;
}

}  // namespace weft::client
