// SPDX-License-Identifier: Apache-2.0
#include "server/http/openapi.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "server/version.h"

namespace weft::server {
namespace {

using Json = nlohmann::ordered_json;

std::string_view type_name(Parameter::Type type) {
  switch (type) {
    case Parameter::Type::kSwitch:
      return "boolean";
    case Parameter::Type::kNumber:
      return "number";
    case Parameter::Type::kCount:
      return "integer";
    case Parameter::Type::kText:
      break;
  }
  return "string";
}

Json parameter_json(const Parameter& parameter) {
  Json schema{{"type", type_name(parameter.type)}};
  if (!parameter.choices.empty()) schema["enum"] = parameter.choices;
  if (parameter.repeats) schema = {{"type", "array"}, {"items", schema}};
  return {{"name", parameter.name},
          {"in", "query"},
          {"description", parameter.about},
          {"schema", schema}};
}

// Of the parts in braces of a path.
Json path_parameters(std::string_view path) {
  Json all = Json::array();
  for (auto open = path.find('{'); open != path.npos; open = path.find('{', open + 1))
    all.push_back({{"name", path.substr(open + 1, path.find('}', open) - open - 1)},
                   {"in", "path"},
                   {"required", true},
                   {"schema", {{"type", "string"}}}});
  return all;
}

Json file_json() {
  return {{"application/octet-stream", {{"schema", {{"type", "string"}, {"format", "binary"}}}}}};
}

// The file of a domain, or a form that has others besides; for a mesh, it may be a
// GenerateMeshRequest instead.
Json body_json(const RouteText& route) {
  const Json file{{"type", "string"}, {"format", "binary"}};
  Json content = file_json();
  content["multipart/form-data"]["schema"] = {{"type", "object"},
                                              {"properties", {{"domain", file}}},
                                              {"required", {"domain"}},
                                              {"additionalProperties", file}};
  if (route.is_mesh) content["application/x-protobuf"] = content["application/octet-stream"];
  return content;
}

Json operation(const RouteText& route) {
  Json made{{"summary", route.about}, {"parameters", path_parameters(route.path)}};
  for (const Parameter* const parameter : parameters_for(route.uses))
    made["parameters"].push_back(parameter_json(*parameter));
  if ((route.uses & static_cast<ParameterUses>(ParameterUse::kDomain)) != 0)
    made["requestBody"] = {{"required", true}, {"content", body_json(route)}};
  const Json ok = route.is_mesh ? file_json() : Json{{"application/json", Json::object()}};
  const Json problem{
      {"application/problem+json", {{"schema", {{"$ref", "#/components/schemas/Problem"}}}}}};
  made["responses"] = {
      {"2XX", {{"description", route.is_mesh ? "The mesh" : "JSON"}, {"content", ok}}},
      {"default", {{"description", "A problem"}, {"content", problem}}}};
  return made;
}

}  // namespace

std::string openapi(std::span<const RouteText> routes) {
  Json paths = Json::object();
  for (const RouteText& route : routes)
    paths[std::string(route.path)][std::string(route.method)] = operation(route);
  const Json text{{"type", "string"}};
  const Json number{{"type", "integer"}};
  const Json error{
      {"type", "object"},
      {"properties", {{"field", text}, {"place", text}, {"line", number}, {"column", number}}}};
  const Json problem{{"type", "object"},
                     {"properties",
                      {{"type", text},
                       {"title", text},
                       {"status", number},
                       {"reason", text},
                       {"detail", text},
                       {"errors", {{"type", "array"}, {"items", error}}}}}};
  const Json all{{"openapi", "3.1.0"},
                 {"info", {{"title", "weft: meshes over HTTP"}, {"version", kVersion}}},
                 {"paths", std::move(paths)},
                 {"security", {Json::object(), {{"token", Json::array()}}}},
                 {"components",
                  {{"schemas", {{"Problem", problem}}},
                   {"securitySchemes", {{"token", {{"type", "http"}, {"scheme", "bearer"}}}}}}}};
  return all.dump(1) + "\n";
}

}  // namespace weft::server
