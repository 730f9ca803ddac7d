/// The rules of `edsc diff`: the kinds of changes between two versions of a device, and what each breaks.
#pragma once

#include "rules/rule.hpp"

namespace edsc {
namespace rule_table {

inline constexpr unsigned none = 0;
inline constexpr unsigned master = 1;
inline constexpr unsigned pdo = 2;
inline constexpr unsigned source = 4;
inline constexpr unsigned storage = 8;

/// `what`: the changed property; `reason`: why the change is breaking, or why not.
constexpr Rule change(std::string_view id, unsigned broken, std::string_view what, std::string_view reason) {
  const Severity severity = broken == none ? note : error;
  const Breaks breaks{(broken & master) != 0, (broken & pdo) != 0, (broken & source) != 0, (broken & storage) != 0};
  return {id, severity, what, "edsc", severity, reason, false, breaks};
}

inline constexpr Rule changes[] = {
    // The device.
    change("identity", master, "identity",
           "a master that checks device type, vendor or product (1F84h to 1F86h) rejects it"),
    change("revision-major", master, "major revision", "it states that the CANopen behaviour has changed"),
    change("revision-unchanged", master, "major revision",
           "a breaking change requires a higher one in 1018h:03, bits 31..16; a master that checks it (1F88h) cannot "
           "tell the devices apart"),
    change("revision-minor", none, "minor revision",
           "the major revision, which counts changes of the CANopen behaviour, stays"),
    change("device-name", none, "device name", "it is for people, not for programs"),
    change("node-id", master | pdo, "node-ID", "the device uses other COB-IDs"),
    change("dummy-removed", master | source, "dummy mapping removed", "an RPDO mapping with this dummy is rejected"),
    change("dummy-added", none, "dummy mapping added", "not used yet"),
    // Objects and entries.
    change("object-removed", master | source, "object removed", "an access is aborted with 0602 0000h"),
    change("object-added", none, "object added", "not used yet"),
    change("object-type", master | source, "object code", "sub-indices and generated types change"),
    change("entry-removed", master | source, "sub-index removed", "an access is aborted with 0609 0011h"),
    change("entry-added", none, "sub-index added", "not used yet"),
    change("identifier", source, "C++ identifier", "code with the old one does not compile"),
    change("name", none, "name", "the C++ identifier is the same"),
    change("data-type", master | source, "data type", "values have another length or meaning"),
    change("access-reduced", master | source, "access", "an access that was allowed is aborted"),
    change("access-extended", none, "access", "all accesses that were allowed still are"),
    change("access-other", none, "access", "SDO access is unchanged"),
    change("mapping-reduced", master | pdo | source, "PDO mapping", "a PDO that maps it is rejected"),
    change("mapping-extended", none, "PDO mapping", "all mappings that were possible still are"),
    change("limit-narrowed", master | source, "limit", "a value that was accepted is rejected"),
    change("limit-widened", none, "limit", "all values that were accepted still are"),
    change("limit-read-only", none, "limit", "the entry is not writable"),
    change("domain-file", none, "file of a DOMAIN", "its bytes differ, its access is the same"),
    change("default-value", none, "default", "a master that configures what it needs is not affected"),
    change("service-cob-id", master, "CAN-ID", "the service uses another CAN-ID"),
    change("service-disabled", master, "bit 31 (does not exist) set",
           "the service does not exist until a master enables it"),
    change("service-enabled", none, "bit 31 (does not exist) cleared", "the service did not exist before"),
    change("sync-started", master | pdo, "bit 30 (produces SYNC) set",
           "with another SYNC producer on the bus, synchronous PDOs are sent and applied at wrong times"),
    change("sync-stopped", master | pdo, "bit 30 (produces SYNC) cleared",
           "no synchronous PDO is sent or applied without SYNC"),
    change("time-started", master, "bit 30 (produces TIME) set",
           "another TIME producer on the bus sets the clocks to another time"),
    change("time-stopped", master, "bit 30 (produces TIME) cleared", "consumers of its TIME do not receive it"),
    change("time-ignored", master, "bit 31 (consumes TIME) cleared", "a master does not set the clock of the device"),
    change("time-consumed", none, "bit 31 (consumes TIME) set", "a master that does not send TIME is not affected"),
    change("frame-format", master | pdo, "bit 29 (29-bit CAN-ID)",
           "frames with 11-bit and 29-bit CAN-ID are different frames"),
    change("sdo-dynamic", none, "bit 30 (assigned dynamically)", "the CAN-ID is the same"),
    change("cob-id-flag", none, "unused flag bit", "no service uses it"),
    change("heartbeat-slowed", master, "heartbeat time", "a consumer with the old time reports a lost node"),
    // The meaning of values.
    change("quantity-changed", master | source, "unit or scale", "a raw number is another physical value"),
    change("quantity-spelled", none, "unit", "raw numbers are the same physical values"),
    change("quantity-added", none, "unit or scale added", "raw numbers are the same"),
    change("quantity-removed", source, "unit or scale removed", "code with its unit does not compile"),
    change("value-changed", master | source, "number of a named value",
           "a program with the old number means another value"),
    change("value-renamed", source, "name of a value", "code with the old name does not compile"),
    change("value-removed", source, "named value removed", "code with the name does not compile"),
    change("value-added", none, "named value added", "not used yet"),
    change("values-closed", master | source, "closed values", "a number without a name is rejected"),
    change("values-opened", none, "open values", "all values that were accepted still are"),
    change("field-moved", master | source, "bits of a field", "a program with the old bits reads or writes others"),
    change("field-renamed", source, "name of a field", "code with the old name does not compile"),
    change("field-removed", source, "field removed", "code with the name does not compile"),
    change("field-added", none, "field added", "not used yet"),
    change("mode-object", master | source, "object that selects the mode of bits", "the old object does not select it"),
    change("mode-values", master | source, "values of a mode", "its bits apply to other values of the object"),
    change("error-code-text", none, "error code", "the number is the same"),
    change("error-code-removed", none, "name of an error code removed", "its error class still has a text"),
    change("error-code-added", none, "name of an error code added", "programs know its error class"),
    // PDOs.
    change("pdo-removed", master | pdo | source, "PDO removed", "it is no longer sent or received"),
    change("pdo-added", none, "PDO added", "not used yet"),
    change("pdo-disabled", pdo, "PDO disabled by default (bit 31 set)",
           "not sent or received until a master enables it"),
    change("pdo-enabled", none, "PDO enabled by default (bit 31 cleared)", "its frames are new on the bus"),
    change("pdo-cob-id", master | pdo, "CAN-ID", "the partner uses the old one"),
    change("rtr-disabled", pdo, "bit 30 (no remote frames) set", "a remote frame for the PDO is not answered"),
    change("rtr-enabled", none, "bit 30 (no remote frames) cleared", "remote frames are answered, but not required"),
    change("pdo-transmission", pdo, "transmission type", "it is sent or applied at other times"),
    change("pdo-timing", none, "PDO timing", "the contents are the same"),
    change("pdo-layout", master | pdo | source, "layout", "the partner reads other values from the frame"),
    change("pdo-layout-extended", none, "layout", "all values that were in the frame keep their position"),
    // Stored parameters.
    change("stored-value-lost", storage, "stored value lost",
           "a device that has stored it starts with the default value and sends EMCY 6300h, unless its application "
           "converts the value"),
};

}  // namespace rule_table

inline constexpr std::span<const Rule> change_rules{rule_table::changes};

using ChangeRule = RuleOf<rule_table::changes>;

}  // namespace edsc
