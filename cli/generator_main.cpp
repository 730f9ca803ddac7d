/// edsc with the command `generate` alone, which a build of this project needs first: it takes half of the time of
/// edsc.
#include <algorithm>
#include <string_view>

#include "program.hpp"

int main(int argc, char** argv) {
  static constexpr edsc::CommandRow generate = *std::ranges::find_if(
      edsc::commands, [](const edsc::CommandRow& row) { return row.name == std::string_view{"generate"}; });
  return edsc::run_program(std::span{&generate, 1}, EDSC_VERSION, argc, argv);
}
