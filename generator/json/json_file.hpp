/// A JSON file with the position of each member and element.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_map>
#include <vector>

#include "diagnostics/diagnostics.hpp"
#include "text/source_file.hpp"

namespace edsc {

/// The places of a value and of the name of the member that has it; of an element of an array, twice that of the value.
struct JsonPlace {
  Position name;
  Position value;
};

/// A text that is not JSON, or a member whose name occurs twice in its object.
struct JsonFault {
  Position position;
  std::string message;
  std::vector<Note> notes;
};

/// Comments as in C++ are allowed. Copies of a value do not have a position: functions take values of `root()`.
class JsonFile {
 public:
  using Json = nlohmann::json;

  struct Member {
    std::string name;
    const Json* value;
  };

  /// Parses the text. The root of a text that is not JSON is null. Of several members with one name, the last is used.
  explicit JsonFile(const SourceFile& source);

  JsonFile(const JsonFile&) = delete;
  JsonFile& operator=(const JsonFile&) = delete;

  /// Whether the text is JSON. It may still have members with one name.
  [[nodiscard]] bool is_valid() const { return is_valid_; }
  [[nodiscard]] const std::vector<JsonFault>& faults() const { return faults_; }
  void report_faults(ErrorRule rule, Diagnostics& diagnostics) const;

  [[nodiscard]] const Json& root() const { return root_; }
  [[nodiscard]] const SourceFile& source() const { return source_; }

  /// The members of an object in the order of the file.
  [[nodiscard]] std::vector<Member> members(const Json& object) const;
  [[nodiscard]] Position value_position(const Json& value) const { return place_of(value).value; }
  /// The position of the name of the member that has the value; of an element of an array, that of the value.
  [[nodiscard]] Position name_position(const Json& value) const { return place_of(value).name; }

 private:
  [[nodiscard]] JsonPlace place_of(const Json& value) const;

  const SourceFile& source_;
  Json root_;
  bool is_valid_ = false;
  std::vector<JsonFault> faults_;
  std::unordered_map<const Json*, JsonPlace> places_;
};

}  // namespace edsc
