// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/zip_archive.h"

#include <cstring>
#include <limits>
#include <utility>

#include "files/bytes/compression.h"

namespace weft::files {
namespace {

// Thrown and caught in this file only.
struct Damaged {
  std::string why = "is cut short";
};

// Little-endian numbers at places that a file names.
template <class T>
T number_at(std::string_view bytes, std::uint64_t at) {
  T value;
  if (at > bytes.size() || bytes.size() - at < sizeof value) throw Damaged{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::string_view piece(std::string_view bytes, std::uint64_t at, std::uint64_t size) {
  if (at > bytes.size() || bytes.size() - at < size) throw Damaged{};
  return bytes.substr(at, size);
}

std::uint64_t plus(std::uint64_t at, std::uint64_t more) {
  if (at > std::numeric_limits<std::uint64_t>::max() - more) throw Damaged{};
  return at + more;
}

// If one of the 32-bit sizes has all bits set, its 64-bit size stands here, in this order.
void read_extra(std::string_view extra, ZipMember& member) {
  while (extra.size() >= 4) {
    const auto id = number_at<std::uint16_t>(extra, 0);
    const auto size = number_at<std::uint16_t>(extra, 2);
    std::string_view field = piece(extra, 4, size);
    extra.remove_prefix(4u + size);
    if (id != 1) continue;
    for (std::uint64_t* value : {&member.size, &member.packed_size, &member.header}) {
      if (*value != 0xffffffff) continue;
      *value = number_at<std::uint64_t>(field, 0);
      field.remove_prefix(8);
    }
  }
}

}  // namespace

tl::expected<ZipArchive, std::string> ZipArchive::open(std::string_view bytes) try {
  constexpr std::size_t kEnd = 22;
  const std::size_t end = bytes.rfind(std::string_view("PK\5\6", 4));
  if (end == std::string_view::npos || bytes.size() - end < kEnd)
    throw Damaged{"is not a zip archive, or it is cut short"};
  std::uint64_t count = number_at<std::uint16_t>(bytes, end + 10);
  std::uint64_t at = number_at<std::uint32_t>(bytes, end + 16);
  constexpr std::size_t kLocator = 20;
  if (end >= kLocator && bytes.substr(end - kLocator, 4) == std::string_view("PK\6\7", 4)) {
    const auto end64 = number_at<std::uint64_t>(bytes, end - kLocator + 8);
    count = number_at<std::uint64_t>(bytes, plus(end64, 32));
    at = number_at<std::uint64_t>(bytes, plus(end64, 48));
  }
  ZipArchive archive(bytes);
  for (std::uint64_t i = 0; i < count; ++i) at = archive.read_entry(at);
  return archive;
} catch (const Damaged& damaged) {
  return tl::unexpected(damaged.why);
}

// Reads the entry of the central directory at `at`, and returns where the next is.
std::uint64_t ZipArchive::read_entry(std::uint64_t at) {
  if (piece(bytes_, at, 4) != std::string_view("PK\1\2", 4))
    throw Damaged{"has a directory that is damaged"};
  ZipMember member{
      number_at<std::uint16_t>(bytes_, at + 10), number_at<std::uint32_t>(bytes_, at + 20),
      number_at<std::uint32_t>(bytes_, at + 24), number_at<std::uint32_t>(bytes_, at + 42)};
  const auto name_size = number_at<std::uint16_t>(bytes_, at + 28);
  const auto extra_size = number_at<std::uint16_t>(bytes_, at + 30);
  const auto comment_size = number_at<std::uint16_t>(bytes_, at + 32);
  const std::string_view name = piece(bytes_, at + 46, name_size);
  read_extra(piece(bytes_, at + 46 + name_size, extra_size), member);
  members_.emplace(name, member);
  return at + 46 + name_size + extra_size + comment_size;
}

tl::expected<std::string_view, std::string> ZipArchive::read(const ZipMember& member,
                                                             std::string& unpacked) const try {
  const auto name_size = number_at<std::uint16_t>(bytes_, plus(member.header, 26));
  const auto extra_size = number_at<std::uint16_t>(bytes_, plus(member.header, 28));
  const std::string_view packed =
      piece(bytes_, plus(member.header, 30u + name_size + extra_size), member.packed_size);
  if (member.method == 0) return packed;
  if (member.method != 8)
    throw Damaged{"is packed by the method " + std::to_string(member.method) +
                  ", only 0 and 8 are read"};
  auto bytes = files::unpacked(Packing::kDeflate, packed, member.size);
  if (!bytes) return tl::unexpected(bytes.error());
  unpacked = std::move(*bytes);
  return unpacked;
} catch (const Damaged& damaged) {
  return tl::unexpected(damaged.why);
}

}  // namespace weft::files
