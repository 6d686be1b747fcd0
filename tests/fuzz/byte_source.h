// SPDX-License-Identifier: Apache-2.0
// The bytes of a fuzzer's input, read as the choices that make a case. Once they are used up every
// choice is 0, so each input, however short, is a case, and a case is a function of its bytes. (Not
// clang's FuzzedDataProvider, which the sanitizers' g++ does not have.)
//
//   ByteSource bytes(data, size);
//   const std::size_t points = 3 + bytes.below(20);
//   const double angle = bytes.one_of<double>({20, 0, 34});
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace weft::fuzz {

class ByteSource {
 public:
  ByteSource(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  std::size_t left() const { return left_; }
  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  // REQUIRES: 0 < n <= 256.
  std::size_t below(std::size_t n) { return byte() % n; }
  bool flag() { return byte() % 2 != 0; }
  std::uint16_t two_bytes() {
    const unsigned low = byte();
    return static_cast<std::uint16_t>(low | unsigned{byte()} << 8);
  }
  template <class T>
  T one_of(std::initializer_list<T> choices) {
    return choices.begin()[below(choices.size())];
  }
  // The next `n`, or as many as there are.
  std::string_view take(std::size_t n) {
    if (n > left_) n = left_;
    const std::string_view taken(reinterpret_cast<const char*>(data_), n);
    data_ += n;
    left_ -= n;
    return taken;
  }
  std::string_view rest() { return take(left_); }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace weft::fuzz
