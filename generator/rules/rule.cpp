#include "rules/rule.hpp"

#include <algorithm>
#include <array>

namespace edsc {
namespace {

constexpr auto error = Severity::error;
constexpr auto warning = Severity::warning;

constexpr std::array rules = {
    // The file and its lines.
    Rule{"unreadable-file", error, "the file cannot be read", "edsc"},
    Rule{"empty-file", error, "the file has no section", "CiA 306-1, 4.2"},
    Rule{"binary-file", error, "the file is not text", "CiA 306-1, 4.2"},
    Rule{"xml-file", error, "the file is XML, not an EDS or DCF", "CiA 306-1, 4.2"},
    Rule{"stray-line", warning, "a line that is neither section, entry nor comment", "CiA 306-1, 4.2"},
    Rule{"hash-comment", warning, "a comment that begins with # and not with ;", "CiA 306-1, 4.2"},
    Rule{"unterminated-section", error, "a section header without ]", "CiA 306-1, 4.2"},
    Rule{"text-after-section", warning, "text behind the ] of a section header", "CiA 306-1, 4.2"},
    Rule{"entry-outside-section", error, "an entry before the first section", "CiA 306-1, 4.2"},
    // Sections and keys.
    Rule{"no-objects", error, "no section describes an object", "CiA 306-1, 4.6"},
    Rule{"duplicate-section", warning, "a section stands there twice: the first counts", "CiA 306-1, 4.2"},
    Rule{"duplicate-key", warning, "a key stands twice in a section: the first counts", "CiA 306-1, 4.2"},
    Rule{"unknown-section", warning, "a section that CiA 306 does not know", "CiA 306-1, 4"},
    Rule{"section-not-used", warning, "a section that edsc does not use", "edsc"},
    Rule{"section-name", error, "an object section's name is not an index or sub-index", "CiA 306-1, 4.6.2"},
    Rule{"unknown-key", warning, "a key that CiA 306 does not know", "CiA 306-1, 4"},
    Rule{"key-spelling", warning, "a key that is spelled otherwise in CiA 306", "CiA 306-1, 4"},
    Rule{"number", error, "a number is wanted", "CiA 306-1, 4.2"},
    // Object lists.
    Rule{"object-list", warning, "an object stands in the wrong list, or in two", "CiA 306-1, 4.6.1"},
    Rule{"object-list-count", warning, "SupportedObjects differs from the number of entries", "CiA 306-1, 4.6.1"},
    Rule{"object-without-section", warning, "an object is listed but not described", "CiA 306-1, 4.6.1"},
    Rule{"object-not-listed", warning, "an object is described but not listed", "CiA 306-1, 4.6.1"},
    Rule{"mandatory-object", warning, "an object that every device has is missing", "CiA 301, 7.5.2"},
    // Objects and their keys.
    Rule{"sub-object-without-object", warning, "sub-objects without their object", "CiA 306-1, 4.6.2"},
    Rule{"object-type", warning, "ObjectType does not fit", "CiA 301, 7.4.3"},
    Rule{"no-sub-objects", warning, "an ARRAY or RECORD without sub-objects", "CiA 306-1, 4.6.2"},
    Rule{"sub-number", warning, "SubNumber differs from the number of sub-objects", "CiA 306-1, 4.6.2"},
    Rule{"sub-index-0", warning, "an ARRAY or RECORD without sub-index 0", "CiA 301, 7.4.4"},
    Rule{"compact-sub-obj", error, "CompactSubObj is not a number of 0..254", "CiA 306-1, 4.6.2.6"},
    Rule{"entry-count", warning, "NrOfEntries differs from the number of entries", "CiA 306-1, 4.6.2.6"},
    Rule{"parameter-name", warning, "an object without a name", "CiA 306-1, 4.6.2"},
    Rule{"data-type", error, "DataType is missing or unknown", "CiA 301, 7.4.7"},
    Rule{"complex-data-type", warning, "an entry of a complex data type", "CiA 301, 7.4.7"},
    Rule{"access-type", error, "AccessType is missing or unknown", "CiA 306-1, 4.6.2"},
    Rule{"pdo-mapping", warning, "PDOMapping is not 0 or 1", "CiA 306-1, 4.6.2"},
    Rule{"parameter-value", warning, "a ParameterValue in an EDS", "CiA 306-1, 5"},
    Rule{"node-id", error, "the node-ID is not in 1..127", "CiA 301, 7.2.2"},
    Rule{"device-info", warning, "a number of [DeviceInfo] cannot be read", "CiA 306-1, 4.5"},
    // Values.
    Rule{"number-format", error, "a value is not of its type", "CiA 306-1, 4.6.2"},
    Rule{"number-range", error, "a value does not fit into its type", "CiA 306-1, 4.6.2"},
    Rule{"number-spelling", warning, "an unusual spelling of a number", "CiA 306-1, 4.2"},
    Rule{"node-id-formula", error, "not a formula of $NODEID and a number", "CiA 306-1, 4.6.2.3"},
    Rule{"octet-string", warning, "an OCTET_STRING that is not hexadecimal", "CiA 306-1, 4.6.2"},
    Rule{"domain-value", warning, "a DOMAIN with a value", "CiA 306-1, 4.6.2"},
    Rule{"limits-order", warning, "LowLimit is above HighLimit", "CiA 306-1, 4.6.2"},
    Rule{"limit-formula", warning, "a limit that follows the node-ID", "CiA 306-1, 4.6.2"},
    Rule{"default-outside-limits", warning, "a default beyond its limits", "CiA 306-1, 4.6.2"},
    // PDOs.
    Rule{"pdo-pair", warning, "a PDO lacks one of its two parameters", "CiA 301, 7.5.2.35"},
    Rule{"pdo-object", error, "a PDO maps what the device does not have", "CiA 301, 7.5.2.36"},
    Rule{"pdo-mappable", error, "a PDO maps an object that cannot be mapped", "CiA 301, 7.5.2.36"},
    Rule{"pdo-direction", error, "a PDO maps an object of the other direction", "CiA 301, 7.5.2.36"},
    Rule{"pdo-length", error, "a PDO maps an object with another length", "CiA 301, 7.5.2.36"},
    Rule{"pdo-boolean-byte", warning, "a PDO maps a BOOLEAN as a byte", "CiA 301, 7.5.2.36"},
    Rule{"pdo-variable-length", error, "a PDO maps a value of no fixed length", "CiA 301, 7.5.2.36"},
    Rule{"pdo-dummy", error, "a PDO maps a dummy that is not allowed", "CiA 301, 7.4.7.1"},
    Rule{"pdo-size", error, "a PDO is longer than 64 bits", "CiA 301, 7.5.2.36"},
    Rule{"pdo-entries", error, "a PDO maps more than 64 objects", "CiA 301, 7.5.2.36"},
    // This compiler.
    Rule{"options", error, "the options file says what edsc does not know", "edsc"},
    Rule{"options-syntax", error, "the options file is not JSON", "edsc"},
    Rule{"dictionary-size", error, "the dictionary is too large", "edsc"},
};

}  // namespace

std::span<const Rule> all_rules() { return rules; }

const Rule* find_rule(std::string_view id) {
  const auto at = std::ranges::find(rules, id, &Rule::id);
  return at == rules.end() ? nullptr : &*at;
}

}  // namespace edsc
