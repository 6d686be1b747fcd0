// SPDX-License-Identifier: Apache-2.0
#include "loader/function_table.h"

#include <dlfcn.h>

#include <cctype>

namespace weft {

tl::expected<SharedLibrary, std::string> SharedLibrary::load(const std::string& soname) {
  void* const handle = ::dlopen(soname.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle != nullptr) return SharedLibrary(handle);
  return tl::unexpected(std::string(::dlerror()) + " (Debian's package " + debian_package(soname) +
                        ")");
}

void* SharedLibrary::find(const char* function) const {
  return ::dlsym(handle_, function);
}

std::string debian_package(const std::string& soname) {
  const std::size_t end = soname.find(".so");
  if (end == std::string::npos) return soname;
  std::string name = soname.substr(0, end);
  const std::string version = soname.size() > end + 4 ? soname.substr(end + 4) : "";
  // With a hyphen between two digits: libsqlite3.so.0 is in libsqlite3-0.
  if (!version.empty() && std::isdigit(static_cast<unsigned char>(name.back())) != 0) name += '-';
  return name + version;
}

}  // namespace weft
