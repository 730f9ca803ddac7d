#include "shared/output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <system_error>
#include <utility>

#include "shared/exit_code.hpp"

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

void flush_output() {
  if (!flushed()) throw std::system_error{errno, std::generic_category(), problem};
}

}  // namespace edsc
