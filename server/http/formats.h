// SPDX-License-Identifier: Apache-2.0
// Which formats are read and written over HTTP, and what their files look like. Files of strangers
// are read by weft's own readers alone, which open no other file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft::server {

// "poly", "geojson", ...: without a dot.
std::vector<std::string> read_formats();
// "vtu", "msh", ...: those whose mesh is one file.
std::vector<std::string> written_formats();

// The extension of a domain's file, such as ".geojson", by the name of the file, by the value of
// Content-Type, or else by its first bytes; empty if none tells.
std::string format_read(std::string_view name, std::string_view content_type,
                        std::string_view bytes);

// The extension that an Accept header wants most; ".vtu" without a header, or for any; empty if
// nothing of it is written.
std::string format_wanted(std::string_view accept);

// What a file with the extension is, for Content-Type.
std::string_view media_type(std::string_view extension);

}  // namespace weft::server
