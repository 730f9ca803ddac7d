#include "device/options/option_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "eds/number.hpp"

namespace edsc {
namespace {

constexpr std::size_t max_depth = 3;  // of a member that a message names

/// The end of a JSON string that begins at `start`: the position of its closing quote.
std::size_t end_of_string(std::string_view text, std::size_t start) {
  std::size_t end = start + 1;
  while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
  return end;
}

/// The opening quote of the name of the first member with a path, such as `sdo.timeout`. The text is valid JSON.
std::size_t find_member(std::string_view text, std::string_view path) {
  std::vector<std::string_view> names;  // of the members around the position
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '{') names.emplace_back();
    if (text[at] == '}') names.pop_back();
    if (text[at] != '"') continue;
    const std::size_t start = at;
    at = end_of_string(text, start);
    const std::size_t next = text.find_first_not_of(" \t\r\n", at + 1);
    if (next == std::string_view::npos || text[next] != ':') continue;
    names.back() = text.substr(start + 1, at - start - 1);
    if (names.size() <= max_depth && fmt::format("{}", fmt::join(names, ".")) == path) return start;
  }
  return std::string_view::npos;
}

}  // namespace

std::optional<std::uint16_t> parse_index(std::string_view text) {
  if (text.ends_with('h')) text.remove_suffix(1);
  const auto index = parse_unsigned(fmt::format("0x{}", text));
  return index && *index <= 0xFFFF ? std::optional{static_cast<std::uint16_t>(*index)} : std::nullopt;
}

std::optional<EntrySelector> parse_entry_selector(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto index = parse_index(text.substr(0, colon));
  if (!index) return std::nullopt;
  if (colon == std::string_view::npos) return EntrySelector{*index, std::nullopt};
  const auto sub_index = parse_unsigned(fmt::format("0x{}", text.substr(colon + 1)));
  if (!sub_index || *sub_index > 0xFF) return std::nullopt;
  return EntrySelector{*index, static_cast<std::uint8_t>(*sub_index)};
}

std::optional<EntryKey> parse_entry_key(std::string_view text) {
  const auto entry = parse_entry_selector(text);
  return entry ? std::optional{EntryKey{entry->index, entry->sub_index.value_or(0)}} : std::nullopt;
}

void OptionFile::error(std::string_view member, const std::string& message) {
  const std::string place = member.empty() ? "" : fmt::format("{}: ", member);
  diagnostics_.error("options", position_of(member), fmt::format("{}{}", place, message));
}

/// Without the position and number of the message, which precede a colon.
void OptionFile::syntax_error(std::optional<std::size_t> byte, std::string_view what) {
  const std::size_t colon = what.find(": ");
  diagnostics_.error("options-syntax", byte ? position_at(*byte) : Position{&source_},
                     fmt::format("not JSON: {}", colon == std::string_view::npos ? what : what.substr(colon + 2)));
}

Position OptionFile::position_of(std::string_view member) const {
  const std::size_t at = find_member(source_.text(), member);
  return at == std::string_view::npos ? Position{&source_} : position_at(at + 1);
}

Position OptionFile::position_of_text(std::string_view text) const {
  const std::size_t at = source_.text().find(text);
  return at == std::string_view::npos ? Position{&source_} : position_at(at + 1);
}

Position OptionFile::position_at(std::size_t byte) const {
  const std::string_view before = source_.text().substr(0, std::max<std::size_t>(byte, 1) - 1);
  const auto line = static_cast<std::uint32_t>(std::ranges::count(before, '\n')) + 1;
  return {&source_, line, static_cast<std::uint32_t>(before.size() - (before.rfind('\n') + 1)) + 1};
}

}  // namespace edsc
