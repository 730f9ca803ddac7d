#include "format/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "eds/allow_comments.hpp"
#include "text/ascii.hpp"
#include "text/source_file.hpp"

namespace edsc {
namespace {

/// Iterates over the remarks of a file in parallel with its sections and entries.
class DocumentReader {
 public:
  explicit DocumentReader(const IniFile& ini) : ini_(ini) {}

  Document read(const std::function<bool(DocumentSection&)>& change) {
    Document document;
    if (!ini_.sections.empty()) {
      document.head = take_head(ini_.sections.front().line);
    }
    document.sections.reserve(ini_.sections.size());
    for (const IniSection& section : ini_.sections) {
      document.sections.push_back(read_section(section));
      if (!change(document.sections.back())) return document;
    }
    document.tail = take(ini_.remarks.size());
    return document;
  }

 private:
  /// The remarks up to the last blank line before the first section, which belong to the whole file.
  Remarks take_head(std::uint32_t first_section) {
    std::size_t end = count_up_to(first_section);
    std::uint32_t line_behind = first_section;
    while (end > 0 && ini_.remarks[end - 1].line + 1 >= line_behind) {
      --end;
      line_behind = ini_.remarks[end].line;
    }
    return take(end);
  }

  DocumentSection read_section(const IniSection& section) {
    DocumentSection result;
    result.remarks = take(count_up_to(section.line - 1));
    take_header(section, result);
    result.kind = read_section_name(section.name, ini_.source->choices().sub_indices);
    result.title = section.name;
    result.entries.reserve(section.entries.size());
    for (const IniEntry& entry : section.entries) {
      result.entries.push_back(
          {take(count_up_to(entry.line)), std::string{entry.key}, std::string{value_of(*ini_.source, entry)}});
    }
    return result;
  }

  /// The remarks after the section header, on its line.
  void take_header(const IniSection& section, DocumentSection& result) {
    const bool is_first = &section == ini_.sections.data();
    for (; taken_ < count_up_to(section.line); ++taken_) {
      for (const std::string_view part : split_header_comment(ini_.remarks[taken_].text)) {
        (is_first && is_for_edsc(part) ? result.header : result.remarks).push_back(remark_line(part));
      }
    }
  }

  /// The number of remarks up to this line.
  [[nodiscard]] std::size_t count_up_to(std::uint32_t line) const {
    std::size_t count = taken_;
    while (count < ini_.remarks.size() && ini_.remarks[count].line <= line) ++count;
    return count;
  }

  Remarks take(std::size_t end) {
    Remarks remarks;
    for (; taken_ < end; ++taken_) remarks.push_back(remark_line(ini_.remarks[taken_].text));
    return remarks;
  }

  const IniFile& ini_;
  std::size_t taken_ = 0;
};

class DocumentWriter {
 public:
  std::string write(const Document& document) {
    put(document.head);
    for (const DocumentSection& section : document.sections) {
      separate();
      put(section.remarks);
      put("[", section.title, fmt::format("]{}{}", section.header.empty() ? "" : " ", fmt::join(section.header, " ")));
      for (const DocumentEntry& entry : section.entries) {
        put(entry.remarks);
        put(entry.key, "=", entry.value);
      }
    }
    if (!document.tail.empty()) {
      separate();
      put(document.tail);
    }
    return std::move(text_);
  }

 private:
  void separate() {
    if (!text_.empty()) text_ += '\n';
  }

  void put(std::string_view a, std::string_view b, std::string_view c) {
    text_.append(a).append(b).append(c);
    text_ += '\n';
  }

  void put(const Remarks& remarks) {
    for (const std::string& remark : remarks) put(remark, {}, {});
  }

  std::string text_;
};

}  // namespace

Document document_of(const IniFile& ini) {
  return document_of(ini, [](const DocumentSection&) { return true; });
}

Document document_of(const IniFile& ini, const std::function<bool(DocumentSection&)>& change) {
  return DocumentReader(ini).read(change);
}

std::string to_text(const Document& document) { return DocumentWriter().write(document); }

std::string remark_line(std::string_view text) {
  if (text.starts_with(';')) return std::string{text};
  if (text.starts_with('#')) return fmt::format(";{}", text.substr(1));
  return fmt::format("; {}", text);
}

void give_up_first_place(Document& document) {
  if (document.sections.empty()) return;
  DocumentSection& section = document.sections.front();
  std::ranges::copy_if(section.remarks, std::back_inserter(document.head), is_for_edsc);
  std::erase_if(section.remarks, is_for_edsc);
  append(section.remarks, std::exchange(section.header, {}));
}

void take_first_place(Document& document) {
  DocumentSection& section = document.sections.front();
  std::ranges::copy_if(section.remarks, std::back_inserter(section.header), is_for_edsc);
  std::erase_if(section.remarks, is_for_edsc);
}

void append(Remarks& remarks, const Remarks& more) { remarks.insert(remarks.end(), more.begin(), more.end()); }

}  // namespace edsc
