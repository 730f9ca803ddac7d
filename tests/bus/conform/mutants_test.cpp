/// Which cases a wrong device fails. The table is mutants.tsv; `--write FILE` writes it anew, `--mutant NAME` and
/// `--only PATTERN` show one run. `--every N` compares each N-th mutant.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "every_service_run.hpp"

namespace edsc::conform {
namespace {

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> all;
  for (auto table : {sdo_mutants, pdo_mutants, control_mutants, network_mutants, new_case_mutants, hostile_mutants,
                     answer_mutants, timing_mutants}) {
    for (Mutant& mutant : table()) all.push_back(std::move(mutant));
  }
  return all;
}

std::string failed_cases(const RunReport& report) {
  std::string ids;
  for (const CaseResult& result : report.cases) {
    if (result.verdict != Verdict::failed) continue;
    ids += ids.empty() ? "" : " ";
    ids += result.row->id;
  }
  if (!report.lost.empty()) ids += ids.empty() ? "lost" : " lost";
  return ids;
}

int show(const Mutant& mutant, const std::vector<std::string>& only) {
  const RunReport report = run_every_service(mutant, only);
  for (const CaseResult& result : report.cases) {
    std::printf("%-6s %-20s %s\n", std::string{result.row->id}.c_str(),
                std::string{row_of(result.verdict).text}.c_str(), std::string{result.row->title}.c_str());
    for (const std::string& text : {result.reason, result.expected, result.got}) {
      if (!text.empty()) std::printf("         %s\n", text.c_str());
    }
    for (const std::string& text : result.warnings) std::printf("         warning: %s\n", text.c_str());
    for (const std::string& text : result.not_restored) std::printf("         not restored: %s\n", text.c_str());
    if (result.verdict != Verdict::failed) continue;
    for (const SeenFrame& seen : result.frames) {
      std::printf("         %10.6f %c %03X%s", static_cast<double>(seen.at) / 1e6, seen.sent ? '>' : '<',
                  static_cast<unsigned>(seen.frame.id), seen.frame.remote ? " R" : "");
      for (unsigned i = 0; i != seen.frame.size && !seen.frame.remote; ++i) std::printf(" %02X", seen.frame.data[i]);
      std::putchar('\n');
    }
  }
  for (const VerdictRow& row : verdicts) {
    std::printf("%zu %s\n", report.count(row.verdict), std::string{row.text}.c_str());
  }
  if (!report.lost.empty()) std::printf("lost: %s\n", report.lost.c_str());
  return report.passed() ? 0 : 1;
}

/// The problems of the table: mutants without a failing case, and cases that no mutant fails.
std::vector<std::string> gaps(const std::map<std::string, std::string>& failed) {
  std::set<std::string> covered;
  std::vector<std::string> problems;
  for (const auto& [name, ids] : failed) {
    if (ids.empty()) problems.push_back(name + ": no case fails");
    std::istringstream words{ids};
    for (std::string id; words >> id;) covered.insert(id);
  }
  for (const CaseRow* row : all_cases()) {
    if (!covered.contains(std::string{row->id}))
      problems.push_back("case " + std::string{row->id} + ": no mutant fails it");
  }
  return problems;
}

/// The cases that the unchanged device fails, and the values that are left changed.
std::vector<std::string> failures_of_good_device() {
  std::vector<std::string> problems;
  const RunReport report = run_every_service(Mutant{"none", {}, {}});
  for (const CaseResult& result : report.cases) {
    const bool fine = result.verdict == Verdict::passed || result.verdict == Verdict::not_applicable;
    if (!fine) problems.push_back("case " + std::string{result.row->id} + ": the good device does not pass");
  }
  problems.insert(problems.end(), report.not_restored.begin(), report.not_restored.end());
  if (!report.lost.empty()) problems.push_back(report.lost);
  std::printf("the good device: %zu passed, %zu not applicable\n", report.count(Verdict::passed),
              report.count(Verdict::not_applicable));
  return problems;
}

int compare(const std::string& path, bool write, std::size_t every) {
  std::map<std::string, std::string> failed, pinned;
  const std::vector<Mutant> mutants = all_mutants();
  for (std::size_t i = 0; i < mutants.size(); i += every) {
    failed[std::string{mutants[i].name}] = failed_cases(run_every_service(mutants[i]));
  }
  const bool is_whole = every == 1;
  std::vector<std::string> problems;
  if (is_whole) problems = gaps(failed);
  for (std::string& problem : failures_of_good_device()) problems.push_back(std::move(problem));
  if (write) {
    std::ofstream out{path};
    for (const auto& [name, ids] : failed) out << name << '\t' << ids << '\n';
  }
  std::ifstream in{path};
  for (std::string line; std::getline(in, line);) {
    const std::size_t tab = line.find('\t');
    pinned[line.substr(0, tab)] = tab == std::string::npos ? "" : line.substr(tab + 1);
  }
  for (const auto& [name, ids] : failed) {
    if (!pinned.contains(name)) {
      problems.push_back(name + ": is not in the table");
    } else if (pinned[name] != ids) {
      problems.push_back(name + ": fails \"" + ids + "\", the table has \"" + pinned[name] + "\"");
    }
  }
  for (const auto& [name, ids] : pinned) {
    if (is_whole && !failed.contains(name)) problems.push_back(name + ": is in the table, but does not exist");
  }
  for (const std::string& problem : problems) std::printf("%s\n", problem.c_str());
  std::printf("%zu mutants, %zu cases, %zu problems\n", failed.size(), all_cases().size(), problems.size());
  return problems.empty() ? 0 : 1;
}

int run(const std::vector<std::string>& arguments) {
  Mutant chosen{"none", {}, {}};
  std::vector<std::string> only;
  std::string table;
  bool write = false;
  std::size_t every = 1;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--write") {
      write = true;
    } else if (argument == "--every" && i + 1 < arguments.size()) {
      every = std::stoul(arguments[++i]);
    } else if (argument == "--only" && i + 1 < arguments.size()) {
      only.push_back(arguments[++i]);
    } else if (argument == "--mutant" && i + 1 < arguments.size()) {
      const std::string& name = arguments[++i];
      for (Mutant& mutant : all_mutants()) {
        if (mutant.name == name) chosen = mutant;
      }
      if (chosen.name != name) {
        std::fprintf(stderr, "there is no mutant \"%s\"\n", name.c_str());
        return 2;
      }
    } else {
      table = argument;
    }
  }
  return table.empty() ? show(chosen, only) : compare(table, write, every);
}

}  // namespace
}  // namespace edsc::conform

int main(int argc, char** argv) { return edsc::conform::run({argv + 1, argv + argc}); }
