/// The files that people write in JSON are read alike: comments are allowed, a duplicate member is an error, and an
/// unknown one is named with a similar one. conform_deviations_test.cpp has the same tests of files of deviations.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "backend/cpp/identifier.hpp"
#include "device/options/options.hpp"
#include "network/network_description.hpp"
#include "support/diagnostic_matchers.hpp"

namespace edsc {
namespace {

using Messages = std::vector<std::string>;
using Findings = std::vector<Finding>;

Diagnostics options_findings(const std::string& text) {
  static std::vector<std::unique_ptr<SourceFile>> files;  // positions point to them
  files.push_back(std::make_unique<SourceFile>("pump.options.json", text));
  Diagnostics diagnostics;
  static_cast<void>(read_options(*files.back(), is_identifier, diagnostics));
  return diagnostics;
}

Diagnostics network_findings(const std::string& text) {
  static std::vector<std::unique_ptr<SourceFile>> files;  // positions point to them
  files.push_back(std::make_unique<SourceFile>("plant.json", text));
  Diagnostics diagnostics;
  static_cast<void>(read_network_file(*files.back(), diagnostics));
  return diagnostics;
}

const std::string nodes = R"("bit_rate": 500, "nodes": {"m": {"node_id": 1, "master": true}})";

TEST(JsonFiles, MayHaveComments) {
  EXPECT_EQ(messages(options_findings("// of the pump\n{ /* in ms */ \"sdo\": {\"timeout\": 500} }")), Messages{});
  EXPECT_EQ(messages(network_findings("{ // the plant\n" + nodes + " /* no signals */ }")), Messages{});
}

TEST(JsonFiles, HaveEachMemberOnce) {
  EXPECT_EQ(findings(options_findings("{\"settable\": [],\n \"settable\": []}")),
            (Findings{error_at(2, 2, "options-syntax")}));
  EXPECT_EQ(findings(network_findings("{" + nodes + ",\n \"bit_rate\": 250}")),
            (Findings{error_at(2, 2, "network-syntax")}));
}

TEST(JsonFiles, SuggestASimilarMember) {
  EXPECT_EQ(messages(options_findings(R"({"setable": []})")),
            (Messages{"setable: unknown option; did you mean \"settable\"?"}));
  EXPECT_EQ(messages(network_findings("{" + nodes + R"(, "signal": []})")),
            (Messages{"unknown member \"signal\"; did you mean \"signals\"?"}));
}

/// The parser of JSON takes a NUL for the end of the text: what follows it had been no part of the value.
TEST(JsonFiles, HaveNoNul) {
  using namespace std::string_literals;
  EXPECT_EQ(findings(options_findings("{\"settable\": []}\n\0e"s)), (Findings{error_at(2, 1, "options-syntax")}));
  EXPECT_EQ(findings(network_findings("{" + nodes + "}\0\"x\""s)), (Findings{error_at(1, 66, "network-syntax")}));
  EXPECT_EQ(messages(options_findings("{} // \0"s)), (Messages{"not JSON: NUL character"}));
}

}  // namespace
}  // namespace edsc
