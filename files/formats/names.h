// SPDX-License-Identifier: Apache-2.0
// The names of markers and regions: "inlet", "fluid".
//
// A table has an id once and a name once. A name is UTF-8, 1 to 255 bytes without control
// characters; the two tables hold at most 16384 names and 1 MiB of text together, as much as a
// server takes.
//
//   NameReader names("mesh.msh");                 // what a file says, fit or not
//   names.add(NameKind::kMarker, 2, "inlet");
//   mesh.warnings = names.warnings();
//   mesh.names = names.take();
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/error.h"
#include "files/formats/warning.h"

namespace weft::files {

using NameTable = std::map<std::int32_t, std::string>;

enum class NameKind { kMarker, kRegion };

struct Names {
  NameTable markers;
  NameTable regions;

  bool empty() const { return markers.empty() && regions.empty(); }
  NameTable& table(NameKind kind) { return kind == NameKind::kMarker ? markers : regions; }
  const NameTable& table(NameKind kind) const {
    return kind == NameKind::kMarker ? markers : regions;
  }
  friend bool operator==(const Names&, const Names&) = default;
};

// What an id is called; null if it has no name.
const std::string* name_of(const NameTable& table, std::int32_t id);
// The id that is called so.
std::optional<std::int32_t> id_of(const NameTable& table, std::string_view name);

// The marker of that name. Error (kUsage): there is none; with what may be meant, or what there is.
Result<std::int32_t> find_marker(std::string_view name, const NameTable& markers);

// "marker", "region".
std::string_view word_of(NameKind kind);

// Whether a text is UTF-8 without control characters.
bool is_plain_text(std::string_view text);

// What is wrong with a text as a name, "is empty"; empty if nothing is.
std::string name_fault(std::string_view name);

// Takes the names of a file. What cannot be a name, or would be there twice, is left out with a
// warning.
class NameReader {
 public:
  // `file` names the file in warnings.
  explicit NameReader(std::string file) : file_(std::move(file)) {}

  // The same name for the same id again is no fault.
  void add(NameKind kind, std::int32_t id, std::string_view name);

  // Few of them.
  std::vector<Warning> warnings() const;
  Names take() { return std::move(names_); }

 private:
  void leave_out(NameKind kind, std::int32_t id, const std::string& why);

  std::string file_;
  Names names_;
  std::map<std::string, std::int32_t, std::less<>> ids_[2];  // of the names of each kind
  std::size_t count_ = 0;
  std::size_t bytes_ = 0;
  std::size_t left_out_ = 0;
  std::vector<Warning> warnings_;  // the first of them
};

// Markers or regions that a file gives by number or by name. A name gets the smallest positive
// number that the file does not use, in the order in which the names appear; so numbers are known
// once all is read.
//
//   Labels labels;
//   const std::uint32_t inlet = labels.of("inlet"), seven = labels.of(7);
//   labels.numbers()[inlet]                       // 1
class Labels {
 public:
  // A label for it, the same each time.
  std::uint32_t of(std::int32_t number);
  std::uint32_t of(std::string_view name);

  // The number of each label.
  std::vector<std::int32_t> numbers() const;
  // Hands the names to the reader.
  void name_all(NameKind kind, NameReader& reader) const;

 private:
  std::map<std::int32_t, std::uint32_t> by_number_;
  std::map<std::string, std::uint32_t, std::less<>> by_name_;
  std::vector<std::uint32_t> named_;  // labels of names, in order
  std::uint32_t count_ = 0;
};

// How a format writes a name: the name itself, if the format can carry it.
using Spelling = std::string (*)(std::string_view name);

enum class NameCase { kMatters, kIgnored };  // of the letters of names in a format

// The table as a format spells it. A spelling that another name has already gets a number: "a_b_2".
NameTable spelled(const NameTable& table, Spelling spelling, NameCase letters = NameCase::kMatters);

}  // namespace weft::files
