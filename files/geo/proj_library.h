// SPDX-License-Identifier: Apache-2.0
// The functions of PROJ that weft calls, from the shared library, which is loaded when something is
// first projected and stays.
#pragma once

#include <proj.h>

#include "files/base/error.h"
#include "loader/function_table.h"

#define WEFT_PROJ_FUNCTIONS(EACH)        \
  EACH(proj_context_create)              \
  EACH(proj_context_destroy)             \
  EACH(proj_coord)                       \
  EACH(proj_create)                      \
  EACH(proj_create_crs_to_crs_from_pj)   \
  EACH(proj_crs_get_coordinate_system)   \
  EACH(proj_crs_get_geodetic_crs)        \
  EACH(proj_cs_get_axis_info)            \
  EACH(proj_destroy)                     \
  EACH(proj_ellipsoid_get_parameters)    \
  EACH(proj_get_ellipsoid)               \
  EACH(proj_get_type)                    \
  EACH(proj_log_level)                   \
  EACH(proj_normalize_for_visualization) \
  EACH(proj_trans)

namespace weft::files {

WEFT_FUNCTION_TABLE(ProjLibrary, WEFT_PROJ_FUNCTIONS);

// Errors (kInternal) name the library and why it is not loaded.
Result<void> load_proj();
// REQUIRES: load_proj succeeded.
const ProjLibrary& loaded_proj();

}  // namespace weft::files
