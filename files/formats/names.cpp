// SPDX-License-Identifier: Apache-2.0
#include "files/formats/names.h"

#include <algorithm>

#include "files/base/did_you_mean.h"
#include "files/base/text.h"
#include "files/base/words.h"

namespace weft::files {
namespace {

constexpr std::size_t kLongestName = 255;
constexpr std::size_t kMaxNames = 16'384;
constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

// Whether a text is well-formed UTF-8 without control characters (Unicode 15, table 3-7).
enum class TextFault { kNone, kNoText, kControl };
TextFault text_fault(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned char lead = byte(i);
    if (lead < 0x80) {
      if (lead < 0x20 || lead == 0x7f) return TextFault::kControl;
      ++i;
      continue;
    }
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || length > text.size() - i) return TextFault::kNoText;
    const unsigned char low = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;
    const unsigned char high = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;
    if (byte(i + 1) < low || byte(i + 1) > high) return TextFault::kNoText;
    for (std::size_t k = 2; k < length; ++k)
      if ((byte(i + k) & 0xc0) != 0x80) return TextFault::kNoText;
    if (lead == 0xc2 && byte(i + 1) < 0xa0) return TextFault::kControl;
    i += length;
  }
  return TextFault::kNone;
}

}  // namespace

const std::string* name_of(const NameTable& table, std::int32_t id) {
  const auto found = table.find(id);
  return found == table.end() ? nullptr : &found->second;
}

std::optional<std::int32_t> id_of(const NameTable& table, std::string_view name) {
  const auto found = std::find_if(table.begin(), table.end(),
                                  [name](const auto& entry) { return entry.second == name; });
  if (found == table.end()) return std::nullopt;
  return found->first;
}

Result<std::int32_t> find_marker(std::string_view name, const NameTable& markers) {
  if (const auto id = id_of(markers, name)) return *id;
  std::vector<std::string> names;
  for (const auto& [id, text] : markers) names.push_back(text);
  std::string hint = did_you_mean(name, names);
  constexpr std::size_t kMaxNamed = 8;
  if (hint.empty() && !names.empty()) {
    hint = "there are ";
    for (std::size_t k = 0; k < std::min(names.size(), kMaxNamed); ++k)
      hint += (k == 0 ? "" : ", ") + names[k];
    if (names.size() > kMaxNamed)
      hint += " and " + with_separators(names.size() - kMaxNamed) + " more";
  }
  return fail(ExitCode::kUsage, "no marker of the domain is named " + in_quotes(name) + ": " +
                                    (hint.empty() ? "it names none" : hint));
}

std::string_view word_of(NameKind kind) {
  return kind == NameKind::kMarker ? "marker" : "region";
}

bool is_plain_text(std::string_view text) {
  return text_fault(text) == TextFault::kNone;
}

std::string name_fault(std::string_view name) {
  if (name.empty()) return "is empty";
  if (name.size() > kLongestName)
    return "has " + std::to_string(name.size()) + " bytes, a name has at most " +
           std::to_string(kLongestName);
  switch (text_fault(name)) {
    case TextFault::kNone:
      return "";
    case TextFault::kNoText:
      return "is not UTF-8";
    case TextFault::kControl:
      return "has a control character";
  }
  return "";
}

void NameReader::add(NameKind kind, std::int32_t id, std::string_view name) {
  NameTable& table = names_.table(kind);
  const std::string* const known = name_of(table, id);
  if (known != nullptr && *known == name) return;
  if (const std::string fault = name_fault(name); !fault.empty())
    return leave_out(kind, id, "it " + fault);
  if (known != nullptr) return leave_out(kind, id, "the first is " + in_quotes(*known));
  auto& ids = ids_[static_cast<std::size_t>(kind)];
  if (const auto same = ids.find(name); same != ids.end())
    return leave_out(kind, id,
                     "it is " + in_quotes(name) + ", as that of " + std::to_string(same->second));
  if (count_ == kMaxNames || bytes_ + name.size() > kMaxBytes)
    return leave_out(kind, id, "there are more than a server takes");
  ++count_;
  bytes_ += name.size();
  ids.emplace(name, id);
  table.emplace(id, name);
}

void NameReader::leave_out(NameKind kind, std::int32_t id, const std::string& why) {
  constexpr std::size_t kMaxNamed = 5;
  if (left_out_++ < kMaxNamed)
    warnings_.push_back({.kind = WarningKind::kName,
                         .file = file_,
                         .text = "a name of " + std::string(word_of(kind)) + " " +
                                 std::to_string(id) + " is left out: " + why});
}

std::vector<Warning> NameReader::warnings() const {
  std::vector<Warning> all = warnings_;
  if (const std::size_t more = left_out_ - all.size(); more > 0)
    all.push_back({.kind = WarningKind::kName,
                   .file = file_,
                   .count = more,
                   .text = with_separators(more) + " more names are left out"});
  return all;
}

std::uint32_t Labels::of(std::int32_t number) {
  const auto [found, is_new] = by_number_.try_emplace(number, count_);
  count_ += is_new ? 1 : 0;
  return found->second;
}

std::uint32_t Labels::of(std::string_view name) {
  auto found = by_name_.find(name);
  if (found == by_name_.end()) {
    found = by_name_.emplace(name, count_).first;
    named_.push_back(count_++);
  }
  return found->second;
}

std::vector<std::int32_t> Labels::numbers() const {
  std::vector<std::int32_t> numbers(count_);
  for (const auto& [number, label] : by_number_) numbers[label] = number;
  std::int32_t next = 1;
  for (const std::uint32_t label : named_) {
    while (by_number_.contains(next)) ++next;
    numbers[label] = next++;
  }
  return numbers;
}

void Labels::name_all(NameKind kind, NameReader& reader) const {
  const std::vector<std::int32_t> all = numbers();
  std::vector<const std::string*> texts(count_);
  for (const auto& [name, label] : by_name_) texts[label] = &name;
  for (const std::uint32_t label : named_) reader.add(kind, all[label], *texts[label]);
}

NameTable spelled(const NameTable& table, Spelling spelling, NameCase letters) {
  NameTable out;
  std::map<std::string, int> used;  // spellings, and how many names wanted each one
  const auto key = [letters](const std::string& text) {
    return letters == NameCase::kIgnored ? lower_case(text) : text;
  };
  // Names that stay as they are come first, so that no other name takes their spelling.
  for (const auto& [id, name] : table)
    if (spelling(name) == name && used.try_emplace(key(name), 1).second) out[id] = name;
  for (const auto& [id, name] : table) {
    if (out.contains(id)) continue;
    const std::string first = spelling(name);
    std::string text = first;
    for (int& wanted = used[key(first)]; wanted++ > 0;) {
      text = first + "_" + std::to_string(wanted);
      if (used.try_emplace(key(text), 1).second) break;
    }
    out[id] = text;
  }
  return out;
}

}  // namespace weft::files
