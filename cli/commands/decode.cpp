#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>

#include "commands/commands.hpp"
#include "decode/log_decoder.hpp"
#include "decode/log_reader.hpp"
#include "device/broken_pdos.hpp"
#include "eds/number.hpp"
#include "load/load_device.hpp"
#include "shared/common_options.hpp"
#include "shared/exit_code.hpp"
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

/// An error that ends the program with exit code 2, with a message for the user.
struct Refused {
  std::string sentence;
};

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
  if (*number < 1 || *number > 127) throw Refused{fmt::format("--node {}: a node-ID must be 1 to 127", text)};
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
  if (loaded->unreadable || !loaded->device) throw Refused{fmt::format("--node: {} cannot be used", argument.path)};
  if (!argument.node_id) argument.node_id = loaded->device->node_id;
  if (!argument.node_id) {
    throw Refused{fmt::format("--node {0}: the file does not state a node-ID; use --node 5={0}", argument.path)};
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
      throw Refused{fmt::format("--node {}: node {} is given twice", text, *argument.node_id)};
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
    if (descriptor_ < 0) throw Refused{fmt::format("{}: {}", path, std::strerror(errno))};
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

/// The reader of standard output has closed it: the program ends without message.
struct OutputClosed {};

void write_all(int descriptor, std::string& text) {
  for (std::string_view rest = text; !rest.empty();) {
    const ssize_t count = ::write(descriptor, rest.data(), rest.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 && errno == EPIPE) throw OutputClosed{};
    if (count < 0) throw Refused{fmt::format("cannot write to standard output: {}", std::strerror(errno))};
    rest.remove_prefix(static_cast<std::size_t>(count));
  }
  text.clear();
}

volatile std::sig_atomic_t interrupted = 0;

/// An interrupt ends the log, so that the summary is printed. It is delivered only while waiting for the log.
class Interrupts {
 public:
  Interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    sigaction(SIGINT, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGINT);
    sigprocmask(SIG_BLOCK, &blocked, &while_waiting_);
    sigdelset(&while_waiting_, SIGINT);
  }

  /// Waits for input. Returns false at an interrupt.
  [[nodiscard]] bool wait_for(int descriptor) const {
    pollfd input{descriptor, POLLIN, 0};
    while (ppoll(&input, 1, nullptr, &while_waiting_) < 0 && errno == EINTR) {
      if (interrupted != 0) return false;
    }
    return true;
  }

 private:
  sigset_t while_waiting_{};
};

int decode_log(const Settings& settings, const Nodes& nodes) {
  constexpr std::size_t output_bytes = std::size_t{64} * 1024;
  LogDecoderSettings decoder_settings{settings.log == "-" ? "<stdin>" : settings.log,
                                      settings.interface,
                                      settings.format == "json",
                                      settings.color.on(stdout),
                                      {}};
  for (const std::string& filter : settings.filters) {
    const std::string problem = decoder_settings.filter.add(filter);
    if (!problem.empty()) throw Refused{"--filter: " + problem};
  }
  const InputFile input{settings.log};
  LogDecoder decoder{nodes.known(), nodes.labels, std::move(decoder_settings)};
  std::string out, complaints;
  const auto flush = [&] {
    write_all(STDOUT_FILENO, out);
    write_all(STDERR_FILENO, complaints);
  };
  const Interrupts interrupts;
  LogReader reader{input.descriptor(), [&] {
                     flush();
                     return interrupts.wait_for(input.descriptor());
                   }};
  std::string_view line;
  while (reader.next(line)) {
    decoder.decode(line, reader.line_number(), out, complaints);
    if (out.size() >= output_bytes || !complaints.empty()) flush();
  }
  decoder.finish(complaints);
  if (settings.summary) out += settings.format == "json" ? decoder.summary().json() : decoder.summary().text();
  flush();
  if (reader.error() != 0) throw Refused{fmt::format("{}: {}", settings.log, std::strerror(reader.error()))};
  return decoder.skipped_lines() ? exit_input_has_errors : exit_fine;
}

int decode(const Settings& settings) {
  try {
    const Nodes nodes = load_nodes(settings);
    return decode_log(settings, nodes);
  } catch (const Refused& refused) {
    print_visibly(stderr, "edsc decode: {}\n", refused.sentence);
    return exit_wrong_usage;
  } catch (const OutputClosed&) {
    return exit_fine;
  }
}

}  // namespace

void add_decode_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("decode", "decode the frames of a candump log");
  command->footer(examples);
  auto settings = std::make_shared<Settings>();
  command->add_option("LOG", settings->log, "log of candump, \"-\" for standard input")->capture_default_str();
  command
      ->add_option("--node", settings->nodes,
                   "ID=FILE: EDS of a node, or FILE: a DCF with its node-ID; may be given more than once")
      ->allow_extra_args(false);
  command->add_option("--format", settings->format, "text or json, an object on each line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  command
      ->add_option("--filter", settings->filters,
                   "show only matching frames: node=5,service=sdo,id=185h,problem=yes; all frames are evaluated")
      ->allow_extra_args(false);
  command->add_option("--interface", settings->interface, "frames of this interface only, such as can0");
  command->add_flag("--summary", settings->summary,
                    "print a summary at the end: frames by service and node, aborts, EMCY messages and times");
  settings->color.add_to(*command);
  command->callback([settings, &exit_code] { exit_code = decode(*settings); });
}

}  // namespace edsc
