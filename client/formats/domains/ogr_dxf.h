// SPDX-License-Identifier: Apache-2.0
// Drawings as GDAL is to see them: GDAL makes geometries of what a drawing says about itself, such
// as dimensions and texts, and takes no file that begins without a section HEADER, as OpenSCAD
// wrote them up to version 2021.01.
#pragma once

#include <string>
#include <vector>

#include "client/formats/files/gdal_library.h"

namespace weft::client {

// The text of a drawing without its texts, dimensions, leaders, attributes and the like, and
// without the layout on paper if there are entities in the model; with a section HEADER. A text
// that is no list of codes and values is left as it is from there on. The sentences, which follow
// the name of the file, tell of entities on paper, and of those that GDAL does not read.
struct DxfModel {
  std::string text;
  std::vector<std::string> sentences;
};
DxfModel dxf_model(std::string_view drawing);

// A copy of it in memory, which GDAL may read as long as it lives.
class DxfCopy {
 public:
  // The address of the file is as in OgrSource. One that cannot be read gives an empty copy.
  DxfCopy(const Gdal& gdal, const std::string& file);
  ~DxfCopy();
  DxfCopy(const DxfCopy&) = delete;
  DxfCopy& operator=(const DxfCopy&) = delete;

  const std::string& address() const { return address_; }
  const std::vector<std::string>& sentences() const { return model_.sentences; }

 private:
  const Gdal& gdal_;
  DxfModel model_;
  std::string address_;
};

}  // namespace weft::client
