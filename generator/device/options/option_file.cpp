#include "device/options/option_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "eds/number.hpp"

namespace edsc {

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
  return position_of_text(fmt::format("\"{}\"", member.substr(member.rfind('/') + 1)));
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
