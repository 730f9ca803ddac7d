/// edsc: the compiler for CANopen Electronic Data Sheets.
#include "program.hpp"

#include "commit.hpp"
#include "system/environment.hpp"

int main(int argc, char** argv) {
  return edsc::run_program(edsc::commands, EDSC_VERSION EDSC_COMMIT, edsc::program_arguments(argc, argv));
}
