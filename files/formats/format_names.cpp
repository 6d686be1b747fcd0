// SPDX-License-Identifier: Apache-2.0
#include "files/formats/format_names.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/formats/mesh_formats.h"

namespace weft::files {
namespace {

constexpr std::size_t kMaxNamed = 5;

std::string replaced(std::string_view name, std::string_view characters, char by) {
  std::string out(name);
  std::replace_if(
      out.begin(), out.end(),
      [characters](char c) { return characters.find(c) != std::string_view::npos; }, by);
  return out;
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Keeps ASCII letters, digits and `others`; every other character becomes _.
std::string ascii_word(std::string_view name, std::string_view others) {
  std::string out;
  for (const char c : name) {
    const bool is_allowed =
        is_letter(c) || (c >= '0' && c <= '9') || others.find(c) != std::string_view::npos;
    const bool goes_on = (c & 0xc0) == 0x80;  // a letter of several bytes
    if (!goes_on) out += is_allowed ? c : '_';
  }
  return out;
}

bool is_integer(std::string_view text) {
  std::int32_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem != std::errc::invalid_argument && end == text.data() + text.size();
}

// Whether a name is "marker" or "region", the separator and an integer.
bool is_number_of(std::string_view name, char separator) {
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion})
    if (const std::string start = std::string(word_of(kind)) + separator; name.starts_with(start))
      return is_integer(name.substr(start.size()));
  return false;
}

// "marker 2 'inlet'".
std::string entry_text(NameKind kind, std::int32_t id, const std::string& name) {
  return std::string(word_of(kind)) + " " + std::to_string(id) + " '" + name + "'";
}

// A list that ends with the number of those that are left out.
class ShortList {
 public:
  void add(const std::string& text) {
    if (count_++ < kMaxNamed) text_ += (text_.empty() ? "" : ", ") + text;
  }
  bool empty() const { return count_ == 0; }
  std::string text() const {
    return text_ +
           (count_ > kMaxNamed ? " and " + with_separators(count_ - kMaxNamed) + " more" : "");
  }

 private:
  std::string text_;
  std::size_t count_ = 0;
};

Spelling spelling_of(const MeshFormat& format, NameKind kind) {
  return kind == NameKind::kMarker ? format.marker_names : format.region_names;
}

}  // namespace

std::string any_name(std::string_view name) {
  return std::string(name);
}

std::string quotable_name(std::string_view name) {
  return replaced(name, "\"", '\'');
}

std::string gmsh_name(std::string_view name) {
  return (is_number_of(name, ' ') ? "_" : "") + quotable_name(name);
}

std::string su2_tag(std::string_view name) {
  return (is_integer(name) ? "_" : "") + replaced(name, " ,=%()\"", '_');
}

std::string flag_meaning(std::string_view name) {
  return ascii_word(name, "_-.+@");
}

std::string group_word(std::string_view name) {
  const std::string word = replaced(name, " ,#", '_');
  return (is_number_of(word, '_') || word == "default" ? "_" : "") + word;
}

std::string exodus_name(std::string_view name) {
  return (is_number_of(name, ' ') ? "_" : "") + std::string(name);
}

std::string foam_word(std::string_view name) {
  const std::string word = ascii_word(name, "_-.");
  const bool begins_well = is_letter(word.front()) || word.front() == '_';
  return (begins_well && !is_number_of(word, '_') && word != kFrontAndBack ? "" : "_") + word;
}

std::string inp_label(std::string_view name) {
  constexpr std::size_t kLongest = 72;
  std::string word = ascii_word(name, "_-");
  if (!is_letter(word.front()) || is_number_of(lower_case(word), '_')) word.insert(0, "n_");
  return word.substr(0, kLongest);
}

Names names_in(const MeshFormat& format, const Names& names) {
  Names out;
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion})
    if (const Spelling spelling = spelling_of(format, kind))
      out.table(kind) = spelled(names.table(kind), spelling, format.name_case);
  return out;
}

void add_name_losses(const std::string& file, const Names& names, const Names& written,
                     std::vector<std::string>& sentences) {
  ShortList lost;
  ShortList changed;
  for (const NameKind kind : {NameKind::kMarker, NameKind::kRegion}) {
    for (const auto& [id, name] : names.table(kind)) {
      const std::string* const now = name_of(written.table(kind), id);
      if (now == nullptr)
        lost.add(entry_text(kind, id, name));
      else if (*now != name)
        changed.add("'" + *now + "' for '" + name + "'");
    }
  }
  if (!lost.empty())
    sentences.push_back(file + ": the format does not carry these names: " + lost.text());
  if (!changed.empty())
    sentences.push_back(file + ": the format cannot spell all names, it has " + changed.text());
}

}  // namespace weft::files
