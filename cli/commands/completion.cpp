#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "commands/commands.hpp"
#include "completion/command_parts.hpp"
#include "load/load_device.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/node_names.hpp"
#include "shared/output.hpp"
#include "system/path.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  source <(edsc completion bash)               completion in this shell; an installed edsc includes it
  edsc completion zsh >~/.zfunc/_edsc          for zsh, in a folder of its fpath
  edsc completion man | man -l -               the manual page
  edsc completion json                         all commands and options, for a program
  edsc completion objects drive.eds            the names of its objects, one on each line)";

struct Settings {
  std::optional<Command> program;
  std::string kind;
  std::vector<std::string> files;
};

/// Network interfaces of type CAN, and the adapters that may be at a serial port.
std::string buses() {
  constexpr int type_of_can = 280;  // ARPHRD_CAN
  std::vector<std::string> found{"socketcand:", "simulated:"};
  std::error_code error;
  for (const auto& interface : std::filesystem::directory_iterator{"/sys/class/net", error}) {
    int type = 0;
    std::ifstream{interface.path() / "type"} >> type;
    if (type == type_of_can) found.push_back("socketcan:" + from_native(interface.path().filename()));
  }
  for (const auto& device : std::filesystem::directory_iterator{"/dev", error}) {
    const std::string path = from_native(device.path());
    if (path.starts_with("/dev/ttyACM") || path.starts_with("/dev/ttyUSB")) found.push_back("slcan:" + path);
  }
  std::ranges::sort(found);
  return fmt::format("{}\n", fmt::join(found, "\n"));
}

std::string nodes() {
  std::string text;
  for (const NamedNode& node : named_nodes(network_or_default(""))) text += node.name + "\n";
  return text;
}

/// `statusword`, `identity_object.vendor_id`
std::string objects_of(const std::string& path) {
  Diagnostics ignored;
  LoadSettings settings;
  settings.path = path;
  settings.check = false;
  settings.keep_going = true;
  const auto loaded = load_device(settings, ignored);
  if (!loaded->device) return {};
  const Identifiers& names = loaded->named().identifiers();
  std::string text;
  for (const Object& object : loaded->device->objects) {
    text += names.of(object) + "\n";
    if (object.entries.size() < 2) continue;
    for (const Entry& entry : object.entries) text += names.of(object) + "." + names.of(entry) + "\n";
  }
  return text;
}

std::string objects(const std::vector<std::string>& files) {
  std::string text;
  for (const std::string& path : files) text += objects_of(path);
  if (!files.empty()) return text;
  for (const NamedNode& node : named_nodes(network_or_default(""))) {
    if (!node.sheet.empty()) text += objects_of(node.sheet);
  }
  return text;
}

std::string text_of(const Settings& settings) {
  if (settings.kind == "buses") return buses();
  if (settings.kind == "nodes") return nodes();
  if (settings.kind == "objects") return objects(settings.files);
  const CommandParts program = parts_of(*settings.program);
  if (settings.kind == "bash") return bash_completion(program);
  if (settings.kind == "zsh") return zsh_completion(program);
  if (settings.kind == "json") return commands_json(program);
  return man_page(program, EDSC_VERSION);
}

int run_completion(const Settings& settings) {
  write_output(text_of(settings));
  return exit_fine;
}

}  // namespace

void add_completion_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, run_completion, exit_code);
  settings.program = command.parent();
  command.add_option("KIND", settings.kind, "what to print")
      .required()
      .one_of({"bash", "zsh", "man", "json", "buses", "nodes", "objects"});
  command.add_option("FILE", settings.files, "with objects: EDS files (default: the EDS files of EDSC_NETWORK)");
}

}  // namespace edsc
