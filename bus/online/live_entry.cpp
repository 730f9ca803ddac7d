#include "online/live_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "device/entry_text.hpp"
#include "device/error_code_text.hpp"
#include "device/meaning/value_parts.hpp"
#include "eds/ini.hpp"
#include "text/counted.hpp"
#include "text/utf8.hpp"
#include "values/little_endian.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using Json = nlohmann::ordered_json;

struct TypeName {
  std::string_view name;
  DataType type;
};

/// Short names, except of integers and REALs: a letter and the number of bits.
constexpr TypeName type_names[] = {
    {"bool", DataType::boolean},           {"string", DataType::visible_string}, {"octets", DataType::octet_string},
    {"unicode", DataType::unicode_string}, {"time", DataType::time_of_day},      {"span", DataType::time_difference},
};

std::string short_name(const canopen::DataTypeRow& type) {
  for (const TypeName& row : type_names) {
    if (row.type == type.type) return std::string{row.name};
  }
  const char letter = type.kind == DataClass::real ? 'f' : type.kind == DataClass::signed_integer ? 'i' : 'u';
  return fmt::format("{}{}", letter, type.bits);
}

/// A number, string or boolean of JSON; null for other types, and if the number of bytes does not match the type.
Json json_value(const canopen::DataTypeRow* type, std::span<const std::uint8_t> bytes) {
  if (type == nullptr) return nullptr;
  if (type->type == DataType::visible_string) {
    std::string text{bytes.begin(), bytes.end()};
    while (text.ends_with('\0')) text.pop_back();
    return is_utf8(text) ? Json(text) : Json(nullptr);
  }
  if (type->bits == 0 || bytes.size() != bytes_for(type->bits)) return nullptr;
  const std::uint64_t number = number_of(bytes);
  switch (type->kind) {
    case DataClass::boolean: return number != 0;
    case DataClass::unsigned_integer: return number;
    case DataClass::signed_integer: return sign_extended(number, type->bits);
    case DataClass::real: {
      const double real =
          type->bits == 64 ? std::bit_cast<double>(number) : std::bit_cast<float>(static_cast<std::uint32_t>(number));
      return std::isfinite(real) ? Json(real) : Json(nullptr);
    }
    case DataClass::string:
    case DataClass::time:
    case DataClass::domain: break;
  }
  return nullptr;
}

Json json_of(const Rational& number) {
  return number.is_integer() ? Json(number.numerator()) : Json(number.to_double());
}

/// The number in a field as a name, a physical value, a flag or a number.
Json field_value(const ValuePart& part) {
  if (part.masked != nullptr) return part.masked->name;
  if (part.named != nullptr) return part.named->name;
  const BitField& field = *part.field;
  if (field.is_flag()) return part.number != 0;
  const auto physical = field.quantity
                            ? physical_value(*field.quantity, type_of(field), static_cast<std::uint64_t>(part.number))
                            : std::nullopt;
  return physical ? json_of(*physical) : Json(part.number);
}

/// The physical value, the name of the value and the fields, where the entry has them.
void add_meaning(Json& json, const LiveEntry& live, std::span<const std::uint8_t> bytes) {
  const Entry& entry = *live.entry;
  if (!entry.meaning || entry.type->bits == 0 || bytes.size() != bytes_for(entry.type->bits)) return;
  const std::uint64_t bits = number_of(bytes);
  if (const Quantity* const quantity = quantity_of(entry)) {
    const auto physical = physical_value(*quantity, *entry.type, bits);
    if (physical) json["physical"] = json_of(*physical);
    if (!quantity->symbol.empty()) json["unit"] = quantity->symbol;
  }
  const Meaning* const meaning = meaning_of_integer(entry);
  if (meaning == nullptr) return;
  const auto number = integer_of(live, bytes);
  if (const NamedValue* const named = number && meaning->values ? meaning->values->find(*number) : nullptr) {
    json["value_name"] = named->name;
  }
  if (!meaning->has_fields()) return;
  Json fields = Json::object();
  for_each_part(*meaning, bits, live.other,
                [&](const ValuePart& part) { fields[std::string{part.name()}] = field_value(part); });
  json["fields"] = std::move(fields);
}

constexpr std::string_view result_names[] = {"done", "refused", "no_answer", "broken"};  ///< by SdoEnd

/// The size of a number, and of a string whose DEFTYPE states its length.
std::optional<std::size_t> size_of_type(const LiveEntry& entry) {
  if (entry.type != nullptr && entry.type->bits != 0) return bytes_for(entry.type->bits);
  if (entry.entry != nullptr && entry.entry->octets != 0) return entry.entry->octets;
  return std::nullopt;
}

}  // namespace

LiveEntry live_entry(const Device& device, const Object& object, const Entry& entry) {
  std::string name = object.name;
  if (object.has_sub_indices()) name += ", " + entry.name;
  return {entry.index, entry.sub_index, &entry, entry.type, std::move(name), &device};
}

LiveEntry live_entry(const Device* device, std::uint16_t index, std::uint8_t sub_index) {
  const Object* const object = device == nullptr ? nullptr : device->find(index);
  const Entry* const entry = object == nullptr ? nullptr : object->find(sub_index);
  if (entry != nullptr) return live_entry(*device, *object, *entry);
  LiveEntry address;
  address.index = index;
  address.sub_index = sub_index;
  return address;
}

std::optional<LiveEntry> selector_of(const LiveEntry& entry) {
  const Meaning* const meaning = entry.entry != nullptr ? entry.entry->meaning.get() : nullptr;
  if (meaning == nullptr || !meaning->depends_on) return std::nullopt;
  return live_entry(entry.device, meaning->depends_on->first, meaning->depends_on->second);
}

void set_type(LiveEntry& entry, const canopen::DataTypeRow& type) {
  entry.type = &type;
  entry.entry = nullptr;
}

SdoOutcome upload(SdoAccess& node, const LiveEntry& entry, SdoTransfer transfer, const SdoProgress& progress) {
  SdoOutcome outcome = node.upload(entry.index, entry.sub_index, transfer, progress, size_of_type(entry));
  if (outcome.size_told || entry.type == nullptr) return outcome;
  if (entry.type->bits != 0) {
    outcome.bytes.resize(std::min<std::size_t>(outcome.bytes.size(), bytes_for(entry.type->bits)));
  } else if (entry.type->type == DataType::visible_string) {
    while (!outcome.bytes.empty() && outcome.bytes.back() == 0) outcome.bytes.pop_back();
  }
  return outcome;
}

std::optional<std::int64_t> integer_of(const LiveEntry& entry, std::span<const std::uint8_t> bytes) {
  const canopen::DataTypeRow* const type = entry.type;
  if (type == nullptr || type->bits == 0 || bytes.size() != bytes_for(type->bits)) return std::nullopt;
  const std::uint64_t number = number_of(bytes);
  if (type->kind == DataClass::signed_integer) return sign_extended(number, type->bits);
  if (type->kind == DataClass::unsigned_integer) return static_cast<std::int64_t>(number);
  return std::nullopt;
}

bool reads_back(const SdoOutcome& outcome, std::span<const std::uint8_t> bytes) {
  if (outcome.size_told) return std::ranges::equal(outcome.bytes, bytes);
  const std::size_t known = std::min(outcome.bytes.size(), bytes.size());
  return bytes.size() <= 4 && std::ranges::equal(std::span{outcome.bytes}.first(known), bytes.first(known));
}

std::string title(const LiveEntry& entry) {
  return entry_label(entry.index, entry.sub_index) + (entry.name.empty() ? "" : " " + entry.name);
}

std::string value_of(const LiveEntry& entry, std::span<const std::uint8_t> bytes) {
  if (entry.type == nullptr) return bytes.empty() ? "nothing" : hex_bytes(bytes);
  if (entry.type->kind == DataClass::domain) {
    return fmt::format("{} ({})", value_text(*entry.type, bytes), counted(bytes.size(), "byte"));
  }
  if (entry.entry == nullptr) return value_text(*entry.type, bytes);
  std::string text;
  append_device_value(text, *entry.device, *entry.entry, bytes, entry.other);
  return text;
}

Json as_json(const LiveEntry& entry, const SdoOutcome& outcome, std::span<const std::uint8_t> bytes) {
  Json json{{"index", entry_label(entry.index, entry.sub_index)}};
  json["name"] = entry.name.empty() ? Json(nullptr) : Json(entry.name);
  json["type"] = entry.type == nullptr ? Json(nullptr) : Json(entry.type->name);
  json["result"] = result_names[static_cast<std::size_t>(outcome.end)];
  if (outcome.done()) {
    json["bytes"] = hex_bytes(bytes);
    json["value"] = json_value(entry.type, bytes);
    if (entry.entry != nullptr) add_meaning(json, entry, bytes);
    json["text"] = value_of(entry, bytes);
  } else {
    json["abort_code"] = canopen::code_in_frame(outcome.code);
    json["text"] = failure_text(outcome);
  }
  return json;
}

const canopen::DataTypeRow* find_type(std::string_view name) {
  const auto found = std::ranges::find_if(canopen::data_types, [&](const canopen::DataTypeRow& row) {
    return equal_ignoring_case(short_name(row), name) || equal_ignoring_case(row.name, name);
  });
  return found == std::end(canopen::data_types) ? nullptr : found;
}

SdoTransfer best_transfer(const LiveEntry& entry) {
  return entry.type != nullptr && entry.type->kind == DataClass::domain ? SdoTransfer::block : SdoTransfer::segmented;
}

}  // namespace edsc
