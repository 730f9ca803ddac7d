#include "backend/dbc/dbc_name.hpp"

#include "text/utf8.hpp"

namespace edsc {

std::string DbcNames::take(std::string_view wanted) {
  std::string name{wanted.substr(0, longest_)};
  for (unsigned number = 2; !taken_.insert(name).second; ++number) {
    const std::string suffix = "_" + std::to_string(number);
    name = std::string{wanted.substr(0, longest_ - suffix.size())} + suffix;
  }
  return name;
}

std::string dbc_string(std::string_view utf8) {
  constexpr char32_t greek_mu = 0x3BC;
  constexpr char32_t micro_sign = 0xB5;
  std::string text = "\"";
  for_each_code_point(utf8, [&text](char32_t c) {
    if (c == greek_mu) c = micro_sign;
    if (c == U'"') c = U'\'';
    if (c < 0x20 || c == 0x7F) c = U' ';
    const bool is_in_code_page = c < 0x80 || (c >= 0xA0 && c <= 0xFF);
    text += is_in_code_page ? static_cast<char>(static_cast<unsigned char>(c)) : '?';
  });
  return text + "\"";
}

}  // namespace edsc
