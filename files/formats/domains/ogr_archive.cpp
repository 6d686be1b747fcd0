// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ogr_archive.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "files/base/text.h"
#include "files/formats/mesh_formats.h"

namespace weft::files {
namespace {

// macOS keeps the attributes of files in archives, under the names of the files.
bool is_of_macos(const std::filesystem::path& name) {
  return name.string().starts_with("__MACOSX/") || name.filename().string().starts_with("._");
}

}  // namespace

Result<OgrSource> find_in_archive(const Gdal& gdal, const std::string& path) {
  // GDAL counts braces; without them it takes what ends in .zip for the archive.
  const bool has_braces = path.find_first_of("{}") != path.npos;
  const std::string root = "/vsizip/" + (has_braces ? path : "{" + path + "}");
  const GdalErrors errors(gdal);
  const std::unique_ptr<char*, decltype(&CSLDestroy)> entries(
      gdal.VSIReadDirRecursive(root.c_str()), gdal.CSLDestroy);
  if (!entries)
    return fail(ExitCode::kUnreadableInput,
                "is damaged, or no ZIP archive" + (errors.any() ? ": " + errors.first() : ""));
  std::vector<std::string> names;
  for (char** entry = entries.get(); *entry != nullptr; ++entry) {
    const DomainFormat* format = domain_format(*entry);
    if (format != nullptr && format->has_layers() && !format->is_archive && !is_of_macos(*entry))
      names.emplace_back(*entry);
  }
  if (names.empty())
    return fail(ExitCode::kUnreadableInput, "holds no file that is read as a domain");
  const DomainFormat* format = domain_format(names[0]);
  if (names.size() == 1) return OgrSource{root + "/" + names[0], format};
  const std::filesystem::path folder = std::filesystem::path(names[0]).parent_path();
  const bool are_layers = std::ranges::all_of(names, [&](const std::filesystem::path& name) {
    return lower_extension(name) == ".shp" && name.parent_path() == folder;
  });
  if (!are_layers)
    return fail(
        ExitCode::kUnreadableInput,
        "holds several files that are read as a domain, take one out of it: " + in_quotes(names));
  return OgrSource{root + (folder.empty() ? "" : "/" + folder.string()), format};
}

}  // namespace weft::files
