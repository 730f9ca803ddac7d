#include <gtest/gtest.h>
#include <canopen/base/result.hpp>

namespace {

using canopen::AbortCode;
using canopen::Result;

TEST(Result, HasAValueOrTheReasonForAMissingOne) {
  const Result<int> read{7};
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, 7);
  EXPECT_EQ(read.value_or(9), 7);

  const Result<int> failed{AbortCode::timeout};
  EXPECT_FALSE(failed);
  EXPECT_EQ(failed.abort_code(), AbortCode::timeout);
  EXPECT_EQ(failed.value_or(9), 9);
}

TEST(ResultDeathTest, EndsTheProgramWhereAMissingValueIsUsed) {
  const Result<int> failed{AbortCode::timeout};
  EXPECT_DEATH(static_cast<void>(*failed), "");
}

}  // namespace
