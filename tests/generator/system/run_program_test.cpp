#include "system/run_program.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <string_view>

namespace edsc {
namespace {

TEST(RunProgram, ReturnsOutputErrorsAndExitCode) {
  const auto outcome = run_program({"sh", "-c", "echo \"$1\"; echo wrong >&2; exit 3", "sh", "a b; $HOME"});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->exit_code, 3);
  EXPECT_EQ(outcome->output, "a b; $HOME\n") << "no shell reads the arguments";
  EXPECT_EQ(outcome->errors, "wrong\n");
}

TEST(RunProgram, HasNoExitCodeAfterASignal) {
  const auto outcome = run_program({"sh", "-c", "kill -9 $$"});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->exit_code, -1);
}

TEST(RunProgram, PassesOnOutputInPieces) {
  std::string pieces;
  const auto outcome = run_program({"sh", "-c", "cat; echo done"}, [&](std::string_view piece) { pieces += piece; });
  ASSERT_TRUE(outcome);
  EXPECT_EQ(pieces, "done\n") << "standard input is empty";
  EXPECT_EQ(outcome->output, "");
}

TEST(RunProgram, ReturnsNothingForAnUnknownProgram) { EXPECT_FALSE(run_program({"edsc-has-no-such-program"})); }

TEST(RunCommandLine, HasTheVariable) {
  EXPECT_TRUE(run_command_line("test \"$EDSC_TEST_WORD\" = 'a b'", "EDSC_TEST_WORD", "a b"));
  EXPECT_FALSE(run_command_line("test \"$EDSC_TEST_WORD\" = 'a b'", "EDSC_TEST_WORD", "c"));
}

TEST(RunProgram, HasTheGivenVariablesOfTheEnvironment) {
  ::setenv("EDSC_TEST_KEPT", "kept", 1);
  ::setenv("EDSC_TEST_CHANGED", "old", 1);
  const auto outcome = run_program({"sh", "-c", "echo $EDSC_TEST_KEPT $EDSC_TEST_CHANGED $EDSC_TEST_NEW"}, {},
                                   {"EDSC_TEST_CHANGED=new", "EDSC_TEST_NEW=too"});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->output, "kept new too\n");
}

}  // namespace
}  // namespace edsc
