#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "commands/commands.hpp"
#include "edit/edit_session.hpp"
#include "online/interruption.hpp"
#include "shared/define_command.hpp"
#include "shared/edit_file.hpp"
#include "shared/exit_code.hpp"
#include "shared/git_file.hpp"
#include "shared/output.hpp"
#include "system/available_input.hpp"
#include "system/memory_arenas.hpp"
#include "system/run_program.hpp"
#include "text/printable.hpp"
#include "web/edit_page.hpp"
#include "web/edit_server.hpp"

namespace edsc {
namespace {

constexpr const char* examples = R"(Examples:
  edsc edit drive.eds                a page in the browser; Ctrl+S there shows the changes and writes the file
  edsc edit epos4.overlay            corrections of a vendor's file: changes are written to the overlay
  edsc edit plant.json               a network file: nodes, signals, drawing and bus load
  edsc edit drive.eds --no-browser   only prints the URL; the key u and Enter print another one)";

struct Settings {
  std::string path;
  std::uint16_t port = 0;
  bool no_browser = false;
};

constexpr std::chrono::seconds end_after_last_page{10};
constexpr std::chrono::milliseconds between_looks{100};

edit::EditSession open_session(const Settings& settings) {
  if (settings.path == "-") fail("-: standard input cannot be changed; name a file");
  edit::SessionSettings session;
  session.path = settings.path;
  session.options = options_beside(settings.path);
  session.journal_folder = edit::journal_folder();
  session.committed = read_git_bytes("HEAD", settings.path).bytes;
  return edit::EditSession{std::move(session)};
}

EditHandlers handlers_of(edit::EditSession& session) {
  EditHandlers handlers;
  handlers.post = [&session](std::string_view action, std::string_view body) {
    edit::EditAnswer answer = session.post(action, body);
    return JsonAnswer{answer.status, std::move(answer.body)};
  };
  handlers.update = [&session](std::uint64_t since) { return session.update(since); };
  handlers.version = [&session] { return session.version(); };
  handlers.look_for_changes = [&session] { return session.look_at_disk(); };
  handlers.section = [&session](std::string_view title) {
    edit::EditAnswer answer = session.section(title);
    return JsonAnswer{answer.status, std::move(answer.body)};
  };
  handlers.diff = [&session] { return session.diff_json(); };
  handlers.has_unsaved_edits = [&session] { return session.has_unsaved_edits(); };
  return handlers;
}

/// Whether the user has entered `u`.
bool wants_url() {
  std::string entered;
  (void)read_available_input(entered);
  return entered.find('u') != std::string::npos;
}

void print_url(const std::string& url) {
  print_visibly(stdout, "{}\n", url);
  flush_output();
}

void open_browser(const std::string& url) {
  std::thread{[url] {
    const auto outcome = run_program({"xdg-open", url});
    if (!outcome || outcome->exit_code != 0) {
      print_to_stderr("edsc: no browser could be opened; open the URL above\n");
    }
  }}.detach();
}

int edit_in_browser(const Settings& settings) {
  share_memory_between_threads();  // each request reads the file in the thread of its connection
  edit::EditSession session = open_session(settings);
  if (!session.problem().empty()) fail(session.problem());
  if (!session.journal_problem().empty()) {
    print_to_stderr("edsc: unsaved edits are lost after a crash: {}\n", session.journal_problem());
  }
  const Interruption interruption;
  std::optional<EditServer> server;
  try {
    server.emplace(settings.port, edit_page(), handlers_of(session));
  } catch (const CannotListen& problem) {
    fail(problem.what());
  }
  const std::string url = server->new_url();
  print_url(url);
  if (!settings.no_browser) open_browser(url);
  while (!Interruption::noted()) {
    std::this_thread::sleep_for(between_looks);
    if (wants_url()) print_url(server->new_url());
    const auto idle = server->time_without_page();
    if (idle && *idle >= end_after_last_page && !server->has_unsaved_edits()) return exit_fine;
  }
  server.reset();
  if (session.has_unsaved_edits()) {
    print_to_stderr("edsc: {}: unsaved edits are in the journal; edsc edit offers them again\n", settings.path);
  }
  return exit_interrupted;
}

}  // namespace

void add_edit_options(Command command, int& exit_code) {
  Settings& settings = define_command(command, examples, edit_in_browser, exit_code);
  command.add_option("FILE", settings.path, "EDS, DCF, overlay or network file").required();
  command.add_option("--port", settings.port, "port of 127.0.0.1 (default: a free one)").range(0, 65535);
  command.add_flag("--no-browser", settings.no_browser);
}

}  // namespace edsc
