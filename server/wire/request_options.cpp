// SPDX-License-Identifier: Apache-2.0
#include "server/wire/request_options.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <vector>

namespace weft::server {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// `from` without its repeated fields, into `to`, an empty message of the same type. The arrays are
// not copied: they may be most of the server's memory.
void copy_single_fields(const Message& from, Message& to) {
  const auto& reflection = *from.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection.ListFields(from, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->is_repeated()) continue;
    switch (field->cpp_type()) {
      case FieldDescriptor::CPPTYPE_MESSAGE:
        copy_single_fields(reflection.GetMessage(from, field),
                           *reflection.MutableMessage(&to, field));
        break;
      case FieldDescriptor::CPPTYPE_BOOL:
        reflection.SetBool(&to, field, reflection.GetBool(from, field));
        break;
      case FieldDescriptor::CPPTYPE_DOUBLE:
        reflection.SetDouble(&to, field, reflection.GetDouble(from, field));
        break;
      case FieldDescriptor::CPPTYPE_ENUM:
        reflection.SetEnumValue(&to, field, reflection.GetEnumValue(from, field));
        break;
      case FieldDescriptor::CPPTYPE_STRING:
        reflection.SetString(&to, field, reflection.GetString(from, field));
        break;
      case FieldDescriptor::CPPTYPE_UINT32:
        reflection.SetUInt32(&to, field, reflection.GetUInt32(from, field));
        break;
      case FieldDescriptor::CPPTYPE_UINT64:
        reflection.SetUInt64(&to, field, reflection.GetUInt64(from, field));
        break;
      default:  // of no field of a request, which the test of its key walks
        break;
    }
  }
}

}  // namespace

v1::GenerateMeshRequest options_of(const v1::GenerateMeshRequest& request) {
  v1::GenerateMeshRequest options;
  copy_single_fields(request, options);
  for (const auto& field : request.size().fields())
    copy_single_fields(field, *options.mutable_size()->add_fields());
  if (!request.domain().marker_names().empty())
    *options.mutable_domain()->mutable_marker_names() = request.domain().marker_names();
  if (!request.domain().region_names().empty())
    *options.mutable_domain()->mutable_region_names() = request.domain().region_names();
  return options;
}

}  // namespace weft::server
