/// A file that a person edits: its changes, undo and redo, the journal, the file on the disk. No sockets and no clock.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/options/options.hpp"
#include "edit/edit_history.hpp"
#include "edit/edit_journal.hpp"
#include "edit/edited_file.hpp"
#include "edit/merge_edits.hpp"

namespace edsc::edit {

struct SessionSettings {
  std::string path;
  Options options;                       ///< of the device
  std::string journal_folder;            ///< empty: no journal
  std::optional<std::string> committed;  ///< the bytes of the file in git HEAD
};

/// An answer as JSON text with the status of HTTP.
struct EditAnswer {
  int status = 200;
  std::string body;
};

/// Requests and answers: docs/schema/edit.schema.json. Only `save` writes the file, and only if nobody else has
/// changed it.
class EditSession {
 public:
  explicit EditSession(SessionSettings settings);

  /// Why the file cannot be edited; empty if it can be.
  [[nodiscard]] const std::string& problem() const { return problem_; }
  /// Why unsaved edits are not stored; empty if they are.
  [[nodiscard]] const std::string& journal_problem() const { return journal_.problem(); }

  /// Answers a request of the page: `change`, `undo`, `redo`, `review`, `save`, `resolve`, `journal`, `import`.
  [[nodiscard]] EditAnswer post(std::string_view action, std::string_view body);
  /// What changed after this version; all with 0.
  [[nodiscard]] std::string update(std::uint64_t since) const;
  [[nodiscard]] EditAnswer section(std::string_view title) const;
  /// The unsaved edits as a unified diff.
  [[nodiscard]] std::string diff() const;
  [[nodiscard]] std::string diff_json() const;

  /// Takes over what another program has written. Returns whether the version has changed.
  bool look_at_disk();

  [[nodiscard]] std::uint64_t version() const { return version_; }
  [[nodiscard]] bool has_unsaved_edits() const { return bytes_ != saved_ || !conflicts_.empty(); }
  /// The bytes as edited, which `save` writes.
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  struct Part {
    std::string text;
    std::uint64_t version = 0;
  };

  void open();
  void become(std::string bytes);
  void take_step(ChangedFile changed);
  void record(const EditStep& step, std::string_view before);
  /// The journal has the one step of a restarted history.
  void restart_journal();
  void publish();
  [[nodiscard]] nlohmann::ordered_json status() const;
  [[nodiscard]] std::shared_ptr<const SourceFile> text_of(const std::string& bytes) const;

  void change(const nlohmann::json& request);
  void apply(const nlohmann::json& requests, bool is_forced);
  void undo();
  void redo();
  [[nodiscard]] nlohmann::ordered_json review() const;
  void save(const nlohmann::json& request);
  void resolve(const nlohmann::json& request);
  void answer_journal(const nlohmann::json& request);
  [[nodiscard]] nlohmann::ordered_json import(const nlohmann::json& request);
  void merge(const std::string& base, const std::string& mine, const std::string& disk);
  void check_editable() const;

  SessionSettings settings_;
  EditJournal journal_;
  std::string problem_;
  std::string saved_;  ///< the bytes of the file on the disk, as far as known
  std::string bytes_;
  std::unique_ptr<const EditedFile> file_;
  EditHistory history_;
  std::optional<StoredEdits> stored_;  ///< of an earlier session, not yet used or discarded
  std::vector<EditConflict> conflicts_;
  std::string conflict_base_, conflict_mine_;  ///< what was merged; while there are conflicts
  std::string message_;
  std::unique_ptr<const SourceFile> imported_;

  std::uint64_t version_ = 0;
  std::map<std::string, Part> parts_;
  std::map<std::string, std::uint64_t> removed_;
};

}  // namespace edsc::edit
