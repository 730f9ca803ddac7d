#include <fmt/format.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "commands/commands.hpp"
#include "lsp/message_reader.hpp"
#include "lsp/server.hpp"
#include "shared/define_command.hpp"
#include "shared/exit_code.hpp"
#include "shared/findings_report.hpp"
#include "shared/git_device.hpp"
#include "shared/output.hpp"
#include "system/input_file.hpp"
#include "system/waiting_signals.hpp"
#include "text/printable.hpp"
#ifndef EDSC_OFFLINE
#include "conform/case.hpp"
#include "conform/deviations.hpp"
#endif

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc lsp      started by an editor; messages of the Language Server Protocol on standard input and output)";

struct Settings {
  std::optional<Command> program;
};

std::shared_ptr<const LoadedDevice> committed_device(const std::string& path) {
  constexpr const char* revision = "HEAD";
  GitFile committed = read_git_file(revision, path);
  if (!committed.source) return nullptr;
  Diagnostics ignored;
  LoadSettings settings;
  settings.path = path;
  settings.check = false;
  return load_git_device(std::move(committed), revision, settings, ignored);
}

lsp::ServerHooks hooks_for(const Settings& settings) {
  lsp::ServerHooks hooks;
  hooks.version = settings.program->version();
  hooks.send = [](std::string_view message) { write_output(lsp::framed(message)); };
  hooks.log = [](std::string_view text) { print_to_stderr("edsc lsp: {}\n", text); };
  hooks.url_of = url_of;
  hooks.committed = committed_device;
#ifndef EDSC_OFFLINE
  hooks.check_deviations = [](const SourceFile& source, Diagnostics& diagnostics) {
    (void)conform::read_deviations(source, diagnostics);
  };
  for (const conform::AreaRow& area : conform::areas()) {
    for (const conform::CaseRow* const row : conform::cases_of(area)) {
      hooks.conformance_cases.push_back({std::string{row->id}, std::string{row->title}});
    }
  }
#endif
  return hooks;
}

int serve(const Settings& settings) {
  const WaitingSignals interrupts{{SIGINT, SIGTERM}, WaitingSignals::Second::ends_program};
  const InputFile input{"-"};
  lsp::MessageReader reader;
  lsp::Server server{hooks_for(settings)};
  std::array<char, 1 << 16> bytes{};
  while (!server.has_ended()) {
    const std::ptrdiff_t count = input.read_some(bytes.data(), bytes.size(), interrupts);
    if (WaitingSignals::noted()) return exit_interrupted;
    if (count <= 0) break;
    reader.add({bytes.data(), static_cast<std::size_t>(count)});
    while (!server.has_ended()) {
      const auto message = reader.next();
      if (const std::string fault = reader.take_fault(); !fault.empty()) print_to_stderr("edsc lsp: {}\n", fault);
      if (!message) break;
      server.receive(*message);
    }
    server.publish();
    flush_output();
  }
  return server.was_shut_down() ? exit_fine : exit_input_has_errors;
}

}  // namespace

void add_lsp_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, serve, exit_code);
  settings.program = command.parent();
}

}  // namespace edsc
