/// The places of the values of a JSON text, as ranges of its bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edsc {

/// Names of members and numbers of elements, from the root.
using JsonPath = std::vector<std::string>;

/// The path of a JSON pointer (RFC 6901): `/nodes/axis1/eds`; nothing if the text is not one.
[[nodiscard]] std::optional<JsonPath> json_path(std::string_view pointer);
[[nodiscard]] std::string json_pointer(const JsonPath& path);

/// A value; offsets count from 0.
struct JsonRange {
  std::size_t begin = 0, end = 0;            ///< of the value
  std::size_t name_begin = 0, name_end = 0;  ///< of the name of a member, with its quotation marks; else empty
  std::string name;                          ///< of a member
  std::optional<std::size_t> comma;          ///< after the value
  std::optional<std::size_t> parent;         ///< as the others, an index of `JsonRanges`; nothing for the root
  std::vector<std::size_t> children;         ///< in the order of the text

  /// The begin of the name, if there is one, else that of the value.
  [[nodiscard]] std::size_t first() const { return name_end > 0 ? name_begin : begin; }
};

/// The text must remain. Comments as in C++ are allowed.
class JsonRanges {
 public:
  /// The text is JSON, as JsonFile says.
  explicit JsonRanges(std::string_view text);

  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::size_t size() const { return ranges_.size(); }
  [[nodiscard]] const JsonRange& operator[](std::size_t index) const { return ranges_[index]; }
  [[nodiscard]] std::string_view value_text(const JsonRange& range) const {
    return text_.substr(range.begin, range.end - range.begin);
  }
  [[nodiscard]] bool is_object(const JsonRange& range) const { return text_[range.begin] == '{'; }
  [[nodiscard]] bool is_array(const JsonRange& range) const { return text_[range.begin] == '['; }

  /// The index of the value at a path; nothing if there is none. Of several members with one name, the last is used.
  [[nodiscard]] std::optional<std::size_t> find(const JsonPath& path) const;
  /// The member or element of a value; as find().
  [[nodiscard]] std::optional<std::size_t> child(std::size_t index, std::string_view name) const;
  /// The path of the innermost value that has the byte, or whose name has it.
  [[nodiscard]] JsonPath path_at(std::size_t offset) const;
  /// The number of a value in its object or array.
  [[nodiscard]] std::size_t place_of(std::size_t index) const;

  static constexpr std::size_t root = 0;

 private:
  std::string_view text_;
  std::vector<JsonRange> ranges_;
};

/// The offset after blanks and comments.
[[nodiscard]] std::size_t after_json_blanks(std::string_view text, std::size_t at);

}  // namespace edsc
