#include "device/pdo/resolve_pdos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "device/pdo/pdo_defaults.hpp"
#include "pdo/mapping_fault.hpp"
#include "text/counted.hpp"

namespace edsc {
namespace {

/// Why a PDO does not have a valid layout.
struct BrokenPdo {
  MappingFault fault;
  std::string message;
  std::string cause = {};  ///< the same for all PDOs with the same fault
};

/// `TPDO 1 entry 2 maps`
std::string maps(const Pdo& pdo, const PdoEntry& entry) {
  return fmt::format("{} entry {} maps", pdo_label(pdo), entry.position);
}

std::string_view name_of(PdoDirection direction) { return direction == PdoDirection::receive ? "RPDO" : "TPDO"; }

BrokenPdo broken_dummy(MappingFault fault, const Pdo& pdo, const PdoEntry& entry) {
  const std::string begin = maps(pdo, entry);
  const std::string dummy = fmt::format("the dummy {} {}", index_label(entry.index), entry.dummy->name);
  switch (fault) {
    case MappingFault::dummy_in_tpdo: return {fault, fmt::format("{} {}, which only an RPDO can map", begin, dummy)};
    case MappingFault::dummy_not_allowed:
      return {fault, fmt::format("{} {}, which [DummyUsage] does not allow", begin, dummy)};
    case MappingFault::variable_length: return {fault, fmt::format("{} {}, a variable-length data type", begin, dummy)};
    default:
      return {fault,
              fmt::format("{} {} of {}, which has {}", begin, counted(entry.bits, "bit"), dummy, entry.dummy->bits)};
  }
}

BrokenPdo broken_string(MappingFault fault, const Pdo& pdo, const PdoEntry& entry, const MappableObject& object) {
  const std::string begin =
      fmt::format("{} {} of {}", maps(pdo, entry), counted(entry.bits, "bit"), named(*entry.object));
  if (fault == MappingFault::part_of_a_byte) {
    return {fault, fmt::format("{}, a {}; expected a multiple of 8 bits", begin, entry.object->type->name)};
  }
  return {fault,
          fmt::format("{}, which is {} and holds {}", begin, entry.object->type->name, *object.string_octets * 8)};
}

BrokenPdo broken_object(MappingFault fault, const Pdo& pdo, const PdoEntry& entry, const MappableObject& object) {
  const std::string begin = maps(pdo, entry);
  const std::string_view pdos = name_of(pdo.direction);
  const std::string_view access = canopen::row_of(entry.object->access).name;
  switch (fault) {
    case MappingFault::not_mappable:
      return {fault, fmt::format("{} {}, which is not PDO-mappable (PDOMapping=0)", begin, named(*entry.object)),
              "PDOMapping=0"};
    case MappingFault::wrong_direction:
      return {fault,
              fmt::format("{} {}, which is not {}-mappable (AccessType {})", begin, named(*entry.object), pdos, access),
              fmt::format("{} in {}s", access, pdos)};
    case MappingFault::variable_length:
      return {fault, fmt::format("{} {}, a variable-length {}", begin, named(*entry.object), entry.object->type->name)};
    default: break;
  }
  if (object.type->kind == canopen::DataClass::string) return broken_string(fault, pdo, entry, object);
  return {fault, fmt::format("{} {} of {}, which is {} and has {}", begin, counted(entry.bits, "bit"),
                             named(*entry.object), object.type->name, object.type->bits)};
}

/// Whether the device has objects in the same block of 4096 indices, such as 6000h to 6FFFh. If it has none, the file
/// describes a part of its objects only.
bool has_objects_near(const Device& device, std::uint16_t index) {
  const auto block = [](std::uint16_t one) { return one >> 12U; };
  return std::ranges::any_of(device.objects, [&](const Object& object) { return block(object.index) == block(index); });
}

BrokenPdo broken_by_missing(const Device& device, const Pdo& pdo, const PdoEntry& entry) {
  const Object* object = device.find(entry.index);
  const std::string label = entry_label(entry.index, entry.sub_index);
  const std::string begin = maps(pdo, entry);
  return {MappingFault::unknown_object,
          object == nullptr
              ? fmt::format("{} {}, which does not exist", begin, label)
              : fmt::format("{} {} of \"{}\", a sub-index that does not exist", begin, label, object->name),
          object != nullptr                       ? label
          : has_objects_near(device, entry.index) ? index_label(entry.index)
                                                  : "none near"};
}

/// An invalid PDO is an error; if it is disabled by default, it is harmless until it is enabled.
void report_broken(Pdo& pdo, BrokenPdo finding, const Position& place, Diagnostics& diagnostics) {
  pdo.broken = true;
  if (on_by_default(pdo)) {
    diagnostics.error(rule_of(finding.fault), place, std::move(finding.message), {}, std::move(finding.cause));
  } else {
    diagnostics.warning(rule_of(finding.fault), place, finding.message + "; the PDO is disabled by default and ignored",
                        {}, std::move(finding.cause));
  }
}

void report_boolean_byte(const Pdo& pdo, const PdoEntry& entry, Diagnostics& diagnostics) {
  diagnostics.warning(
      "pdo-boolean-byte", entry.place,
      fmt::format("{} {} as 8 bits, but a BOOLEAN has 1; using the whole byte", maps(pdo, entry), named(*entry.object)),
      {}, "bytes");
}

/// What the mapping of an existing object says for certain: that the object can be mapped, and its length.
void offer_mapping(MappingFault fault, const PdoEntry& entry, const MappableObject& object, Diagnostics& diagnostics) {
  const std::string label = entry_label(entry.index, entry.sub_index);
  if (fault == MappingFault::not_mappable) {
    diagnostics.offer_key(rule_of(fault), entry.object->mapping_position, "PDOMapping", "1",
                          fmt::format("a PDO maps {} by default", label));
  } else if (fault == MappingFault::wrong_length && object.type->bits > 0) {
    diagnostics.offer_value(rule_of(fault), entry.place,
                            fmt::format("0x{:04X}{:02X}{:02X}", entry.index, entry.sub_index, object.type->bits),
                            fmt::format("{} has {} bits", label, object.type->bits));
  }
}

void check_entry(const Device& device, const Options& options, Pdo& pdo, const PdoEntry& entry,
                 Diagnostics& diagnostics) {
  std::optional<MappableObject> object;
  if (entry.object != nullptr) object = mappable_object(*entry.object, options);
  const auto fault = fault_of(pdo.direction, entry, object ? &*object : nullptr, device.dummies);
  if (fault) {
    report_broken(pdo,
                  entry.dummy != nullptr ? broken_dummy(*fault, pdo, entry)
                  : object               ? broken_object(*fault, pdo, entry, *object)
                                         : broken_by_missing(device, pdo, entry),
                  entry.place, diagnostics);
    if (object && entry.dummy == nullptr) offer_mapping(*fault, entry, *object, diagnostics);
  } else if (entry.dummy == nullptr && is_boolean_in_a_byte(entry, *object->type)) {
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
  const PdoLimits& limits = classical_can;
  const auto over = std::ranges::find_if_not(pdo.entries, [&](const PdoEntry& one) { return one.is_within(limits); });
  if (over != pdo.entries.end()) {
    report_broken(
        pdo,
        {MappingFault::too_many_bits, fmt::format("{} maps {} bits; the maximum is {}, which {} exceeds",
                                                  pdo_label(pdo), pdo.bits(), limits.bits(), labelled(*over))},
        over->place, diagnostics);
  }
  if (pdo.entries.size() > limits.objects) {
    const PdoEntry& first_over = pdo.entries[limits.objects];
    report_broken(pdo,
                  {MappingFault::too_many_objects,
                   fmt::format("{} maps {} objects; the maximum is {}, which {} exceeds", pdo_label(pdo),
                               pdo.entries.size(), limits.objects, labelled(first_over))},
                  first_over.place, diagnostics);
  }
}

}  // namespace

void mark_broken_pdos(Device& device, const Options& options, Diagnostics& diagnostics) {
  for (Pdo& pdo : device.pdos) {
    for (const PdoEntry& entry : pdo.entries) check_entry(device, options, pdo, entry, diagnostics);
    check_size(pdo, diagnostics);
  }
}

}  // namespace edsc
