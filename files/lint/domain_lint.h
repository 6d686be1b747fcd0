// SPDX-License-Identifier: Apache-2.0
// The faults of a domain in words, with the places that its file has for them.
//
//   const auto lint = lint_domain(domain, "yard.poly", {.snap = 0.01});
//   print(lint_text(*lint));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/base/data_path.h"
#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

struct LintSettings {
  double snap = 0;                     // merged before, 0 or more
  bool lonlat = false;                 // the domain is in degrees: it is judged in metres
  std::vector<std::string> ignored{};  // kinds that are no faults
};

struct Finding {
  std::string kind;                      // such as "open-end", or "warning" of the reader
  std::string warning{};                 // of these the kind, such as "open-ring"
  std::optional<Point> at{};             // none for a warning
  std::optional<Point> to{};             // the other end, if it has a length
  std::string text;                      // what is wrong, without a full stop
  std::string remedy{};                  // what to do; empty: the text says it
  std::vector<std::string> offenders{};  // "line 7": where the file has what is wrong
  std::optional<double> measure{};       // a distance, length, area or angle in degrees
};

struct Lint {
  std::string file;
  std::vector<Finding> findings{};  // by kind, at most some of each
  std::vector<std::pair<std::string, std::uint64_t>>
      counts{};  // of each kind that there is, of all
  std::uint64_t total = 0;
  bool complete = true;  // false: segments meet too often for all rules
};

// "open-end, gap, ...": the kinds; without "warning".
std::string fault_kinds();
bool is_fault_kind(const std::string& name);

// `path` is the path that the domain was read from. Errors: kUnreadableInput for coordinates or
// indices that cannot be computed with.
Result<Lint> lint_domain(const Domain& domain, const DataPath& path, const LintSettings& settings);

// Adds what there is to say of a domain after its file was read, as a warning about coordinates.
void add_warning(Lint& lint, std::string text);

}  // namespace weft::files
