#include "backend/json/meaning_view.hpp"

#include <string_view>

namespace edsc {
namespace {

using nlohmann::ordered_json;

/// Numbers of UNSIGNED64 are above those of a signed number.
ordered_json number_view(std::int64_t number, bool is_signed) {
  return is_signed ? ordered_json(number) : ordered_json(static_cast<std::uint64_t>(number));
}

void add_texts(const MeaningText& texts, ordered_json& view) {
  if (!texts.text.empty()) view["text"] = texts.text;
  if (!texts.place.empty()) view["place"] = texts.place;
  view["source"] = to_string(texts.source);
}

ordered_json key_view(const EntryKey& key) { return {{"index", key.first}, {"sub_index", key.second}}; }

ordered_json quantity_view(const Quantity& quantity) {
  ordered_json view;
  view["unit"] = quantity.unit != nullptr ? quantity.unit->symbol : std::string_view{quantity.symbol};
  view["ascii_unit"] = quantity.unit != nullptr ? ordered_json(quantity.unit->ascii) : ordered_json(nullptr);
  view["scale"] = fraction_text(quantity.scale);
  view["offset"] = fraction_text(quantity.offset);
  add_texts(quantity, view);
  return view;
}

void add_values(const Enumeration& enumeration, bool is_signed, ordered_json& view) {
  ordered_json values = ordered_json::array();
  for (const NamedValue& one : enumeration.values) {
    ordered_json row;
    row["value"] = number_view(one.value, is_signed);
    row["name"] = one.name;
    add_texts(one, row);
    values.push_back(std::move(row));
  }
  view["values"] = std::move(values);
  view["closed"] = enumeration.closed;
}

ordered_json fields_view(const std::vector<BitField>& fields) {
  ordered_json view = ordered_json::array();
  for (const BitField& field : fields) {
    ordered_json row;
    row["first_bit"] = field.first_bit;
    row["bits"] = field.bits;
    row["name"] = field.is_reserved() ? ordered_json(nullptr) : ordered_json(field.name);
    row["signed"] = field.is_signed;
    if (field.quantity) row["quantity"] = quantity_view(*field.quantity);
    if (field.values) add_values(*field.values, field.is_signed, row);
    add_texts(field, row);
    view.push_back(std::move(row));
  }
  return view;
}

ordered_json masked_view(const std::vector<MaskedGroup>& groups) {
  ordered_json view = ordered_json::array();
  for (const MaskedGroup& group : groups) {
    ordered_json values = ordered_json::array();
    for (const MaskedValue& one : group.values) {
      ordered_json row = {{"mask", one.mask}, {"value", one.value}, {"name", one.name}};
      add_texts(one, row);
      values.push_back(std::move(row));
    }
    view.push_back({{"name", group.name}, {"values", std::move(values)}});
  }
  return view;
}

ordered_json cases_view(const std::vector<FieldCase>& cases) {
  ordered_json view = ordered_json::array();
  for (const FieldCase& one : cases) {
    ordered_json row;
    row["values"] = one.values;
    row["name"] = one.name;
    add_texts(one, row);
    row["fields"] = fields_view(one.fields);
    view.push_back(std::move(row));
  }
  return view;
}

}  // namespace

ordered_json meaning_view(const Meaning& meaning, const canopen::DataTypeRow& type) {
  ordered_json view;
  if (meaning.quantity) view["quantity"] = quantity_view(*meaning.quantity);
  if (meaning.values) {
    add_values(*meaning.values, type.kind == canopen::DataClass::signed_integer, view);
  }
  if (!meaning.fields.empty()) view["fields"] = fields_view(meaning.fields);
  if (!meaning.masked.empty()) view["masked"] = masked_view(meaning.masked);
  if (meaning.depends_on) view["depends_on"] = key_view(*meaning.depends_on);
  if (!meaning.cases.empty()) view["cases"] = cases_view(meaning.cases);
  if (meaning.same_as) view["same_as"] = key_view(*meaning.same_as);
  add_texts(meaning, view);
  return view;
}

ordered_json error_codes_view(const std::vector<ErrorCodeName>& codes) {
  ordered_json view = ordered_json::array();
  for (const ErrorCodeName& one : codes) {
    ordered_json row = {{"code", one.code}};
    add_texts(one, row);
    view.push_back(std::move(row));
  }
  return view;
}

}  // namespace edsc
