#include "conform/requirements.hpp"

namespace edsc::conform {
namespace {

// clang-format off
constexpr RequirementRow requirement_rows[] = {
    {"CiA 306-1", "The EDS of the device has no errors", "1.0", ""},
    {"CiA 301, 7.4.5", "Each entry that the EDS declares readable can be read, with the size of its data type", "4.1 4.7", ""},
    {"CiA 301, 7.4.5", "Each entry that the EDS declares writable can be written; the others refuse a write", "4.3 4.9 4.10 4.11 4.12 2.3", ""},
    {"CiA 301, 7.4.5", "An entry that is write-only refuses to be read", "4.4 2.4", ""},
    {"CiA 301, 7.4.4", "Sub-index FFh, if it exists, has object code and data type of the object", "4.5", ""},
    {"CiA 306-1, 4.6.2", "Constants have their DefaultValue, and limits are enforced", "4.2 4.6 4.8", ""},
    {"CiA 301, 7.4.4", "Sub-index 0 of an ARRAY or RECORD has the highest sub-index", "4.2 4.8", ""},
    {"CiA 301, 7.2.4.2", "A device has at least the default SDO server, in Pre-operational and Operational", "2.1 9.2 9.3", ""},
    {"CiA 301, 7.2.4.2", "What is written to a parameter can be read back", "2.2", ""},
    {"CiA 301, 7.2.4.3.3", "An expedited download is confirmed with the multiplexer and zeros", "2.2 2.110", ""},
    {"CiA 301, 7.2.4.3.4", "A download in segments: toggle bit, size and end are checked", "2.14 2.15 2.108", ""},
    {"CiA 301, 7.2.4.3.4", "The answer to a download segment has the toggle bit of the request and zeros", "2.14 2.15 2.110", ""},
    {"CiA 301, 7.2.4.3.6", "An upload of up to four bytes may be expedited; n is right if s is 1", "2.1 2.13", ""},
    {"CiA 301, 7.2.4.3.6", "The size that an answer to initiate upload indicates is the size of the value", "2.16 2.18", ""},
    {"CiA 301, 7.2.4.3.7", "The segments of an upload alternate the toggle bit, from 0 on, and the last one is marked", "2.16 2.17 2.18 2.111", ""},
    {"CiA 301, 7.2.4.3.7", "A segment that is requested or sent without a transfer is refused", "2.101 2.102", ""},
    {"CiA 301, 7.2.4.2", "A transfer can be initiated at any time; one that was not completed writes nothing", "2.106 2.107", ""},
    {"CiA 301, 7.2.4.3", "An SDO has eight bytes", "2.105", ""},
    {"CiA 301, 7.2.4.3.8", "Block download: block size 1 to 127, confirmation of the last segment in sequence, end with the number of unused bytes", "2.20 2.21 2.24 2.25", "the confirmation after a lost segment: CiA 301 does not say when a server sends it"},
    {"CiA 301, 7.2.4.3.11", "A block download with a wrong CRC is refused", "2.24 2.25", ""},
    {"CiA 301, 7.2.4.3.12", "Block upload: segments in sequence, a new block after each confirmation, repetition after a lost block", "2.19 2.22 2.23", ""},
    {"CiA 301, 7.2.4.3.12", "A block size other than 1 to 127 and an invalid confirmation are refused", "2.26 2.27", ""},
    {"CiA 301, 7.2.4.3.16", "The CRC of a block upload is the CRC of the value", "2.23", ""},
    {"CiA 301, 7.2.4.3.8", "A command of a block transfer without a transfer is refused", "2.103", ""},
    {"CiA 301, 7.2.4.3.12", "A server may send a short value by the upload protocol instead of a block (pst)", "", "optional for the server; the test does not request it"},
    {"CiA 301, 7.2.4.3.17", "Aborts have the multiplexer of the request and a code of table 22", "2.109 2.5 2.6 2.7 2.10 2.11 2.8 2.9", ""},
    {"CiA 301, 7.2.4.3.17", "An abort of the client ends the transfer and is not answered", "2.104", ""},
    {"CiA 301, 7.2.4.3.17", "A server may abort a transfer whose client is silent", "12.101", "CiA 301 does not specify a time"},
    {"CiA 301, 7.5.2.33", "1200h has the COB-IDs of the default SDO; the objects of other servers are as in the EDS", "2.12 2.28 2.29", ""},
    {"CiA 301, 7.5.2.34", "SDO client parameters are as in the EDS and are stored", "2.30", ""},
    {"CiA 301, 7.5.2.33", "An additional SDO server serves the CAN-IDs of its parameter", "", "the test uses one client; a second SDO channel needs CAN-IDs that are free on the bus"},
    {"CiA 301, 7.2.2.2", "Synchronous RPDOs are processed at the next SYNC", "3.107", ""},
    {"CiA 301, 7.2.2.2", "Event-driven RPDOs are processed on reception", "3.101 3.22", ""},
    {"CiA 301, 7.2.2.5.1", "An RPDO that is too short is not processed and is reported with 8210h; of a longer one the first bytes are used, or 8220h is sent", "3.104 3.105 5.4", ""},
    {"CiA 301, 7.2.2.5.1", "A TPDO has the length and the values of its mapping", "3.3 3.4 3.5 3.6 3.22", ""},
    {"CiA 301, 7.5.2.35", "The communication parameters of RPDOs are as in the EDS, with legal values; reserved transmission types are refused", "3.1 3.111", ""},
    {"CiA 301, 7.5.2.37", "The communication parameters of TPDOs are as in the EDS, with legal values; sub-index 4 does not exist; reserved transmission types are refused", "3.2 3.111", ""},
    {"CiA 301, 7.5.2.35", "Bit 31 of the COB-ID disables an RPDO; bits 0 to 29 do not change while it is valid", "3.106 3.108", ""},
    {"CiA 301, 7.5.2.37", "Bits 0 to 29 of the COB-ID and the inhibit time of a TPDO do not change while it is valid", "3.109 3.110", ""},
    {"CiA 301, 7.5.2.35", "An RPDO whose event timer elapses is indicated to the application", "", "the indication is local; EMCY 8250h is not required"},
    {"CiA 301, 7.5.2.37", "Types 0 to 240: a TPDO at the SYNC after an event, or at each n-th SYNC", "3.6 3.7 6.3", ""},
    {"CiA 301, 7.5.2.37", "Types 252 and 253: a TPDO on a remote frame, with the values of the last SYNC or the present ones", "3.3", ""},
    {"CiA 301, 7.5.2.37", "Types 254 and 255: a TPDO on an event, with inhibit time and event timer", "3.4 3.5", ""},
    {"CiA 301, 7.5.2.37", "Bit 30 of the COB-ID forbids remote frames", "3.3", ""},
    {"CiA 301, 7.5.2.37", "A TPDO with a SYNC start value waits for the SYNC with this counter", "3.8", ""},
    {"CiA 301, 7.5.2.36", "Mapped objects exist, may be mapped, and have at most 64 bits", "3.21 3.25 3.26 3.28 3.29 3.31 3.32", ""},
    {"CiA 301, 7.5.2.36", "A mapping changes by the procedure: disable, sub-index 0 = 0, entries, sub-index 0, enable", "3.22 3.23 3.24 3.27 3.30 3.33", ""},
    {"CiA 301, 7.5.2.36", "MPDOs: source and destination address mode, scanner and dispatching list", "", "not in the list of services that the test covers: the tests of edsc's runtime have it"},
    {"CiA 301, 7.2.5", "SYNC starts the cycle of synchronous PDOs", "3.6 3.7 3.8 3.12 3.13 3.14 3.18 3.19 3.20 3.107 6.3", ""},
    {"CiA 301, 7.5.2.5", "1005h has the default COB-ID of SYNC; bit 30 selects the producer; bits 0 to 29 do not change while it produces", "6.1 6.4 6.103", ""},
    {"CiA 301, 7.5.2.6", "A producer sends SYNC in each period of 1006h, none with 0, and the first within one period", "6.2 6.4", ""},
    {"CiA 301, 7.5.2.7", "Synchronous PDOs are sent and processed within the window of 1007h", "3.6 6.10", "the reaction of a device to a SYNC window that has elapsed is optional"},
    {"CiA 301, 7.5.2.22", "1019h: no counter with 0, reserved values refused, not changed while 1006h is not 0", "6.5 6.6 6.9", ""},
    {"CiA 301, 7.2.5.1", "The counter counts from 1 to 1019h and begins again with 1 after Stopped", "6.7 6.8", ""},
    {"CiA 301, 7.5.2.22", "A SYNC whose length does not fit 1019h may be reported with 8240h", "12.8", "the EMCY is optional"},
    {"CiA 301, 7.5.2.15", "1012h has the default COB-ID of TIME; bits 0 to 29 do not change while TIME is used", "6.101 6.102", ""},
    {"CiA 301, 7.2.6", "A consumer takes the time of TIME; a producer sends it with six bytes", "12.8", "no object of CiA 301 shows the time that was received, and the application starts the producer"},
    {"CiA 301, 7.5.2.16", "The high resolution time stamp 1013h is used with TPDOs", "4.1", "its value is not standardized enough to be compared"},
    {"CiA 301, 7.2.7.1", "An error is reported once, with its code, and again when it is over", "5.4 5.104", ""},
    {"CiA 301, 7.2.7.3.1", "An EMCY has eight bytes: code, error register 1001h, manufacturer-specific bytes", "5.4 5.5 5.101 5.102 5.103", ""},
    {"CiA 301, 7.5.2.2", "1001h: bit 0 is set with each error, bit 6 is reserved", "5.2 5.5 5.101 5.102 5.103 5.104", "the bits of error classes are optional: a warning"},
    {"CiA 301, 7.5.2.4", "1003h has the errors, newest first; 1003h:00 their number; 0 deletes them; other values are refused", "5.3 5.6 5.7 5.108 5.109", ""},
    {"CiA 301, 7.5.2.17", "1014h has the default COB-ID of EMCY; bit 31 disables EMCY; bits 0 to 29 do not change while it is valid", "5.1 5.106 5.107", ""},
    {"CiA 301, 7.5.2.18", "Two EMCYs are not sent within the inhibit time 1015h", "5.105", ""},
    {"CiA 301, 7.5.2.31", "An EMCY consumer receives the COB-IDs of 1028h", "4.1 4.11", "what the application does with a received EMCY is not standardized"},
    {"CiA 301, 7.2.8.2.1", "Each NMT command leads from each state to the state of table 39", "10.1 10.2 10.3 10.4", ""},
    {"CiA 301, 7.2.8.3.1", "NMT messages with another node-ID, an unknown command or a missing byte have no effect; node-ID 0 is for each node", "10.101 10.102 10.103 10.104", ""},
    {"CiA 301, 7.2.8.3.3", "After power-on and reset the device sends one boot-up message, and then is Pre-operational", "9.1 9.2 10.1", ""},
    {"CiA 301, 7.3.2.2.1", "A reset restores the power-on values: stored ones, else default values", "9.1 2.29 8.4 8.8", ""},
    {"CiA 301, 7.3.2.2.5", "Pre-operational: SDO, SYNC, TIME, EMCY, error control; no PDO", "9.2 3.15 3.16 3.17 3.18 3.19 3.20 3.101 3.103", ""},
    {"CiA 301, 7.3.2.2.5", "Operational: all services", "9.3", ""},
    {"CiA 301, 7.3.2.2.5", "Stopped: NMT and error control only", "9.4 3.9 3.10 3.11 3.12 3.13 3.14 3.102", ""},
    {"CiA 301, 7.2.8.3.2", "A device has heartbeat or node guarding; heartbeat excludes guarding", "7.201 7.202 7.203 7.204 7.205 7.206 7.207", ""},
    {"CiA 301, 7.2.8.3.2.1", "Node guarding: one answer with the state and a toggle bit that begins with 0 and alternates", "7.2 7.3 7.4", ""},
    {"CiA 301, 7.2.8.3.2.1", "Life guarding: after 100Ch times 100Dh without a request the device reports 8130h; it begins with the first request", "7.1 7.5 7.6 7.7", ""},
    {"CiA 301, 7.2.8.3.2.2", "A heartbeat with the NMT state in each period of 1017h, from the write on; none with 0", "7.101 7.102 7.103 7.109 7.110", ""},
    {"CiA 301, 7.2.8.2.2", "A heartbeat consumer monitors from the first heartbeat on and reports a missing one with 8130h", "7.105 7.106 7.107", ""},
    {"CiA 301, 7.5.2.19", "1016h: 0 ends the monitoring, and a second entry for one node is refused with 0604 0043h", "7.104 7.108", ""},
    {"CiA 301, 7.5.2.32", "After an error of communication an Operational device enters the state of 1029h, else Pre-operational", "9.101", "bus-off cannot be caused through the bus interface; manufacturer-specific errors depend on the device"},
    {"CiA 301, 7.5.2.1", "1000h has profile and additional information", "2.1 4.2", ""},
    {"CiA 301, 7.5.2.3", "1002h, 1008h, 1009h and 100Ah are as in the EDS", "4.1 4.2", "the meaning of their values is manufacturer-specific"},
    {"CiA 301, 7.5.2.21", "1018h has vendor-ID, product code, revision and serial number", "4.2", ""},
    {"CiA 301, 7.5.2.13", "1010h stores with \"save\" only, what it says, until power is lost and after", "6.8 6.10 8.1 8.2 8.5 8.6 8.101 8.102", ""},
    {"CiA 301, 7.5.2.14", "1011h restores default values with \"load\" only, at the next reset", "8.3 8.4 8.7 8.8", ""},
    {"CiA 301, 7.5.2.23", "1020h is stored with the configuration and becomes 0 when a parameter changes", "8.9", ""},
    {"CiA 301, 7.5.2.24 and 7.5.2.25", "1021h and 1022h hold the EDS and its format", "4.1", "optional; the length of the file is not known from the EDS"},
    {"CiA 301, 7.5.2.26 to 7.5.2.30", "1023h to 1027h: commands, debugger and modules", "4.1", "optional; commands are manufacturer-specific"},
    {"CiA 301, 7.3.5, table 41", "COB-IDs refuse the restricted CAN-IDs", "8.10 2.28", ""},
    {"CiA 301, 7.3.4", "CAN-IDs follow the pre-defined connection set by default", "2.12 5.1 6.1 6.101", "COB-IDs of PDOs are compared with the EDS in 3.1 and 3.2"},
    {"CiA 301, 7.3.4", "Frames with other CAN-IDs, of other lengths, remote or extended ones, and repeated ones have no effect", "12.1 12.2 12.3 12.4 12.5 12.6 12.7 12.8", ""},
    {"CiA 301, 7.2.4", "The SDO server serves the next request after each sequence of requests", "12.101 12.102 12.103 12.104 12.105 12.106 12.107 12.108", ""},
    {"CiA 302", "Program download and the other objects from 1F50h on", "", "not services of CiA 301; the objects are read and written as other objects"},
    {"CiA 305, switch state", "Switch state selective needs all four numbers of 1018h; switch state global is not answered", "11.1 11.2", ""},
    {"CiA 305, inquiry", "The inquiry services answer with the numbers of 1018h and the node-ID, in the configuration state only", "11.3 11.4 11.5", ""},
    {"CiA 305, identification", "Identify remote slave, identify non-configured remote slave and Fastscan", "11.6 11.7 11.8 11.9 11.10", ""},
    {"CiA 305, configure node-ID", "A node-ID of 1 to 127 or 255 is accepted, others refused with error code 1; it takes effect with reset communication", "11.11 11.12", ""},
    {"CiA 305, configure bit timing", "Reserved tables and indices are refused with error code 1; activate keeps both delays", "11.13 11.15", "another bit rate would separate the device from the test"},
    {"CiA 305, store configuration", "Store configuration keeps the node-ID over a power cycle", "11.14", ""},
};
// clang-format on

}  // namespace

std::span<const RequirementRow> requirements() { return requirement_rows; }

std::vector<std::string_view> case_ids(const RequirementRow& row) {
  std::vector<std::string_view> ids;
  for (std::string_view rest = row.cases; !rest.empty();) {
    const std::size_t end = rest.find(' ');
    ids.push_back(rest.substr(0, end));
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  return ids;
}

}  // namespace edsc::conform
