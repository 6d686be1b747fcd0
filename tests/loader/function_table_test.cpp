// SPDX-License-Identifier: Apache-2.0
#include "loader/function_table.h"

#include <gtest/gtest.h>

#include <cmath>

// Beside those of libm, one that no library has.
extern "C" double no_such_function(double);

namespace weft {
namespace {

#define WEFT_TEST_FUNCTIONS(EACH) EACH(cbrtf) EACH(ldexpf)
WEFT_FUNCTION_TABLE(Roots, WEFT_TEST_FUNCTIONS);

#define WEFT_TEST_MISSING(EACH) EACH(cbrtf) EACH(no_such_function)
WEFT_FUNCTION_TABLE(Missing, WEFT_TEST_MISSING);

TEST(FunctionTables, HaveTheFunctionsOfTheLibrary) {
  const auto roots = load_functions<Roots>("libm.so.6");
  ASSERT_TRUE(roots) << roots.error();
  EXPECT_EQ(roots->cbrtf(27), 3);
  EXPECT_EQ(roots->ldexpf(3, 4), 48);
}

TEST(FunctionTables, NameTheFunctionThatTheLibraryLacks) {
  const auto missing = load_functions<Missing>("libm.so.6");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error(), "libm.so.6 has no function no_such_function");
}

TEST(FunctionTables, NameThePackageOfALibraryThatIsNotThere) {
  const auto roots = load_functions<Roots>("libweft-nowhere.so.7");
  ASSERT_FALSE(roots);
  EXPECT_EQ(roots.error(),
            "libweft-nowhere.so.7: cannot open shared object file: No such file or directory "
            "(Debian's package libweft-nowhere7)");
}

TEST(FunctionTables, KnowDebiansRuleForTheNamesOfPackages) {
  EXPECT_EQ(debian_package("libproj.so.25"), "libproj25");
  EXPECT_EQ(debian_package("libsqlite3.so.0"), "libsqlite3-0");
}

}  // namespace
}  // namespace weft
