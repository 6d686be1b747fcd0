// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/zip_archive.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/npz.h"

namespace weft::files {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{64} << 30;

// Thrown and caught in this file only.
struct Malformed {
  std::string why;
};

// Little-endian numbers at places that a file names.
template <class T>
T number_at(std::string_view bytes, std::uint64_t at) {
  T value;
  if (at > bytes.size() || bytes.size() - at < sizeof value)
    throw Malformed{"an array is cut short"};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::string_view piece(std::string_view bytes, std::uint64_t at, std::uint64_t size) {
  if (at > bytes.size() || bytes.size() - at < size) throw Malformed{"an array is cut short"};
  return bytes.substr(at, size);
}

// The arrays of an archive, by name without ".npy".
class Archive {
 public:
  explicit Archive(std::string_view bytes) : zip_(opened(bytes)) {}

  bool has(const std::string& name) const { return member(name) != nullptr; }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [path, entry] : zip_.members())
      names.push_back(path.ends_with(kEnd) ? path.substr(0, path.size() - kEnd.size()) : path);
    return names;
  }
  std::string_view array(const std::string& name) {
    const ZipMember* const found = member(name);
    if (found == nullptr) throw Malformed{"holds no array " + in_quotes(name)};
    const auto bytes = zip_.read(*found, unpacked_[name]);
    if (!bytes) throw Malformed{"array " + in_quotes(name) + " " + bytes.error()};
    return *bytes;
  }

 private:
  static constexpr std::string_view kEnd = ".npy";

  static ZipArchive opened(std::string_view bytes) {
    auto zip = ZipArchive::open(bytes);
    if (!zip) throw Malformed{zip.error()};
    return std::move(*zip);
  }
  const ZipMember* member(const std::string& name) const {
    for (const std::string& path : {name + std::string(kEnd), name})
      if (const auto found = zip_.members().find(path); found != zip_.members().end())
        return &found->second;
    return nullptr;
  }

  ZipArchive zip_;
  std::map<std::string, std::string> unpacked_;
};

// A .npy file: the parsed header, and the values.
struct Array {
  std::string type;                  // "<f8"
  std::vector<std::uint64_t> shape;  // one or two
  std::string_view values;
  char kind = 'f';       // of the type: f, i, u, or U for text
  std::size_t item = 0;  // bytes
  bool is_big_endian = false;
  bool by_columns = false;  // in the order of Fortran, else by rows

  template <class Stored>
  Stored at(std::uint64_t row, std::uint64_t column, std::uint64_t columns) const {
    const std::uint64_t i = by_columns ? column * shape[0] + row : row * columns + column;
    char bytes[sizeof(Stored)];
    std::memcpy(bytes, values.data() + i * sizeof bytes, sizeof bytes);
    if (is_big_endian) std::reverse(std::begin(bytes), std::end(bytes));
    Stored value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }
};

Array parse_npy(const std::string& name, std::string_view bytes) {
  const auto bad = [&name](const std::string& why) {
    return Malformed{"array " + in_quotes(name) + " " + why};
  };
  if (!bytes.starts_with("\x93NUMPY") || bytes.size() < 12) throw bad("is not in NumPy's format");
  const bool short_head = bytes[6] == 1;
  const std::uint64_t size = short_head ? number_at<std::uint16_t>(bytes, 8)
                                        : std::uint64_t{number_at<std::uint32_t>(bytes, 8)};
  const std::uint64_t start = short_head ? 10 : 12;
  const std::string_view head = piece(bytes, start, size);
  const auto after = [&](std::string_view key) {
    const std::size_t at = head.find(key);
    if (at == std::string_view::npos) throw bad("has a head without " + std::string(key));
    return head.substr(at + key.size());
  };
  Array array;
  const std::string_view type = after("'descr': '");
  array.type = type.substr(0, type.find('\''));
  const auto unknown = [&] {
    return bad("has the type " + in_quotes(array.type) + ", which is not read");
  };
  if (array.type.size() < 3 || std::string_view("<>|").find(array.type[0]) == type.npos)
    throw unknown();
  array.is_big_endian = array.type[0] == '>';
  array.kind = array.type[1];
  std::uint64_t item = 0;  // in bytes, or in letters
  const char* const type_end = array.type.data() + array.type.size();
  const auto [item_end, item_problem] = std::from_chars(array.type.data() + 2, type_end, item);
  constexpr std::uint64_t kMaxLetters = 1 << 20;
  if (item_problem != std::errc() || item_end != type_end || item == 0 || item > kMaxLetters)
    throw unknown();
  const bool is_integer = array.kind == 'i' || array.kind == 'u';
  const bool is_number = (is_integer && (item == 1 || item == 2 || item == 4 || item == 8)) ||
                         (array.kind == 'f' && (item == 4 || item == 8));
  const bool is_text = array.kind == 'U' && !array.is_big_endian;
  if (!is_number && !is_text) throw unknown();
  array.item = is_text ? 4 * item : item;
  array.by_columns = after("'fortran_order': ").starts_with("True");
  std::string_view shape = after("'shape': (");
  shape = shape.substr(0, shape.find(')'));
  std::uint64_t count = 1;
  while (!shape.empty()) {
    std::uint64_t extent = 0;
    const auto [end, problem] = std::from_chars(shape.data(), shape.data() + shape.size(), extent);
    if (problem != std::errc() || (extent != 0 && count > kMaxFileBytes / extent))
      throw bad("has a shape that is not read");
    count *= extent;
    array.shape.push_back(extent);
    shape.remove_prefix(static_cast<std::size_t>(end - shape.data()));
    shape.remove_prefix(std::min(shape.find_first_not_of(", "), shape.size()));
  }
  array.values = bytes.substr(start + size);
  if (array.values.size() / array.item < count) throw bad("is cut short");
  return array;
}

template <class Stored, class Out>
void convert(const std::string& name, const Array& array, std::size_t columns, std::size_t stride,
             std::vector<Out>& out) {
  const std::uint64_t rows = array.shape[0];
  out.reserve(rows * columns);
  for (std::uint64_t row = 0; row < rows; ++row) {
    for (std::size_t k = 0; k < columns; ++k) {
      const Stored value = array.at<Stored>(row, k, stride);
      if constexpr (std::is_integral_v<Out>) {
        if (!std::in_range<Out>(value))
          throw Malformed{"array " + in_quotes(name) + " has " + std::to_string(value) +
                          " in row " + std::to_string(row) + ", out of range"};
      }
      out.push_back(static_cast<Out>(value));
    }
  }
}

// The first `columns` columns of the array.
template <class Out>
std::vector<Out> column_values(Archive& archive, const std::string& name, std::size_t columns) {
  const Array array = parse_npy(name, archive.array(name));
  const std::size_t stride = array.shape.size() == 2 ? array.shape[1] : 1;
  const bool fits = columns == 1 ? array.shape.size() == 1
                                 : array.shape.size() == 2 &&
                                       (stride == columns || (name == "points" && stride == 3));
  if (!fits)
    throw Malformed{"array " + in_quotes(name) + " does not have " + std::to_string(columns) +
                    (columns == 1 ? " column" : " columns")};
  std::vector<Out> out;
  const auto is = [&array](char kind, std::size_t item) {
    return array.kind == kind && array.item == item;
  };
  const auto as = [&]<class Stored>(Stored) {
    convert<Stored>(name, array, columns, stride, out);
    return std::move(out);
  };
  if constexpr (std::is_floating_point_v<Out>) {
    if (is('f', 8)) return as(double{});
    if (is('f', 4)) return as(float{});
  }
  if (is('i', 1)) return as(std::int8_t{});
  if (is('i', 2)) return as(std::int16_t{});
  if (is('i', 4)) return as(std::int32_t{});
  if (is('i', 8)) return as(std::int64_t{});
  if (is('u', 1)) return as(std::uint8_t{});
  if (is('u', 2)) return as(std::uint16_t{});
  if (is('u', 4)) return as(std::uint32_t{});
  if (is('u', 8)) return as(std::uint64_t{});
  throw Malformed{"array " + in_quotes(name) + " has the type " + in_quotes(array.type) +
                  ", which does not fit"};
}

constexpr std::string_view kMeshArrays[] = {
    "points", "triangles",  "regions",      "edges",      "edge_markers", "edge_bulges",
    "parts",  "marker_ids", "marker_names", "region_ids", "region_names"};

void append_utf8(std::uint32_t point, std::string& out) {
  const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (point < 0x80) return put(point);
  if (point < 0x800) {
    put(0xc0 | point >> 6);
  } else {
    if (point < 0x10000) {
      put(0xe0 | point >> 12);
    } else {
      put(0xf0 | (point >> 18 & 7));  // a number that is no code point gives invalid UTF-8
      put(0x80 | (point >> 12 & 0x3f));
    }
    put(0x80 | (point >> 6 & 0x3f));
  }
  put(0x80 | (point & 0x3f));
}

std::vector<std::string> texts(Archive& archive, const std::string& name) {
  const Array array = parse_npy(name, archive.array(name));
  if (array.kind != 'U' || array.shape.size() != 1)
    throw Malformed{"array " + in_quotes(name) + " is not one of texts"};
  std::vector<std::string> out;
  for (std::uint64_t row = 0; row < array.shape[0]; ++row) {
    std::string& text = out.emplace_back();
    for (std::size_t at = 0; at < array.item; at += 4) {
      std::uint32_t point = 0;
      std::memcpy(&point, array.values.data() + row * array.item + at, sizeof point);
      if (point == 0) break;
      append_utf8(point, text);
    }
  }
  return out;
}

void read_names(Archive& archive, NameKind kind, NameReader& names) {
  const std::string word(word_of(kind));
  if (!archive.has(word + "_ids") || !archive.has(word + "_names")) return;
  const auto ids = column_values<std::int32_t>(archive, word + "_ids", 1);
  const auto all = texts(archive, word + "_names");
  if (ids.size() != all.size())
    throw Malformed{"arrays '" + word + "_ids' and '" + word + "_names' differ in length"};
  for (std::size_t i = 0; i < ids.size(); ++i) names.add(kind, ids[i], all[i]);
}

Mesh mesh_of(const std::filesystem::path& path, Archive& archive) {
  Mesh mesh;
  mesh.coordinates = column_values<double>(archive, "points", 2);
  mesh.triangles = column_values<std::uint32_t>(archive, "triangles", 3);
  if (archive.has("regions")) mesh.regions = column_values<std::int32_t>(archive, "regions", 1);
  if (archive.has("parts")) mesh.parts = column_values<std::int32_t>(archive, "parts", 1);
  if (archive.has("edges")) mesh.edges = column_values<std::uint32_t>(archive, "edges", 2);
  if (archive.has("edge_markers"))
    mesh.edge_markers = column_values<std::int32_t>(archive, "edge_markers", 1);
  if (archive.has("edge_bulges"))
    mesh.edge_bulges = column_values<double>(archive, "edge_bulges", 1);
  NameReader names(path.string());
  read_names(archive, NameKind::kMarker, names);
  read_names(archive, NameKind::kRegion, names);
  mesh.warnings = names.warnings();
  mesh.names = names.take();
  return mesh;
}

Result<std::vector<double>> values_of(const std::filesystem::path& path, Archive& archive,
                                      const std::string& name) {
  try {
    return column_values<double>(archive, name, 1);
  } catch (const Malformed& malformed) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + malformed.why);
  }
}

// What `read` makes of the archive of that file.
template <class Read>
auto read_archive(const std::filesystem::path& path, const Read& read)
    -> decltype(read(std::declval<Archive&>())) {
  const auto contents = read_file(path, kMaxFileBytes);
  if (!contents) return tl::unexpected(contents.error());
  try {
    Archive archive(contents->text());
    return read(archive);
  } catch (const Malformed& malformed) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + malformed.why);
  }
}

}  // namespace

Result<Mesh> read_npz(const std::filesystem::path& path) {
  return read_archive(path,
                      [&](Archive& archive) { return validated(path, mesh_of(path, archive)); });
}

Result<MeshWithArrays> read_npz_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted) {
  return read_archive(path, [&](Archive& archive) -> Result<MeshWithArrays> {
    std::vector<std::string> names = archive.names();
    std::erase_if(names, [](const std::string& name) {
      return std::find(std::begin(kMeshArrays), std::end(kMeshArrays), name) !=
             std::end(kMeshArrays);
    });
    const auto chosen = chosen_arrays(path, std::move(names), wanted);
    if (!chosen) return tl::unexpected(chosen.error());
    auto mesh = validated(path, mesh_of(path, archive));
    if (!mesh) return tl::unexpected(mesh.error());
    MeshWithArrays all{std::move(*mesh), {}};
    for (const std::string& name : *chosen)
      all.arrays.push_back({name, values_of(path, archive, name)});
    return all;
  });
}

}  // namespace weft::files
