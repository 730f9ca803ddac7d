#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "completion/command_description.hpp"

namespace edsc {
namespace {

constexpr const char* tail = R"(.SH EXIT STATUS
.TP
.B 0
fine; there may have been warnings
.TP
.B 1
the input has errors
.TP
.B 2
wrong usage, or a file could not be read or written
.SH ENVIRONMENT
.TP
.B NO_COLOR
if set, output is not coloured unless
.B \-\-color
says so
.SH SEE ALSO
.BR candump (1)
)";

/// Text with roff markup escaped.
std::string escaped(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool line_begins = at == 0 || text[at - 1] == '\n';
    if (line_begins && (text[at] == '.' || text[at] == '\'')) out += "\\&";
    switch (text[at]) {
      case '\\': out += "\\e"; break;
      case '-': out += "\\-"; break;
      case '\'': out += "\\(aq"; break;
      case '`': out += "\\(ga"; break;
      case '^': out += "\\(ha"; break;
      case '~': out += "\\(ti"; break;
      default: out += text[at];
    }
  }
  return out;
}

/// A sentence, wrapped to the line length recommended by mandoc.
std::string filled(std::string_view text) {
  constexpr std::size_t max_columns = 78;
  std::string out, line;
  const auto end_line = [&] {
    out += escaped(line) + "\n";
    line.clear();
  };
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find_first_of(" \n"), text.size());
    const std::string_view word = text.substr(0, blank);
    if (!line.empty() && line.size() + 1 + word.size() > max_columns) end_line();
    if (!line.empty() && !word.empty()) line += ' ';
    line += word;
    text.remove_prefix(std::min(blank + 1, text.size()));
  }
  end_line();
  return out;
}

/// `Say what is wrong.`
std::string sentence(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  if (!text.ends_with('.')) text += '.';
  return text;
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return text;
}

std::string name_of(const CommandDescription& command) {
  return escaped(command.path.empty() ? "edsc" : fmt::format("edsc {}", fmt::join(command.path, " ")));
}

void append_synopsis(std::string& out, const CommandDescription& command) {
  const auto put = std::back_inserter(out);
  for (const CommandDescription& sub : command.commands) append_synopsis(out, sub);
  if (!command.commands.empty()) return;
  fmt::format_to(put, ".br\n.B {}\n", name_of(command));
  if (!command.options.empty()) out += "[\\fIoptions\\fR]\n";
  for (const OptionDescription& argument : command.arguments) {
    const std::string name = escaped(argument.names.front()) + (argument.repeats ? "..." : "");
    const std::string word = fmt::format("\\fI{}\\fR", name);
    out += (argument.required ? word : "[" + word + "]") + "\n";
  }
}

void append_option(std::string& out, const OptionDescription& option, bool argument) {
  const auto put = std::back_inserter(out);
  std::string names;
  for (const std::string& name : option.names) {
    names += fmt::format("{}\\f{}{}\\fR", names.empty() ? "" : ", ", argument ? 'I' : 'B', escaped(name));
  }
  const std::string value = argument ? "" : value_words(option);
  fmt::format_to(put, ".TP\n{}{}\n", names, value.empty() ? "" : fmt::format(" \\fI{}\\fR", escaped(value)));
  const bool words = argument && option.value == ValueKind::words;
  out += filled(words ? option.text + ": " + value_words(option) : option.text);
}

void append_command(std::string& out, const CommandDescription& command) {
  const auto put = std::back_inserter(out);
  if (command.commands.empty()) {
    fmt::format_to(put, ".SS {}\n{}", name_of(command), filled(sentence(command.text)));
    for (const OptionDescription& argument : command.arguments) append_option(out, argument, true);
    for (const OptionDescription& option : command.options) append_option(out, option, false);
    if (!command.examples.empty()) fmt::format_to(put, ".PP\n.nf\n{}\n.fi\n", escaped(command.examples));
    return;
  }
  for (const CommandDescription& sub : command.commands) append_command(out, sub);
  if (!command.path.empty() && !command.examples.empty())
    fmt::format_to(put, ".PP\n.nf\n{}\n.fi\n", escaped(command.examples));
}

}  // namespace

std::string man_page(const CommandDescription& program, const std::string& version) {
  std::string out;
  const auto put = std::back_inserter(out);
  fmt::format_to(put, ".TH EDSC 1 \"\" \"edsc {}\" \"User Commands\"\n", escaped(version));
  out += ".SH NAME\nedsc \\- compiler for CANopen Electronic Data Sheets\n.SH SYNOPSIS\n.nh\n.ad l\n";
  std::string synopsis;
  append_synopsis(synopsis, program);
  out += synopsis.substr(std::string_view{".br\n"}.size());  // none before the first
  out += ".ad b\n.hy\n.SH DESCRIPTION\n" + filled(program.text);
  for (const std::string& group : groups_of(program)) {
    fmt::format_to(put, ".SH COMMANDS: {}\n", escaped(upper_case(group)));
    for (const CommandDescription& command : program.commands) {
      if (command.group == group) append_command(out, command);
    }
  }
  return out + tail;
}

}  // namespace edsc
