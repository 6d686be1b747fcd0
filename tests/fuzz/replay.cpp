// SPDX-License-Identifier: Apache-2.0
// Stands in for libFuzzer wherever there is none: runs a target on every file of the folders that
// are named. So ctest holds every build to what the fuzzers have found.
//
//   engine_fuzz tests/fuzz/corpus/engine
//
// A release build runs ten times as fast as one with sanitizers and coverage, which pays for
// targets that are held to laws: for so many seconds, inputs that are made of those files by
// chance.
//
//   WEFT_FUZZ_FINDINGS=found engine_fuzz --seconds 3600 --seed 7 tests/fuzz/corpus/engine
//
// How often a file is taken depends on the time that it takes, so a seed does not repeat a run.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/fuzz/law.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

// Seconds of all threads.
constexpr double kSlow = 3;     // a case is bounded to take a fraction of that
constexpr double kFast = 1e-4;  // below this, inputs count as equally fast

using Bytes = std::vector<std::uint8_t>;
using Input = std::pair<std::filesystem::path, Bytes>;

void read(const std::filesystem::path& file, std::vector<Input>& inputs) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  inputs.emplace_back(file, Bytes(bytes.begin(), bytes.end()));
}

std::vector<Input> inputs_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<Input> inputs;
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      read(path, inputs);
      continue;
    }
    for (const auto& entry : std::filesystem::directory_iterator(path)) read(entry, inputs);
  }
  std::sort(inputs.begin(), inputs.end());
  return inputs;
}

// Returns the seconds that the target takes for an input.
double run(const Bytes& bytes) {
  const std::clock_t before = std::clock();
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
}

// A few changes to one of the inputs, now and then with the end of another, or nothing but chance.
// What is made of an input takes about as long as the input. Each gets about the same time, not the
// same number of runs, because a few in a hundred would take most of the time otherwise.
class Mutator {
 public:
  Mutator(std::uint64_t seed, const std::vector<Input>& inputs) : random_(seed), inputs_(inputs) {
    std::vector<double> frequencies;
    for (const auto& [file, bytes] : inputs) frequencies.push_back(1 / std::max(kFast, run(bytes)));
    some_input_ = {frequencies.begin(), frequencies.end()};
  }

  Bytes next() {
    Bytes bytes;
    if (inputs_.empty() || below(4) == 0) {
      bytes.resize(1 + below(kLongest));
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random_());
      return bytes;
    }
    bytes = inputs_[some_input_(random_)].second;
    if (below(4) == 0) splice(bytes, inputs_[below(inputs_.size())].second);
    for (std::size_t changes = 1 + below(6); changes > 0; --changes) change(bytes);
    return bytes;
  }

 private:
  static constexpr std::size_t kLongest = 150;

  std::size_t below(std::size_t n) { return random_() % n; }

  void splice(Bytes& bytes, const Bytes& other) {
    bytes.resize(below(bytes.size() + 1));
    const auto from = static_cast<std::ptrdiff_t>(below(other.size() + 1));
    bytes.insert(bytes.end(), other.begin() + from, other.end());
  }

  void change(Bytes& bytes) {
    const std::size_t at = below(bytes.size() + 1);
    const auto place = bytes.begin() + static_cast<std::ptrdiff_t>(at);
    if (at == bytes.size() || below(4) == 0) {
      bytes.insert(place, static_cast<std::uint8_t>(random_()));
    } else if (below(4) == 0) {
      bytes.erase(place);
    } else if (below(2) == 0) {
      *place = static_cast<std::uint8_t>(random_());
    } else {
      *place ^= static_cast<std::uint8_t>(1u << below(8));
    }
  }

  std::mt19937_64 random_;
  const std::vector<Input>& inputs_;
  std::discrete_distribution<std::size_t> some_input_;
};

void run_for(std::chrono::duration<double> time, std::uint64_t seed,
             const std::vector<Input>& inputs) {
  const auto start = std::chrono::steady_clock::now();
  Mutator mutator(seed, inputs);
  std::uint64_t runs = 0;
  double slowest = 0;
  while (std::chrono::steady_clock::now() - start < time) {
    const Bytes bytes = mutator.next();
    const double took = run(bytes);
    if (took > kSlow)
      weft::fuzz::broken("slow", std::to_string(took) + " s", bytes.data(), bytes.size());
    slowest = std::max(slowest, took);
    ++runs;
  }
  std::fprintf(stderr, "%llu inputs, the slowest of %.3f s\n",
               static_cast<unsigned long long>(runs), slowest);
}

}  // namespace

int main(int count, char** arguments) {
  double seconds = 0;
  std::uint64_t seed = 1;
  std::vector<std::filesystem::path> paths;
  for (int i = 1; i < count; ++i) {
    const std::string_view argument = arguments[i];
    if (argument == "--seconds" && i + 1 < count)
      seconds = std::atof(arguments[++i]);
    else if (argument == "--seed" && i + 1 < count)
      seed = std::strtoull(arguments[++i], nullptr, 10);
    else
      paths.emplace_back(argument);
  }
  const std::vector<Input> inputs = inputs_of(paths);
  if (seconds > 0) {
    run_for(std::chrono::duration<double>(seconds), seed, inputs);
    return 0;
  }
  for (const auto& [file, bytes] : inputs) {
    std::fprintf(stderr, "%s\n", file.c_str());  // the last one printed is the one that failed
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::fprintf(stderr, "%zu inputs\n", inputs.size());
  return inputs.empty() ? 1 : 0;  // a folder that has moved is no success
}
