#include "shared/output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <utility>

#include "shared/exit_code.hpp"
#include "system/path.hpp"
#include "text/printable.hpp"

namespace edsc {
namespace {

constexpr const char* problem = "cannot write to standard output";

bool flushed() {
  std::cout.flush();
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout;
}

}  // namespace

bool finish_output(int error_number) {
  errno = error_number;
  if (flushed()) return true;
  print_to_stderr("edsc: {}{}{}\n", problem, errno == 0 ? "" : ": ", errno == 0 ? "" : std::strerror(errno));
  return false;
}

void write_output(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) {
    throw std::system_error{errno, std::generic_category(), problem};
  }
}

void write_output(const std::string& path, std::string text, const std::vector<std::string>& inputs) {
  if (path.empty()) {
    write_output(text);
  } else {
    write_all_files({{path, std::move(text)}}, inputs);
  }
}

void write_all_files(const std::vector<OutputFile>& files, const std::vector<std::string>& inputs) {
  if (const std::string failure = write_files(files, inputs); !failure.empty()) fail(failure);
}

void refuse_input(const std::string& path, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code error;
    if (!path.empty() && !input.empty() && std::filesystem::equivalent(to_native(path), to_native(input), error))
      fail(fmt::format("{}: is the same file as the input {}", printable(path), printable(input)));
  }
}

void flush_output() {
  if (!flushed()) throw std::system_error{errno, std::generic_category(), problem};
}

}  // namespace edsc
