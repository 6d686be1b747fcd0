// SPDX-License-Identifier: Apache-2.0
// The functions of cairo that weft calls, from the shared library, which is loaded when something
// is first drawn and stays.
#pragma once

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

#include "client/base/files.h"
#include "files/base/error.h"
#include "loader/function_table.h"

#define WEFT_CAIRO_FUNCTIONS(EACH)          \
  EACH(cairo_arc)                           \
  EACH(cairo_clip)                          \
  EACH(cairo_close_path)                    \
  EACH(cairo_create)                        \
  EACH(cairo_destroy)                       \
  EACH(cairo_fill)                          \
  EACH(cairo_get_target)                    \
  EACH(cairo_image_surface_create)          \
  EACH(cairo_image_surface_create_for_data) \
  EACH(cairo_image_surface_get_data)        \
  EACH(cairo_image_surface_get_height)      \
  EACH(cairo_image_surface_get_stride)      \
  EACH(cairo_image_surface_get_width)       \
  EACH(cairo_line_to)                       \
  EACH(cairo_move_to)                       \
  EACH(cairo_new_path)                      \
  EACH(cairo_new_sub_path)                  \
  EACH(cairo_paint)                         \
  EACH(cairo_pattern_add_color_stop_rgb)    \
  EACH(cairo_pattern_create_linear)         \
  EACH(cairo_pattern_destroy)               \
  EACH(cairo_pdf_surface_create_for_stream) \
  EACH(cairo_rectangle)                     \
  EACH(cairo_restore)                       \
  EACH(cairo_save)                          \
  EACH(cairo_scale)                         \
  EACH(cairo_select_font_face)              \
  EACH(cairo_set_antialias)                 \
  EACH(cairo_set_font_size)                 \
  EACH(cairo_set_line_cap)                  \
  EACH(cairo_set_line_width)                \
  EACH(cairo_set_source)                    \
  EACH(cairo_set_source_rgba)               \
  EACH(cairo_set_source_surface)            \
  EACH(cairo_show_text)                     \
  EACH(cairo_status)                        \
  EACH(cairo_status_to_string)              \
  EACH(cairo_stroke)                        \
  EACH(cairo_stroke_preserve)               \
  EACH(cairo_surface_destroy)               \
  EACH(cairo_surface_finish)                \
  EACH(cairo_surface_flush)                 \
  EACH(cairo_surface_status)                \
  EACH(cairo_surface_write_to_png_stream)   \
  EACH(cairo_svg_surface_create_for_stream) \
  EACH(cairo_text_extents)                  \
  EACH(cairo_text_path)                     \
  EACH(cairo_translate)

namespace weft::client {

WEFT_FUNCTION_TABLE(Cairo, WEFT_CAIRO_FUNCTIONS);

// Errors (kInternal) name the library and why it is not loaded.
Result<void> load_cairo();
// REQUIRES: load_cairo succeeded.
const Cairo& loaded_cairo();

}  // namespace weft::client
