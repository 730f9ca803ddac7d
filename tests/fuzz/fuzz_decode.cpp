/// A log of any format -> text, JSON lines and CSV, summary and problems, with an axis (node 6) and a device with
/// multiplex PDOs (node 7).
#include <algorithm>
#include <nlohmann/json.hpp>

#include "decode/formats/log_formats.hpp"
#include "decode/log/log_decoder.hpp"
#include "fuzz.hpp"
#include "load/load_device.hpp"
#include "text/utf8.hpp"

namespace edsc::fuzz {
namespace {

constexpr std::size_t max_output_per_line = 16 * 1024;

struct Nodes {
  std::unique_ptr<LoadedDevice> axis = load(EDSC_SOURCE_DIR "/tests/bus/decode/axis.dcf", 6);
  std::unique_ptr<LoadedDevice> mpdo = load(EDSC_SOURCE_DIR "/tests/fixtures/mpdo_device.eds", 7);

  static std::unique_ptr<LoadedDevice> load(const char* path, std::uint8_t node_id) {
    Diagnostics diagnostics;
    LoadSettings settings;
    settings.path = path;
    settings.node_id = node_id;
    settings.check = false;
    auto loaded = load_device(settings, diagnostics);
    require(loaded->device.has_value(), "the data sheet can be read");
    return loaded;
  }

  [[nodiscard]] std::vector<KnownNode> known() const { return {{6, &*axis->device}, {7, &*mpdo->device}}; }
};

void check_text(std::string_view text) {
  require(is_utf8(text), "output is UTF-8");
  for (const char c : text) {
    require(c == '\n' || static_cast<unsigned char>(c) >= 0x20, "output holds no control characters of the log");
  }
}

/// The bytes of a log in pieces of different lengths, as of a pipe.
LogInput pieces_of(std::string_view log) {
  return LogInput{[log, size = std::size_t{1}](char* to, std::size_t most) mutable -> std::ptrdiff_t {
    size = size * 5 % 97 + 1;
    const std::size_t count = std::min({size, most, log.size()});
    std::copy_n(log.data(), count, to);
    log.remove_prefix(count);
    return static_cast<std::ptrdiff_t>(count);
  }};
}

/// `format`: null: by the content.
void decode(const Nodes& nodes, std::string_view log, LogOutput output, const LogFormat* format) {
  LogDecoderSettings settings;
  settings.log_name = "fuzz.log";
  settings.output = output;
  LogDecoder decoder{nodes.known(), NodeLabels{}, std::move(settings)};
  LogInput input = pieces_of(log);
  std::string out, complaints;
  const auto source = (format != nullptr ? *format : detect_format(input)).open(input, complaints);
  check_text(complaints);
  if (source == nullptr) return require(!complaints.empty(), "a log that cannot be read has a reason");
  LogLine line;
  for (std::size_t lines = 0; source->next(line); ++lines) {
    require(lines <= log.size(), "a log ends");
    out.clear();
    decoder.decode(line, out, complaints);
    require(out.size() < max_output_per_line, "the line of a frame has a limited length");
    if (output != LogOutput::csv) {
      require(out.empty() || (out.ends_with('\n') && out.find('\n') == out.size() - 1), "a frame is one line");
    }
    if (output == LogOutput::csv) std::erase(out, '\r');
    check_text(out);
    if (output == LogOutput::json && !out.empty()) require(nlohmann::json::accept(out), "a line of JSON is JSON");
  }
  decoder.finish(complaints);
  check_text(complaints);
  check_text(decoder.summary().text());
  require(nlohmann::json::accept(decoder.summary().json()), "the summary is JSON");
}

}  // namespace
}  // namespace edsc::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const edsc::fuzz::Nodes nodes;
  const std::string log = edsc::fuzz::text_of(data, size);
  for (const auto output : {edsc::LogOutput::text, edsc::LogOutput::json, edsc::LogOutput::csv}) {
    edsc::fuzz::decode(nodes, log, output, nullptr);
  }
  for (const edsc::LogFormat* const format : edsc::log_formats) {
    edsc::fuzz::decode(nodes, log, edsc::LogOutput::text, format);
  }
  return 0;
}
