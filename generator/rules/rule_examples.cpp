#include "rules/rule_examples.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include "rules/check_rules.hpp"

namespace edsc {

/// The text of check_examples.txt, whose format tests/generator/lint/rules_test.py describes.
extern const std::string_view check_examples;

namespace {

using ExampleMap = std::map<RuleId, std::vector<RuleExample>>;

void trim_line_ends(std::string& block) {
  while (block.ends_with("\n\n") || block == "\n") block.pop_back();
}

void drop_empty_blocks(std::vector<std::string>& blocks) {
  for (std::string& block : blocks) trim_line_ends(block);
  std::erase(blocks, std::string{});
}

ExampleMap read_examples(std::string_view text) {
  ExampleMap all;
  std::vector<RuleExample>* of_rule = nullptr;
  std::string* block = nullptr;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with("@@ ")) {
      const bool is_wrong = line.starts_with("@@ bad");
      const bool is_options = line.ends_with(" options");
      if ((is_wrong && !is_options) || of_rule->empty()) of_rule->emplace_back();
      block = &(is_wrong ? of_rule->back().wrong : of_rule->back().right).emplace_back();
    } else if (line.starts_with("@ ")) {
      of_rule = &all[find_rule(check_rules, line.substr(2)).value()];
    } else if (block != nullptr) {
      block->append(line).append("\n");
    }
  }
  for (auto& [rule, examples] : all) {
    for (RuleExample& one : examples) {
      drop_empty_blocks(one.wrong);
      drop_empty_blocks(one.right);
    }
  }
  return all;
}

}  // namespace

const std::vector<RuleExample>& examples_of(RuleId rule) {
  static const ExampleMap all = read_examples(check_examples);
  static const std::vector<RuleExample> none;
  const auto found = all.find(rule);
  return found == all.end() ? none : found->second;
}

}  // namespace edsc
