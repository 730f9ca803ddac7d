#include "decode/formats/log_formats.hpp"

#include <algorithm>
#include <iterator>

#include "decode/formats/asc_parser.hpp"
#include "decode/formats/candump_parser.hpp"
#include "decode/formats/packet_source.hpp"
#include "decode/formats/trc_parser.hpp"
#include "decode/log/log_reader.hpp"

namespace edsc {
namespace {

/// A log of lines.
template <class Parser>
class TextSource final : public LogSource {
 public:
  template <class... Settings>
  explicit TextSource(LogInput& input, const Settings&... settings) : reader_{input}, parser_{settings...} {}

  [[nodiscard]] bool next(LogLine& line) override {
    std::string_view text;
    if (at_end_ || !reader_.next(text)) return false;
    line = parser_.parse(text);
    line.number = reader_.line_number();
    line.text = text;
    at_end_ = line.kind == LogLineKind::unreadable;
    return true;
  }

 private:
  LogReader reader_;
  Parser parser_;
  bool at_end_ = false;
};

template <class Parser>
std::unique_ptr<LogSource> open_text(LogInput& input, std::string& /*problem*/) {
  return std::make_unique<TextSource<Parser>>(input);
}

std::unique_ptr<LogSource> open_candump(LogInput& input, std::string& /*problem*/) {
  return std::make_unique<TextSource<CandumpParser>>(input, input.beginning());
}

constexpr LogFormat formats[] = {
    {"pcapng", "capture of Wireshark", is_pcapng, open_packets},
    {"pcap", "capture of tcpdump", is_pcap, open_packets},
    {"trc", "trace of PEAK PCAN-View, versions 1.0 to 2.1", is_trc, open_text<TrcParser>},
    {"asc", "log of Vector CANoe and CANalyzer", is_asc, open_text<AscParser>},
    {"candump", "log or screen output of candump", [](std::string_view) { return true; }, open_candump},
};

/// Files that are not read, but given as a log.
struct ForeignRow {
  std::string_view beginning, conversion;
};

constexpr ForeignRow foreign_rows[] = {
    {"\x1F\x8B", "compressed with gzip; use zcat and LOG -"},
    {"\x28\xB5\x2F\xFD", "compressed with zstd; use zstdcat and LOG -"},
    {"\xFD"
     "7zXZ",
     "compressed with xz; use xzcat and LOG -"},
    {"PK\x03\x04", "a zip archive; unpack it"},
    {"\xFF\xFE", "text in UTF-16; use iconv -f UTF-16 -t UTF-8"},
    {"\xFE\xFF", "text in UTF-16; use iconv -f UTF-16 -t UTF-8"},
    {"LOGG\x90", "a BLF file of Vector; export it as ASC"},
    {"MDF     ", "an MDF file; export it as ASC"},
};

}  // namespace

std::string_view conversion_of(std::string_view beginning) {
  const auto* const found =
      std::ranges::find_if(foreign_rows, [&](const ForeignRow& row) { return beginning.starts_with(row.beginning); });
  return found == std::end(foreign_rows) ? std::string_view{} : found->conversion;
}

std::span<const LogFormat> log_formats() { return formats; }

const LogFormat& detect_format(LogInput& input) {
  return *std::ranges::find_if(formats, [&](const LogFormat& row) { return row.is_format(input.beginning()); });
}

const LogFormat* find_format(std::string_view name) {
  const auto* const found = std::ranges::find(formats, name, &LogFormat::name);
  return found == std::end(formats) ? nullptr : found;
}

}  // namespace edsc
