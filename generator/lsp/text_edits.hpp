/// Edits of a document in the form of the Language Server Protocol.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "change/change.hpp"
#include "change/open_sheet.hpp"
#include "change/text_edit.hpp"
#include "lsp/features.hpp"

namespace edsc::lsp {

/// The range of `removed` lines from `line` on, with their line ends.
[[nodiscard]] TextRange range_of_lines(const View& view, std::uint32_t line, std::uint32_t removed);

/// The text of the editor as a file that changes apply to.
[[nodiscard]] std::unique_ptr<const OpenSheet> open_document(const View& view);

/// The edit of the document `before` that the changes result in. Throws RequestFailed if they are impossible.
[[nodiscard]] Json edit_of_changes(const View& view, const OpenSheet& before, std::span<const SheetChange> changes);

}  // namespace edsc::lsp
