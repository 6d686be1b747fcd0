// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/mesh_key.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <openssl/evp.h>

#include <algorithm>

#include "engine/engine.h"

namespace weft::server {
namespace {

void make_canonical(v1::GenerateMeshRequest& request) {
  request.DiscardUnknownFields();
  request.clear_threads();
  request.clear_first_chunk();
  request.clear_want_quadtree();
  request.clear_no_cache();
  const std::uint64_t max_triangles = request.budget().max_triangles();
  request.clear_budget();
  if (max_triangles != 0) request.mutable_budget()->set_max_triangles(max_triangles);
  v1::Quality& quality = *request.mutable_quality();
  if (!quality.has_min_angle_deg()) quality.set_min_angle_deg(MeshRequest{}.min_angle_deg);
  if (quality.placement() == v1::PLACEMENT_UNSPECIFIED)
    quality.set_placement(v1::PLACEMENT_LATTICE);
  if (request.size().field_case() == v1::SizeField::FIELD_NOT_SET) request.clear_size();
  v1::Domain& domain = *request.mutable_domain();
  if (domain.fill() == v1::FILL_UNSPECIFIED) domain.set_fill(v1::FILL_SEEDS);
  if (domain.snap() == 0) domain.clear_snap();  // -0 is 0
  const auto& markers = domain.segment_markers();
  if (std::all_of(markers.begin(), markers.end(), [](int marker) { return marker == 0; }))
    domain.clear_segment_markers();
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

std::string sha256(std::string_view bytes) {
  std::string digest(EVP_MD_size(EVP_sha256()), '\0');
  EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(digest.data()), nullptr,
             EVP_sha256(), nullptr);
  return digest;
}

}  // namespace weft::server
