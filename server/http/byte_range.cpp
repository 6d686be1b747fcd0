// SPDX-License-Identifier: Apache-2.0
#include "server/http/byte_range.h"

#include <algorithm>
#include <charconv>

namespace weft::server {
namespace {

// nullopt: the text is no number that fits.
std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<ByteRange> range_of(std::string_view header, std::uint64_t size) {
  constexpr std::string_view kUnit = "bytes=";
  const ByteRange all{0, size};
  const auto dash = header.find('-');
  if (!header.starts_with(kUnit) || dash == header.npos) return all;
  const std::string_view from = header.substr(kUnit.size(), dash - kUnit.size());
  const std::string_view to = header.substr(dash + 1);
  const auto first = number(from), last = number(to);
  if (from.empty()) {  // the last bytes
    if (!last) return all;
    const std::uint64_t bytes = std::min(*last, size);
    return bytes == 0 ? std::nullopt : std::optional(ByteRange{size - bytes, bytes});
  }
  if (!first || (!to.empty() && (!last || *last < *first))) return all;
  if (*first >= size) return std::nullopt;
  return ByteRange{*first, std::min(last.value_or(size) - *first, size - 1 - *first) + 1};
}

}  // namespace weft::server
