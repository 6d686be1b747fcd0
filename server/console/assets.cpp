// SPDX-License-Identifier: Apache-2.0
#include "server/console/assets.h"

#include <zlib.h>

#include <algorithm>
#include <array>

namespace weft::server {
namespace {

// The pages of console/src/main.tsx.
bool is_page(std::string_view path) {
  if (path.ends_with('/') && path.size() > 1) path.remove_suffix(1);
  return path == "/" || path == "/jobs" || path == "/server" || path.starts_with("/job/") ||
         path.starts_with("/mesh/") || path.starts_with("/compare/");
}

}  // namespace

const Asset* find_asset(std::span<const Asset> assets, std::string_view path) {
  if (is_page(path)) path = "/index.html";
  const auto found =
      std::find_if(assets.begin(), assets.end(), [&](const Asset& a) { return a.path == path; });
  return found == assets.end() ? nullptr : &*found;
}

std::string inflated(const Asset& asset) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  std::string out;
  if (inflateInit2(&stream, kGzip) != Z_OK) return out;
  // zlib does not write to its input.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(asset.gzip.data()));
  stream.avail_in = static_cast<uInt>(asset.gzip.size());
  std::array<char, 16384> part;
  int state = Z_OK;
  while (state == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(part.data());
    stream.avail_out = part.size();
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(part.data(), part.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  return out;
}

}  // namespace weft::server
