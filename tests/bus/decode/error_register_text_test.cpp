/// The bits of the error register as text.
#include "decode/error_register_text.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace edsc {
namespace {

TEST(ErrorRegister, NamesEachBitOfCia301) {
  constexpr std::string_view names[] = {"generic",       "current",        "voltage",        "temperature",
                                        "communication", "device profile", "reserved bit 6", "manufacturer"};
  for (unsigned bit = 0; bit < 8; ++bit) {
    std::string text;
    append_error_register(text, static_cast<std::uint8_t>(1U << bit));
    EXPECT_EQ(text, names[bit]);
  }
  std::string text;
  append_error_register(text, 0);
  EXPECT_EQ(text, "no error");
  text.clear();
  append_error_register(text, 0x81);
  EXPECT_EQ(text, "generic, manufacturer");
}

}  // namespace
}  // namespace edsc
