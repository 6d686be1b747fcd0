// SPDX-License-Identifier: Apache-2.0
// An option that a flag of the command line and a key of a manifest set alike: a table has one row
// for it, which holds its name, its help and how its value is read. cli/flags.h makes flags of the
// rows, batch/manifest.h keys.
//
//   const OptionRows<RequestOptions> rows = {
//       {"min-angle", "WEFT_MIN_ANGLE", "Minimum angle of every triangle, in degrees", "20",
//        number("DEG", &RequestOptions::min_angle_deg)}};
//   rows[0].value.read({"25"}, "", options);    // ""; options.min_angle_deg is 25
//   rows[0].value.read({"much"}, "", options);  // "'much' is not a number"
#pragma once

#include <CLI/TypeTools.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "client/base/files.h"
#include "files/base/text.h"
#include "files/base/value_of.h"

namespace weft::client {

enum class Arity { kSwitch, kOne, kList };  // a flag without a value; with one; may be repeated

// How an option is read from text.
template <class Options>
struct OptionValue {
  std::string unit;   // what help calls the value, such as "DEG"
  std::string range;  // such as "1 or more"; empty: any value
  Arity arity = Arity::kOne;
  // Sets the option and returns an empty text, or leaves the option alone and returns what is
  // wrong with which text. Paths in texts are relative to `folder`. REQUIRES: exactly one text,
  // unless it is a list.
  std::function<std::string(const std::vector<std::string>& texts,
                            const std::filesystem::path& folder, Options& options)>
      read;
};

template <class Options>
struct OptionRow {
  std::string name;          // of the key; the flag is --name
  std::string variable;      // of the environment; empty: none
  std::string about;         // what it is or does, without a full stop
  std::string default_text;  // the default, for people; empty: help does not name one
  OptionValue<Options> value;
  // The field of a request that the option sets, such as "quality.min_edge"; empty if it is none
  // that an error names.
  std::string field{};

  std::string help() const {
    std::string text = about;
    if (!value.range.empty()) text += ". Range: " + value.range;
    if (!default_text.empty()) text += ". Default: " + default_text;
    return text;
  }
};

template <class Options>
using OptionRows = std::vector<OptionRow<Options>>;

template <class Target>
struct Numeric {
  using Type = Target;
};
template <class T>
struct Numeric<std::optional<T>> {
  using Type = T;
};

// A number into a target that is a T or an std::optional<T>: a number but NaN if T is double, a
// count if T is unsigned, an integer otherwise.
template <class Target, class T = typename Numeric<Target>::Type>
OptionValue<Target> number(std::string unit,
                           std::type_identity_t<T> least = std::numeric_limits<T>::lowest(),
                           std::type_identity_t<T> most = std::numeric_limits<T>::max()) {
  const auto as_text = [](T bound) { return shortest(static_cast<double>(bound)); };
  std::string range;
  if (most != std::numeric_limits<T>::max())
    range = as_text(least) + " to " + as_text(most);
  else if (least != std::numeric_limits<T>::lowest())
    range = as_text(least) + " or more";
  return {std::move(unit), range, Arity::kOne,
          [=](const auto& texts, const auto&, Target& target) -> std::string {
            const auto value = value_of<T>(texts.front());
            if (!value || std::isnan(static_cast<double>(*value)))
              return in_quotes(texts.front()) + " is not a " +
                     (std::is_unsigned_v<T> ? "count" : "number");
            if (!range.empty() && !(*value >= least && *value <= most))
              return in_quotes(texts.front()) + " is not in the range " + range;
            target = *value;
            return "";
          }};
}

// The same into a member of the options.
template <class Options, class Target, class T = typename Numeric<Target>::Type>
OptionValue<Options> number(std::string unit, Target Options::*field,
                            std::type_identity_t<T> least = std::numeric_limits<T>::lowest(),
                            std::type_identity_t<T> most = std::numeric_limits<T>::max()) {
  const OptionValue<Target> alone = number<Target>(std::move(unit), least, most);
  return {alone.unit, alone.range, alone.arity,
          [=](const auto& texts, const auto& folder, Options& options) {
            return alone.read(texts, folder, options.*field);
          }};
}

// True or false; as a flag, true if it is given.
template <class Options>
OptionValue<Options> on_or_off(bool Options::*field) {
  return {"", "", Arity::kSwitch,
          [=](const auto& texts, const auto&, Options& options) -> std::string {
            bool value = false;
            if (!CLI::detail::lexical_cast(texts.front(), value))
              return in_quotes(texts.front()) + " is not true or false";
            options.*field = value;
            return "";
          }};
}

// One of several names.
template <class Options, class T>
OptionValue<Options> one_of(T Options::*field,
                            std::vector<std::pair<std::string, std::type_identity_t<T>>> values) {
  std::string unit;
  std::string list;  // "angle, region or none"
  for (std::size_t i = 0; i < values.size(); ++i) {
    unit += (i == 0 ? "" : "|") + values[i].first;
    list += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + values[i].first;
  }
  return {unit, "", Arity::kOne,
          [=](const auto& texts, const auto&, Options& options) -> std::string {
            for (const auto& [name, value] : values) {
              if (name != texts.front()) continue;
              options.*field = value;
              return "";
            }
            return in_quotes(texts.front()) + " is not " + list;
          }};
}

}  // namespace weft::client
