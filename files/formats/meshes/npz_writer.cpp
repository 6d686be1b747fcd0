// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "files/formats/meshes/npz.h"

namespace weft::files {
namespace {

// Little-endian numbers of a zip header.
class Header {
 public:
  template <class T>
  Header& operator<<(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Header& operator<<(const std::string& text) {
    bytes_ += text;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

using U16 = std::uint16_t;
using U32 = std::uint32_t;
using U64 = std::uint64_t;

constexpr U16 kVersion = 45;             // 4.5, which has 64-bit sizes
constexpr U16 kDate = (46 << 9) | 0x21;  // 1 January 2026: the same mesh gives the same file
constexpr U32 kIn64Bits = 0xffffffff;
constexpr U16 kExtra64 = 1;  // the extra field with the 64-bit sizes

// An archive whose files are stored without compression (PKWARE's APPNOTE.TXT, 4.3).
class Zip {
 public:
  explicit Zip(OutputFile& file) : file_(file) {}

  void add(const std::string& name, std::span<const char> head, std::span<const char> body,
           PagedMemory* pages) {
    uLong crc = 0;
    const auto sum = [&crc](std::span<const char> bytes) {
      crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    };
    sum(head);
    in_pieces(pages, body, sum);
    const U64 size = head.size() + body.size();
    Header local;
    local << U32{0x04034b50} << common(static_cast<U32>(crc), name, 20) << name << kExtra64
          << U16{16} << size << size;
    entries_ += (Header() << U32{0x02014b50} << kVersion << common(static_cast<U32>(crc), name, 28)
                          << U16{0} << U16{0} << U16{0} << U32{0} << kIn64Bits << name << kExtra64
                          << U16{24} << size << size << at_)
                    .bytes();
    ++count_;
    put(local.bytes());
    put(head);
    in_pieces(pages, body, [this](std::span<const char> bytes) { put(bytes); });
  }

  void finish() {
    const U64 directory = at_;
    const U64 size = entries_.size();
    put(entries_);
    const U64 end = at_;
    put((Header() << U32{0x06064b50} << U64{44} << kVersion << kVersion << U32{0} << U32{0}
                  << count_ << count_ << size << directory << U32{0x07064b50} << U32{0} << end
                  << U32{1} << U32{0x06054b50} << U16{0} << U16{0} << U16{0xffff} << U16{0xffff}
                  << kIn64Bits << kIn64Bits << U16{0})
            .bytes());
  }

 private:
  // What the local and the central header of an entry have in common, up to the length of the extra
  // field.
  static std::string common(U32 crc, const std::string& name, U16 extra) {
    return (Header() << kVersion << U16{0} << U16{0} << U16{0} << kDate << crc << kIn64Bits
                     << kIn64Bits << static_cast<U16>(name.size()) << extra)
        .bytes();
  }
  void put(std::span<const char> bytes) {
    file_.put_array(bytes);
    at_ += bytes.size();
  }

  OutputFile& file_;
  U64 at_ = 0;
  U64 count_ = 0;
  std::string entries_;  // the central directory
};

// The header of a .npy file (version 1.0), padded to a multiple of 64 bytes.
std::string npy_head(const char* type, std::size_t rows, std::size_t columns) {
  std::string text = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(rows) + "," +
                     (columns == 1 ? "" : " " + std::to_string(columns)) + "), }";
  constexpr std::size_t kPrefix = 10;
  constexpr std::size_t kAlign = 64;
  text.append(kAlign - 1 - (kPrefix + text.size()) % kAlign, ' ');
  text += '\n';
  return (Header() << std::string("\x93NUMPY\x01\x00", 8) << static_cast<U16>(text.size()) << text)
      .bytes();
}

template <class T>
void add_array(Zip& zip, const std::string& name, const char* type, std::size_t columns,
               std::span<const T> values, PagedMemory* pages) {
  const auto bytes = std::as_bytes(values);
  zip.add(name + ".npy", npy_head(type, values.size() / columns, columns),
          std::span(reinterpret_cast<const char*>(bytes.data()), bytes.size()), pages);
}

// The code points of a name, which is UTF-8.
std::vector<U32> code_points(const std::string& name) {
  std::vector<U32> points;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xc0) == 0x80) {
      points.back() = points.back() << 6 | (byte & 0x3fu);
    } else {
      points.push_back(byte < 0x80   ? byte
                       : byte < 0xe0 ? byte & 0x1fu
                       : byte < 0xf0 ? byte & 0xfu
                                     : byte & 7u);
    }
  }
  return points;
}

// NumPy's texts all have the same length, and are padded with zeros.
void add_names(Zip& zip, const std::string& kind, const NameTable& names) {
  if (names.empty()) return;
  std::vector<std::int32_t> ids;
  std::vector<std::vector<U32>> texts;
  std::size_t longest = 1;
  for (const auto& [id, name] : names) {
    ids.push_back(id);
    texts.push_back(code_points(name));
    longest = std::max(longest, texts.back().size());
  }
  std::vector<U32> table;
  for (std::vector<U32>& text : texts) {
    text.resize(longest);
    table.insert(table.end(), text.begin(), text.end());
  }
  add_array(zip, kind + "_ids", "<i4", 1, std::span<const std::int32_t>(ids), nullptr);
  const auto bytes = std::as_bytes(std::span(table));
  zip.add(kind + "_names.npy", npy_head(("<U" + std::to_string(longest)).c_str(), ids.size(), 1),
          std::span(reinterpret_cast<const char*>(bytes.data()), bytes.size()), nullptr);
}

}  // namespace

void write_npz(const MeshView& mesh, OutputFile& file) {
  Zip zip(file);
  add_array(zip, "points", "<f8", 2, mesh.coordinates, mesh.pages);
  add_array(zip, "triangles", "<u4", 3, mesh.triangles, mesh.pages);
  add_array(zip, "regions", "<i4", 1, mesh.regions, mesh.pages);
  add_array(zip, "edges", "<u4", 2, mesh.edges, mesh.pages);
  add_array(zip, "edge_markers", "<i4", 1, mesh.edge_markers, mesh.pages);
  if (!mesh.edge_bulges.empty())
    add_array(zip, "edge_bulges", "<f8", 1, mesh.edge_bulges, mesh.pages);
  if (!mesh.parts.empty()) add_array(zip, "parts", "<i4", 1, mesh.parts, mesh.pages);
  add_names(zip, "marker", mesh.names->markers);
  add_names(zip, "region", mesh.names->regions);
  for (const VertexValues& values : mesh.vertex_values)
    add_array(zip, values.name, "<f8", 1, values.values, mesh.pages);
  zip.finish();
}

}  // namespace weft::files
