#include "shared/vocabulary.hpp"

#include <algorithm>
#include <iterator>

namespace edsc {
namespace {

using enum OptionValueKind;

// clang-format off
constexpr CommandOptionRow rows_of_options[] = {
    {"--help",           'h', "",          flag,       "print the options and examples, and end"},
    {"--version",        'V', "",          flag,       "print the version, and end"},
    {"--absent",         0,   "DURATION",  duration,   "time without a frame and without an answer after which a node is absent"},
    {"--access-types",   0,   "WORD",      text,       "how the file writes access types"},
    {"--against",        0,   "FILE",      file,       "older version to compare with: a file, or git:REF"},
    {"--all",            0,   "",          flag,       "all entries, not only those that differ or that are named"},
    {"--all-differences", 0, "",         flag,       "show all differences, not only the first one"},
    {"--all-findings",   0,   "",          flag,       "list the findings that follow from others too, and all places of each cause"},
    {"--allow",          0,   "NODE.OBJECT", text,     "entry that the application of the master writes, such as axis1.6040h"},
    {"--allow-new",      0,   "",          flag,       "accept a file that the older version does not have"},
    {"--application",    0,   "",          flag,       "write objects from 2000h, then restore the original values"},
    {"--audience",       0,   "WORD",      word,       "whose breaking changes to report: wire (masters, PDO partners), source (C++ code) or all"},
    {"--author",         0,   "TEXT",      text,       "author of the document"},
    {"--bit-rate",       0,   "KBIT",      number,     "bit rate in kbit/s"},
    {"--block",          0,   "",          flag,       "use block transfer for all values"},
    {"--check",          0,   "",          flag,       "write nothing; list the files that would change; exit code 1 if there is one"},
    {"--clients",        0,   "NUMBER",    number,     "maximum number of connected clients"},
    {"--color",          0,   "WHEN",      word,       "use colours; auto: on a terminal, unless NO_COLOR is set or TERM is dumb"},
    {"--concise",        0,   "",          flag,       "the file is a concise DCF, as in object 1F22h"},
    {"--conform",        0,   "FILE",      file,       "JSON report of the conformance test that wrote the log; what its cases provoke is listed apart"},
    {"--count",          0,   "NUMBER",    number,     "number of frames until the command ends, or of nodes"},
    {"--cpp",            0,   "",          flag,       "add the data of the C++ templates"},
    {"--cycles",         0,   "",          flag,       "print cycle times and jitter of PDOs, SYNC and heartbeats"},
    {"--date",           0,   "TEXT",      text,       "date of the document"},
    {"--dbc",            0,   "FILE",      file,       "write the PDOs as a DBC file"},
    {"--dcf",            0,   "",          flag,       "make a DCF: [DeviceComissioning], and the ParameterValues that differ from the default values"},
    {"--delay",          0,   "DURATION",  duration,   "switch delay, before and after the switch of the bit rate"},
    {"--depfile",        0,   "FILE",      file,       "write what the output depends on, for make and ninja"},
    {"--depfile-target", 0,   "FILE",      file,       "target in the depfile (default: the output)"},
    {"--device-profile", 0,   "",          flag,       "behave as the device profile in 1000h says"},
    {"--deviations",     0,   "FILE",      file,       "declared deviations of the node, with their reasons (JSON)"},
    {"--dry-run",        0,   "",          flag,       "print the differences and the steps, and write nothing to the node"},
    {"--eds",            0,   "FILE",      path,       "EDS, DCF, XDD or XDC of the node"},
    {"--encoding",       0,   "NAME",      text,       "encoding of the text in the file"},
    {"--every",          0,   "DURATION",  duration,   "period of the frame; without --count until Ctrl-C"},
    {"--exit-on",        0,   "ALARM",     rule,       "end at this alarm, or at any"},
    {"--except",         0,   "NODES",     text,       "nodes not to run, such as axis1,axis2"},
    {"--explain",        0,   "RULE",      rule,       "describe a rule, and end"},
    {"--fail-on",        0,   "WORD",      word,       "changes that cause exit code 1"},
    {"--fault",          0,   "FAULT",     text,       "fault to inject"},
    {"--file",           0,   "FILE",      file,       "file with the bytes to write to the node"},
    {"--filter",         0,   "CONDITION", text,       "show only matching frames"},
    {"--for",            0,   "DURATION",  duration,   "how long frames are received or simulated"},
    {"--force",          0,   "",          flag,       "continue although a check fails"},
    {"--format",         0,   "FORMAT",    word,       "format of the output"},
    {"--html",           0,   "FILE",      file,       "write the report as one HTML file, which a browser prints as PDF"},
    {"--id",             0,   "CAN-ID",    text,       "CAN-ID of the frame, such as 81h; above 7FFh an extended one"},
    {"--ignore",         0,   "OBJECT",    object,     "object or entry whose SDO transfers are not compared"},
    {"--in-place",       'i', "",          flag,       "write each file itself"},
    {"--interface",      0,   "NAME",      text,       "frames of this interface or channel of the log only, such as can0"},
    {"--json",           0,   "FILE",      file,       "write the report as JSON"},
    {"--junit",          0,   "FILE",      file,       "write the report as JUnit XML"},
    {"--keep-going",     0,   "",          flag,       "for the EDS of a purchased device: errors become warnings, and invalid objects are skipped"},
    {"--keep-state",     0,   "",          flag,       "do not set the node to Pre-operational first"},
    {"--level",          0,   "LEVEL",     word,       "what the test may do to the node"},
    {"--list",           0,   "",          flag,       "list the cases and what they need, and end"},
    {"--list-alarms",    0,   "",          flag,       "list the alarms, and end"},
    {"--list-options",   0,   "",          flag,       "list the members of an options file, and end"},
    {"--list-rules",     0,   "",          flag,       "list the rules, and end"},
    {"--listen",         0,   "HOST:PORT", address,    "address at which clients connect; port 0: any free port"},
    {"--log",            0,   "FILE",      file,       "write the frames as a candump log"},
    {"--log-format",     0,   "FORMAT",    word,       "format of the log that is read"},
    {"--log-interface",  0,   "NAME",      text,       "name of the interface in the log that is written (default: the name of the bus)"},
    {"--logo",           0,   "FILE",      file,       "picture for the page: SVG, PNG or JPEG"},
    {"--lss",            0,   "",          flag,       "also find devices without node-ID, by LSS Fastscan"},
    {"--master",         0,   "NODE",      node,       "node-ID or name of the NMT master, which need not obey its own commands (default: bit 0 of 1F80h)"},
    {"--max-bytes",      0,   "NUMBER",    number,     "maximum number of bytes of a variable-length value"},
    {"--max-load",       0,   "PERCENT",   number,     "limit of the bus load over 100 ms, in percent"},
    {"--memory",         0,   "FILE",      file,       "file of the parameters that the node stores (1010h)"},
    {"--name",           0,   "NAME",      text,       "C++ namespace (default: the name of the file)"},
    {"--network",        0,   "FILE",      file,       "network file (JSON), which states the nodes and their EDS files (default: that of EDSC_NETWORK)"},
    {"--node",           0,   "ID=FILE",   node_file,  "node-ID or name of a node, and its EDS; a DCF that states its node-ID needs no ID="},
    {"--node-id",        0,   "NODE",      number,     "node-ID that the device gets, 1..127"},
    {"--node-id-and-bit-rate", 0, "",      flag,       "also write the node-ID and bit rate of the node itself"},
    {"--node-pages",     0,   "",          flag,       "of a network: also write a page for each node, beside the page of the network"},
    {"--nodes",          0,   "LIST",      text,       "node-IDs to scan: 1..127, or a list such as 1,3,8..20"},
    {"--on-error",       0,   "WORD",      word,       "after a node that cannot be configured: abort, continue with the others, or retry"},
    {"--once",           0,   "DURATION",  duration,   "print one table after this time, and end"},
    {"--only",           0,   "NAMES",     text,       "run only these"},
    {"--operator",       0,   "NAME",      text,       "who tests, for the report"},
    {"--options",        0,   "FILE",      file,       "options file (default: the name of the EDS with .options.json, if there)"},
    {"--output",         'o', "PATH",      path,       "file or folder to write"},
    {"--outputs",        0,   "",          flag,       "send RPDOs and SYNC: outputs may move"},
    {"--overflow",       0,   "NUMBER",    number,     "send the counter of SYNC, from 1 to this number, as in 1019h"},
    {"--pdos",           0,   "",          flag,       "also compare the contents of TPDOs"},
    {"--place",          0,   "TEXT",      text,       "where the test is done, for the report"},
    {"--product",        0,   "NUMBER",    number,     "product code, 1018h:02"},
    {"--profile",        0,   "FILE",      file,       "profile database in the syntax of an EDS: object codes, data types and access types"},
    {"--quiet",          0,   "",          flag,       "print only failures and the result"},
    {"--raw",            0,   "",          flag,       "the value is bytes, as hexadecimal digits"},
    {"--remind",         0,   "DURATION",  duration,   "time after which an alarm that goes on is reported again"},
    {"--repair",         0,   "",          flag,       "write an overlay for the findings that have a certain remedy, and try the device in simulated time"},
    {"--requirements",   0,   "",          flag,       "list what the standards require of a device, with the cases that test it, and end"},
    {"--retries",        0,   "NUMBER",    number,     "number of repetitions for each node"},
    {"--revision",       0,   "NUMBER",    number,     "revision number, 1018h:03"},
    {"--run",            0,   "COMMAND",   text,       "command line for the shell, run for each alarm"},
    {"--runtime",        0,   "DIR",       folder,     "include folder of the runtime (default: the folder of edsc)"},
    {"--script",         0,   "FILE",      file,       "behaviour of the nodes (JSON), by convention NAME.behaviour.json"},
    {"--scripts",        0,   "",          flag,       "behaviour of each node: NAME.behaviour.json beside NAME.eds, if it exists"},
    {"--seed",           0,   "NUMBER",    number,     "seed of random choices; the same seed has the same result"},
    {"--segmented",      0,   "",          flag,       "do not use block transfer"},
    {"--serial",         0,   "NUMBER",    number,     "serial number, 1018h:04"},
    {"--silence",        0,   "RULE",      rule,       "rule, or alarm, not to report"},
    {"--skip",           0,   "NAME",      text,       "node to ignore"},
    {"--speed",          0,   "PERCENT",   number,     "speed of the replay, in percent of the speed of the log"},
    {"--start",          0,   "",          flag,       "start the node after success"},
    {"--static-mapping", 0,   "",          flag,       "no PDO can be mapped over the bus, for smaller firmware"},
    {"--step",           0,   "DURATION",  duration,   "time of each step of Fastscan; more on a slow bus"},
    {"--set",            0,   "OBJECT=VALUE", text,    "value of an object instead of its default value"},
    {"--stimulus",       0,   "CASE=COMMAND", case_command, "command that acts on the node in a case"},
    {"--storage",        0,   "",          flag,       "list which stored parameters a device keeps, and which are converted or dropped"},
    {"--store",          0,   "",          flag,       "store in the non-volatile memory of the node"},
    {"--strict",         0,   "",          flag,       "warnings count as errors; notes do not"},
    {"--sub-indices",    0,   "WORD",      text,       "how the file writes sub-indices in section names"},
    {"--summary",        0,   "",          flag,       "print a summary at the end: frames by service and node, aborts, EMCY messages and times"},
    {"--target",         0,   "TARGET",    word,       "language or program for which the files are generated"},
    {"--templates",      0,   "DIR",       folder,     "folder with templates that replace the built-in ones"},
    {"--timeout",        0,   "DURATION",  duration,   "time that a device has to respond"},
    {"--times",          0,   "",          flag,       "print period, worst-case response time and deadline of each message"},
    {"--title",          0,   "TEXT",      text,       "title of the report, document or picture"},
    {"--tolerance",      0,   "PERCENT",   number,     "how much a time may differ from the nominal one, in percent; at least 1 ms or half of a short time"},
    {"--tpdo",           0,   "",          flag,       "send a TPDO of the node in its place"},
    {"--type",           0,   "TYPE",      text,       "data type instead of the type of the EDS: bool, u8..u64, i8..i64, f32, f64, string, unicode, octets, time, span, domain"},
    {"--utf8",           0,   "",          flag,       "write UTF-8 if a change of an ASCII file is not ASCII"},
    {"--vendor",         0,   "NUMBER",    number,     "vendor-ID, 1018h:01"},
    {"--verbose",        'v', "",          flag,       "print the names of the files that are written"},
    {"--verify",         0,   "",          flag,       "read the value back and compare it"},
    {"--wait",           0,   "DURATION",  duration,   "time to wait until the node reports its new state"},
    {"--web",            0,   "HOST:PORT", address,    "serve a page with live values and plots, at this address"},
    {"--without-findings", 0, "",          flag,       "leave out the findings of edsc check"},
    {"--write-options",  0,   "FILE",      file,       "write the options file for the storage groups in the comments ;StorageLocation= (CANopenNode), and no EDS"},
};

constexpr ArgumentRow rows_of_arguments[] = {
    {"BASE", file},     {"BUS", bus},      {"COMMAND", command_words}, {"FILE", path},
    {"KBIT", number},   {"LOG", file},     {"NAME", text},             {"NODE", node},
    {"NUMBER", number}, {"OBJECT", object}, {"SOURCE", path}, {"TARGET", bus},
};

constexpr OldOptionRow rows_of_old_options[] = {
    {"accept",           "-o",            "--html",          "", ""},
    {"audit",            "--sdo-timeout", "--timeout",       "ms", ""},
    {"bus",              "--bus",         "",                "", ""},
    {"bus",              "--log",         "--log",           "", "-"},
    {"check",            "--all",         "--all-findings",  "", ""},
    {"document",         "--nodes",       "--node-pages",    "", ""},
    {"lss activate",     "--delay",       "--delay",         "ms", ""},
    {"monitor",          "--once",        "--once",          "s", ""},
    {"network check",    "--all",         "--all-findings",  "", ""},
    {"network scan",     "--listen",      "--for",           "ms", ""},
    {"network scan",     "--sheets",      "--eds",           "", ""},
    {"nmt",              "--wait",        "--wait",          "ms", ""},
    {"read",             "--file",        "--output",        "", ""},
    {"record",           "--interface",   "--log-interface", "", ""},
    {"record",           "--seconds",     "--for",           "s", ""},
    {"scan",             "--listen",      "--for",           "ms", ""},
    {"send",             "--every",       "--every",         "ms", ""},
    {"",                 "--step",        "--step",          "ms", ""},
    {"",                 "--timeout",     "--timeout",       "ms", ""},
};
// clang-format on

}  // namespace

std::string_view to_string(OptionValueKind kind) {
  constexpr std::string_view names[] = {"flag",   "text", "number",       "duration",     "word", "file",
                                        "folder", "path", "node_file",    "address",      "bus",  "node",
                                        "object", "rule", "case_command", "command_words"};
  return names[static_cast<std::size_t>(kind)];
}

std::span<const CommandOptionRow> command_option_rows() { return rows_of_options; }
std::span<const OldOptionRow> old_option_rows() { return rows_of_old_options; }

const CommandOptionRow* find_command_option(std::string_view name) {
  const auto* const row = std::ranges::find(rows_of_options, name, &CommandOptionRow::name);
  return row == std::end(rows_of_options) ? nullptr : row;
}

const ArgumentRow* find_argument_row(std::string_view name) {
  const auto* const row = std::ranges::find(rows_of_arguments, name, &ArgumentRow::name);
  return row == std::end(rows_of_arguments) ? nullptr : row;
}

}  // namespace edsc
