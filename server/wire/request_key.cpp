// SPDX-License-Identifier: Apache-2.0
#include "server/wire/request_key.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/message.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstddef>

#include "weft/weft.h"

namespace weft::server {
namespace {

void clear(google::protobuf::Message& message, std::string_view path) {
  const std::size_t dot = path.find('.');
  const auto* const field =
      message.GetDescriptor()->FindFieldByName(std::string(path.substr(0, dot)));
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  if (dot == std::string_view::npos) return reflection.ClearField(&message, field);
  if (!reflection.HasField(message, field)) return;
  google::protobuf::Message& inner = *reflection.MutableMessage(&message, field);
  clear(inner, path.substr(dot + 1));
  if (inner.ByteSizeLong() == 0) reflection.ClearField(&message, field);
}

void sort_by_id(google::protobuf::RepeatedPtrField<v1::Name>& names) {
  std::sort(names.begin(), names.end(),
            [](const v1::Name& a, const v1::Name& b) { return a.id() < b.id(); });
}

void make_canonical(v1::GenerateMeshRequest& request) {
  request.DiscardUnknownFields();
  for (const std::string_view path : kNotInMeshKey) clear(request, path);
  if (request.simplify() == 0) request.clear_simplify();  // -0 is 0
  v1::Quality& quality = *request.mutable_quality();
  if (!quality.has_min_angle_deg()) quality.set_min_angle_deg(MeshRequest{}.min_angle_deg);
  if (quality.placement() == v1::PLACEMENT_UNSPECIFIED)
    quality.set_placement(v1::PLACEMENT_LATTICE);
  for (v1::Layers& layers : *quality.mutable_layers())
    if (layers.ratio() == 0) layers.set_ratio(1);
  v1::SizeField& size = *request.mutable_size();
  if (size.cells_across() == 0) size.clear_cells_across();            // -0 is 0
  if (size.gradation() == 0) size.clear_gradation();                  // -0 is 0
  if (size.points_per_circle() == 0) size.clear_points_per_circle();  // -0 is 0
  // Fields that the mesh does not need are in the warnings that are kept with it.
  if (size.field_case() == v1::SizeField::FIELD_NOT_SET && size.cells_across() == 0 &&
      size.points_per_circle() == 0 && size.at().empty() && size.fields().empty() &&
      !size.gradation_within() && size.gradation() == 0) {
    request.clear_size();
  } else if (size.measure() == v1::MEASURE_UNSPECIFIED) {
    size.set_measure(v1::MEASURE_AREA);
  }
  v1::Domain& domain = *request.mutable_domain();
  if (domain.fill() == v1::FILL_UNSPECIFIED) domain.set_fill(v1::FILL_SEEDS);
  if (domain.snap() == 0) domain.clear_snap();  // -0 is 0
  const auto& markers = domain.segment_markers();
  if (std::all_of(markers.begin(), markers.end(), [](int marker) { return marker == 0; }))
    domain.clear_segment_markers();
  const auto& borders = domain.segment_areas();
  if (std::all_of(borders.begin(), borders.end(), [](std::uint32_t area) { return area == 0; }))
    domain.clear_segment_areas();
  sort_by_id(*domain.mutable_marker_names());
  sort_by_id(*domain.mutable_region_names());
}

}  // namespace

std::string mesh_key(v1::GenerateMeshRequest request) {
  make_canonical(request);
  std::string bytes = std::string(kEngineVersion) + '\n';
  {
    google::protobuf::io::StringOutputStream stream(&bytes);  // appends
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    request.SerializeToCodedStream(&coded);
  }
  return sha256(bytes);
}

std::string key_of_client(const std::string& key, const std::string& client) {
  return sha256(key + client);  // the key's length is fixed: the two cannot be mistaken
}

std::string sha256(std::string_view bytes) {
  std::string digest(EVP_MD_size(EVP_sha256()), '\0');
  EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(digest.data()), nullptr,
             EVP_sha256(), nullptr);
  return digest;
}

}  // namespace weft::server
