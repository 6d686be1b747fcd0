// SPDX-License-Identifier: Apache-2.0
// The fields of a message of the protocol, one by one, from its bytes.
//
//   for (Fields in(bytes); in.next();) switch (in.number()) {
//     case 1: in.read(request.threads); break;
//     default: in.skip();
//   }
//
// A field that has another wire type than the value it is read into is unknown, and skipped. Of a
// signed number the type is sint32, of an unsigned one a varint. Throws protozero::exception for
// bytes that are no message.
#pragma once

#include <cstdint>
#include <optional>
#include <protozero/pbf_reader.hpp>
#include <string>
#include <utility>
#include <vector>

namespace weft::wire {

class Fields {
 public:
  explicit Fields(protozero::data_view bytes) : in_(bytes) {}

  bool next() { return in_.next(); }
  std::uint32_t number() const { return in_.tag(); }
  void skip() { in_.skip(); }

  void read(double& to) {
    if (is(Type::fixed64)) to = in_.get_double();
  }
  void read(bool& to) {
    if (is(Type::varint)) to = in_.get_uint64() != 0;
  }
  void read(std::int32_t& to) {
    if (is(Type::varint)) to = in_.get_sint32();
  }
  void read(std::uint32_t& to) {
    if (is(Type::varint)) to = in_.get_uint32();
  }
  void read(std::uint64_t& to) {
    if (is(Type::varint)) to = in_.get_uint64();
  }
  void read(std::string& to) {
    if (is(Type::length_delimited)) to = in_.get_string();
  }
  template <class T>
  void read(std::optional<T>& to) {
    T value{};
    const bool known = in_.wire_type() == type_of(value);
    read(value);
    if (known) to = value;
  }
  void read_enumerator(std::int32_t& to) {
    if (is(Type::varint)) to = in_.get_enum();
  }

  // Calls `read` with the fields of the message that the field holds.
  template <class F>
  void message(F&& read) {
    if (is(Type::length_delimited)) read(Fields(in_.get_view()));
  }

  // Calls `add` with each number of an array, packed or not. `reserve` hears before of how many.
  template <class T, class F>
  void array(F&& add) {
    array<T>(std::forward<F>(add), [](std::size_t) {});
  }
  template <class T, class F, class Reserve>
  void array(F&& add, Reserve&& reserve) {
    if (in_.wire_type() == Type::length_delimited) {
      const auto numbers = packed(T{});
      reserve(numbers.size());
      for (const T number : numbers) add(number);
    } else if (is(type_of(T{}))) {
      add(single(T{}));
    }
  }
  // Appends them.
  template <class T>
  void array(std::vector<T>& to) {
    array<T>([&](T number) { to.push_back(number); },
             [&](std::size_t numbers) {
               if (to.empty()) to.reserve(numbers);
             });
  }

 private:
  using Type = protozero::pbf_wire_type;

  bool is(Type type) {
    if (in_.wire_type() == type) return true;
    in_.skip();
    return false;
  }

  static Type type_of(const std::string&) { return Type::length_delimited; }
  static Type type_of(double) { return Type::fixed64; }
  static Type type_of(float) { return Type::fixed32; }
  static Type type_of(std::int32_t) { return Type::varint; }
  static Type type_of(std::uint32_t) { return Type::varint; }

  auto packed(double) { return in_.get_packed_double(); }
  auto packed(float) { return in_.get_packed_float(); }
  auto packed(std::int32_t) { return in_.get_packed_sint32(); }
  auto packed(std::uint32_t) { return in_.get_packed_uint32(); }

  double single(double) { return in_.get_double(); }
  float single(float) { return in_.get_float(); }
  std::int32_t single(std::int32_t) { return in_.get_sint32(); }
  std::uint32_t single(std::uint32_t) { return in_.get_uint32(); }

  protozero::pbf_reader in_;
};

}  // namespace weft::wire
