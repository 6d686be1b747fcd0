// SPDX-License-Identifier: Apache-2.0
#include "client/base/option_row.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace weft::client {
namespace {

struct Options {
  std::optional<double> angle{};
  std::optional<double> seconds{};
  std::optional<std::uint32_t> count{};
  bool on = false;
  int order = 1;
};

const OptionValue<Options> kAngle = number("DEG", &Options::angle);
const OptionValue<Options> kSeconds = number("S", &Options::seconds, 0.5, 100);
const OptionValue<Options> kCount = number("N", &Options::count, 1);
const OptionValue<Options> kOn = on_or_off(&Options::on);
const OptionValue<Options> kOrder = one_of(&Options::order, {{"one", 1}, {"two", 2}, {"six", 6}});

// What is wrong with the texts.
std::string fault(const OptionValue<Options>& value, const std::vector<std::string>& texts) {
  Options options;
  return value.read(texts, "", options);
}

// The options after the texts, without a fault.
Options after(const OptionValue<Options>& value, const std::vector<std::string>& texts) {
  Options options;
  EXPECT_EQ(value.read(texts, "", options), "");
  return options;
}

TEST(OptionRow, ReadsANumberAsTheNearestDouble) {
  EXPECT_EQ(after(kAngle, {"-2.5e1"}).angle, -25);
  // By way of a long double, it would be the neighbour of this.
  EXPECT_EQ(after(kAngle, {"0.0010549"}).angle, 0.0010549);
  for (const char* text : {"", "much", "1x", "1 ", ".inf", "nan", "-nan"})
    EXPECT_EQ(fault(kAngle, {text}), "'" + std::string(text) + "' is not a number");
}

TEST(OptionRow, HoldsANumberToItsRange) {
  EXPECT_EQ(kSeconds.range, "0.5 to 100");
  EXPECT_EQ(after(kSeconds, {"0.5"}).seconds, 0.5);
  EXPECT_EQ(after(kSeconds, {"100"}).seconds, 100);
  EXPECT_EQ(fault(kSeconds, {"nan"}), "'nan' is not a number");
  for (const char* text : {"0.49", "100.1", "inf"})
    EXPECT_EQ(fault(kSeconds, {text}),
              "'" + std::string(text) + "' is not in the range 0.5 to 100");
}

TEST(OptionRow, ReadsACount) {
  EXPECT_EQ(kCount.range, "1 or more");
  EXPECT_EQ(after(kCount, {"4294967295"}).count, 4294967295u);
  EXPECT_EQ(after(kCount, {"0x10"}).count, 16u);
  EXPECT_EQ(fault(kCount, {"0"}), "'0' is not in the range 1 or more");
  for (const char* text : {"", "-5", "-18446744073709551611", "1.5", "4294967296"})
    EXPECT_EQ(fault(kCount, {text}), "'" + std::string(text) + "' is not a count");
}

TEST(OptionRow, ReadsANumberWithoutOptionsAroundIt) {
  double plain = 7;
  EXPECT_EQ(number<double>("S", 1, 9).read({"3"}, "", plain), "");
  EXPECT_EQ(plain, 3);
  EXPECT_EQ(number<double>("S", 1, 9).read({"10"}, "", plain), "'10' is not in the range 1 to 9");
  EXPECT_EQ(plain, 3);
}

TEST(OptionRow, ReadsTrueAndFalse) {
  for (const char* text : {"true", "True", "yes", "on", "1"}) EXPECT_TRUE(after(kOn, {text}).on);
  for (const char* text : {"false", "FALSE", "no", "off", "0"}) {
    Options options{.on = true};
    EXPECT_EQ(kOn.read({text}, "", options), "");
    EXPECT_FALSE(options.on) << text;
  }
  EXPECT_EQ(fault(kOn, {"perhaps"}), "'perhaps' is not true or false");
}

TEST(OptionRow, TakesOneOfItsNamesAlone) {
  EXPECT_EQ(kOrder.unit, "one|two|six");
  EXPECT_EQ(after(kOrder, {"six"}).order, 6);
  EXPECT_EQ(fault(kOrder, {"6"}), "'6' is not one, two or six");
}

TEST(OptionRow, HelpsWithRangeAndDefault) {
  EXPECT_EQ((OptionRow<Options>{"seconds", "", "Time", "all", kSeconds}.help()),
            "Time. Range: 0.5 to 100. Default: all");
  EXPECT_EQ((OptionRow<Options>{"angle", "", "Angle", "", kAngle}.help()), "Angle");
}

}  // namespace
}  // namespace weft::client
