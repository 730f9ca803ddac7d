/// The rule table: the faults that edsc reports in EDS, DCF and XDD files, with severity and clause. A finding names a
/// row and has a severity that the row allows; another id or severity does not compile.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>

namespace edsc {

enum class Severity : std::uint8_t { note, warning, error };

struct Rule {
  std::string_view id;
  Severity severity;  ///< of most findings
  std::string_view meaning;
  std::string_view source;      ///< clause of a CiA document, or "edsc" for a rule of this compiler
  Severity mildest = severity;  ///< if the value can still be read, or the fault is harmless

  [[nodiscard]] constexpr bool allows(Severity other) const { return other == severity || other == mildest; }
};

namespace rule_table {

inline constexpr auto note = Severity::note;
inline constexpr auto error = Severity::error;
inline constexpr auto warning = Severity::warning;

inline constexpr Rule rows[] = {
    // The file and its lines.
    Rule{"unreadable-file", error, "the file cannot be read", "edsc"},
    Rule{"empty-file", error, "the file has no section", "CiA 306-1, 4.2"},
    Rule{"binary-file", error, "the file is not text", "CiA 306-1, 4.2"},
    Rule{"xml-file", error, "the file is XML, not an EDS or DCF", "CiA 306-1, 4.2"},
    Rule{"stray-line", warning, "a line that is neither section, entry nor comment", "CiA 306-1, 4.2"},
    Rule{"hash-comment", warning, "a comment that begins with # instead of ;", "CiA 306-1, 4.2"},
    Rule{"unterminated-section", error, "a section header without ]", "CiA 306-1, 4.2"},
    Rule{"text-after-section", warning, "text after a section header", "CiA 306-1, 4.2"},
    Rule{"entry-outside-section", error, "an entry before the first section", "CiA 306-1, 4.2"},
    Rule{"long-line", note, "a line of more than 255 characters", "CiA 306-1, 4.2"},
    Rule{"encoding", note, "non-ASCII characters", "CiA 306-1, 4.2"},
    // [FileInfo], [DummyUsage] and [DeviceComissioning].
    Rule{"file-info", note, "missing section [FileInfo]", "CiA 306-1, 4.4"},
    Rule{"file-name", note, "FileName is missing, or is not the name of the file", "CiA 306-1, 4.4"},
    Rule{"file-version", note, "FileVersion or FileRevision is not a number of 0..255", "CiA 306-1, 4.4"},
    Rule{"eds-version", note, "EDSVersion is not of the form 4.0", "CiA 306-1, 4.4"},
    Rule{"file-date", note, "a date is not of the form mm-dd-yyyy", "CiA 306-1, 4.4"},
    Rule{"file-time", note, "a time is not of the form hh:mmAM", "CiA 306-1, 4.4"},
    Rule{"dummy-usage", warning, "DummyNNNN is not 0 or 1, or NNNN is not a basic data type", "CiA 306-1, 4.6.4"},
    Rule{"section-spelling", note, "a section that CiA 306 spells differently", "CiA 306-1, 5.3"},
    Rule{"commissioned-node-id", note, "a DCF without NodeID", "CiA 306-1, 5.3"},
    Rule{"commissioned-baud-rate", warning, "Baudrate is not a CANopen bit rate, or not one of the device",
         "CiA 306-1, 5.3"},
    // [DeviceInfo].
    Rule{"no-device-info", warning, "missing section [DeviceInfo]", "CiA 306-1, 4.5"},
    Rule{"device-info-flag", warning, "a key of [DeviceInfo] is not 0 or 1", "CiA 306-1, 4.5"},
    Rule{"baud-rates", warning, "the device does not support any bit rate", "CiA 306-1, 4.5"},
    Rule{"baud-rate-key", note, "a bit rate for which CiA 306 does not define a key", "CiA 306-1, 4.5"},
    Rule{"granularity", warning, "Granularity is not a number of 0..64", "CiA 306-1, 4.5"},
    Rule{"pdo-count", warning, "NrOfRXPDO or NrOfTXPDO differs from the number of PDOs described", "CiA 306-1, 4.5"},
    Rule{"vendor-number", warning, "VendorNumber differs from 1018h:01", "CiA 306-1, 4.5"},
    Rule{"product-number", warning, "ProductNumber differs from 1018h:02", "CiA 306-1, 4.5"},
    Rule{"revision-number", warning, "RevisionNumber differs from 1018h:03", "CiA 306-1, 4.5"},
    Rule{"lss-identity", warning, "LSS is supported, but 1018h is not complete", "CiA 305, 3"},
    Rule{"dynamic-channels", note, "dynamic channels are supported, but not described", "CiA 306-1, 4.8"},
    // Sections besides those of objects.
    Rule{"comments", warning, "Lines differs from the number of lines in [Comments]", "CiA 306-1, 4.7"},
    Rule{"tools", warning, "Items differs from the number of sections [ToolX]", "CiA 306-1, 4"},
    Rule{"dynamic-segment", warning, "a segment of [DynamicChannels] cannot be read, or the count differs",
         "CiA 306-1, 4.8"},
    Rule{"commissioning", warning, "a number of [DeviceComissioning] cannot be read", "CiA 306-1, 5.3"},
    Rule{"modules", warning, "NrOfEntries of [SupportedModules] differs from the number of modules", "CiA 306-1, 6"},
    Rule{"connected-module", error, "a connected module is not supported", "CiA 306-1, 6"},
    Rule{"module-count", error, "Count of a module's extension is not n or 0;m", "CiA 306-1, 6", warning},
    Rule{"module-object", error, "an object of a module already exists, or does not fit", "CiA 306-1, 6", warning},
    // XDD and XDC.
    Rule{"xml-syntax", error, "the file is not well-formed XML", "XML 1.0", warning},
    Rule{"xml-profile", error, "the XML is not a CANopen device profile", "CiA 311"},
    Rule{"xml-element", warning, "an element or attribute that edsc does not read", "CiA 311", note},
    // Sections and keys.
    Rule{"no-objects", error, "the file does not describe any object", "CiA 306-1, 4.6"},
    Rule{"duplicate-section", warning, "duplicate section; the first is used", "CiA 306-1, 4.2"},
    Rule{"duplicate-key", warning, "duplicate key in a section; the first is used", "CiA 306-1, 4.2"},
    Rule{"unknown-section", warning, "a section that CiA 306 does not define", "CiA 306-1, 4"},
    Rule{"section-name", error, "an object section's name is not an index or sub-index", "CiA 306-1, 4.6.2", warning},
    Rule{"unknown-key", warning, "a key that CiA 306 does not define", "CiA 306-1, 4"},
    Rule{"key-spelling", warning, "a key that CiA 306 spells differently", "CiA 306-1, 4"},
    Rule{"number", error, "a value is not a number", "CiA 306-1, 4.2"},
    // Object lists.
    Rule{"object-list", warning, "an object is in the wrong list, or listed twice", "CiA 306-1, 4.6.1"},
    Rule{"object-list-count", warning, "SupportedObjects differs from the number of entries", "CiA 306-1, 4.6.1"},
    Rule{"object-without-section", warning, "an object is listed but not described", "CiA 306-1, 4.6.1"},
    Rule{"object-not-listed", warning, "an object is described but not listed", "CiA 306-1, 4.6.1"},
    Rule{"mandatory-object", warning, "a mandatory object is missing", "CiA 301, 7.5.2"},
    Rule{"needed-object", warning, "an object requires another one, which is not implemented", "CiA 301, 7.5.2"},
    Rule{"error-control", warning, "neither heartbeat nor node guarding is implemented", "CiA 301, 7.2.8.2.2"},
    Rule{"default-sdo", warning, "additional SDO servers, but 1200h is missing", "CiA 301, 7.5.2.33"},
    Rule{"obsolete-object", note, "an object of an earlier CiA 301 that is now reserved", "CiA 301, 7.5.2"},
    Rule{"reserved-index", warning, "an object at C000h..FFFFh", "CiA 301, 7.4.1"},
    // The objects of the communication profile.
    Rule{"standard-object-type", note, "wrong object code for an object of CiA 301", "CiA 301, 7.5.2"},
    Rule{"standard-data-type", warning, "wrong data type for an object of CiA 301", "CiA 301, 7.5.2"},
    Rule{"standard-access", warning, "an access type that CiA 301 does not allow for the object", "CiA 301, 7.5.2"},
    Rule{"standard-sub-index", warning, "a sub-index that CiA 301 does not define for the object", "CiA 301, 7.5.2"},
    Rule{"standard-sub-index-missing", warning, "missing sub-index that CiA 301 requires for the object",
         "CiA 301, 7.5.2"},
    Rule{"heartbeat-consumer", warning, "1016h monitors an invalid node-ID, or a node twice", "CiA 301, 7.5.2.19"},
    Rule{"two-error-controls", warning, "heartbeat and node guarding are both enabled by default",
         "CiA 301, 7.2.8.2.2"},
    Rule{"sync-counter", warning, "1019h is 1 or above 240", "CiA 301, 7.5.2.22"},
    Rule{"error-behavior", warning, "1029h has a reserved value", "CiA 301, 7.5.2.32"},
    Rule{"storage-autonomous", warning, "1010h says that the device stores parameters by itself", "CiA 301, 7.5.2.13"},
    Rule{"storage-default", note, "a sub-index of 1010h or 1011h has no default value", "CiA 301, 7.5.2.13"},
    Rule{"storage-sub-index", note, "a manufacturer-specific sub-index of 1010h or 1011h without entries",
         "CiA 301, 7.5.2.13"},
    Rule{"storage-capability", warning, "1010h or 1011h has reserved bits set", "CiA 301, 7.5.2.13"},
    // Objects and their keys.
    Rule{"sub-object-without-object", warning, "sub-objects without a parent section, or of a VAR", "CiA 306-1, 4.6.2"},
    Rule{"object-type", warning, "ObjectType does not match the object", "CiA 301, 7.4.3"},
    Rule{"no-sub-objects", warning, "an ARRAY or RECORD without sub-objects", "CiA 306-1, 4.6.2"},
    Rule{"sub-number", warning, "SubNumber differs from the number of sub-objects", "CiA 306-1, 4.6.2"},
    Rule{"sub-index-0", warning, "an ARRAY or RECORD without sub-index 0", "CiA 301, 7.4.4"},
    Rule{"sub-index-0-type", warning, "sub-index 0 is not UNSIGNED8", "CiA 301, 7.4.4"},
    Rule{"sub-index-0-access", warning, "sub-index 0 is writable, or not readable", "CiA 301, 7.4.4"},
    Rule{"sub-index-0-value", warning, "sub-index 0 is not the highest sub-index", "CiA 301, 7.4.4"},
    Rule{"sub-index-255", warning, "sub-index FFh does not describe its object", "CiA 301, 7.4.4"},
    Rule{"compact-sub-obj", error, "CompactSubObj is not a number of 0..254", "CiA 306-1, 4.6.2.6", warning},
    Rule{"entry-count", warning, "NrOfEntries differs from the number of entries", "CiA 306-1, 4.6.2.6"},
    Rule{"compact-entry", warning, "an entry of [HHHHName], [HHHHValue] or [HHHHDenotation] for an unknown sub-index",
         "CiA 306-1, 4.6.2.6"},
    Rule{"compact-pdo", warning, "CompactPDO or the number of its PDOs is too large", "CiA 306-1, 4.5"},
    Rule{"object-links", warning, "ObjectLinks contains an invalid index", "CiA 306-1, 4.6.2"},
    Rule{"sub-index-base", warning, "sub-indices that look decimal: 10h without Ah, 16h without 10h",
         "CiA 306-1, 4.6.2"},
    Rule{"array-data-type", warning, "elements of an ARRAY have different data types", "CiA 301, 7.4.3"},
    Rule{"parameter-name", warning, "an object without a name", "CiA 306-1, 4.6.2"},
    Rule{"data-type", error, "DataType is missing or unknown", "CiA 301, 7.4.7", warning},
    Rule{"complex-data-type", warning, "an entry of a complex data type", "CiA 301, 7.4.7"},
    Rule{"type-definition", warning, "a DEFTYPE or DEFSTRUCT does not refer to a data type", "CiA 301, 7.4.7"},
    Rule{"type-length", note, "a DEFTYPE whose length differs from that of its basic type", "CiA 301, 7.4.7"},
    Rule{"access-type", error, "AccessType is missing or unknown", "CiA 306-1, 4.6.2", warning},
    Rule{"pdo-mapping", warning, "PDOMapping is not 0 or 1", "CiA 306-1, 4.6.2"},
    Rule{"mapping-of-no-length", warning, "PDOMapping=1 for a variable-length data type", "CiA 301, 7.4.7"},
    Rule{"process-data-not-mappable", note, "rwr or rww without PDOMapping=1", "CiA 306-1, 4.6.2"},
    Rule{"object-flags", warning, "ObjFlags has reserved bits", "CiA 306-1, 4.6.2"},
    Rule{"parameter-value", warning, "a ParameterValue in an EDS", "CiA 306-1, 5"},
    Rule{"node-id", error, "the node-ID is not in 1..127", "CiA 301, 7.2.2"},
    Rule{"device-info", warning, "a number of [DeviceInfo] cannot be read", "CiA 306-1, 4.5"},
    // Values.
    Rule{"number-format", error, "a value does not match its data type", "CiA 306-1, 4.6.2"},
    Rule{"number-range", error, "a value is out of the range of its data type", "CiA 306-1, 4.6.2", warning},
    Rule{"number-spelling", warning, "an unusual spelling of a number", "CiA 306-1, 4.2"},
    Rule{"node-id-formula", error, "not a valid $NODEID formula", "CiA 306-1, 4.6.2.3", warning},
    Rule{"octet-string", warning, "an OCTET_STRING that is not hexadecimal", "CiA 306-1, 4.6.2"},
    Rule{"string-quotes", warning, "a string in quotation marks", "CiA 306-1, 4.6.2"},
    Rule{"domain-value", warning, "a DOMAIN with a value", "CiA 306-1, 4.6.2"},
    Rule{"limits-order", warning, "LowLimit is above HighLimit", "CiA 306-1, 4.6.2"},
    Rule{"limit-formula", warning, "a node-ID-dependent limit", "CiA 306-1, 4.6.2"},
    Rule{"default-outside-limits", warning, "a default value outside its limits", "CiA 306-1, 4.6.2"},
    Rule{"implied-option", warning, "a writable PDO parameter that CiA 301 locks, because the COB-ID is not writable",
         "CiA 301, 7.5.2.36"},
    Rule{"never-writable", warning, "a writable entry that no write can change", "CiA 301, 7.5.2"},
    Rule{"default-rejected", warning, "a default value that the device itself rejects in a write", "CiA 301, 7.5.2"},
    Rule{"implied-default", note, "missing default value that CiA 301 implies", "CiA 301, 7.5.2"},
    Rule{"live-default", note, "a default value for a value that the device measures or counts", "CiA 306-1, 4.6.2"},
    Rule{"const-without-value", note, "a constant without DefaultValue", "CiA 306-1, 4.6.2"},
    // Names.
    Rule{"name-length", note, "a name of more than 241 characters", "CiA 306-1, 4.6.2"},
    Rule{"name-twice", note, "two names are the same in C++; the second gets a suffix", "edsc"},
    Rule{"name-empty", warning, "a name without letters and digits", "edsc"},
    Rule{"name-reserved", note, "a name is reserved in C++ or in the generated code", "edsc"},
    Rule{"name-digit", note, "a name begins with a digit", "edsc"},
    // COB-IDs.
    Rule{"cob-id-missing", note, "a COB-ID without default value, or 0", "CiA 301, 7.3.5"},
    Rule{"cob-id-frame", error, "a CAN-ID with more bits than its frame has", "CiA 301, 7.5.2.35"},
    Rule{"cob-id-restricted", error, "a restricted CAN-ID", "CiA 301, 7.3.5"},
    Rule{"cob-id-node-id", warning, "a CAN-ID of one node in an EDS for any node, or the node-ID is added twice",
         "CiA 301, 7.3.5"},
    Rule{"cob-id-twice", warning, "several services with the same CAN-ID", "CiA 301, 7.3.5"},
    Rule{"default-sdo-cob-id", warning, "the default SDO does not have its pre-defined CAN-IDs", "CiA 301, 7.5.2.33"},
    // PDOs.
    Rule{"pdo-pair", warning, "a PDO without communication or mapping parameter", "CiA 301, 7.5.2.35"},
    Rule{"pdo-object", error, "a PDO maps an object that does not exist", "CiA 301, 7.5.2.36", warning},
    Rule{"pdo-mappable", error, "a PDO maps an object that is not PDO-mappable", "CiA 301, 7.5.2.36", warning},
    Rule{"pdo-direction", error, "a PDO maps an object mappable only in the other direction", "CiA 301, 7.5.2.36",
         warning},
    Rule{"pdo-length", error, "a PDO maps an object with the wrong length", "CiA 301, 7.5.2.36", warning},
    Rule{"pdo-boolean-byte", warning, "a PDO maps a BOOLEAN as a byte", "CiA 301, 7.5.2.36"},
    Rule{"pdo-variable-length", error, "a PDO maps a variable-length data type", "CiA 301, 7.5.2.36", warning},
    Rule{"pdo-dummy", error, "a PDO maps a dummy entry that is not allowed", "CiA 301, 7.4.7.1", warning},
    Rule{"pdo-size", error, "a PDO is longer than 64 bits", "CiA 301, 7.5.2.36", warning},
    Rule{"pdo-entries", error, "a PDO maps more than 64 objects", "CiA 301, 7.5.2.36", warning},
    Rule{"pdo-mapping-count", warning, "a PDO maps more objects than its mapping parameter has sub-indices",
         "CiA 301, 7.5.2.36"},
    Rule{"pdo-mapping-gap", warning, "an empty entry within a PDO mapping", "CiA 301, 7.5.2.36"},
    Rule{"pdo-object-twice", warning, "a PDO maps an object twice", "CiA 301, 7.5.2.36"},
    Rule{"pdo-empty", note, "a valid PDO without mapped objects", "CiA 301, 7.5.2.36"},
    Rule{"pdo-granularity", warning, "a PDO maps a length that is not a multiple of Granularity", "CiA 306-1, 4.5"},
    Rule{"granularity-static", note, "Granularity 0, but a mapping can be changed", "CiA 306-1, 4.5"},
    Rule{"pdo-both-directions", note, "a TPDO maps an object that an RPDO also maps", "CiA 301, 7.5.2.38"},
    Rule{"pdo-transmission-type", warning, "a reserved transmission type", "CiA 301, 7.5.2.37"},
    Rule{"pdo-sync", warning, "a synchronous PDO, but 1005h is missing", "CiA 301, 7.5.2.5"},
    Rule{"pdo-remote", warning, "an RTR-only TPDO whose COB-ID does not allow RTR", "CiA 301, 7.5.2.37"},
    Rule{"pdo-inhibit-time", warning, "the inhibit time is longer than the event timer", "CiA 301, 7.5.2.37"},
    Rule{"pdo-time-unused", note, "an inhibit time or event timer that the transmission type does not use",
         "CiA 301, 7.5.2.37"},
    Rule{"pdo-compatibility-entry", note, "sub-index 4 of a PDO communication parameter", "CiA 301, 7.5.2.37"},
    Rule{"pdo-sync-start", warning, "a SYNC start value without effect", "CiA 301, 7.5.2.37"},
    // Multiplex PDOs.
    Rule{"mpdo-option", warning, "a multiplex PDO, but the option pdo.mpdo is not set", "CiA 301, 7.2.2.5"},
    Rule{"mpdo-transmission-type", warning, "a multiplex PDO whose transmission type is not 254 or 255",
         "CiA 301, 7.2.2.5"},
    Rule{"mpdo-list", warning, "an MPDO in source addressing mode without scanner or dispatching list",
         "CiA 301, 7.2.2.5"},
    Rule{"mpdo-list-object", warning, "a scanner or dispatching list contains an object that an MPDO cannot map",
         "CiA 301, 7.2.2.5"},
    Rule{"mpdo-second-producer", warning, "two TPDOs in source addressing mode", "CiA 301, 7.2.2.5"},
    // Device profiles.
    Rule{"device-type", note, "1000h without default value", "CiA 301, 7.5.2.1"},
    Rule{"io-kinds", warning, "1000h states other inputs or outputs than the device has", "CiA 401-1, 5.2"},
    Rule{"profile-401-object", warning, "an I/O module without the objects of its inputs or outputs", "CiA 401-1, 5"},
    Rule{"profile-402-object", warning, "a drive without an object that every drive has", "CiA 402-2, 8"},
    Rule{"profile-402-modes", note, "a drive without 6502h supported drive modes", "CiA 402-2, 8"},
    Rule{"profile-406-object", warning, "an encoder without an object that every encoder has", "CiA 406, 5"},
    Rule{"profile-data-type", warning, "wrong data type for an object of the device profile", "CiA 401, 402, 406"},
    // Networks.
    Rule{"network-syntax", error, "the network file is not JSON", "edsc"},
    Rule{"network-file", error, "an unknown or missing member, or an invalid value in the network file", "edsc"},
    Rule{"network-value", error, "a setting that the entry of the node cannot have", "edsc"},
    Rule{"network-signal", error, "a signal that cannot be assigned to PDOs, or two that set one entry", "edsc",
         warning},
    Rule{"network-node-id", error, "two nodes with one node-ID, or a DCF for another node-ID", "CiA 301, 7.3.5",
         warning},
    Rule{"network-bit-rate", error, "a node that does not support the bit rate, or a DCF for another one",
         "CiA 301, 5.3", warning},
    Rule{"network-length", warning, "a bus that is too long for its bit rate", "CiA 303-1, 4.3"},
    Rule{"network-lss-address", error, "two nodes with one LSS address", "CiA 305, 3"},
    Rule{"network-cob-id", error, "a CAN-ID with two transmitters, two services, or a restricted one",
         "CiA 301, 7.3.5"},
    Rule{"network-pdo-unsent", warning, "an RPDO that no node transmits", "CiA 301, 7.2.2", note},
    Rule{"network-pdo-unheard", warning, "a TPDO that no node receives", "CiA 301, 7.2.2", note},
    Rule{"network-pdo-length", error, "an RPDO that is longer than the TPDO that it receives", "CiA 301, 7.2.2"},
    Rule{"network-pdo-layout", warning, "an entry of an RPDO without an equal entry in the TPDO", "CiA 301, 7.2.2"},
    Rule{"network-pdo-type", warning, "an entry of an RPDO whose data type differs from that in the TPDO",
         "CiA 301, 7.2.2"},
    Rule{"network-pdo-unit", warning, "an entry of an RPDO whose unit differs from that in the TPDO", "edsc"},
    Rule{"network-pdo-mapping", error, "a mapping in the network file that the device does not allow",
         "CiA 301, 7.5.2.36"},
    Rule{"network-sync", error, "synchronous PDOs without exactly one SYNC producer", "CiA 301, 7.2.5", warning},
    Rule{"network-sync-counter", error, "nodes with different overflow values of the SYNC counter",
         "CiA 301, 7.5.2.22"},
    Rule{"network-sync-window", error, "synchronous PDOs that do not fit into the synchronous window or the period",
         "CiA 301, 7.2.5"},
    Rule{"network-time", warning, "TIME with two producers, or with consumers only", "CiA 301, 7.2.6"},
    Rule{"network-nmt-master", warning, "a network without exactly one NMT master", "CiA 301, 7.2.8"},
    Rule{"network-heartbeat", error,
         "a heartbeat consumer that cannot receive the heartbeat in time, or monitors no node", "CiA 301, 7.2.8.3.2",
         warning},
    Rule{"network-guarding", warning, "node guarding and heartbeat in one node, or guarding without a master for it",
         "CiA 301, 7.2.8.3.2"},
    Rule{"network-unmonitored", warning, "a node whose failure no other node detects", "CiA 301, 7.2.8.3.2"},
    Rule{"network-load", error, "a bus load above 100 percent, or above max_load", "edsc", warning},
    Rule{"network-response-time", error, "a frame that may be sent later than its deadline", "edsc"},
    Rule{"network-event-rate", note, "an event-driven TPDO whose rate nothing limits", "CiA 301, 7.5.2.37"},
    // This compiler.
    Rule{"options", error, "an unknown option or an invalid value in the options file", "edsc"},
    Rule{"options-syntax", error, "the options file is not JSON", "edsc"},
    Rule{"deprecated-option", warning, "an option by its name outside the group of its service", "edsc"},
    Rule{"allow-comment", warning, "an invalid comment \"; edsc:\"", "edsc"},
    Rule{"allow-unused", warning, "a silenced or allowed rule without a finding", "edsc"},
    Rule{"dictionary-size", error, "the dictionary is too large", "edsc"},
};

inline constexpr std::string_view fatal[] = {"unreadable-file", "empty-file",  "binary-file", "xml-file",
                                             "xml-syntax",      "xml-profile", "no-objects",  "dictionary-size"};

}  // namespace rule_table

/// The rules whose errors stop edsc even with `--keep-going`: no device can be resolved.
[[nodiscard]] constexpr std::span<const std::string_view> fatal_rules() { return rule_table::fatal; }

[[nodiscard]] constexpr std::span<const Rule> all_rules() { return rule_table::rows; }

/// Returns the rule with this id, or null.
[[nodiscard]] constexpr const Rule* find_rule(std::string_view id) {
  const auto* const at = std::ranges::find(rule_table::rows, id, &Rule::id);
  return at == std::end(rule_table::rows) ? nullptr : at;
}

namespace rule_table {
/// Names in the compiler's error for an unknown id, or a severity that the row does not allow.
void no_such_rule();
void severity_is_not_in_the_row_of_the_rule();

template <Severity severity, Severity... others>
inline constexpr bool is_one_of = ((severity == others) || ...);
}  // namespace rule_table

/// The id of a row whose findings may have each of these severities.
template <Severity... severities>
class RuleId {
 public:
  consteval RuleId(const char* id) : row_{find_rule(id)} {
    if (row_ == nullptr) rule_table::no_such_rule();
    if (!(row_->allows(severities) && ...)) rule_table::severity_is_not_in_the_row_of_the_rule();
  }
  /// A rule with several severities converts to a rule with some of them.
  template <Severity... others>
  requires(sizeof...(others) > sizeof...(severities) &&
           (rule_table::is_one_of<severities, others...> && ...)) constexpr RuleId(const RuleId<others...>& other)
      : row_{&other.row()} {}

  [[nodiscard]] constexpr const Rule& row() const { return *row_; }
  [[nodiscard]] constexpr std::string_view id() const { return row_->id; }

 private:
  const Rule* row_;
};

using ErrorRule = RuleId<Severity::error>;
using WarningRule = RuleId<Severity::warning>;
using NoteRule = RuleId<Severity::note>;
using AnyRule = RuleId<>;

}  // namespace edsc
