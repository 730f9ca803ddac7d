#include "rules/pdo_rules.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rules/pdo_defaults.hpp"

namespace edsc {
namespace {

using canopen::Mappable;

constexpr unsigned most_bits = 64;
constexpr std::size_t most_entries = 64;

/// What a rule says of one entry of a mapping; an empty message means nothing.
struct Finding {
  std::string_view rule;
  std::string message;
};

std::string quoted_object(const PdoEntry& entry) {
  return fmt::format("{} \"{}\"", entry_label(entry.index, entry.sub_index), entry.object->name);
}

/// Usual in vendors' files: one byte on the wire for a BOOLEAN.
bool is_boolean_in_a_byte(const PdoEntry& entry) {
  return entry.object->type->type == canopen::DataType::boolean && entry.bits == 8;
}

Finding check_dummy(const Device& device, const Pdo& pdo, const PdoEntry& entry) {
  if (pdo.direction == PdoDirection::transmit) {
    return {"pdo-dummy",
            fmt::format("{} maps the dummy {}, which only an RPDO may", pdo_label(pdo), entry.dummy->name)};
  }
  if (std::ranges::find(device.dummies, entry.index) == device.dummies.end()) {
    return {"pdo-dummy",
            fmt::format("{} maps the dummy {}, which [DummyUsage] does not allow", pdo_label(pdo), entry.dummy->name)};
  }
  const unsigned bits = entry.dummy->bits;
  if (entry.bits != bits) {
    return {"pdo-length", fmt::format("{} maps {} bits of the dummy {}, which has {}", pdo_label(pdo), entry.bits,
                                      entry.dummy->name, bits)};
  }
  return {};
}

Finding check_object(const Device& device, const Pdo& pdo, const PdoEntry& entry) {
  const std::string label = entry_label(entry.index, entry.sub_index);
  if (entry.object == nullptr) {
    const char* what = device.find(entry.index) == nullptr ? "object" : "sub-index";
    return {"pdo-object", fmt::format("{} maps {}: the device has no such {}", pdo_label(pdo), label, what)};
  }
  const Entry& object = *entry.object;
  if (!object.pdo_mapping) {
    return {"pdo-mappable",
            fmt::format("{} maps {}, which cannot be mapped (PDOMapping=0)", pdo_label(pdo), quoted_object(entry))};
  }
  const Mappable needed = pdo.direction == PdoDirection::receive ? Mappable::rpdo : Mappable::tpdo;
  if (!canopen::allows(object.mappable(), needed)) {
    return {"pdo-direction",
            fmt::format("{} maps {}, which {} may not carry (access {})", pdo_label(pdo), quoted_object(entry),
                        pdo.direction == PdoDirection::receive ? "an RPDO" : "a TPDO",
                        canopen::row_of(object.access).name)};
  }
  if (object.type->bits == 0) {
    return {"pdo-variable-length", fmt::format("{} maps {}, a {} of no fixed length", pdo_label(pdo),
                                               quoted_object(entry), object.type->name)};
  }
  if (is_boolean_in_a_byte(entry)) {
    return {"pdo-boolean-byte", fmt::format("{} maps {} as 8 bits; a BOOLEAN has 1. The whole byte is used",
                                            pdo_label(pdo), quoted_object(entry))};
  }
  if (object.type->bits != entry.bits) {
    return {"pdo-length", fmt::format("{} maps {} bits of {}, which is {} and has {}", pdo_label(pdo), entry.bits,
                                      quoted_object(entry), object.type->name, object.type->bits)};
  }
  return {};
}

/// A PDO that is wrong is an error; one that is off by default harms nobody until it is switched on.
void report_broken(Pdo& pdo, Finding finding, const Position& place, Diagnostics& diagnostics) {
  pdo.broken = true;
  if (on_by_default(pdo)) {
    diagnostics.error(finding.rule, place, std::move(finding.message));
  } else {
    diagnostics.warning(finding.rule, place, finding.message + "; it is off by default and left out");
  }
}

void check_entry(const Device& device, Pdo& pdo, const PdoEntry& entry, Diagnostics& diagnostics) {
  Finding finding = entry.dummy != nullptr ? check_dummy(device, pdo, entry) : check_object(device, pdo, entry);
  if (finding.rule.empty()) return;
  if (finding.rule == "pdo-boolean-byte") {
    diagnostics.warning(finding.rule, entry.place, std::move(finding.message));
  } else {
    report_broken(pdo, std::move(finding), entry.place, diagnostics);
  }
}

void check_size(Pdo& pdo, Diagnostics& diagnostics) {
  if (pdo.bits() > most_bits) {
    unsigned sum = 0;
    const auto over =
        std::ranges::find_if(pdo.entries, [&](const PdoEntry& entry) { return (sum += entry.bits) > most_bits; });
    report_broken(
        pdo, {"pdo-size", fmt::format("{} maps {} bits; its frame carries {}", pdo_label(pdo), pdo.bits(), most_bits)},
        over->place, diagnostics);
  }
  if (pdo.entries.size() > most_entries) {
    report_broken(pdo,
                  {"pdo-entries",
                   fmt::format("{} maps {} objects; {} is the most", pdo_label(pdo), pdo.entries.size(), most_entries)},
                  pdo.entries[most_entries].place, diagnostics);
  }
}

void check_pair(const Pdo& pdo, Diagnostics& diagnostics) {
  if (pdo.communication != nullptr && pdo.mapping != nullptr) return;
  const bool receive = pdo.direction == PdoDirection::receive;
  const std::uint16_t offset = static_cast<std::uint16_t>(pdo.number - 1);
  const auto missing = static_cast<std::uint16_t>(
      (pdo.communication == nullptr ? (receive ? 0x1400 : 0x1800) : (receive ? 0x1600 : 0x1A00)) + offset);
  diagnostics.warning("pdo-pair", pdo.position,
                      fmt::format("{} has no {} parameter {}", pdo_label(pdo),
                                  pdo.communication == nullptr ? "communication" : "mapping", index_label(missing)));
}

}  // namespace

void check_pdos(Device& device, Diagnostics& diagnostics) {
  for (Pdo& pdo : device.pdos) {
    check_pair(pdo, diagnostics);
    for (const PdoEntry& entry : pdo.entries) check_entry(device, pdo, entry, diagnostics);
    check_size(pdo, diagnostics);
  }
}

}  // namespace edsc
