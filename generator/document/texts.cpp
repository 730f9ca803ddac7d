#include <fmt/format.h>

#include <algorithm>
#include <canopen/pdo/transmission_type.hpp>
#include <vector>

#include "diagnostics/place.hpp"
#include "document/views.hpp"
#include "eds/allow_comments.hpp"
#include "system/path.hpp"
#include "text/source_file.hpp"
#include "text/utf8.hpp"

namespace edsc::document {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// The text of a comment line.
std::string_view without_semicolons(std::string_view line) {
  return trimmed(line.substr(std::min(line.find_first_not_of(';'), line.size())));
}

}  // namespace

std::string url_of(std::string_view file_name) {
  constexpr std::string_view unreserved = "-._~";  // RFC 3986, 2.3, with letters and digits
  std::string url;
  for (const char one : file_name) {
    const auto byte = static_cast<unsigned char>(one);
    const bool is_letter = (byte >= 'A' && byte <= 'Z') || (byte >= 'a' && byte <= 'z');
    const bool is_plain = is_letter || (byte >= '0' && byte <= '9') || unreserved.find(one) != std::string_view::npos;
    url += is_plain ? std::string{one} : fmt::format("%{:02X}", byte);
  }
  return url;
}

std::string anchor_of(const Object& object, const Entry& entry) {
  if (!object.has_sub_indices()) return index_label(object.index);
  return fmt::format("{}-{:02X}", index_label(object.index), entry.sub_index);
}

Json line_of(const Position& position) {
  const Position origin = origin_of(position);
  if (origin.file == position.file) return origin.line;
  return fmt::format("{} of {}", origin.line, file_name_of(origin.file->name()));
}

std::string comment_before(const Position& section) {
  if (section.file == nullptr || !trimmed(section.file->line(section.line)).starts_with('[')) return {};
  std::vector<std::string_view> lines;
  for (std::uint32_t number = section.line; number > 1; --number) {
    const std::string_view line = trimmed(section.file->line(number - 1));
    if (!line.starts_with(';')) break;
    if (!is_for_edsc(line)) lines.push_back(without_semicolons(line));
  }
  std::string text;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    if (line->empty()) continue;
    text += (text.empty() ? "" : " ") + std::string{*line};
  }
  return text;
}

std::string shortened(std::string_view text, std::size_t max) {
  if (count_code_points(text) <= max) return std::string{text};
  std::string out;
  std::size_t used = 0;
  for_each_code_point(text, [&](char32_t code_point) {
    if (++used < max) append_utf8(out, code_point);
  });
  return out + "\u2026";
}

std::string transmission_text(std::uint64_t transmission_type) {
  switch (canopen::transmission_of(static_cast<std::uint32_t>(transmission_type))) {
    case canopen::Transmission::synchronous:
      if (transmission_type == 0) return "synchronous, acyclic";
      return transmission_type == 1 ? "every SYNC" : fmt::format("every {} SYNCs", transmission_type);
    case canopen::Transmission::remote_synchronous: return "on request, sampled at SYNC";
    case canopen::Transmission::remote: return "on request";
    case canopen::Transmission::event_driven:
      return transmission_type == 254 ? "event-driven (manufacturer)" : "event-driven (device profile)";
    case canopen::Transmission::reserved: break;
  }
  return "reserved";
}

}  // namespace edsc::document
