// SPDX-License-Identifier: Apache-2.0
// The members of a ZIP archive: stored or deflated, with sizes of 32 or 64 bits, in one file.
// Source: PKWARE's APPNOTE.TXT, 4.3. Checksums are not asked.
//
//   const auto archive = ZipArchive::open(bytes);          // which outlive it
//   for (const auto& [name, member] : archive->members())
//     ... archive->read(member, held) ...
//
// Errors are the ends of sentences, as in "coast.zip " + error.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace weft::files {

struct ZipMember {
  std::uint16_t method = 0;
  std::uint64_t packed_size = 0;
  std::uint64_t size = 0;  // as the archive claims
  std::uint64_t header = 0;
};

class ZipArchive {
 public:
  static tl::expected<ZipArchive, std::string> open(std::string_view bytes);

  // By their paths in the archive; of several of one path, the first.
  const std::map<std::string, ZipMember, std::less<>>& members() const { return members_; }
  // A member's bytes: those of the archive, or, if it is packed, `unpacked`, which gets them.
  tl::expected<std::string_view, std::string> read(const ZipMember& member,
                                                   std::string& unpacked) const;

 private:
  explicit ZipArchive(std::string_view bytes) : bytes_(bytes) {}
  std::uint64_t read_entry(std::uint64_t at);

  std::string_view bytes_;
  std::map<std::string, ZipMember, std::less<>> members_;
};

}  // namespace weft::files
