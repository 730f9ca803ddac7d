#include "device/options/option_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "eds/number.hpp"

namespace edsc {
std::optional<std::uint16_t> parse_index(std::string_view text) {
  if (text.ends_with('h')) text.remove_suffix(1);
  const auto index = parse_unsigned(fmt::format("0x{}", text));
  return index && *index <= 0xFFFF ? std::optional{static_cast<std::uint16_t>(*index)} : std::nullopt;
}

std::optional<EntryAddress> parse_option_address(std::string_view text) {
  const std::size_t colon = text.find(':');
  const auto index = parse_index(text.substr(0, colon));
  if (!index) return std::nullopt;
  if (colon == std::string_view::npos) return EntryAddress{*index, std::nullopt};
  const auto sub_index = parse_unsigned(fmt::format("0x{}", text.substr(colon + 1)));
  if (!sub_index || *sub_index > 0xFF) return std::nullopt;
  return EntryAddress{*index, static_cast<std::uint8_t>(*sub_index)};
}

std::optional<EntryKey> parse_option_entry(std::string_view text) {
  const auto entry = parse_option_address(text);
  return entry ? std::optional{EntryKey{entry->index, entry->sub_index.value_or(0)}} : std::nullopt;
}

void OptionFile::error(const JsonFile::Json& value, std::string_view path, std::string_view message,
                       std::vector<Note> notes) {
  error_at(file_.name_position(value), path, message, std::move(notes));
}

void OptionFile::error_at(const Position& position, std::string_view path, std::string_view message,
                          std::vector<Note> notes) {
  const std::string place = path.empty() ? "" : fmt::format("{}: ", path);
  diagnostics_.error("options", position, fmt::format("{}{}", place, message), std::move(notes));
}

}  // namespace edsc
