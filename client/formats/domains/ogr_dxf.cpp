// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/ogr_dxf.h"

#include <cstdint>

namespace weft::client {

DxfWithHeader::DxfWithHeader(const Gdal& gdal, const std::string& file)
    : gdal_(gdal),
      contents_("  0\nSECTION\n  2\nHEADER\n  0\nENDSEC\n"),
      // No other file in memory has the name, as no other object has the address.
      address_("/vsimem/weft-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + ".dxf") {
  GByte* bytes = nullptr;
  vsi_l_offset size = 0;
  if (gdal_.VSIIngestFile(nullptr, file.c_str(), &bytes, &size, -1) != 0)
    contents_.append(reinterpret_cast<const char*>(bytes), size);
  gdal_.VSIFree(bytes);
  VSILFILE* made =
      gdal_.VSIFileFromMemBuffer(address_.c_str(), reinterpret_cast<GByte*>(contents_.data()),
                                 contents_.size(), /*bTakeOwnership=*/FALSE);
  if (made != nullptr) gdal_.VSIFCloseL(made);
}

DxfWithHeader::~DxfWithHeader() {
  gdal_.VSIUnlink(address_.c_str());
}

}  // namespace weft::client
