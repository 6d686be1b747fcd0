// SPDX-License-Identifier: Apache-2.0
#include "client/report/terminal_picture.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace weft::client {
namespace {

constexpr std::size_t kMaxColors = 256;
constexpr std::uint32_t kBits = 5;  // of a channel; colours that share them are one
constexpr std::uint32_t kRow = 6;   // pixels of a sixel

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // and a 0 behind
  const int size = ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

// In pieces of at most 4096 bytes; q=2: the terminal does not answer.
std::string kitty(std::string_view png) {
  constexpr std::size_t kPiece = 4096;
  const std::string all = base64(png);
  std::string text;
  for (std::size_t start = 0; start < all.size(); start += kPiece) {
    text += start == 0 ? "\033_Ga=T,f=100,q=2,m=" : "\033_Gm=";
    text += start + kPiece < all.size() ? "1;" : "0;";
    text.append(all, start, kPiece);
    text += "\033\\";
  }
  return text + "\n";
}

std::uint32_t channel(std::uint32_t pixel, std::size_t c) {
  return pixel >> (16 - 8 * c) & 0xff;
}

std::size_t bin_of(std::uint32_t pixel) {
  constexpr std::uint32_t kDrop = 8 - kBits;
  return (channel(pixel, 0) >> kDrop << 2 * kBits) | (channel(pixel, 1) >> kDrop << kBits) |
         channel(pixel, 2) >> kDrop;
}

// The pixels that share the upper bits of their channels.
struct Bin {
  std::uint64_t count = 0;
  std::array<std::uint64_t, 3> sums{};
  std::size_t number = 0;

  double mean(std::size_t c) const {
    return static_cast<double>(sums[c]) / static_cast<double>(count);
  }
  void add(const Bin& other) {
    count += other.count;
    for (std::size_t c = 0; c < 3; ++c) sums[c] += other.sums[c];
  }
};

struct Palette {
  std::vector<Bin> colors;           // the means
  std::vector<std::uint8_t> of_bin;  // the colour of each
};

// Bins of similar colours, and how much they differ.
struct Group {
  std::vector<Bin> bins;
  std::size_t channel = 0;  // in which they differ most
  double spread = 0;        // there, times the square root of the pixels

  explicit Group(std::vector<Bin> of) : bins(std::move(of)) {
    double count = 0;
    for (const Bin& bin : bins) count += static_cast<double>(bin.count);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [low, high] =
          std::minmax_element(bins.begin(), bins.end(),
                              [c](const Bin& a, const Bin& b) { return a.mean(c) < b.mean(c); });
      const double differ = (high->mean(c) - low->mean(c)) * std::sqrt(count);
      if (differ > spread) {
        spread = differ;
        channel = c;
      }
    }
  }
};

// Median cut (P. Heckbert, Color image quantization for frame buffer display, 1982).
Palette palette_of(const Image& image) {
  std::vector<Bin> all(std::size_t{1} << 3 * kBits);
  for (const std::uint32_t pixel : image.pixels) {
    Bin& bin = all[bin_of(pixel)];
    ++bin.count;
    for (std::size_t c = 0; c < 3; ++c) bin.sums[c] += channel(pixel, c);
  }
  std::vector<Bin> used;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].number = i;
    if (all[i].count > 0) used.push_back(all[i]);
  }
  std::vector<Group> groups = {Group(std::move(used))};
  while (groups.size() < kMaxColors) {
    const auto widest =
        std::max_element(groups.begin(), groups.end(),
                         [](const Group& a, const Group& b) { return a.spread < b.spread; });
    if (!(widest->spread > 0)) break;
    std::vector<Bin> bins = std::move(widest->bins);
    std::sort(bins.begin(), bins.end(),
              [c = widest->channel](const Bin& a, const Bin& b) { return a.mean(c) < b.mean(c); });
    std::uint64_t count = 0;
    for (const Bin& bin : bins) count += bin.count;
    std::size_t half = 0;
    for (std::uint64_t below = 0; half + 1 < bins.size() && 2 * below < count;)
      below += bins[half++].count;
    const auto middle = bins.begin() + static_cast<std::ptrdiff_t>(half);
    *widest = Group({bins.begin(), middle});
    groups.push_back(Group({middle, bins.end()}));
  }
  Palette palette;
  palette.of_bin.resize(all.size());
  for (const Group& group : groups) {
    Bin color;
    for (const Bin& bin : group.bins) {
      color.add(bin);
      palette.of_bin[bin.number] = static_cast<std::uint8_t>(palette.colors.size());
    }
    palette.colors.push_back(color);
  }
  return palette;
}

// "!12~": so many columns of the same six pixels.
void add_run(std::string& text, std::size_t count, std::uint8_t bits) {
  constexpr std::size_t kShort = 3;
  const char sixel = static_cast<char>('?' + bits);
  if (count > kShort)
    text += "!" + std::to_string(count) + sixel;
  else
    text.append(count, sixel);
}

// Six rows of pixels: the columns of one colour after those of another.
void add_band(std::string& text, const std::vector<std::uint8_t>& colors, std::size_t width) {
  std::array<std::vector<std::uint8_t>, kMaxColors> columns;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    auto& of_color = columns[colors[i]];
    of_color.resize(width);
    of_color[i % width] |= static_cast<std::uint8_t>(1U << i / width);
  }
  for (std::size_t color = 0; color < columns.size(); ++color) {
    const auto& bits = columns[color];
    if (bits.empty()) continue;
    text += "#" + std::to_string(color);
    std::size_t start = 0;
    for (std::size_t x = 1; x <= width; ++x) {
      if (x < width && bits[x] == bits[start]) continue;
      if (x < width || bits[start] != 0) add_run(text, x - start, bits[start]);
      start = x;
    }
    text += "$";
  }
  text.back() = '-';
}

std::string sixel(const Image& image) {
  const Palette palette = palette_of(image);
  std::string text =
      "\033P0;1;0q\"1;1;" + std::to_string(image.width) + ";" + std::to_string(image.height);
  for (std::size_t color = 0; color < palette.colors.size(); ++color) {
    text += "#" + std::to_string(color) + ";2";
    for (std::size_t c = 0; c < 3; ++c)  // in per cent
      text += ";" + std::to_string(std::lround(palette.colors[color].mean(c) * 100 / 255));
  }
  std::vector<std::uint8_t> colors;
  for (std::size_t top = 0; top < image.height; top += kRow) {
    const std::size_t end = std::min(top + kRow, image.height) * image.width;
    colors.clear();
    for (std::size_t i = top * image.width; i < end; ++i)
      colors.push_back(palette.of_bin[bin_of(image.pixels[i])]);
    add_band(text, colors, image.width);
  }
  text.back() = '\033';  // no row below the last
  return text + "\\\n";
}

}  // namespace

Result<std::string> terminal_picture(const Image& image, PictureProtocol protocol) {
  if (protocol == PictureProtocol::kSixel) return sixel(image);
  return png_of(image).map([](const std::string& png) { return kitty(png); });
}

}  // namespace weft::client
