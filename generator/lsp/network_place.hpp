/// The place of a cursor in a JSON file of edsc, and what a network file has there, also while its text is not yet
/// JSON.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lsp/features.hpp"

namespace edsc::lsp {

struct JsonPlaceInText {
  std::vector<std::string> path;  ///< names of the members around the cursor; `[]` for an array
  bool is_in_string = false;
  bool is_name = false;            ///< the string is, or becomes, the name of a member
  std::string text;                ///< the whole string
  std::size_t begin = 0, end = 0;  ///< of the string without its quotation marks
};

/// Reads the text up to `offset`, and the string around it.
[[nodiscard]] JsonPlaceInText json_place(std::string_view text, std::size_t offset);

/// What a string of a JSON file can be.
struct JsonOffer {
  std::string label, detail, text;
};

/// The offers as items that replace the string at the cursor.
[[nodiscard]] Json completion_items(const View& view, const TextPosition& at, const JsonPlaceInText& place,
                                    std::vector<JsonOffer> offers);

/// The offset of a position in the text of the document.
[[nodiscard]] std::size_t offset_in(const View& view, const TextPosition& at);

/// The network of the document: of the last text that was JSON. Null if there is none.
[[nodiscard]] const Network* network_of(const View& view);

/// The node and the entry that a string means; null if it does not mean one.
struct NetworkTarget {
  const NetworkNode* node = nullptr;
  const Entry* entry = nullptr;
};
[[nodiscard]] NetworkTarget network_target(const Network& network, const JsonPlaceInText& place,
                                           std::string_view document);

/// Markdown about the member, node or entry at the cursor; empty if there is nothing.
[[nodiscard]] std::string describe_network_place(const View& view, const TextPosition& at);

[[nodiscard]] Json network_completion(const View& view, const TextPosition& at);

}  // namespace edsc::lsp
