#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>

#include "commands/commands.hpp"
#include "decode/log/log_decoder.hpp"
#include "decode/log/log_reader.hpp"
#include "device/pdo/resolve_pdos.hpp"
#include "eds/number.hpp"
#include "load/load_device.hpp"
#include "shared/common_options.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/waiting_signals.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc decode --node 5=drive.eds can0.log            decode each frame of a candump log
  candump -L can0 | edsc decode --node axis1.dcf -   the same on a live bus; the DCF states the node-ID
  edsc decode --node 5=drive.eds can0.log --filter node=5,service=sdo --summary
  edsc decode --node 5=drive.eds can0.log --format json | jq -c 'select(.problem)')";

struct Settings {
  std::string log = "-";
  std::vector<std::string> nodes;
  std::vector<std::string> filters;
  std::string interface;
  std::string format = "text";
  bool summary = false;
  ColorOption color;
};

/// Ends the command with a message.
[[noreturn]] void refuse(std::string_view sentence) {
  print_visibly(stderr, "edsc decode: {}\n", sentence);
  throw Exit{};
}

/// `5=drive.eds`, or `axis1.dcf` with its own node-ID.
struct NodeArgument {
  std::optional<std::uint8_t> node_id;
  std::string path;
};

NodeArgument parse_node_argument(const std::string& text) {
  const std::size_t equals = text.find('=');
  const auto number =
      equals == std::string::npos ? std::nullopt : parse_unsigned(std::string_view{text}.substr(0, equals));
  if (!number) return {std::nullopt, text};
  if (*number < 1 || *number > 127) refuse(fmt::format("--node {}: a node-ID must be 1 to 127", text));
  return {static_cast<std::uint8_t>(*number), text.substr(equals + 1)};
}

/// Warnings and invalid mappings are for `edsc check`: a PDO is decoded as mapped.
void print_errors(const Diagnostics& diagnostics, const ColorOption& color) {
  Diagnostics errors;
  for (const Diagnostic& one : diagnostics.all()) {
    if (one.severity == Severity::error && !is_broken_pdo_rule(one.rule)) errors.report(one);
  }
  print_findings(stderr, errors, color);
}

/// The device of a node. Errors in its EDS are printed; the rest is used.
std::unique_ptr<LoadedDevice> load_node(NodeArgument& argument, const ColorOption& color) {
  Diagnostics diagnostics;
  LoadSettings load;
  load.path = argument.path;
  load.node_id = argument.node_id;
  load.check = false;
  auto loaded = load_device(load, diagnostics);
  print_errors(diagnostics, color);
  if (loaded->unreadable || !loaded->device) refuse(fmt::format("--node: {} cannot be used", argument.path));
  if (!argument.node_id) argument.node_id = loaded->device->node_id;
  if (!argument.node_id) {
    refuse(fmt::format("--node {0}: the file does not state a node-ID; use --node 5={0}", argument.path));
  }
  return loaded;
}

struct Nodes {
  std::map<std::uint8_t, std::unique_ptr<LoadedDevice>> loaded;  ///< by node-ID
  NodeLabels labels;

  [[nodiscard]] std::vector<KnownNode> known() const {
    std::vector<KnownNode> nodes;
    for (const auto& [node_id, device] : loaded) nodes.push_back({node_id, &*device->device});
    return nodes;
  }
};

Nodes load_nodes(const Settings& settings) {
  Nodes nodes;
  for (const std::string& text : settings.nodes) {
    NodeArgument argument = parse_node_argument(text);
    auto loaded = load_node(argument, settings.color);
    if (nodes.loaded.contains(*argument.node_id)) {
      refuse(fmt::format("--node {}: node {} is given twice", text, *argument.node_id));
    }
    if (const auto& commissioning = loaded->device->information.commissioning) {
      nodes.labels.set_name(*argument.node_id, commissioning->node_name);
    }
    nodes.loaded.emplace(*argument.node_id, std::move(loaded));
  }
  return nodes;
}

/// A file, or standard input.
class InputFile {
 public:
  explicit InputFile(const std::string& path)
      : descriptor_{path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)} {
    if (descriptor_ < 0) refuse(fmt::format("{}: {}", path, std::strerror(errno)));
  }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile() {
    if (descriptor_ != STDIN_FILENO) ::close(descriptor_);
  }
  [[nodiscard]] int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Ends the command without a message if the reader of standard output has closed it.
void write_all(int descriptor, std::string& text) {
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t count = ::write(descriptor, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EPIPE) throw Exit{exit_fine};
    if (count < 0) refuse(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  text.clear();
}

/// Waits for input. Returns false at an interrupt.
bool wait_for(int descriptor, const WaitingSignals& interrupts) {
  pollfd input{descriptor, POLLIN, 0};
  while (ppoll(&input, 1, nullptr, interrupts.while_waiting()) < 0 && errno == EINTR) {
    if (WaitingSignals::noted()) return false;
  }
  return true;
}

int decode_log(const Settings& settings, const Nodes& nodes) {
  constexpr std::size_t output_bytes = std::size_t{64} * 1024;
  LogDecoderSettings decoder_settings{settings.log == "-" ? "<stdin>" : settings.log,
                                      settings.interface,
                                      settings.format == "json",
                                      settings.color.on(stdout),
                                      {}};
  for (const std::string& filter : settings.filters) {
    const std::string problem = decoder_settings.filter.add(filter);
    if (!problem.empty()) refuse("--filter: " + problem);
  }
  const InputFile input{settings.log};
  LogDecoder decoder{nodes.known(), nodes.labels, std::move(decoder_settings)};
  std::string out, complaints;
  const auto flush = [&] {
    write_all(STDOUT_FILENO, out);
    write_all(STDERR_FILENO, complaints);
  };
  // An interrupt ends the log, so that the summary is printed; the second one ends the program.
  const WaitingSignals interrupts({SIGINT}, static_cast<int>(SA_RESETHAND));
  std::signal(SIGPIPE, SIG_IGN);
  LogReader reader{input.descriptor(), [&] {
                     flush();
                     return wait_for(input.descriptor(), interrupts);
                   }};
  std::string_view line;
  while (reader.next(line)) {
    decoder.decode(line, reader.line_number(), out, complaints);
    if (out.size() >= output_bytes || !complaints.empty()) flush();
  }
  decoder.finish(complaints);
  if (settings.summary) out += settings.format == "json" ? decoder.summary().json() : decoder.summary().text();
  flush();
  if (reader.error() != 0) refuse(fmt::format("{}: {}", settings.log, std::strerror(reader.error())));
  return decoder.skipped_lines() ? exit_input_has_errors : exit_fine;
}

int decode(const Settings& settings) { return decode_log(settings, load_nodes(settings)); }

}  // namespace

void add_decode_options(CLI::App& command, int& exit_code) {
  Settings& settings = define_command(command, examples, decode, exit_code);
  command.add_option("LOG", settings.log, "log of candump, \"-\" for standard input")->capture_default_str();
  command
      .add_option("--node", settings.nodes,
                  "ID=FILE: EDS of a node, or FILE: a DCF with its node-ID; may be given more than once")
      ->allow_extra_args(false);
  add_choice(command, "--format", settings.format, {"text", "json"}, "text or json, an object on each line");
  command
      .add_option("--filter", settings.filters,
                  "show only matching frames: node=5,service=sdo,id=185h,problem=yes; all frames are evaluated")
      ->allow_extra_args(false);
  command.add_option("--interface", settings.interface, "frames of this interface only, such as can0");
  command.add_flag("--summary", settings.summary,
                   "print a summary at the end: frames by service and node, aborts, EMCY messages and times");
  settings.color.add_to(command);
}

}  // namespace edsc
