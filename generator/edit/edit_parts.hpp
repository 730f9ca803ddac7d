/// The parts of the state that the page of `edsc edit` shows, as JSON: docs/schema/edit.schema.json.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace edsc::edit {

using Json = nlohmann::ordered_json;

/// Parts by their names; a part is sent again if its text changes.
class EditParts {
 public:
  void set(std::string name, const Json& part) {
    texts_[std::move(name)] = part.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  /// `json`: the text of a part.
  void set_text(std::string name, std::string json) { texts_[std::move(name)] = std::move(json); }
  [[nodiscard]] const std::map<std::string, std::string>& texts() const { return texts_; }

 private:
  std::map<std::string, std::string> texts_;
};

}  // namespace edsc::edit
