// SPDX-License-Identifier: Apache-2.0
// What became of a batch, for people (Markdown with the drawings) and for pipelines (JUnit XML).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "client/base/files.h"
#include "files/base/error.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

struct BatchOutcome {
  std::string name;
  std::optional<v1::Summary> summary{};  // nothing if there is no mesh
  std::optional<Error> error{};          // why there is none
  std::vector<std::string> failures{};   // gates and the lock
  std::vector<std::string> warnings{};   // for people; each is one line
  std::filesystem::path drawing{};       // empty: none
  double seconds = 0;

  bool passed() const { return !error && failures.empty(); }
};

// A <testcase> for each mesh, whose <error> is a call that failed and whose <failure> is a gate or
// the lock: https://github.com/testmoapp/junitxml.
std::string junit_xml(const std::vector<BatchOutcome>& outcomes);

// `folder` is where the page will lie: the drawings are named from there.
std::string markdown_summary(const std::vector<BatchOutcome>& outcomes,
                             const std::filesystem::path& folder);

}  // namespace weft::client
