// SPDX-License-Identifier: Apache-2.0
#include "client/report/quality_report.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "files/base/text.h"

namespace weft::client {
namespace {

constexpr std::size_t kBarWidth = 40;  // columns

// A bar of `share` of the full width, padded with blanks to that width. It is empty only if `share`
// is 0.
std::string bar(double share, bool unicode) {
  constexpr std::array<const char*, 8> kEighths = {"", "▏", "▎", "▍", "▌", "▋", "▊", "▉"};
  const std::size_t steps = unicode ? 8 : 1;
  auto length =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(kBarWidth * steps)));
  if (share > 0) length = std::max<std::size_t>(length, 1);
  std::string text;
  for (std::size_t i = 0; i < length / steps; ++i) text += unicode ? "█" : "#";
  if (unicode) text += kEighths[length % steps];
  const std::size_t columns = (length + steps - 1) / steps;
  return text + std::string(kBarWidth - std::min(columns, kBarWidth), ' ');
}

std::string range_text(double from, double to) {
  char text[64];
  if (std::isinf(to))
    std::snprintf(text, sizeof text, "%5s and up", digits(from, 3).c_str());
  else
    std::snprintf(text, sizeof text, "%5s to %-4s", digits(from, 3).c_str(), digits(to, 3).c_str());
  return text;
}

std::string histogram_text(const std::string& title, const Histogram& histogram, bool unicode) {
  std::uint64_t sum = 0;
  std::uint64_t most = 1;
  for (const std::uint64_t count : histogram.counts) {
    sum += count;
    most = std::max(most, count);
  }
  std::string text = "\n" + title + "\n";
  if (sum == 0) return text + "  none\n";
  // Empty bins at both ends are left out.
  std::size_t first = 0;
  std::size_t last = histogram.counts.size();
  while (histogram.counts[first] == 0) ++first;
  while (histogram.counts[last - 1] == 0) --last;
  for (std::size_t i = first; i < last; ++i) {
    const std::uint64_t count = histogram.counts[i];
    char tail[64];
    std::snprintf(tail, sizeof tail, " %13s %5.1f %%\n", with_separators(count).c_str(),
                  100 * static_cast<double>(count) / static_cast<double>(sum));
    text += range_text(histogram.bounds[i], histogram.bounds[i + 1]) + "  " +
            bar(static_cast<double>(count) / static_cast<double>(most), unicode) + tail;
  }
  return text;
}

std::string worst_text(const std::string& title, const std::vector<MeasuredTriangle>& worst) {
  std::string text = "\n" + title + "\n";
  for (const MeasuredTriangle& one : worst) {
    text += "  triangle " + with_separators(one.triangle) + " at (" + digits(one.at.x, 6) + ", " +
            digits(one.at.y, 6) + "): " + digits(one.min_angle_deg, 4) + " degrees, aspect " +
            digits(one.aspect, 3);
    if (one.area_over_bound) text += ", area " + digits(*one.area_over_bound, 4) + " of its bound";
    text += "\n";
  }
  return text;
}

Json histogram_json(const Histogram& histogram) {
  return {{"bounds", histogram.bounds}, {"counts", histogram.counts}};
}

Json worst_json(const std::vector<MeasuredTriangle>& worst) {
  Json list = Json::array();
  for (const MeasuredTriangle& one : worst) {
    Json json = {{"triangle", one.triangle},
                 {"at", {one.at.x, one.at.y}},
                 {"min_angle_deg", one.min_angle_deg},
                 {"aspect", one.aspect}};
    if (one.area_over_bound) json["area_over_bound"] = *one.area_over_bound;
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

std::string quality_text(const MeshQuality& quality, bool unicode) {
  std::string text =
      histogram_text("smallest angle of each triangle, in degrees", quality.min_angles, unicode) +
      histogram_text("all angles, in degrees", quality.angles, unicode) +
      histogram_text("aspect ratio: circumradius over twice the inradius, 1 if equilateral",
                     quality.aspects, unicode);
  if (quality.areas_over_bound)
    text += histogram_text("area over its bound", *quality.areas_over_bound, unicode);
  if (!quality.worst_by_angle.empty())
    text += worst_text("smallest angles", quality.worst_by_angle);
  if (!quality.worst_by_area.empty())
    text += worst_text("largest areas over their bounds", quality.worst_by_area);
  return text;
}

Json quality_json(const MeshQuality& quality) {
  Json json = figures_json(quality.figures);
  Json& histograms = json["histograms"];
  histograms["min_angle_deg"] = histogram_json(quality.min_angles);
  histograms["angle_deg"] = histogram_json(quality.angles);
  histograms["aspect"] = histogram_json(quality.aspects);
  if (quality.areas_over_bound)
    histograms["area_over_bound"] = histogram_json(*quality.areas_over_bound);
  json["worst"]["by_angle"] = worst_json(quality.worst_by_angle);
  if (quality.areas_over_bound)
    json["worst"]["by_area_over_bound"] = worst_json(quality.worst_by_area);
  return json;
}

bool locale_is_utf8() {
  for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
    const char* const value = std::getenv(name);
    if (value == nullptr || *value == '\0') continue;
    std::string lower = value;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower.find("utf-8") != std::string::npos || lower.find("utf8") != std::string::npos;
  }
  return false;
}

}  // namespace weft::client
