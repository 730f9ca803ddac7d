/// The signals of an entry in a DBC file: the entry itself, or its fields.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/device.hpp"

namespace edsc {

/// A number in the bits of an entry. Its bits are those of an integer type or, if `type` is REAL, of a real number.
struct DbcSignal {
  unsigned first_bit = 0;  ///< in the entry
  unsigned bits = 0;
  bool is_signed = false;
  std::string name;  ///< after the name of the entry, with a `_` before it; empty for the entry itself
  std::string factor = "1", offset = "0";
  std::string min = "0", max = "0";     ///< physical values; both 0: no limits
  std::string unit;                     ///< UTF-8, all of its characters in code page 1252
  const Enumeration* values = nullptr;  ///< names of raw values; null without them
  std::string text;                     ///< for the comment: the bits of a field, and what it means; may be empty
};

/// The signals of an entry of which a PDO maps the first `bits`. Of a word with fields, each field is a signal, and
/// each run of bits without a field, such as those of which the meaning depends on another object; reserved bits are
/// not.
[[nodiscard]] std::vector<DbcSignal> dbc_signals(const Entry& entry, unsigned bits);

}  // namespace edsc
