// Random edits of EDS and DCF files: undo gives the text before, redo the text after, and the journal what was not
// saved. The folder EDSC_CORPUS has further files; without it, only small files of the repository are edited.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "change/sheet_text.hpp"
#include "edit/edit_session.hpp"
#include "support/sheet_files.hpp"
#include "system/temporary_folder.hpp"
#include "text/source_file.hpp"

namespace edsc::edit {
namespace {

using Request = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::initializer_list<std::string_view> keys{"ParameterName",  "DataType",  "AccessType", "DefaultValue",
                                                       "ParameterValue", "LowLimit",  "HighLimit",  "PDOMapping",
                                                       "Unit",           "SubNumber", "ObjectType", "VendorNumber"};
constexpr std::initializer_list<std::string_view> texts{
    "",       "0",     "7",          "0x1F",        "64h",           "-5",         "70000",
    "REAL64", "const", "a ; remark", "  blanks   ", "$NODEID+0x180", "Größe in °C"};
constexpr std::initializer_list<std::string_view> indices{"1000", "1018", "1A00", "2000", "2000sub1", "5F00", "6041"};

/// A session, and the texts that it must have.
class RandomEdits {
 public:
  RandomEdits(std::string path, std::string journal)
      : path_{std::move(path)}, journal_{std::move(journal)}, saved_{read_bytes(path_).bytes}, states_{saved_} {
    random_.seed(static_cast<unsigned>(saved_.size()));
    open();
  }

  [[nodiscard]] bool can_edit() const { return session_->problem().empty(); }
  [[nodiscard]] std::size_t made() const { return made_; }

  void run(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) make_step();
    while (at_ > 0 && !testing::Test::HasFailure()) undo();
    EXPECT_FALSE(is_done("undo"));
    while (at_ + 1 < states_.size() && !testing::Test::HasFailure()) redo();
    EXPECT_FALSE(is_done("redo"));
    restart(true);
  }

 private:
  void open() { session_.emplace(SessionSettings{path_, {}, journal_, {}}); }

  /// Whether a request is not rejected.
  bool is_done(std::string_view action, Request request = Request::object()) {
    request["since"] = session_->version();
    const EditAnswer answer = session_->post(action, request.dump());
    EXPECT_EQ(answer.status, 200) << answer.body;
    return !answer.body.starts_with(R"({"rejected")");
  }

  void make_step() {
    switch (below(12)) {
      case 0:
      case 1: undo(); break;
      case 2: redo(); break;
      case 3: restart(below(4) > 0); break;
      case 4: save(); break;
      default: change(); break;
    }
  }

  void change() {
    Request changes = Request::array();
    for (std::size_t count = 1 + below(3); count > 0; --count) changes.push_back(random_change());
    SCOPED_TRACE(changes.dump());
    const bool is_forced = below(2) == 0;
    const bool is_made = is_done("change", {{"changes", std::move(changes)}, {"force", is_forced}});
    if (is_made && session_->bytes() != states_[at_]) {
      states_.resize(at_ + 1);
      states_.push_back(session_->bytes());
      go_to(at_ + 1);
      ++made_;
    }
    check("a change");
  }

  void undo() {
    ASSERT_EQ(is_done("undo"), at_ > 0);
    if (at_ > 0) go_to(at_ - 1);
    check("undo");
  }

  void redo() {
    const bool can_redo = at_ + 1 < states_.size();
    ASSERT_EQ(is_done("redo"), can_redo);
    if (can_redo) go_to(at_ + 1);
    check("redo");
  }

  void save() {
    ASSERT_TRUE(is_done("save"));
    saved_ = states_[at_];
    unsaved_.clear();
    check("save");
  }

  /// The program ends and is run again.
  void restart(bool uses_journal) {
    session_.reset();
    open();
    states_ = {saved_};
    at_ = 0;
    check("a restart");
    EXPECT_EQ(is_done("journal", {{"use", uses_journal}}), !unsaved_.empty());
    if (uses_journal) {
      states_.insert(states_.end(), unsaved_.begin(), unsaved_.end());
      at_ = states_.size() - 1;
    } else {
      unsaved_.clear();
    }
    check("the journal");
  }

  void go_to(std::size_t at) {
    at_ = at;
    if (states_[at] == saved_) {
      unsaved_.clear();
    } else {
      unsaved_.push_back(states_[at]);
    }
  }

  void check(const char* after) {
    EXPECT_TRUE(session_->bytes() == states_[at_]) << "another text after " << after;
    EXPECT_TRUE(read_bytes(path_).bytes == saved_) << "another file after " << after;
  }

  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>{0, end - 1}(random_); }
  std::string one_of(std::initializer_list<std::string_view> some) {
    return std::string{some.begin()[below(some.size())]};
  }

  Request random_change() {
    const SourceFile source{path_, session_->bytes()};
    const SheetText text{source};
    if (text.sections().empty()) return {{"do", "new"}, {"kind", "standard"}, {"objects", {"1000"}}};
    const TextSection& section = text.sections()[below(text.sections().size())];
    const std::vector<IniEntry> entries = text.entries(section);
    const bool has_key = !entries.empty() && below(2) == 0;
    const std::string key = has_key ? std::string{entries[below(entries.size())].key} : one_of(keys);
    switch (below(10)) {
      case 0: return {{"do", "remove"}, {"section", section.title}};
      case 1: return {{"do", "remove"}, {"section", section.title}, {"key", key}};
      case 2: return {{"do", "rename"}, {"section", section.title}, {"name", one_of(indices)}};
      case 3: return {{"do", "allow"}, {"section", section.title}, {"rule", "unknown-key"}, {"reason", "an old tool"}};
      case 4: return new_object(section);
      case 5: return pdo();
      default: return {{"do", "set"}, {"section", section.title}, {"key", key}, {"value", one_of(texts)}};
    }
  }

  Request new_object(const TextSection& section) {
    switch (below(3)) {
      case 0: return {{"do", "new"}, {"kind", "standard"}, {"objects", {one_of(indices)}}};
      case 1: return {{"do", "new"}, {"kind", "copy"}, {"from", section.title.substr(0, 4)}, {"to", {one_of(indices)}}};
      default: break;
    }
    return {{"do", "new"},          {"kind", "ARRAY"}, {"index", one_of(indices)}, {"name", "New values"},
            {"type", "UNSIGNED16"}, {"access", "rww"}, {"mappable", true},         {"elements", 1 + below(4)}};
  }

  Request pdo() {
    Request request{{"do", "pdo"}, {"direction", below(2) == 0 ? "rpdo" : "tpdo"}, {"number", 1 + below(5)}};
    if (below(2) == 0) request["entries"] = {"20000010h", "60410010h"};
    if (below(2) == 0) request["cob_id"] = {{"kind", below(2) == 0 ? "predefined" : "disabled"}};
    if (below(2) == 0) request["type"] = one_of({"1", "254"});
    return request;
  }

  std::string path_, journal_;
  std::mt19937 random_;
  std::optional<EditSession> session_;
  std::string saved_;                 ///< the bytes of the file
  std::vector<std::string> states_;   ///< from the first text to the last one that can be redone
  std::size_t at_ = 0;                ///< the state of the session
  std::vector<std::string> unsaved_;  ///< the texts since the one of the file, in the order of the journal
  std::size_t made_ = 0;
};

void edit_files(const std::vector<std::string>& files, std::size_t max_steps) {
  constexpr std::size_t max_bytes_of_steps = 300'000;
  std::size_t made = 0;
  for (const std::string& file : files) {
    SCOPED_TRACE(file);
    const TemporaryFolder folder{"edit"};
    const std::string path = folder.path() + "/" + fs::path{file}.filename().string();
    fs::copy_file(file, path);
    RandomEdits edits{path, folder.path() + "/journal"};
    if (!edits.can_edit()) continue;
    edits.run(std::clamp<std::size_t>(max_bytes_of_steps / fs::file_size(file), 2, max_steps));
    made += edits.made();
  }
  std::cout << made << " edits of " << files.size() << " files\n";
  EXPECT_GT(made, files.size());
}

TEST(EditFiles, OfTheRepository) {
  const fs::path root = EDSC_SOURCE_DIR;
  std::vector<std::string> files = sheet_files_in(root / "tests/fixtures");
  constexpr std::size_t max_bytes = 12'000;  // those of a larger one take seconds
  std::erase_if(files, [](const std::string& file) { return fs::file_size(file) > max_bytes; });
  edit_files(files, 10);
}

TEST(EditFiles, OfACorpus) {
  const char* const corpus = std::getenv("EDSC_CORPUS");
  if (corpus == nullptr || !fs::is_directory(corpus)) {
    std::cout << "SKIPPED: no corpus; set EDSC_CORPUS to its folder\n";
    return;
  }
  edit_files(sheet_files_in(corpus), 20);
}

}  // namespace
}  // namespace edsc::edit
