#include "simulate/compiled_object.hpp"

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "system/path.hpp"
#include "system/read_file.hpp"
#include "system/write_files.hpp"

namespace edsc {
namespace {

namespace fs = std::filesystem;

std::string command_text(const std::vector<std::string>& command) {
  std::string text;
  for (const std::string& word : command) text += word + '\n';
  return text;
}

/// The files after the colon of a rule for make. A backslash escapes a blank or continues the line.
std::vector<std::string> prerequisites(std::string_view rule) {
  std::vector<std::string> files;
  std::string file;
  const auto end_file = [&] {
    if (!file.empty()) files.push_back(std::exchange(file, {}));
  };
  rule.remove_prefix(std::min(rule.find(": "), rule.size()));
  rule.remove_prefix(std::min<std::size_t>(rule.size(), 1));
  for (std::size_t i = 0; i < rule.size(); ++i) {
    const char next = i + 1 < rule.size() ? rule[i + 1] : '\0';
    if (rule[i] == '\\' && next == '\n') {
      ++i;
      end_file();
    } else if ((rule[i] == '\\' && (next == ' ' || next == '#')) || (rule[i] == '$' && next == '$')) {
      file += rule[++i];
    } else if (rule[i] == ' ' || rule[i] == '\n') {
      end_file();
    } else {
      file += rule[i];
    }
  }
  end_file();
  return files;
}

}  // namespace

CompiledObject::CompiledObject(std::string path)
    : path_{std::move(path)}, dependency_file_{path_ + ".d"}, command_file_{path_ + ".command"} {}

bool CompiledObject::is_up_to_date(const std::vector<std::string>& command) const {
  std::string text, rule;
  if (!read_file(command_file_, text).empty() || text != command_text(command)) return false;
  if (!read_file(dependency_file_, rule).empty()) return false;
  std::error_code error;
  const fs::file_time_type compiled = fs::last_write_time(to_native(path_), error);
  if (error) return false;
  const std::vector<std::string> files = prerequisites(rule);
  const auto is_older = [&](const std::string& file) {
    const fs::file_time_type changed = fs::last_write_time(to_native(file), error);
    return !error && changed <= compiled;
  };
  return !files.empty() && std::ranges::all_of(files, is_older);
}

void CompiledObject::begin() const {
  std::error_code missing;
  fs::remove(to_native(command_file_), missing);
}

/// An object without its command is compiled again.
void CompiledObject::complete(const std::vector<std::string>& command) const {
  static_cast<void>(write_files({{command_file_, command_text(command)}}));
}

}  // namespace edsc
