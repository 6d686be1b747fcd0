// SPDX-License-Identifier: Apache-2.0
#include "tests/files/support/shapefile_writer.h"

#include <shapefil.h>

#include <utility>
#include <vector>

namespace weft::files {
namespace {

struct Record {
  std::vector<double> x;
  std::vector<double> y;
  std::vector<int> parts;
};

void add(SHPInfo* shapes, const Record& record) {
  SHPObject* shape = ::SHPCreateObject(
      SHPT_POLYGON, -1, static_cast<int>(record.parts.size()), record.parts.data(), nullptr,
      static_cast<int>(record.x.size()), record.x.data(), record.y.data(), nullptr, nullptr);
  ::SHPWriteObject(shapes, -1, shape);
  ::SHPDestroyObject(shape);
}

}  // namespace

void write_sample_shapefile(const std::filesystem::path& base) {
  SHPInfo* shapes = ::SHPCreate(base.c_str(), SHPT_POLYGON);
  add(shapes, {{0, 0, 4, 4, 0, 1, 2, 2, 1}, {0, 4, 4, 0, 0, 1, 1, 2, 1}, {0, 5}});
  add(shapes, {{10, 10, 11, 10}, {0, 1, 0, 0}, {0}});
  ::SHPClose(shapes);

  DBFInfo* table = ::DBFCreate(base.c_str());
  ::DBFAddField(table, "marker", FTInteger, 9, 0);
  ::DBFAddField(table, "region", FTInteger, 9, 0);
  ::DBFAddField(table, "max_area", FTDouble, 12, 4);
  ::DBFWriteIntegerAttribute(table, 0, 0, 3);
  ::DBFWriteIntegerAttribute(table, 0, 1, 7);
  ::DBFWriteDoubleAttribute(table, 0, 2, 0.5);
  ::DBFWriteIntegerAttribute(table, 1, 0, 4);
  ::DBFWriteNULLAttribute(table, 1, 1);
  ::DBFWriteNULLAttribute(table, 1, 2);
  ::DBFClose(table);
}

void write_named_shapefile(const std::filesystem::path& base) {
  SHPInfo* shapes = ::SHPCreate(base.c_str(), SHPT_POLYGON);
  add(shapes, {{0, 0, 4, 0}, {0, 4, 0, 0}, {0}});
  add(shapes, {{10, 10, 11, 10}, {0, 1, 0, 0}, {0}});
  ::SHPClose(shapes);

  DBFInfo* table = ::DBFCreate(base.c_str());
  ::DBFAddField(table, "marker", FTString, 20, 0);
  ::DBFAddField(table, "region", FTInteger, 9, 0);
  ::DBFAddField(table, "region_nam", FTString, 20, 0);
  ::DBFWriteStringAttribute(table, 0, 0, "coast");
  ::DBFWriteIntegerAttribute(table, 0, 1, 5);
  ::DBFWriteStringAttribute(table, 0, 2, "bay");
  ::DBFWriteStringAttribute(table, 1, 0, "island");
  ::DBFWriteNULLAttribute(table, 1, 1);
  ::DBFWriteNULLAttribute(table, 1, 2);
  ::DBFClose(table);
}

void write_text_shapefile(const std::filesystem::path& base) {
  SHPInfo* shapes = ::SHPCreate(base.c_str(), SHPT_POLYGON);
  add(shapes, {{0, 0, 4, 0}, {0, 4, 0, 0}, {0}});
  add(shapes, {{10, 10, 10, 10}, {0, 1, 0, 0}, {0}});
  ::SHPClose(shapes);

  DBFInfo* table = ::DBFCreate(base.c_str());
  int field = 0;
  for (const auto& [name, text] :
       {std::pair{"marker", "3"}, {"region", "7"}, {"max_area", "0.1"}}) {
    ::DBFAddField(table, name, FTString, 12, 0);
    for (const int record : {0, 1}) ::DBFWriteStringAttribute(table, record, field, text);
    ++field;
  }
  ::DBFClose(table);
}

}  // namespace weft::files
