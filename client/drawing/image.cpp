// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/image.h"

#include <memory>

#include "client/drawing/cairo_library.h"

namespace weft::client {
namespace {

struct DestroySurface {
  void operator()(cairo_surface_t* surface) const { loaded_cairo().cairo_surface_destroy(surface); }
};

cairo_status_t append(void* bytes, const unsigned char* next, unsigned size) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(next), size);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Result<std::string> png_of(const Image& image) {
  if (auto loaded = load_cairo(); !loaded) return tl::unexpected(loaded.error());
  std::vector<std::uint32_t> pixels = image.pixels;  // cairo needs memory that it may write to
  const std::unique_ptr<cairo_surface_t, DestroySurface> surface(
      loaded_cairo().cairo_image_surface_create_for_data(
          reinterpret_cast<unsigned char*>(pixels.data()), CAIRO_FORMAT_RGB24,
          static_cast<int>(image.width), static_cast<int>(image.height),
          static_cast<int>(image.width * sizeof(std::uint32_t))));
  std::string bytes;
  const cairo_status_t status =
      loaded_cairo().cairo_surface_write_to_png_stream(surface.get(), append, &bytes);
  if (status != CAIRO_STATUS_SUCCESS)
    return fail(ExitCode::kInternal, std::string("a picture cannot be made: ") +
                                         loaded_cairo().cairo_status_to_string(status));
  return bytes;
}

}  // namespace weft::client
