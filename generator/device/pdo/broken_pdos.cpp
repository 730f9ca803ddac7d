#include "device/pdo/resolve_pdos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "device/limits.hpp"
#include "device/pdo/pdo_defaults.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

using canopen::Mappable;

constexpr unsigned max_bits = 64;

/// An error, or a warning if the PDO is disabled by default.
using BrokenPdoRule = RuleId<Severity::error, Severity::warning>;

constexpr BrokenPdoRule rules[] = {"pdo-object",          "pdo-mappable", "pdo-direction", "pdo-length",
                                   "pdo-variable-length", "pdo-dummy",    "pdo-size",      "pdo-entries"};

/// Why a PDO does not have a valid layout.
struct BrokenPdo {
  BrokenPdoRule rule;
  std::string message;
  std::string cause = {};  ///< the same for all PDOs with the same fault
};
using Finding = std::optional<BrokenPdo>;

/// `TPDO 1 entry 2 maps`
std::string maps(const Pdo& pdo, const PdoEntry& entry) {
  return fmt::format("{} entry {} maps", pdo_label(pdo), entry.position);
}

/// Usual in vendors' files: one byte in the PDO for a BOOLEAN.
bool is_boolean_in_a_byte(const PdoEntry& entry) {
  return entry.object->type->type == canopen::DataType::boolean && entry.bits == 8;
}

Finding check_dummy(const Device& device, const Pdo& pdo, const PdoEntry& entry) {
  const std::string dummy = fmt::format("the dummy {} {}", index_label(entry.index), entry.dummy->name);
  if (pdo.direction == PdoDirection::transmit) {
    return BrokenPdo{"pdo-dummy", fmt::format("{} {}, which only an RPDO can map", maps(pdo, entry), dummy)};
  }
  if (std::ranges::find(device.dummies, entry.index) == device.dummies.end()) {
    return BrokenPdo{"pdo-dummy", fmt::format("{} {}, which [DummyUsage] does not allow", maps(pdo, entry), dummy)};
  }
  const unsigned bits = entry.dummy->bits;
  if (bits == 0) {
    return BrokenPdo{"pdo-variable-length", fmt::format("{} {}, a variable-length data type", maps(pdo, entry), dummy)};
  }
  if (entry.bits != bits) {
    return BrokenPdo{"pdo-length", fmt::format("{} {} of {}, which has {}", maps(pdo, entry),
                                               counted(entry.bits, "bit"), dummy, bits)};
  }
  return {};
}

/// A string can be mapped up to its capacity, given by the options or the default value.
Finding check_string(const Options& options, const Pdo& pdo, const PdoEntry& entry) {
  const auto capacity = mapped_string_capacity(*entry.object, options);
  if (!capacity) {
    return BrokenPdo{"pdo-variable-length", fmt::format("{} {}, a variable-length {}", maps(pdo, entry),
                                                        named(*entry.object), entry.object->type->name)};
  }
  if (entry.bits % 8 != 0 || entry.bits == 0) {
    return BrokenPdo{"pdo-variable-length",
                     fmt::format("{} {} of {}, a {}; expected a multiple of 8 bits", maps(pdo, entry),
                                 counted(entry.bits, "bit"), named(*entry.object), entry.object->type->name)};
  }
  if (entry.bits / 8u > *capacity) {
    return BrokenPdo{"pdo-length",
                     fmt::format("{} {} of {}, which is {} and holds {}", maps(pdo, entry), counted(entry.bits, "bit"),
                                 named(*entry.object), entry.object->type->name, *capacity * 8)};
  }
  return {};
}

Finding check_object(const Device& device, const Options& options, const Pdo& pdo, const PdoEntry& entry) {
  if (entry.object == nullptr) {
    const Object* object = device.find(entry.index);
    const std::string label = entry_label(entry.index, entry.sub_index);
    if (object == nullptr) {
      return BrokenPdo{"pdo-object", fmt::format("{} {}, which does not exist", maps(pdo, entry), label), label};
    }
    return BrokenPdo{
        "pdo-object",
        fmt::format("{} {} of \"{}\", a sub-index that does not exist", maps(pdo, entry), label, object->name), label};
  }
  const Entry& object = *entry.object;
  if (!object.pdo_mapping) {
    return BrokenPdo{
        "pdo-mappable",
        fmt::format("{} {}, which is not PDO-mappable (PDOMapping=0)", maps(pdo, entry), named(*entry.object)),
        "PDOMapping=0"};
  }
  const Mappable needed = pdo.direction == PdoDirection::receive ? Mappable::rpdo : Mappable::tpdo;
  if (!canopen::allows(object.mappable(), needed)) {
    return BrokenPdo{
        "pdo-direction",
        fmt::format("{} {}, which is not {}-mappable (AccessType {})", maps(pdo, entry), named(*entry.object),
                    pdo.direction == PdoDirection::receive ? "RPDO" : "TPDO", canopen::row_of(object.access).name),
        fmt::format("{} in {}", canopen::row_of(object.access).name,
                    pdo.direction == PdoDirection::receive ? "RPDOs" : "TPDOs")};
  }
  if (object.type->kind == canopen::DataClass::string) return check_string(options, pdo, entry);
  if (object.type->bits == 0) {
    return BrokenPdo{"pdo-variable-length", fmt::format("{} {}, a variable-length {}", maps(pdo, entry),
                                                        named(*entry.object), object.type->name)};
  }
  if (object.type->bits != entry.bits && !is_boolean_in_a_byte(entry)) {
    return BrokenPdo{"pdo-length",
                     fmt::format("{} {} of {}, which is {} and has {}", maps(pdo, entry), counted(entry.bits, "bit"),
                                 named(*entry.object), object.type->name, object.type->bits)};
  }
  return {};
}

/// An invalid PDO is an error; if it is disabled by default, it is harmless until it is enabled.
void report_broken(Pdo& pdo, BrokenPdo finding, const Position& place, Diagnostics& diagnostics) {
  pdo.broken = true;
  if (on_by_default(pdo)) {
    diagnostics.error(finding.rule, place, std::move(finding.message), {}, std::move(finding.cause));
  } else {
    diagnostics.warning(finding.rule, place, finding.message + "; the PDO is disabled by default and left out", {},
                        std::move(finding.cause));
  }
}

void report_boolean_byte(const Pdo& pdo, const PdoEntry& entry, Diagnostics& diagnostics) {
  diagnostics.warning(
      "pdo-boolean-byte", entry.place,
      fmt::format("{} {} as 8 bits, but a BOOLEAN has 1; using the whole byte", maps(pdo, entry), named(*entry.object)),
      {}, "bytes");
}

void check_entry(const Device& device, const Options& options, Pdo& pdo, const PdoEntry& entry,
                 Diagnostics& diagnostics) {
  Finding finding =
      entry.dummy != nullptr ? check_dummy(device, pdo, entry) : check_object(device, options, pdo, entry);
  if (finding) {
    report_broken(pdo, std::move(*finding), entry.place, diagnostics);
  } else if (entry.object != nullptr && entry.dummy == nullptr && is_boolean_in_a_byte(entry)) {
    report_boolean_byte(pdo, entry, diagnostics);
  }
}

/// `entry 3, 6064h:00 "Position actual value"`
std::string labelled(const PdoEntry& entry) {
  const bool known = entry.dummy == nullptr && entry.object != nullptr;
  return fmt::format("entry {}, {}", entry.position,
                     known ? named(*entry.object) : entry_label(entry.index, entry.sub_index));
}

void check_size(Pdo& pdo, Diagnostics& diagnostics) {
  if (pdo.bits() > max_bits) {
    unsigned sum = 0;
    const auto over =
        std::ranges::find_if(pdo.entries, [&](const PdoEntry& entry) { return (sum += entry.bits) > max_bits; });
    report_broken(pdo,
                  {"pdo-size", fmt::format("{} maps {} bits; the maximum is {}, which {} exceeds", pdo_label(pdo),
                                           pdo.bits(), max_bits, labelled(*over))},
                  over->place, diagnostics);
  }
  if (pdo.entries.size() > max_mapped_objects) {
    const PdoEntry& over = pdo.entries[max_mapped_objects];
    report_broken(pdo,
                  {"pdo-entries", fmt::format("{} maps {} objects; the maximum is {}, which {} exceeds", pdo_label(pdo),
                                              pdo.entries.size(), max_mapped_objects, labelled(over))},
                  over.place, diagnostics);
  }
}

}  // namespace

void mark_broken_pdos(Device& device, const Options& options, Diagnostics& diagnostics) {
  for (Pdo& pdo : device.pdos) {
    for (const PdoEntry& entry : pdo.entries) check_entry(device, options, pdo, entry, diagnostics);
    check_size(pdo, diagnostics);
  }
}

bool is_broken_pdo_rule(std::string_view rule) {
  return std::ranges::find(rules, rule, &BrokenPdoRule::id) != std::end(rules);
}

}  // namespace edsc
