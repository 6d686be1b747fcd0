// SPDX-License-Identifier: Apache-2.0
#include "files/formats/meshes/vtu_arrays.h"

namespace weft::files {
namespace {

constexpr char kBeyond[] = "lies beyond the end of the file";
constexpr char kCutShort[] = "goes on beyond the end of the file";

}  // namespace

std::optional<std::uint64_t> VtuArrays::number(std::string_view bytes, std::uint64_t index) const {
  if (index >= bytes.size() / header_) return std::nullopt;
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + index * header_, header_);
  return value;
}

VtuArrays::Bytes VtuArrays::bytes_of(const VtuArray& array, std::string& made) const {
  const bool is_inline = array.place == VtuArray::Place::kInline;
  std::string_view stored = is_inline ? array.text : appended_;
  if (!is_inline) {
    if (array.offset > stored.size()) return tl::unexpected<std::string>(kBeyond);
    // What is encoded ends where the next array begins.
    const auto next = offsets_.upper_bound(array.offset);
    const bool is_cut = is_base64_ && next != offsets_.end() && *next <= stored.size();
    stored = stored.substr(array.offset, is_cut ? *next - array.offset : stored.npos);
  }
  std::string decoded;
  if (is_inline || is_base64_) {
    auto bytes = from_base64(stored);
    if (!bytes) return tl::unexpected(bytes.error());
    decoded = std::move(*bytes);
    stored = decoded;
  }
  if (packing_) return unpack(stored, made);
  const auto size = number(stored, 0);
  if (!size) return tl::unexpected<std::string>(kBeyond);
  if (*size > stored.size() - header_) return tl::unexpected<std::string>(kCutShort);
  if (decoded.empty()) return stored.substr(header_, *size);
  made = decoded.substr(header_, *size);
  return made;
}

// The header is the number of blocks, their size, that of the last one if it is smaller, else 0,
// and the packed size of each.
VtuArrays::Bytes VtuArrays::unpack(std::string_view stored, std::string& made) const {
  const auto blocks = number(stored, 0);
  if (!blocks) return tl::unexpected<std::string>(kBeyond);
  if (*blocks == 0) return made;
  constexpr std::uint64_t kHead = 3;
  if (*blocks > stored.size() / header_ - std::min<std::size_t>(kHead, stored.size() / header_))
    return tl::unexpected<std::string>(kCutShort);
  const std::uint64_t whole = *number(stored, 1);
  const std::uint64_t last = *number(stored, 2);
  std::string_view rest = stored.substr((kHead + *blocks) * header_);
  for (std::uint64_t block = 0; block < *blocks; ++block) {
    const std::uint64_t packed = *number(stored, kHead + block);
    if (packed > rest.size()) return tl::unexpected<std::string>(kCutShort);
    auto bytes = unpacked(*packing_, rest.substr(0, packed),
                          block + 1 == *blocks && last != 0 ? last : whole);
    if (!bytes) return tl::unexpected(bytes.error());
    made += *bytes;
    rest.remove_prefix(packed);
  }
  return made;
}

}  // namespace weft::files
