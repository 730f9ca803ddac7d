#include "system/environment.hpp"

#include <windows.h>

#include <shellapi.h>

#include <cstdlib>

#include "system/windows/wide_text.hpp"

namespace edsc {

// argv has lost the characters that the code page of the system does not have.
std::vector<std::string> program_arguments(int /*argc*/, char** /*argv*/) {
  int count = 0;
  wchar_t** const words = CommandLineToArgvW(GetCommandLineW(), &count);
  std::vector<std::string> arguments;
  for (int i = 1; words != nullptr && i < count; ++i) arguments.push_back(from_wide(words[i]));
  LocalFree(words);
  return arguments;
}

std::optional<std::string> environment_variable(const char* name) {
  const wchar_t* const value = _wgetenv(to_wide(name).c_str());
  return value != nullptr ? std::optional{from_wide(value)} : std::nullopt;
}

std::filesystem::path program_file() {
  std::wstring name(MAX_PATH, L'\0');
  DWORD length = 0;
  while ((length = GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size()))) == name.size()) {
    name.resize(2 * name.size());
  }
  name.resize(length);
  return name;
}

}  // namespace edsc
