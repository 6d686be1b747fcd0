// SPDX-License-Identifier: Apache-2.0
#include "server/wire/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

namespace weft::server {
namespace {

using Table = google::protobuf::RepeatedPtrField<v1::Name>;

// Where a control character begins in UTF-8; nullopt if there is none.
std::optional<std::size_t> control_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 || byte == 0x7f) return i;
    // U+0080 to U+009F are 0xc2 0x80 to 0xc2 0x9f.
    if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0)
      return i;
  }
  return std::nullopt;
}

Failure bad(const std::string& field, const std::string& what) {
  return {Reason::kBadOption, field, field + " " + what};
}

std::optional<Failure> check_text(const std::string& field, const std::string& name) {
  if (name.empty()) return bad(field, "is empty");
  if (name.size() > kLongestName)
    return bad(field,
               fmt::format("has {} bytes; a name has at most {}", name.size(), kLongestName));
  if (const auto at = control_character(name))
    return bad(field, fmt::format("has a control character at byte {}", *at));
  return std::nullopt;
}

// The first entry, by its place in the table, whose key an earlier one has, and that earlier one.
struct Repeated {
  int later = 0;
  int first = 0;
};
template <class Key>
std::optional<Repeated> find_repeated(const Table& table, Key&& key) {
  std::vector<int> order(static_cast<std::size_t>(table.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return key(table[i]) != key(table[j]) ? key(table[i]) < key(table[j]) : i < j;
  });
  std::optional<Repeated> found;
  for (std::size_t k = 1; k < order.size(); ++k)
    if (key(table[order[k]]) == key(table[order[k - 1]]) && (!found || order[k] < found->later))
      found = {order[k], order[k - 1]};
  return found;
}

std::optional<Failure> check_table(std::string_view table_name, const Table& table) {
  const auto field = [&](int i, std::string_view member) {
    return fmt::format("domain.{}[{}].{}", table_name, i, member);
  };
  for (int i = 0; i < table.size(); ++i)
    if (auto failure = check_text(field(i, "name"), table[i].name())) return failure;
  if (const auto found = find_repeated(table, [](const v1::Name& name) { return name.id(); }))
    return bad(field(found->later, "id"),
               fmt::format("is {}, which {} names already", table[found->later].id(),
                           field(found->first, "id")));
  const auto text = [](const v1::Name& name) -> std::string_view { return name.name(); };
  if (const auto found = find_repeated(table, text))
    return bad(field(found->later, "name"),
               fmt::format("is '{}', which is the name of {} already", table[found->later].name(),
                           table[found->first].id()));
  return std::nullopt;
}

}  // namespace

std::optional<Failure> check_names(const v1::Domain& domain) {
  if (auto failure = check_table("marker_names", domain.marker_names())) return failure;
  return check_table("region_names", domain.region_names());
}

std::uint64_t name_bytes(const v1::Domain& domain) {
  std::uint64_t bytes = 0;
  for (const Table* table : {&domain.marker_names(), &domain.region_names()})
    for (const v1::Name& name : *table) bytes += name.name().size();
  return bytes;
}

}  // namespace weft::server
