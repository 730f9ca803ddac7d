/// edsc with few commands: `generate`, which a build of this project needs first, and what ./demo.sh shows besides.
#include <algorithm>
#include <array>
#include <string_view>

#include "program.hpp"
#include "system/environment.hpp"

namespace {

constexpr std::array names = {std::string_view{"generate"}, std::string_view{"check"}, std::string_view{"document"},
                              std::string_view{"plot"}};

consteval std::array<edsc::CommandRow, names.size()> rows() {
  std::array<edsc::CommandRow, names.size()> result{};
  std::ranges::transform(names, result.begin(), [](std::string_view name) {
    return *std::ranges::find_if(edsc::commands, [name](const edsc::CommandRow& row) { return row.name == name; });
  });
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  static constexpr auto few_commands = rows();
  return edsc::run_program(few_commands, EDSC_VERSION, edsc::program_arguments(argc, argv));
}
