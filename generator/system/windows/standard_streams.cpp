#include "system/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <windows.h>

#include <io.h>

#include <array>
#include <cstdlib>
#include <optional>

#include "system/environment.hpp"
#include "system/write_all.hpp"

namespace edsc {
namespace {

/// Some values of an older SDK are missing.
constexpr DWORD escape_sequences = 0x0004;  ///< ENABLE_VIRTUAL_TERMINAL_PROCESSING

/// The settings of the console, which other programs use after this one.
class Console {
 public:
  void prepare() {
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      DWORD mode = 0;
      const HANDLE output = GetStdHandle(outputs[i]);
      if (GetConsoleMode(output, &mode) == 0) continue;
      modes_[i] = mode;
      if (SetConsoleMode(output, mode | escape_sequences) == 0) has_escape_sequences_ = false;
    }
    if (!modes_[0] && !modes_[1]) return;
    code_page_ = GetConsoleOutputCP();
    SetConsoleOutputCP(CP_UTF8);
  }

  void restore() const {
    if (code_page_ != 0) SetConsoleOutputCP(code_page_);
    for (std::size_t i = 0; i < modes_.size(); ++i) {
      if (modes_[i]) SetConsoleMode(GetStdHandle(outputs[i]), *modes_[i]);
    }
  }

  [[nodiscard]] bool has_escape_sequences() const { return has_escape_sequences_; }

 private:
  static constexpr std::array outputs{STD_OUTPUT_HANDLE, STD_ERROR_HANDLE};
  std::array<std::optional<DWORD>, 2> modes_;  ///< nothing for what is not a console
  UINT code_page_ = 0;
  bool has_escape_sequences_ = true;
};

Console console;

}  // namespace

void prepare_standard_streams() {
  for (std::FILE* const stream : {stdin, stdout, stderr}) {
    if (_fileno(stream) >= 0) _setmode(_fileno(stream), _O_BINARY);
  }
  console.prepare();
  std::atexit([] { console.restore(); });
}

bool is_terminal(std::FILE* stream) {
  DWORD mode = 0;
  return GetConsoleMode(reinterpret_cast<HANDLE>(_get_osfhandle(_fileno(stream))), &mode) != 0;
}

bool is_dumb_terminal() { return !console.has_escape_sequences() || environment_variable("TERM") == "dumb"; }

void report_closed_pipes() {}  // Windows has no signal for it

void write_to_stderr(std::string_view text) { static_cast<void>(write_all(STDERR_FILENO, text)); }

int write_unbuffered(std::FILE* stream, std::string_view text) { return write_all(_fileno(stream), text); }

}  // namespace edsc
