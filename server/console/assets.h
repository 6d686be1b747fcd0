// SPDX-License-Identifier: Apache-2.0
// The files of the application, as server/console/embed.py puts them into the binary.
//
// This folder has more than 25 files because the console has a web server of its own: each step
// from the bytes of a browser to a call of gRPC and back has a file pair.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace weft::server {

struct Asset {
  std::string_view path;  // "/assets/index-4f2a91.js"
  std::string_view type;  // MIME
  std::string_view gzip;  // its bytes, compressed
  std::string_view etag;  // of its bytes, with quotes
  bool immutable;         // its name has a hash of its bytes
};

// Those of this weftd; none if it was built without the console. Defined by what embed.py writes.
std::span<const Asset> console_assets();

// Returns the file that a path gives: its own, or index.html for a page of the application; null if
// it gives none.
const Asset* find_asset(std::span<const Asset> assets, std::string_view path);

// The bytes of a file before compression.
std::string inflated(const Asset& asset);

}  // namespace weft::server
