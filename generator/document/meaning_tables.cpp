#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/error_code_text.hpp"
#include "device/meaning/raw_unit.hpp"
#include "document/views.hpp"

namespace edsc::document {
namespace {

/// Bits in a row of a drawn word.
constexpr unsigned bits_per_row = 16;

/// `4..7`, `3`.
std::string bits_text(const BitField& field) {
  if (field.bits == 1) return fmt::format("{}", field.first_bit);
  return fmt::format("{}..{}", field.first_bit, field.first_bit + field.bits - 1);
}

/// The text as parts of which the last one ends with a possible end of line: `set_`, `point_`, `acknowledge`.
Json parts_of(std::string_view name) {
  Json parts = Json::array();
  while (!name.empty()) {
    const std::size_t end = std::min(name.find('_'), name.size() - 1) + 1;
    parts.push_back(name.substr(0, end));
    name.remove_prefix(end);
  }
  return parts;
}

/// Adds a sentence of the manual and its place.
void add_sources(const MeaningText& texts, Json& view) {
  view["row_text"] = shown(texts.text);
  view["row_place"] = shown(texts.place);
}

/// Adds rows, and whether any of them has a sentence or a place: a column without one is ignored.
void add_rows(std::string_view name, Json rows, Json& view) {
  const auto any = [&](auto... keys) {
    return std::ranges::any_of(rows, [&](const Json& row) {
      return ((row.contains(keys) && !row[keys].is_null() && !(row[keys].is_array() && row[keys].empty())) || ...);
    });
  };
  view["text_column"] = any("row_text", "field_kind", "choices");
  view["place_column"] = any("row_place");
  view[std::string{name}] = std::move(rows);
}

Json value_rows(const Enumeration& values, bool is_signed) {
  Json rows = Json::array();
  for (const NamedValue& one : values.values) {
    Json row = {
        {"number", is_signed ? fmt::format("{}", one.value) : fmt::format("{}", static_cast<std::uint64_t>(one.value))},
        {"value_name", one.name}};
    add_sources(one, row);
    rows.push_back(std::move(row));
  }
  return rows;
}

Json field_row(const BitField& field) {
  std::vector<std::string> kind;
  if (field.is_signed) kind.emplace_back("signed");
  if (field.quantity) kind.push_back(unit_text(*field.quantity));
  if (field.values && field.values->closed) kind.emplace_back("only these values");
  Json row = {{"range", bits_text(field)},
              {"is_reserved", field.is_reserved()},
              {"field_name", field.is_reserved() ? "reserved" : field.name},
              {"field_kind", shown(fmt::format("{}", fmt::join(kind, ", ")))},
              {"choices", field.values ? value_rows(*field.values, field.is_signed) : Json::array()}};
  add_sources(field, row);
  return row;
}

/// What a bit of a drawn word is.
struct Cell {
  std::string_view kind = "unused";  ///< the class in the page: field, mode, reserved or unused
  const BitField* field = nullptr;

  friend bool operator==(const Cell&, const Cell&) = default;
};

/// The bits of a word, each with its field.
class DrawnWord {
 public:
  explicit DrawnWord(unsigned bits) : cells_(bits) {}

  void add(const std::vector<BitField>& fields, std::string_view kind) {
    for (const BitField& field : fields) {
      for (unsigned bit = field.first_bit; bit < std::min<unsigned>(field.first_bit + field.bits, count()); ++bit) {
        cells_[bit] = field.is_reserved() ? Cell{"reserved", nullptr} : Cell{kind, &field};
      }
    }
  }
  /// The bits that mean something else in each mode.
  void add_modes(const std::vector<FieldCase>& cases) {
    for (const FieldCase& one : cases) {
      for (const BitField& field : one.fields) {
        for (unsigned bit = field.first_bit; bit < std::min<unsigned>(field.first_bit + field.bits, count()); ++bit) {
          if (cells_[bit].kind == "unused") cells_[bit] = {"mode", nullptr};
        }
      }
    }
  }

  /// Rows with the most significant bit first.
  [[nodiscard]] Json rows() const {
    Json rows = Json::array();
    for (unsigned end = count(); end > 0;) {
      const unsigned begin = (end - 1) / bits_per_row * bits_per_row;
      rows.push_back(row(begin, end));
      end = begin;
    }
    return rows;
  }

 private:
  [[nodiscard]] unsigned count() const { return static_cast<unsigned>(cells_.size()); }

  [[nodiscard]] Json row(unsigned begin, unsigned end) const {
    Json numbers = Json::array();
    Json cells = Json::array();
    for (unsigned bit = end; bit > begin; --bit) numbers.push_back(bit - 1);
    for (unsigned last = end; last > begin;) {
      const Cell& cell = cells_[last - 1];
      unsigned first = last - 1;
      while (first > begin && cells_[first - 1] == cell) --first;
      cells.push_back({{"span", last - first},
                       {"is_narrow", last - first < 4},
                       {"cell_class", cell.kind},
                       {"label", parts_of(cell.field != nullptr     ? std::string_view{cell.field->name}
                                          : cell.kind == "mode"     ? "by mode"
                                          : cell.kind == "reserved" ? "reserved"
                                                                    : "")}});
      last = first;
    }
    return {{"numbers", std::move(numbers)}, {"cells", std::move(cells)}};
  }

  std::vector<Cell> cells_;
};

Json field_rows(const std::vector<BitField>& fields) {
  Json rows = Json::array();
  for (const BitField& field : fields) rows.push_back(field_row(field));
  return rows;
}

/// `6061h = 1, profile_position`.
std::string mode_caption(const Device& device, const Meaning& meaning, const FieldCase& one) {
  const Entry* const other = device.find(meaning.depends_on->first, meaning.depends_on->second);
  const bool has_sub_index = meaning.depends_on->second != 0;
  std::string caption = has_sub_index ? entry_label(meaning.depends_on->first, meaning.depends_on->second)
                                      : index_label(meaning.depends_on->first);
  if (other != nullptr) caption += fmt::format(" \"{}\"", other->name);
  caption += fmt::format(" = {}", fmt::join(one.values, ", "));
  return one.name.empty() ? caption : caption + ", " + one.name;
}

/// The bit tables: the fields of each value, and one table for each mode.
Json word_views(const Device& device, const Meaning& meaning, const Entry& entry) {
  Json words = Json::array();
  const auto add = [&](const std::string& caption, const DrawnWord& word, const std::vector<BitField>& fields,
                       const MeaningText* texts) {
    Json view = {{"caption", caption}, {"bit_rows", word.rows()}};
    add_rows("fields", field_rows(fields), view);
    view["has_fields"] = !fields.empty();
    add_sources(texts != nullptr ? *texts : MeaningText{}, view);
    words.push_back(std::move(view));
  };
  if (!meaning.fields.empty() || !meaning.cases.empty()) {
    DrawnWord word{entry.type->bits};
    word.add(meaning.fields, "field");
    word.add_modes(meaning.cases);
    add(meaning.cases.empty() ? "Bits" : "Bits in each mode", word, meaning.fields, nullptr);
  }
  if (!meaning.depends_on) return words;
  for (const FieldCase& one : meaning.cases) {
    DrawnWord word{entry.type->bits};
    word.add(meaning.fields, "other");
    word.add(one.fields, "field");
    add(mode_caption(device, meaning, one), word, one.fields, &one);
  }
  return words;
}

/// The bits of a mask, in groups of four: `xxxx xxxx x01x 0111`.
std::string pattern_text(const MaskedValue& one, unsigned bits) {
  std::string text;
  for (unsigned bit = bits; bit-- > 0;) {
    const bool is_fixed = (one.mask >> bit & 1) != 0;
    text += is_fixed ? ((one.value >> bit & 1) != 0 ? '1' : '0') : 'x';
    if (bit % 4 == 0 && bit != 0) text += ' ';
  }
  return text;
}

Json masked_views(const Meaning& meaning, const Entry& entry) {
  Json groups = Json::array();
  const unsigned digits = (entry.type->bits + 3U) / 4;
  for (const MaskedGroup& group : meaning.masked) {
    Json states = Json::array();
    for (const MaskedValue& one : group.values) {
      Json row = {{"state_name", one.name},
                  {"pattern", pattern_text(one, entry.type->bits)},
                  {"mask", fmt::format("{:0{}X}h", one.mask, digits)},
                  {"masked_value", fmt::format("{:0{}X}h", one.value, digits)}};
      add_sources(one, row);
      states.push_back(std::move(row));
    }
    Json view = {{"group_name", group.name}};
    add_rows("states", std::move(states), view);
    groups.push_back(std::move(view));
  }
  return groups;
}

bool has_tables(const Meaning& meaning) { return meaning.values || meaning.has_fields(); }

/// `01`, `01 to 08`: the sub-indices of entries with one meaning.
std::string sub_indices_text(const std::vector<const Entry*>& entries) {
  std::string text;
  for (std::size_t first = 0; first < entries.size();) {
    std::size_t last = first;
    while (last + 1 < entries.size() && entries[last + 1]->sub_index == entries[last]->sub_index + 1) ++last;
    if (!text.empty()) text += ", ";
    text += fmt::format("{:02X}", entries[first]->sub_index);
    if (last != first) text += fmt::format(" to {:02X}", entries[last]->sub_index);
    first = last + 1;
  }
  return text;
}

}  // namespace

std::string unit_text(const Quantity& quantity) {
  return (quantity.is_raw() ? "" : "\u00D7 ") + raw_unit_text(quantity);
}

Json MeaningTables::of(const Object& object) {
  std::vector<std::pair<const Meaning*, std::vector<const Entry*>>> meanings;
  for (const Entry& entry : object.entries) {
    const Meaning* const meaning = entry.meaning.get();
    if (meaning == nullptr) continue;
    const auto at = std::ranges::find(meanings, meaning, &decltype(meanings)::value_type::first);
    if (at == meanings.end()) {
      meanings.push_back({meaning, {&entry}});
    } else {
      at->second.push_back(&entry);
    }
  }
  Json views = Json::array();
  for (const auto& [meaning, entries] : meanings) {
    const bool is_text_only = !has_tables(*meaning) && meaning->text.empty() && meaning->place.empty();
    if (!is_text_only) views.push_back(view_of(object, *meaning, entries));
  }
  return views;
}

Json MeaningTables::view_of(const Object& object, const Meaning& meaning, const std::vector<const Entry*>& entries) {
  const Entry& entry = *entries.front();
  const std::string anchor = anchor_of(object, entry);
  Json view = {{"meaning_of", object.has_sub_indices() ? Json(sub_indices_text(entries)) : Json(nullptr)}};
  add_sources(meaning, view);
  view["drawn_at"] = nullptr;
  view["values"] = nullptr;
  view["words"] = Json::array();
  view["groups"] = Json::array();
  if (!has_tables(meaning)) return view;
  const auto [drawn, is_new] = drawn_.try_emplace(&meaning, anchor);
  if (!is_new) {
    view["drawn_at"] = drawn->second;
    return view;
  }
  if (meaning.values) {
    const bool is_signed = entry.type->kind == canopen::DataClass::signed_integer;
    Json values = {{"values_note", shown(meaning.values->closed ? "Other values are rejected." : "")}};
    add_rows("value_rows", value_rows(*meaning.values, is_signed), values);
    view["values"] = std::move(values);
  }
  view["words"] = word_views(device_, meaning, entry);
  view["groups"] = masked_views(meaning, entry);
  return view;
}

void add_error_codes(const Device& device, Json& view) {
  Json of_device = Json::array(), of_profile = Json::array();
  for (const ErrorCodeName& one : device.error_codes) {
    Json row = {{"code", fmt::format("{:04X}h", one.code)}, {"code_text", one.text}, {"code_place", shown(one.place)}};
    (one.source == MeaningSource::profile ? of_profile : of_device).push_back(std::move(row));
  }
  view["has_error_codes"] = !of_device.empty();
  view["error_codes"] = std::move(of_device);
  view["has_profile_codes"] = !of_profile.empty();
  view["profile_codes"] = std::move(of_profile);
}

}  // namespace edsc::document
