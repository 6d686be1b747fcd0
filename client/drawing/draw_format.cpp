// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/draw.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {

std::optional<DrawFormat> draw_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".png") return DrawFormat::kPng;
  if (extension == ".svg") return DrawFormat::kSvg;
  if (extension == ".pdf") return DrawFormat::kPdf;
  return std::nullopt;
}

}  // namespace weft::client
