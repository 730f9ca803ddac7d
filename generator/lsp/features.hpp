/// What an editor asks about a document. Each function returns the result of a request in the form of the Language
/// Server Protocol; null or an empty array if there is nothing.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "lsp/workspace.hpp"

namespace edsc::lsp {

/// A request that cannot be fulfilled; the message is for the user.
class RequestFailed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A document and the others that are open.
struct View {
  Workspace& workspace;
  const Document& document;
  const Analysis& analysis;
  PositionEncoding encoding;

  [[nodiscard]] std::string_view line(std::uint32_t number) const { return analysis.own->line(number); }
  /// The column, from 1 in bytes, of a position.
  [[nodiscard]] std::uint32_t column_of(const TextPosition& at) const {
    return static_cast<std::uint32_t>(bytes_before(line(at.line + 1), at.character, encoding)) + 1;
  }
  [[nodiscard]] bool is_sheet() const {
    return document.kind == DocumentKind::device || document.kind == DocumentKind::overlay;
  }
  /// Whether it is an options file or a file of deviations.
  [[nodiscard]] bool has_options() const {
    return document.kind == DocumentKind::options || document.kind == DocumentKind::deviations;
  }
};

/// The committed version of a file; null if there is none, or it cannot be read.
using Committed = std::function<std::shared_ptr<const LoadedDevice>(const std::string& path)>;

[[nodiscard]] Json hover(const View& view, const TextPosition& at);
[[nodiscard]] Json inlay_hints(const View& view, const TextRange& range);
[[nodiscard]] Json completion(const View& view, const TextPosition& at);
[[nodiscard]] Json definition(const View& view, const TextPosition& at);
[[nodiscard]] Json references(const View& view, const TextPosition& at, bool with_declaration);
[[nodiscard]] Json document_symbols(const View& view);
[[nodiscard]] Json folding_ranges(const View& view);
[[nodiscard]] Json formatting(const View& view);
/// What the changes since the committed version break.
[[nodiscard]] Json code_lenses(const View& view, const Committed& committed);
/// Fixes of the findings in a range. `is_resolved_later`: the editor asks for the edit of the one that the user
/// selects.
[[nodiscard]] Json code_actions(const View& view, const TextRange& range, const Json& context, bool is_resolved_later);
/// The action with its edit.
[[nodiscard]] Json resolved_action(const View& view, Json action);
/// The range and the text of the index, or index and sub-index, that can be renamed.
[[nodiscard]] Json prepare_rename(const View& view, const TextPosition& at);
[[nodiscard]] Json rename(const View& view, const TextPosition& at, const std::string& new_name);

/// The findings of a document as diagnostics, by the URI of the file that they are in.
using Published = std::map<std::string, Json>;
[[nodiscard]] Published diagnostics_of(const Analysis& analysis, const std::function<std::string(const Rule&)>& url_of,
                                       PositionEncoding encoding);

/// A description of an object or entry in Markdown; empty if the device does not have it.
[[nodiscard]] std::string describe(const LoadedDevice& loaded, const Device& device, const EntryAddress& address);

}  // namespace edsc::lsp
