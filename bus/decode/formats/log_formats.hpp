/// The formats of logs: candump, Vector ASC and BLF, PEAK TRC, BUSMASTER, SavvyCAN, pcap and pcapng.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "decode/formats/log_input.hpp"
#include "decode/formats/log_source.hpp"

namespace edsc {

struct LogFormat {
  std::string_view name;
  std::string_view description;

  /// Whether a log that begins with these bytes has the format.
  bool (*is_format)(std::string_view beginning);

  /// Returns null and sets `problem`, a clause, if the log cannot be read. `input` must outlive the source.
  std::unique_ptr<LogSource> (*open)(LogInput& input, std::string& problem);
};

// Each is defined in a source of its own.
extern const LogFormat pcapng_format;
extern const LogFormat pcap_format;
extern const LogFormat blf_format;
extern const LogFormat trc_format;
extern const LogFormat busmaster_format;
extern const LogFormat savvycan_format;
extern const LogFormat asc_format;
extern const LogFormat candump_format;

/// In the order of detection; the last one is that of all other logs.
inline constexpr const LogFormat* log_formats[] = {
    &pcapng_format,    &pcap_format,     &blf_format, &trc_format,
    &busmaster_format, &savvycan_format, &asc_format, &candump_format,
};

/// The format that the content has.
[[nodiscard]] const LogFormat& detect_format(LogInput& input);

/// Why a log that begins with these bytes must be converted before, as a clause; empty if it need not be.
[[nodiscard]] std::string_view conversion_of(std::string_view beginning);

/// Null if no format has this name.
[[nodiscard]] const LogFormat* find_format(std::string_view name);

}  // namespace edsc
