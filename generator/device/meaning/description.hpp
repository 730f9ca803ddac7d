/// The member "meaning" of an options file or a profile as written, before it is applied to a device.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "device/meaning/meaning.hpp"
#include "device/options/option_file.hpp"

namespace edsc {

/// A property of a quantity.
template <class Value>
struct Stated {
  Value value;
  Position position;
};

/// The meaning of an object, of one of its entries, or in a profile of a range of objects. Only properties that are
/// written have values.
struct MeaningDescription : MeaningText {
  std::uint16_t first_index = 0, last_index = 0;
  std::optional<std::uint8_t> sub_index;  ///< nothing: a VAR, and the entries after sub-index 0
  std::string address;                    ///< as written
  std::optional<Stated<std::string>> unit;
  std::optional<Stated<Rational>> scale, offset;
  std::optional<Enumeration> values;
  std::vector<BitField> fields;
  std::vector<MaskedGroup> masked;
  std::optional<EntryKey> depends_on;
  std::vector<FieldCase> cases;
  std::optional<EntryKey> same_as;

  [[nodiscard]] bool applies_to(std::uint16_t index, std::uint8_t sub_index_of_entry) const;
};

struct MeaningDescriptions {
  std::vector<MeaningDescription> entries;  ///< in the order of the file
  std::vector<ErrorCodeName> error_codes;   ///< ascending by code
};

/// Reads the value of "meaning". Reports each fault; invalid objects are skipped. `path` is the name of the member for
/// the messages. Ranges of objects are allowed in profiles only.
[[nodiscard]] MeaningDescriptions read_meaning(const nlohmann::json& value, std::string_view path, MeaningSource source,
                                               OptionFile& file);

/// Reads the names of error codes: `{"2310h": "continuous over current"}`. Ascending by code.
[[nodiscard]] std::vector<ErrorCodeName> read_error_codes(const nlohmann::json& value, std::string_view path,
                                                          MeaningSource source, OptionFile& file);

/// Whether a text can be the name of a value, field or case: `[a-z][a-z0-9_]*`.
[[nodiscard]] bool is_meaning_name(std::string_view name);

}  // namespace edsc
