#include "lint/allow_findings.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "diagnostics/quote.hpp"
#include "diagnostics/unknown_rule.hpp"
#include "eds/allow_comments.hpp"
#include "rules/check_rules.hpp"

namespace edsc {
namespace {

void report_former_id(RuleId rule, std::string_view id, const Position& position, Diagnostics& diagnostics) {
  if (id != rule.row().former_id) return;
  diagnostics.warning("deprecated-option", position,
                      fmt::format("the rule {} is called {} now", quote(id), rule.text()));
}

void allow_by_comment(const AllowComment& comment, Diagnostics& diagnostics) {
  const auto warning = [&](std::string message) {
    diagnostics.warning("allow-comment", comment.position, std::move(message));
  };
  if (comment.rule.empty()) return warning("a comment of edsc has the form \"; edsc: allow RULE - reason\"");
  const auto rule = find_rule(check_rules, comment.rule);
  if (!rule) return warning(unknown_rule(comment.rule, check_rules));
  if (comment.reason.empty()) return warning("missing reason: \"; edsc: allow RULE - reason\"");
  if (!comment.has_target) return warning("no key or section follows to which this comment applies");
  diagnostics.allow({*rule, std::string{comment.reason}, comment.position, true, comment.scope});
}

}  // namespace

void silence_by_options(const Options& options, Diagnostics& diagnostics) {
  for (const SilencedRule& silenced : options.silence) {
    if (const auto rule = find_rule(check_rules, silenced.rule)) {
      report_former_id(*rule, silenced.rule, silenced.position, diagnostics);
      diagnostics.silence(*rule);
    } else {
      diagnostics.error("options", silenced.position, "silence: " + unknown_rule(silenced.rule, check_rules));
    }
  }
}

void allow_by_options(const Options& options, Diagnostics& diagnostics) {
  for (const AllowedFindings& allowed : options.allow) {
    const auto rule = find_rule(check_rules, allowed.rule);
    if (!rule) {
      diagnostics.error("options", allowed.position, "allow: " + unknown_rule(allowed.rule, check_rules));
      continue;
    }
    report_former_id(*rule, allowed.rule, allowed.position, diagnostics);
    Allowance allowance{*rule, allowed.reason, allowed.position, false, {}};
    if (allowed.object) {
      const bool is_entry = allowed.object->sub_index.has_value();
      allowance.scope.kind = is_entry ? AllowanceScope::Kind::entry : AllowanceScope::Kind::object;
      allowance.scope.index = allowed.object->index;
      allowance.scope.sub_index = allowed.object->sub_index.value_or(0);
    }
    diagnostics.allow(std::move(allowance));
  }
}

void allow_by_comments(const SourceFile& source, const Options& options, Diagnostics& diagnostics) {
  const bool has_comments = source.text().find("edsc:") != std::string_view::npos;
  if (!has_comments && options.allow.empty()) return;
  AllowComments found = find_allow_comments(source);
  diagnostics.set_outline(std::move(found.outline));
  for (const AllowComment& comment : found.comments) allow_by_comment(comment, diagnostics);
}

}  // namespace edsc
