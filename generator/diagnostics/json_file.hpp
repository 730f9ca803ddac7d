/// A JSON file with the position of each member and element.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// The places of a value and of the name of the member that has it; of an element of an array, twice that of the value.
struct JsonPlace {
  Position name;
  Position value;
};

/// By JSON pointer.
using JsonPlaces = std::unordered_map<std::string, JsonPlace>;

/// Members keep the order of the file. Comments as in C++ are allowed.
class JsonFile {
 public:
  using Json = nlohmann::ordered_json;
  using Pointer = Json::json_pointer;

  /// Parses the text. A text that is not JSON is reported as a finding of `syntax_rule`; the root is then null.
  JsonFile(const SourceFile& source, ErrorRule syntax_rule, Diagnostics& diagnostics);

  /// Whether the text is JSON; a text that is not was reported.
  [[nodiscard]] bool is_valid() const { return is_valid_; }
  [[nodiscard]] const Json& root() const { return root_; }
  [[nodiscard]] const SourceFile& source() const { return source_; }

  /// The position of the value at `pointer`; the whole file if it does not exist, or below `max_depth` levels.
  [[nodiscard]] Position value_position(const Pointer& pointer) const;
  /// The position of the name of the member at `pointer`; of an element of an array, that of its value.
  [[nodiscard]] Position name_position(const Pointer& pointer) const;

  static constexpr std::size_t max_depth = 8;

 private:
  const SourceFile& source_;
  Json root_;
  bool is_valid_ = false;
  JsonPlaces places_;
};

}  // namespace edsc
