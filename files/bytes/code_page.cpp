// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/code_page.h"

#include <iconv.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/number_text.h"

namespace weft::files {
namespace {

// Of the language drivers that there are, those of Western Europe, of Russian and of Eastern
// Europe; 0x57 is what GIS programs write for "that of the system".
struct LanguageDriver {
  std::int64_t id;
  const char* encoding;
};
constexpr LanguageDriver kDrivers[] = {{0x01, "CP437"},  {0x02, "CP850"},  {0x03, "CP1252"},
                                       {0x57, "CP1252"}, {0x65, "CP866"},  {0xc8, "CP1250"},
                                       {0xc9, "CP1251"}, {0xcb, "CP1253"}, {0xca, "CP1254"}};

// As iconv calls it.
std::string encoding_of(std::string_view code_page) {
  code_page = trimmed(code_page);
  constexpr std::string_view kDriver = "LDID/";
  if (code_page.starts_with(kDriver)) {
    const auto id = integer_of(code_page.substr(kDriver.size()));
    const auto* const found = std::find_if(std::begin(kDrivers), std::end(kDrivers),
                                           [&id](const LanguageDriver& d) { return d.id == id; });
    return found == std::end(kDrivers) ? "CP1252" : found->encoding;
  }
  if (lower_case(code_page).starts_with("ansi ")) code_page = trimmed(code_page.substr(5));
  if (code_page.empty()) return "CP1252";
  if (!integer_of(code_page)) return std::string(code_page);
  constexpr std::string_view kIso = "8859";
  return (code_page.starts_with(kIso) ? "ISO-8859-" : "CP") +
         std::string(code_page.starts_with(kIso) ? code_page.substr(kIso.size()) : code_page);
}

// Nothing if the text is not of that encoding, or the encoding is unknown.
std::optional<std::string> converted(const std::string& text, const std::string& encoding) {
  const iconv_t state = ::iconv_open("UTF-8", encoding.c_str());
  if (state == reinterpret_cast<iconv_t>(-1)) return std::nullopt;
  constexpr std::size_t kMaxBytes = 4;  // of a character in UTF-8
  std::string in = text;
  std::string out(kMaxBytes * text.size(), '\0');
  char* from = in.data();
  char* to = out.data();
  std::size_t left = in.size();
  std::size_t room = out.size();
  const bool failed = ::iconv(state, &from, &left, &to, &room) == static_cast<std::size_t>(-1);
  ::iconv_close(state);
  if (failed) return std::nullopt;
  out.resize(out.size() - room);
  return out;
}

}  // namespace

std::string to_utf8(const std::string& text, std::string_view code_page) {
  const bool is_ascii =
      std::all_of(text.begin(), text.end(), [](char c) { return (c & 0x80) == 0; });
  if (is_ascii || converted(text, "UTF-8")) return text;
  return converted(text, encoding_of(code_page)).value_or(text);
}

}  // namespace weft::files
