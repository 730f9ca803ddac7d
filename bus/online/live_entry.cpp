#include "online/live_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "eds/ini.hpp"
#include "text/utf8.hpp"
#include "values/value_text.hpp"

namespace edsc {
namespace {

using canopen::DataClass;
using canopen::DataType;
using Json = nlohmann::ordered_json;

struct TypeName {
  std::string_view name;
  DataType type;
};

constexpr TypeName type_names[] = {
    {"bool", DataType::boolean},        {"i8", DataType::integer8},
    {"i16", DataType::integer16},       {"i24", DataType::integer24},
    {"i32", DataType::integer32},       {"i40", DataType::integer40},
    {"i48", DataType::integer48},       {"i56", DataType::integer56},
    {"i64", DataType::integer64},       {"u8", DataType::unsigned8},
    {"u16", DataType::unsigned16},      {"u24", DataType::unsigned24},
    {"u32", DataType::unsigned32},      {"u40", DataType::unsigned40},
    {"u48", DataType::unsigned48},      {"u56", DataType::unsigned56},
    {"u64", DataType::unsigned64},      {"f32", DataType::real32},
    {"f64", DataType::real64},          {"string", DataType::visible_string},
    {"octets", DataType::octet_string}, {"unicode", DataType::unicode_string},
    {"time", DataType::time_of_day},    {"span", DataType::time_difference},
    {"domain", DataType::domain},
};

/// A number, string or boolean of JSON; null for other types, and if the number of bytes does not match the type.
Json json_value(const canopen::DataTypeRow* type, std::span<const std::uint8_t> bytes) {
  if (type == nullptr) return nullptr;
  if (type->type == DataType::visible_string) {
    std::string text{bytes.begin(), bytes.end()};
    while (text.ends_with('\0')) text.pop_back();
    return is_utf8(text) ? Json(text) : Json(nullptr);
  }
  if (type->bits == 0 || bytes.size() != (type->bits + 7U) / 8U) return nullptr;
  std::uint64_t number = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) number = number << 8 | bytes[i];
  switch (type->kind) {
    case DataClass::boolean: return number != 0;
    case DataClass::unsigned_integer: return number;
    case DataClass::signed_integer: {
      const unsigned unused = 64U - type->bits;
      return static_cast<std::int64_t>(number << unused) >> unused;
    }
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

std::string_view to_text(SdoEnd end) {
  switch (end) {
    case SdoEnd::done: return "done";
    case SdoEnd::refused: return "refused";
    case SdoEnd::no_answer: return "no_answer";
    case SdoEnd::broken: return "broken";
  }
  return {};
}

/// The size of a number, and of a string whose DEFTYPE states its length.
std::optional<std::size_t> size_of_type(const LiveEntry& entry) {
  if (entry.type != nullptr && entry.type->bits != 0) return (entry.type->bits + 7U) / 8U;
  if (entry.entry != nullptr && entry.entry->octets != 0) return entry.entry->octets;
  return std::nullopt;
}

}  // namespace

LiveEntry live_entry(const Object& object, const Entry& entry) {
  std::string name = object.name;
  if (object.has_sub_indices()) name += ", " + entry.name;
  return {entry.index, entry.sub_index, &entry, entry.type, std::move(name)};
}

LiveEntry live_entry(const Device* device, std::uint16_t index, std::uint8_t sub_index) {
  const Object* const object = device == nullptr ? nullptr : device->find(index);
  const Entry* const entry = object == nullptr ? nullptr : object->find(sub_index);
  if (entry != nullptr) return live_entry(*object, *entry);
  LiveEntry address;
  address.index = index;
  address.sub_index = sub_index;
  return address;
}

void set_type(LiveEntry& entry, const canopen::DataTypeRow& type) {
  entry.type = &type;
  entry.entry = nullptr;
}

SdoOutcome upload(SdoAccess& node, const LiveEntry& entry, SdoTransfer transfer, const SdoProgress& progress) {
  SdoOutcome outcome = node.upload(entry.index, entry.sub_index, transfer, progress, size_of_type(entry));
  if (outcome.size_told || entry.type == nullptr) return outcome;
  if (entry.type->bits != 0) {
    outcome.bytes.resize(std::min<std::size_t>(outcome.bytes.size(), (entry.type->bits + 7U) / 8U));
  } else if (entry.type->type == DataType::visible_string) {
    while (!outcome.bytes.empty() && outcome.bytes.back() == 0) outcome.bytes.pop_back();
  }
  return outcome;
}

bool reads_back(const SdoOutcome& outcome, std::span<const std::uint8_t> bytes) {
  if (outcome.size_told) return std::ranges::equal(outcome.bytes, bytes);
  const std::size_t known = std::min(outcome.bytes.size(), bytes.size());
  return bytes.size() <= 4 && std::ranges::equal(std::span{outcome.bytes}.first(known), bytes.first(known));
}

std::string title(const LiveEntry& entry) {
  return entry_label(entry.index, entry.sub_index) + (entry.name.empty() ? "" : " " + entry.name);
}

std::string hex_bytes(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  return text;
}

std::string value_of(const LiveEntry& entry, std::span<const std::uint8_t> bytes) {
  if (entry.type == nullptr) return bytes.empty() ? "nothing" : hex_bytes(bytes);
  if (entry.type->kind == DataClass::domain) {
    return fmt::format("{} ({} {})", value_text(*entry.type, bytes), bytes.size(),
                       bytes.size() == 1 ? "byte" : "bytes");
  }
  return entry.entry != nullptr ? value_text(*entry.entry, bytes) : value_text(*entry.type, bytes);
}

Json as_json(const LiveEntry& entry, const SdoOutcome& outcome, std::span<const std::uint8_t> bytes) {
  Json json{{"index", entry.index}, {"sub_index", entry.sub_index}};
  json["name"] = entry.name.empty() ? Json(nullptr) : Json(entry.name);
  json["type"] = entry.type == nullptr ? Json(nullptr) : Json(entry.type->name);
  json["result"] = to_text(outcome.end);
  if (outcome.done()) {
    json["bytes"] = hex_bytes(bytes);
    json["value"] = json_value(entry.type, bytes);
    json["text"] = value_of(entry, bytes);
  } else {
    json["abort_code"] = static_cast<std::uint32_t>(outcome.code);
    json["text"] = failure_text(outcome);
  }
  return json;
}

const canopen::DataTypeRow* find_type(std::string_view name) {
  for (const TypeName& row : type_names) {
    if (equal_ignoring_case(row.name, name)) return canopen::find_data_type(static_cast<std::uint32_t>(row.type));
  }
  for (const canopen::DataTypeRow& row : canopen::data_types) {
    if (equal_ignoring_case(row.name, name)) return &row;
  }
  return nullptr;
}

SdoTransfer best_transfer(const LiveEntry& entry) {
  return entry.type != nullptr && entry.type->kind == DataClass::domain ? SdoTransfer::block : SdoTransfer::segmented;
}

}  // namespace edsc
