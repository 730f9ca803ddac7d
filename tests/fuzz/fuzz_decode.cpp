/// A candump log -> text and JSON lines, summary and problems, with an axis (node 6) and a device with multiplex
/// PDOs (node 7).
#include <nlohmann/json.hpp>

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

void decode(const Nodes& nodes, std::string_view log, bool json) {
  LogDecoderSettings settings;
  settings.log_name = "fuzz.log";
  settings.json = json;
  LogDecoder decoder{nodes.known(), NodeLabels{}, std::move(settings)};
  std::string out, complaints;
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < log.size();) {
    const std::size_t end = std::min(log.find('\n', begin), log.size());
    out.clear();
    decoder.decode(log.substr(begin, end - begin), ++number, out, complaints);
    require(out.size() < max_output_per_line, "a frame is told in a line of bearable length");
    require(out.empty() || (out.ends_with('\n') && out.find('\n') == out.size() - 1), "a frame is one line");
    check_text(out);
    if (json && !out.empty()) require(nlohmann::json::accept(out), "a line of JSON is JSON");
    begin = end + 1;
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
  edsc::fuzz::decode(nodes, log, false);
  edsc::fuzz::decode(nodes, log, true);
  return 0;
}
