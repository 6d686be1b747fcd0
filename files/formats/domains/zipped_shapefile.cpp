// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/zipped_shapefile.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/zip_archive.h"
#include "files/formats/domains/shapefile.h"
#include "files/formats/mesh_formats.h"

namespace weft::files {
namespace {

// By their extensions, in lower case.
using Parts = std::map<std::string, ZipMember>;

tl::expected<Parts, std::string> parts_of(const ZipArchive& archive) {
  std::string stem;
  for (const auto& [name, member] : archive.members()) {
    const std::filesystem::path path(name);
    if (name.starts_with("__MACOSX/") || lower_extension(path) != ".shp") continue;
    if (!stem.empty())
      return tl::unexpected<std::string>("holds several shapefiles, and one is read");
    stem = name.substr(0, name.size() - path.extension().string().size());
  }
  if (stem.empty()) return tl::unexpected<std::string>("holds no shapefile");
  Parts parts;
  for (const auto& [name, member] : archive.members()) {
    const std::string extension = lower_extension(std::filesystem::path(name));
    const bool is_part = extension == ".shp" || extension == ".shx" || extension == ".dbf" ||
                         extension == ".prj" || extension == ".cpg";
    if (is_part && name.size() == stem.size() + extension.size() && name.starts_with(stem))
      parts.emplace(extension, member);
  }
  return parts;
}

}  // namespace

Result<Domain> read_zipped_shapefile(const std::filesystem::path& path, bool lonlat) {
  const auto bad = [&path](const std::string& why) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + why);
  };
  const auto contents = read_file(path, std::numeric_limits<std::uint32_t>::max());
  if (!contents) return tl::unexpected(contents.error());
  const auto archive = ZipArchive::open(contents->text());
  if (!archive) return bad(archive.error());
  const auto parts = parts_of(*archive);
  if (!parts) return bad(parts.error());
  ShapefileParts unpacked;
  for (const auto& [extension, member] : *parts) {
    std::string& part = unpacked[extension];
    const auto bytes = archive->read(member, part);
    if (!bytes) return bad("its " + extension + " " + bytes.error());
    if (part.empty()) part = *bytes;
  }
  return read_shapefile(std::move(unpacked), path, lonlat);
}

std::uint64_t zipped_shapefile_bytes(std::string_view bytes) {
  const auto archive = ZipArchive::open(bytes);
  const auto parts = archive ? parts_of(*archive) : tl::unexpected(archive.error());
  std::uint64_t sum = 0;
  if (parts)
    for (const auto& [extension, member] : *parts)
      sum += std::min(member.size, std::numeric_limits<std::uint64_t>::max() - sum);
  return sum;
}

}  // namespace weft::files
