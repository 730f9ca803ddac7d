#include "decode/error_register_text.hpp"

#include <cstddef>
#include <iterator>
#include <string_view>

namespace edsc {
namespace {

/// The bits of 1001h, from bit 0 (CiA 301, 7.5.2.2).
constexpr std::string_view register_bits[] = {"generic",       "current",        "voltage",        "temperature",
                                              "communication", "device profile", "reserved bit 6", "manufacturer"};

}  // namespace

void append_error_register(std::string& text, std::uint8_t error_register) {
  if (error_register == 0) text += "no error";
  std::string_view separator;
  for (std::size_t bit = 0; bit < std::size(register_bits); ++bit) {
    if ((error_register >> bit & 1) == 0) continue;
    text += separator;
    text += register_bits[bit];
    separator = ", ";
  }
}

}  // namespace edsc
