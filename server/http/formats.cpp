// SPDX-License-Identifier: Apache-2.0
#include "server/http/formats.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "files/base/words.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::server {
namespace {

struct MediaType {
  std::string_view type;
  std::string_view extension;
};

constexpr MediaType kRead[] = {{"application/geo+json", ".geojson"},
                               {"application/json", ".geojson"},
                               {"application/vnd.geo+json", ".geojson"},
                               {"text/csv", ".csv"},
                               {"image/vnd.dxf", ".dxf"},
                               {"application/dxf", ".dxf"},
                               {"application/x-dxf", ".dxf"},
                               {"application/zip", ".zip"},
                               {"application/x-zip-compressed", ".zip"}};
constexpr MediaType kWritten[] = {{"application/geo+json", ".geojson"},
                                  {"application/x-netcdf", ".nc"},
                                  {"application/netcdf", ".nc"},
                                  {"model/obj", ".obj"},
                                  {"model/stl", ".stl"},
                                  {"application/x-npz", ".npz"}};

// Of ".vtu, .msh".
std::vector<std::string> without_dots(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream words(list);
  for (std::string word; words >> word;)
    names.push_back(word.substr(1, word.size() - (word.ends_with(',') ? 2 : 1)));
  return names;
}

bool is_read(std::string_view extension) {
  const auto names = read_formats();
  return !extension.empty() && std::ranges::find(names, extension.substr(1)) != names.end();
}

// A media type in lower case, without its parameters.
std::string type_of(std::string_view value) {
  value = value.substr(0, value.find(';'));
  const auto first = std::min(value.find_first_not_of(" \t"), value.size());
  value.remove_prefix(first);
  return files::lower_case(value.substr(0, value.find_last_not_of(" \t") + 1));
}

// What the first bytes of a file look like.
std::string sniffed(std::string_view bytes) {
  constexpr std::size_t kMax = 4096;
  std::string text = files::lower_case(bytes.substr(0, kMax));
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  if (text.starts_with("autocad binary dxf")) return ".dxf";
  if (text.starts_with("pk\3\4")) return ".zip";
  text.erase(0, std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const std::string_view word :
       {"polygon", "multipolygon", "linestring", "multilinestring", "point", "multipoint",
        "geometrycollection", "srid=", "curvepolygon", "multisurface", "compoundcurve",
        "circularstring", "multicurve"})
    if (text.starts_with(word)) return ".wkt";
  if (text.starts_with('{')) return ".geojson";
  if (text.starts_with("splinecurves2d")) return ".in2d";
  // The code of a group, then its value: a comment, or the first section.
  std::istringstream words(text);
  std::string first, second;
  words >> first >> second;
  if ((first == "0" && second == "section") ||
      (first == "999" && text.find("section") != text.npos))
    return ".dxf";
  // Lines of numbers: with commas a table, or else the counts of a .poly; a table may have names.
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto start = line.find_first_not_of(" \t\r");
    if (start == line.npos || line[start] == '#') continue;
    if (line.find_first_of(",;") != line.npos) return ".csv";
    return line.find_first_not_of("0123456789 \t\r#") == line.npos ? ".poly" : ".csv";
  }
  return "";
}

}  // namespace

std::vector<std::string> read_formats() {
  return without_dots(files::own_domain_extensions());
}

std::vector<std::string> written_formats() {
  std::vector<std::string> names = without_dots(files::written_mesh_extensions());
  std::erase_if(names, [](const std::string& name) {
    return files::mesh_format("mesh." + name)->files != nullptr;
  });
  return names;
}

std::string format_read(std::string_view name, std::string_view content_type,
                        std::string_view bytes) {
  const std::string extension = files::lower_case(std::filesystem::path(name).extension().string());
  if (is_read(extension)) return extension;
  if (files::is_domain_path(std::filesystem::path(name))) return "";
  const auto* const told = std::ranges::find(kRead, type_of(content_type), &MediaType::type);
  if (told != std::end(kRead)) return std::string(told->extension);
  return sniffed(bytes);
}

std::string format_wanted(std::string_view accept) {
  if (accept.empty()) return ".vtu";
  while (!accept.empty()) {
    const auto comma = std::min(accept.find(','), accept.size());
    const std::string type = type_of(accept.substr(0, comma));
    accept.remove_prefix(std::min(comma + 1, accept.size()));
    if (type == "*/*" || type == "application/*" || type == "application/octet-stream")
      return ".vtu";
    const auto* const told = std::ranges::find(kWritten, type, &MediaType::type);
    if (told != std::end(kWritten)) return std::string(told->extension);
  }
  return "";
}

std::string_view media_type(std::string_view extension) {
  const auto* const told = std::ranges::find(kWritten, extension, &MediaType::extension);
  return told == std::end(kWritten) ? "application/octet-stream" : told->type;
}

}  // namespace weft::server
