#include "system/run_program.hpp"

#include <windows.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cwctype>
#include <thread>
#include <utility>

#include "system/windows/open_handle.hpp"
#include "system/windows/wide_text.hpp"

namespace edsc {
namespace {

constexpr DWORD first_exception_code = 0xC0000000;  ///< exit code of a program that has crashed

/// Both ends of a pipe. The program that is started inherits the end for writing.
struct OutputPipe {
  OutputPipe() {
    HANDLE from = nullptr;
    HANDLE to = nullptr;
    if (CreatePipe(&from, &to, nullptr, 0) == 0) return;
    reading = OpenHandle{from};
    writing = OpenHandle{to};
    is_open = SetHandleInformation(to, HANDLE_FLAG_INHERIT, HANDLE_FLAG_INHERIT) != 0;
  }
  OpenHandle reading;
  OpenHandle writing;
  bool is_open = false;
};

void read_pipe(const OutputPipe& pipe, const std::function<void(std::string_view)>& take) {
  std::array<char, 1U << 16U> buffer;
  DWORD count = 0;
  while (ReadFile(pipe.reading.get(), buffer.data(), static_cast<DWORD>(buffer.size()), &count, nullptr) != 0) {
    take({buffer.data(), count});
  }
}

void append_limited(std::string& text, std::string_view piece) {
  if (text.size() <= max_program_output_bytes) text.append(piece);
}

/// An argument as CommandLineToArgvW() and the libraries of C read it: backslashes before a quotation mark are doubled.
void append_quoted(std::wstring& line, std::wstring_view argument) {
  line += line.empty() ? L"\"" : L" \"";
  std::size_t backslashes = 0;
  for (const wchar_t c : argument) {
    if (c == L'"') line.append(backslashes + 1, L'\\');
    backslashes = c == L'\\' ? backslashes + 1 : 0;
    line += c;
  }
  line.append(backslashes, L'\\');
  line += L'"';
}

/// The file of a program: in PATH, not in the current folder. Empty if there is none.
std::wstring find_program(const std::wstring& name) {
  const bool has_folder = name.find_first_of(L"/\\") != std::wstring::npos;
  const wchar_t* const folders = has_folder ? nullptr : _wgetenv(L"PATH");
  if (!has_folder && folders == nullptr) return {};
  std::wstring found(std::size_t{1} << 15U, L'\0');
  const DWORD length =
      SearchPathW(folders, name.c_str(), L".exe", static_cast<DWORD>(found.size()), found.data(), nullptr);
  found.resize(length < found.size() ? length : 0);
  return found;
}

/// The name of NAME=VALUE, in which letters have one case. The first character may be `=`, for the folders of drives.
std::wstring name_of_variable(std::wstring_view text) {
  std::wstring name{text.substr(0, text.find(L'=', 1))};
  std::ranges::transform(name, name.begin(), [](wchar_t c) { return static_cast<wchar_t>(std::towupper(c)); });
  return name;
}

/// `variables`, and those of this process that they do not replace, in the form of CreateProcessW().
std::wstring environment_with(const std::vector<std::string>& variables) {
  std::vector<std::wstring> all;
  all.reserve(variables.size());
  for (const std::string& variable : variables) all.push_back(to_wide(variable));
  wchar_t* const own = GetEnvironmentStringsW();
  for (const wchar_t* at = own; at != nullptr && *at != L'\0';) {
    const std::wstring_view text{at};
    const auto is_same = [&](const std::wstring& one) { return name_of_variable(one) == name_of_variable(text); };
    if (std::none_of(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(variables.size()), is_same)) {
      all.emplace_back(text);
    }
    at += text.size() + 1;
  }
  if (own != nullptr) FreeEnvironmentStringsW(own);
  std::ranges::sort(all, {}, name_of_variable);
  std::wstring block;
  for (const std::wstring& variable : all) block.append(variable) += L'\0';
  return block += L'\0';
}

/// The handles that the program inherits. Without a list it would inherit those for programs of other threads, too.
class Inheritance {
 public:
  explicit Inheritance(std::array<HANDLE, 3> handles) : handles_{handles} {
    SIZE_T size = 0;
    InitializeProcThreadAttributeList(nullptr, 1, 0, &size);
    bytes_.resize(size);
    InitializeProcThreadAttributeList(list(), 1, 0, &size);
    UpdateProcThreadAttribute(list(), 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, handles_.data(), sizeof handles_, nullptr,
                              nullptr);
  }
  Inheritance(const Inheritance&) = delete;
  Inheritance& operator=(const Inheritance&) = delete;
  ~Inheritance() { DeleteProcThreadAttributeList(list()); }
  [[nodiscard]] LPPROC_THREAD_ATTRIBUTE_LIST list() {
    return reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(bytes_.data());
  }

 private:
  std::array<HANDLE, 3> handles_;
  std::vector<char> bytes_;
};

/// Starts the program; nothing is open if that is not possible.
OpenHandle start(const std::vector<std::string>& words, const std::vector<std::string>& variables,
                 const std::array<HANDLE, 3>& streams) {
  const std::wstring program = find_program(to_wide(words.front()));
  if (program.empty()) return {};
  std::wstring line;
  for (const std::string& word : words) append_quoted(line, to_wide(word));
  std::wstring environment = environment_with(variables);
  Inheritance inheritance{streams};
  STARTUPINFOEXW startup{};
  startup.StartupInfo.cb = sizeof startup;
  startup.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
  startup.StartupInfo.hStdInput = streams[0];
  startup.StartupInfo.hStdOutput = streams[1];
  startup.StartupInfo.hStdError = streams[2];
  startup.lpAttributeList = inheritance.list();
  PROCESS_INFORMATION started{};
  if (CreateProcessW(program.c_str(), line.data(), nullptr, nullptr, TRUE,
                     CREATE_UNICODE_ENVIRONMENT | EXTENDED_STARTUPINFO_PRESENT, environment.data(), nullptr,
                     &startup.StartupInfo, &started) == 0) {
    return {};
  }
  CloseHandle(started.hThread);
  return OpenHandle{started.hProcess};
}

}  // namespace

std::optional<ProgramOutcome> run_program(std::vector<std::string> words,
                                          const std::function<void(std::string_view)>& on_output,
                                          std::vector<std::string> variables) {
  SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
  const OpenHandle input{
      CreateFileW(L"NUL", GENERIC_READ, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited, OPEN_EXISTING, 0, nullptr)};
  OutputPipe output;
  OutputPipe errors;
  if (!output.is_open || !errors.is_open) return std::nullopt;
  const OpenHandle process = start(words, variables, {input.get(), output.writing.get(), errors.writing.get()});
  if (!process) return std::nullopt;
  output.writing.close();
  errors.writing.close();
  ProgramOutcome outcome;
  {
    const std::jthread other{
        [&] { read_pipe(errors, [&](std::string_view piece) { append_limited(outcome.errors, piece); }); }};
    read_pipe(output, [&](std::string_view piece) {
      if (on_output) {
        on_output(piece);
      } else {
        append_limited(outcome.output, piece);
      }
    });
  }
  WaitForSingleObject(process.get(), INFINITE);
  DWORD code = 0;
  if (GetExitCodeProcess(process.get(), &code) != 0 && code < first_exception_code) {
    outcome.exit_code = static_cast<int>(code);
  }
  return outcome;
}

bool run_command_line(const std::string& line, const std::string& variable, const std::string& value) {
  SetEnvironmentVariableW(to_wide(variable).c_str(), to_wide(value).c_str());
  return _wsystem(to_wide(line).c_str()) == 0;  // NOLINT(cert-env33-c): the user's own command line
}

}  // namespace edsc
