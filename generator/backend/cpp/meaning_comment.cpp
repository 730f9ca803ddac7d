#include "backend/cpp/meaning_comment.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "backend/cpp/cpp_text.hpp"
#include "backend/cpp/word_view.hpp"
#include "device/meaning/physical.hpp"
#include "text/ascii.hpp"

namespace edsc {
namespace {

using nlohmann::ordered_json;

/// Lines of a list that is separated by commas.
class ListLines {
 public:
  explicit ListLines(std::string title) : line_{std::move(title)} {}

  void add(const std::string& item) {
    constexpr std::size_t longest = 116;
    if (any_) line_ += ',';
    if (line_.size() + 1 + item.size() > longest) {
      lines_.push_back(std::move(line_));
      line_ = " ";
    }
    line_ += ' ' + item;
    any_ = true;
  }
  void append_to(ordered_json& lines, std::string_view end) {
    if (!any_) return;
    for (std::string& line : lines_) lines.push_back(std::move(line));
    lines.push_back(line_.append(end));
  }

 private:
  std::vector<std::string> lines_;
  std::string line_;
  bool any_ = false;
};

std::string physical_text(const Entry& entry, const Value& value) {
  std::string text;
  append_physical(text, *entry.meaning->quantity, *entry.type, value.bits, entry.type->bits);
  return cpp_comment(text);
}

/// `Unit °C, scale 1/10: 0 °C to 90 °C; default value 21.5 °C.`
std::string quantity_line(const Entry& entry) {
  const Quantity& quantity = *entry.meaning->quantity;
  std::string line = quantity.symbol.empty() ? "Scale " : "Unit " + cpp_comment(quantity.symbol);
  if (quantity.symbol.empty() || quantity.scale != Rational{1}) {
    line += (quantity.symbol.empty() ? "" : ", scale ") + fraction_text(quantity.scale);
  }
  if (quantity.offset != Rational{0}) line += ", offset " + fraction_text(quantity.offset);
  if (!quantity.stated_by.empty()) line += ", " + quantity.text;
  const auto known = [](const std::optional<Value>& value) { return value && !value->plus_node_id; };
  std::string separator = ": ";
  const auto add = [&](std::string_view text, const std::optional<Value>& value) {
    if (!known(value)) return;
    line += std::exchange(separator, "; ").append(text) + physical_text(entry, *value);
  };
  if (known(entry.low_limit) && known(entry.high_limit)) {
    add("", entry.low_limit);
    line += " to " + physical_text(entry, *entry.high_limit);
  } else {
    add("at least ", entry.low_limit);
    add("at most ", entry.high_limit);
  }
  add("default value ", entry.default_value);
  return line + ".";
}

void add_values(const Enumeration& values, ordered_json& lines) {
  ListLines list{"Values:"};
  for (const NamedValue& one : values.values) list.add(fmt::format("{} {}", one.value, one.name));
  list.append_to(lines, values.closed ? "; others are rejected." : ".");
}

void add_fields(std::string title, const std::vector<BitField>& fields, ordered_json& lines) {
  ListLines list{std::move(title)};
  for (const BitField& field : fields) {
    if (field.is_reserved()) continue;
    const int last = field.first_bit + field.bits - 1;
    list.add(field.bits == 1 ? fmt::format("{} {}", field.first_bit, field.name)
                             : fmt::format("{}..{} {}", field.first_bit, last, field.name));
  }
  list.append_to(lines, ".");
}

}  // namespace

ordered_json meaning_lines(const Entry& entry) {
  ordered_json lines = ordered_json::array();
  if (!entry.meaning) return lines;
  const Meaning& meaning = *entry.meaning;
  const bool is_number =
      entry.type->kind != canopen::DataClass::string && entry.type->kind != canopen::DataClass::domain;
  if (meaning.quantity && is_number) lines.push_back(quantity_line(entry));
  if (meaning.values) add_values(*meaning.values, lines);
  add_fields("Bits:", meaning.fields, lines);
  for (const FieldCase& one : meaning.cases)
    add_fields(fmt::format("Bits for {}:", name_of_case(one)), one.fields, lines);
  for (const MaskedGroup& group : meaning.masked) {
    ListLines list{fmt::format("Values of {}:", group.name)};
    for (const MaskedValue& one : group.values) list.add(one.name);
    list.append_to(lines, ".");
  }
  if (!meaning.text.empty()) {
    std::string text = cpp_comment(meaning.text);
    text.front() = to_upper(text.front());
    if (!text.ends_with('.')) text += '.';
    lines.push_back(std::move(text));
  }
  if (!meaning.place.empty()) {
    const bool is_of_device = meaning.source == MeaningSource::options;
    lines.push_back(fmt::format("{} {}.", is_of_device ? "Manual:" : "See", cpp_comment(meaning.place)));
  }
  return lines;
}

}  // namespace edsc
