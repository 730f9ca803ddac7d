#include "edit/member_text.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace edsc::edit {
namespace {

/// Whether JSON has the character as it is.
bool is_plain(char one) { return one >= ' ' && one <= '~' && one != '"' && one != '\\'; }

}  // namespace

MemberText& MemberText::add_text(std::string_view name, std::string_view text) {
  add_name(name);
  if (std::ranges::all_of(text, is_plain)) {
    quote(text);
  } else {
    text_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  return *this;
}

MemberText& MemberText::add_flag(std::string_view name, bool flag) { return add_json(name, flag ? "true" : "false"); }

MemberText& MemberText::add_json(std::string_view name, std::string_view json) {
  add_name(name);
  text_ += json;
  return *this;
}

void MemberText::add_name(std::string_view name) {
  if (!text_.empty()) text_ += ',';
  quote(name);
  text_ += ':';
}

void MemberText::quote(std::string_view text) {
  text_ += '"';
  text_ += text;
  text_ += '"';
}

}  // namespace edsc::edit
