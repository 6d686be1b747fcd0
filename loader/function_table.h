// SPDX-License-Identifier: Apache-2.0
// Functions of a shared library that is loaded when somebody first asks for it, so that a program
// which does not need it starts without it.
//
//   #define MY_PROJ_FUNCTIONS(EACH) EACH(proj_create) EACH(proj_destroy)
//   WEFT_FUNCTION_TABLE(Proj, MY_PROJ_FUNCTIONS);
//
//   const auto& proj = loaded_functions<Proj>("libproj.so.25");
//   if (!proj) return fail(proj.error());
//   proj->proj_destroy(pj);
//
// The library's header must be included before, because it has the types of the functions.
#pragma once

#include <string>
#include <tl/expected.hpp>

// A struct with a pointer to each of the functions, of the function's name.
#define WEFT_FUNCTION_TABLE(Table, FUNCTIONS) \
  struct Table {                              \
    FUNCTIONS(WEFT_FUNCTION_MEMBER)           \
    template <class Visit>                    \
    void visit(const Visit& each) {           \
      FUNCTIONS(WEFT_FUNCTION_VISIT)          \
    }                                         \
  }
#define WEFT_FUNCTION_MEMBER(name) decltype(&::name) name = nullptr;
#define WEFT_FUNCTION_VISIT(name) each(#name, name);

namespace weft {

// A library stays loaded to the end of the process, because libraries have destructors that run
// then. Thread-safe.
class SharedLibrary {
 public:
  // `soname` is what programs that are linked with the library ask the loader for. The error says
  // why it is not loaded, and names the package of Debian that has it.
  static tl::expected<SharedLibrary, std::string> load(const std::string& soname);
  // Null if the library has no such function.
  void* find(const char* function) const;

 private:
  explicit SharedLibrary(void* handle) : handle_(handle) {}
  void* handle_;
};

// The package of a library by Debian's rule (Debian Policy, 8.1): libproj.so.25 is in libproj25.
std::string debian_package(const std::string& soname);

// Errors: those of SharedLibrary::load, and a function that the library does not have.
template <class Table>
tl::expected<Table, std::string> load_functions(const std::string& soname) {
  const auto library = SharedLibrary::load(soname);
  if (!library) return tl::unexpected(library.error());
  Table table;
  std::string missing;
  table.visit([&](const char* name, auto& function) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(library->find(name));
    if (function == nullptr && missing.empty()) missing = name;
  });
  if (!missing.empty()) return tl::unexpected(soname + " has no function " + missing);
  return table;
}

// The same, loaded once: whether or not that succeeds, later calls return what the first did.
// REQUIRES: the same name in each call. Thread-safe.
template <class Table>
const tl::expected<Table, std::string>& loaded_functions(const char* soname) {
  static const tl::expected<Table, std::string> loaded = load_functions<Table>(soname);
  return loaded;
}

}  // namespace weft
