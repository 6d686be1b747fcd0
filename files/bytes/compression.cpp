// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/compression.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>

#include "loader/function_table.h"

namespace weft::files {
namespace {

using Unpacked = tl::expected<std::string, std::string>;

constexpr char kWrongSize[] = "does not unpack to the size that it claims";

Unpacked inflated(std::string_view packed, std::uint64_t size, int window_bits) {
  std::string out(size, '\0');
  z_stream stream{};
  if (::inflateInit2(&stream, window_bits) != Z_OK)
    return tl::unexpected<std::string>("zlib does not start");
  std::size_t read = 0;
  std::size_t written = 0;
  int state = Z_OK;
  while (state == Z_OK) {
    constexpr std::size_t kStep = std::size_t{1} << 30;
    const std::size_t in = std::min(kStep, packed.size() - read);
    const std::size_t room = std::min(kStep, out.size() - written);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + read));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + written);
    stream.avail_out = static_cast<uInt>(room);
    state = ::inflate(&stream, Z_NO_FLUSH);
    read += in - stream.avail_in;
    written += room - stream.avail_out;
  }
  ::inflateEnd(&stream);
  if (state != Z_STREAM_END || written != size) return tl::unexpected<std::string>(kWrongSize);
  return out;
}

// A block is a list of sequences: a token with two lengths, literals, and a copy of earlier bytes
// (LZ4 Block Format Description). The last sequence has no copy.
class Lz4Block {
 public:
  Lz4Block(std::string_view packed, std::uint64_t size) : rest_(packed), size_(size) {}

  Unpacked unpack() {
    out_.reserve(size_);
    while (!rest_.empty() && sequence()) {
    }
    if (!rest_.empty() || out_.size() != size_) return tl::unexpected<std::string>(kWrongSize);
    return std::move(out_);
  }

 private:
  // Returns false if the block is damaged.
  bool sequence() {
    const unsigned token = byte();
    const std::size_t literals = length(token >> 4);
    if (literals > rest_.size() || literals > size_ - out_.size()) return false;
    out_ += rest_.substr(0, literals);
    rest_.remove_prefix(literals);
    if (rest_.empty()) return true;
    if (rest_.size() < 2) return false;
    const unsigned low = byte();
    const std::size_t back = low | byte() << 8;
    constexpr std::size_t kMin = 4;
    const std::size_t copied = length(token & 15) + kMin;
    if (back == 0 || back > out_.size() || copied > size_ - out_.size()) return false;
    for (std::size_t i = 0; i < copied; ++i) out_ += out_[out_.size() - back];
    return true;
  }
  // 0 behind the end.
  unsigned byte() {
    if (rest_.empty()) return 0;
    const auto value = static_cast<unsigned char>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  // 15 goes on in bytes up to one that is not 255.
  std::size_t length(std::size_t value) {
    constexpr unsigned kMore = 255;
    if (value != 15) return value;
    unsigned more = kMore;
    while (more == kMore) value += more = byte();
    return value;
  }

  std::string_view rest_;
  std::size_t size_;
  std::string out_;
};

// liblzma's lzma_stream_buffer_decode: its numbers are part of what the library promises.
using DecodeStream = int(std::uint64_t* memory_limit, std::uint32_t flags, const void* allocator,
                         const std::uint8_t* in, std::size_t* in_at, std::size_t in_size,
                         std::uint8_t* out, std::size_t* out_at, std::size_t out_size);

Unpacked from_xz(std::string_view packed, std::uint64_t size) {
  static const auto library = SharedLibrary::load(WEFT_LZMA_SONAME);
  if (!library) return tl::unexpected<std::string>("is packed by LZMA: " + library.error());
  auto* const decode = reinterpret_cast<DecodeStream*>(library->find("lzma_stream_buffer_decode"));
  if (decode == nullptr)
    return tl::unexpected<std::string>("is packed by LZMA, which liblzma does not unpack");
  std::string out(size, '\0');
  std::uint64_t memory_limit = std::uint64_t{1} << 30;
  std::size_t read = 0;
  std::size_t written = 0;
  const int state =
      decode(&memory_limit, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &read,
             packed.size(), reinterpret_cast<std::uint8_t*>(out.data()), &written, out.size());
  if (state != 0 || written != size) return tl::unexpected<std::string>(kWrongSize);
  return out;
}

// What no packing of so few bytes can become is refused before any memory is taken for it.
std::uint64_t most_growth(Packing packing) {
  if (packing == Packing::kLz4) return 255;
  return packing == Packing::kLzma ? 10'000 : 1100;
}

}  // namespace

Unpacked unpacked(Packing packing, std::string_view packed, std::uint64_t size) {
  if (size / most_growth(packing) > packed.size() + 1)
    return tl::unexpected<std::string>("claims an absurd size");
  switch (packing) {
    case Packing::kDeflate:
      return inflated(packed, size, -MAX_WBITS);
    case Packing::kZlib:
      return inflated(packed, size, MAX_WBITS);
    case Packing::kLz4:
      return Lz4Block(packed, size).unpack();
    case Packing::kLzma:
      break;
  }
  return from_xz(packed, size);
}

Unpacked from_base64(std::string_view text) {
  constexpr std::string_view kLetters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int letters = 0;  // of the group, of four
  int padding = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\t' || c == '\r' || c == '\n') continue;
    const std::size_t value = c == '=' ? 0 : kLetters.find(c);
    padding = c == '=' ? padding + 1 : padding;
    if (value == kLetters.npos || padding > 2 || (padding > 0 && (c != '=' || letters < 2)))
      return tl::unexpected<std::string>("is not in base64");
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (++letters < 4) continue;
    for (int k = 0; k < 3 - padding; ++k) out += static_cast<char>(bits >> (16 - 8 * k) & 0xff);
    letters = padding = 0;
    bits = 0;
  }
  if (letters != 0) return tl::unexpected<std::string>("is not in base64");
  return out;
}

}  // namespace weft::files
