#include "lsp/text_edits.hpp"

#include <utility>

#include "change/apply_changes.hpp"

namespace edsc::lsp {
namespace {

std::string_view usual_line_end(const View& view) {
  const std::string_view end = view.analysis.own->line_end(1);
  return end.empty() ? "\n" : end;
}

Json to_json(const View& view, const TextEdit& edit) {
  const std::uint32_t last = view.analysis.own->lines();
  const bool is_after_open_line = edit.line > last && last > 0 && view.analysis.own->line_end(last).empty();
  std::string text = is_after_open_line ? std::string{usual_line_end(view)} : std::string{};
  for (std::size_t i = 0; i < edit.lines.size(); ++i) {
    const std::uint32_t line = edit.line + static_cast<std::uint32_t>(i);
    text += edit.lines[i].text;
    const bool keeps_end = i < edit.removed && i + 1 == edit.lines.size() && line == last;
    text += keeps_end ? view.analysis.own->line_end(line) : usual_line_end(view);
  }
  return {{"range", lsp::to_json(range_of_lines(view, edit.line, edit.removed))}, {"newText", std::move(text)}};
}

Json to_json(const View& view, const std::vector<TextEdit>& edits) {
  Json rows = Json::array();
  for (const TextEdit& edit : edits) rows.push_back(to_json(view, edit));
  return rows;
}

}  // namespace

TextRange range_of_lines(const View& view, std::uint32_t line, std::uint32_t removed) {
  const std::uint32_t end = line + removed;
  if (end <= view.analysis.own->lines()) return {{line - 1, 0}, {end - 1, 0}};
  const std::uint32_t last = view.analysis.own->lines();
  const TextPosition end_of_text =
      last == 0 || !view.analysis.own->line_end(last).empty()
          ? TextPosition{last, 0}
          : TextPosition{last - 1, units_before(view.line(last), view.line(last).size(), view.encoding)};
  return {line > last ? end_of_text : TextPosition{line - 1, 0}, end_of_text};
}

std::unique_ptr<const OpenSheet> open_document(const View& view) {
  Options options = view.analysis.loaded ? view.analysis.loaded->options : Options{};
  if (options.reading.encoding) options.reading.encoding = Encoding::utf8;  // the editor has decoded the bytes
  return open_sheet(view.analysis.own->name(), std::string{view.analysis.own->text()}, options, SheetChecks::all);
}

Json edit_of_changes(const View& view, const OpenSheet& before, std::span<const SheetChange> changes) {
  ChangeSettings how;
  how.force = how.utf8 = true;  // the editor shows what the result has
  const AppliedChanges applied = apply_changes(before, changes, how);
  if (!applied.problem.empty()) throw RequestFailed{applied.problem};
  return {{"changes", {{view.document.uri, to_json(view, applied.edits)}}}};
}

}  // namespace edsc::lsp
