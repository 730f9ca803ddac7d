/// Members of a JSON object as text.
#pragma once

#include <string>
#include <string_view>

namespace edsc::edit {

/// Writes `"name":"Speed","locked":false`. It is for parts of which each edit makes thousands again: a Json of them
/// takes longer than reading the file.
class MemberText {
 public:
  /// U+FFFD in place of what is not UTF-8.
  MemberText& add_text(std::string_view name, std::string_view text);
  MemberText& add_flag(std::string_view name, bool flag);
  /// `json`: a value as text.
  MemberText& add_json(std::string_view name, std::string_view json);

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void add_name(std::string_view name);
  void quote(std::string_view text);

  std::string text_;
};

}  // namespace edsc::edit
