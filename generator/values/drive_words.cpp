#include "values/drive_words.hpp"

#include <span>
#include <string_view>

#include "values/append.hpp"

namespace edsc {
namespace {

struct BitPattern {
  std::uint16_t mask;
  std::uint16_t value;
  std::string_view text;
};

using Rows = std::span<const BitPattern>;

/// The first matching row is used.
constexpr BitPattern drive_states[] = {
    {0x4F, 0x00, "not ready to switch on"}, {0x4F, 0x40, "switch on disabled"},
    {0x6F, 0x21, "ready to switch on"},     {0x6F, 0x23, "switched on"},
    {0x6F, 0x27, "operation enabled"},      {0x6F, 0x07, "quick stop active"},
    {0x4F, 0x0F, "fault reaction active"},  {0x4F, 0x08, "fault"},
    {0x00, 0x00, "not a state of CiA 402"},
};

constexpr BitPattern drive_commands[] = {
    {0x80, 0x80, "fault reset"}, {0x02, 0x00, "disable voltage"}, {0x06, 0x02, "quick stop"},
    {0x07, 0x06, "shutdown"},    {0x0F, 0x07, "switch on"},       {0x0F, 0x0F, "enable operation"},
};

/// Bits with the same meaning in all modes of operation.
constexpr BitPattern status_bits[] = {
    {0x0080, 0x0080, ", warning"},
    {0x0400, 0x0400, ", target reached"},
    {0x0800, 0x0800, ", internal limit active"},
};

constexpr BitPattern control_bits[] = {{0x0100, 0x0100, ", halt"}};

/// The texts of the rows that match, or of the first one alone.
void append_matching(std::string& text, Rows rows, std::uint16_t value, bool first_alone) {
  for (const BitPattern& row : rows) {
    if ((value & row.mask) != row.value) continue;
    text += row.text;
    if (first_alone) return;
  }
}

}  // namespace

DriveWord drive_word_at(std::uint16_t index, std::uint8_t sub_index) {
  constexpr unsigned first_axis = 0x6000, behind_last_axis = 0xA000, axis_objects = 0x800;
  if (sub_index != 0 || index < first_axis || index >= behind_last_axis) return DriveWord::none;
  switch ((index - first_axis) % axis_objects) {
    case 0x40: return DriveWord::controlword;
    case 0x41: return DriveWord::statusword;
    default: return DriveWord::none;
  }
}

void append_drive_word(std::string& text, DriveWord word, std::uint16_t value) {
  append_hex_number(text, value, 4);
  text += " ";
  const bool status = word == DriveWord::statusword;
  append_matching(text, status ? Rows{drive_states} : Rows{drive_commands}, value, true);
  append_matching(text, status ? Rows{status_bits} : Rows{control_bits}, value, false);
}

}  // namespace edsc
