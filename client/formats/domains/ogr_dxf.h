// SPDX-License-Identifier: Apache-2.0
// DXF files without a section HEADER. GDAL 3.6 knows a file by its first section, and takes none
// that begins with BLOCKS, as OpenSCAD wrote them up to version 2021.01.
#pragma once

#include <string>

#include "client/formats/files/gdal_library.h"

namespace weft::client {

// A copy in memory with an empty HEADER before all else. GDAL may read it as long as it lives.
class DxfWithHeader {
 public:
  // The address of the file is as in OgrSource. One that cannot be read gives an empty copy.
  DxfWithHeader(const Gdal& gdal, const std::string& file);
  ~DxfWithHeader();
  DxfWithHeader(const DxfWithHeader&) = delete;
  DxfWithHeader& operator=(const DxfWithHeader&) = delete;

  const std::string& address() const { return address_; }

 private:
  const Gdal& gdal_;
  std::string contents_;
  std::string address_;
};

}  // namespace weft::client
