/// Unsaved edits on the disk, to offer them again after a crash.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "edit/edit_history.hpp"
#include "system/locked_file.hpp"

namespace edsc::edit {

/// What an earlier session did not save.
struct StoredEdits {
  std::string base;  ///< the bytes of the file before the first step
  std::vector<EditStep> steps;

  [[nodiscard]] std::string result() const;
};

/// The journal of one file, with mode 0600, which only one session has at a time. A record is on the disk when a
/// function returns. Each line is a JSON value: the bytes of the file and the number of the steps that are written with
/// them, or a step. The last complete beginning counts, so that no step is lost if the program ends while a new
/// beginning is written.
class EditJournal {
 public:
  /// `folder`: created if it is missing. `file`: an absolute path.
  EditJournal(const std::string& folder, const std::string& file);
  ~EditJournal();
  EditJournal(const EditJournal&) = delete;
  EditJournal& operator=(const EditJournal&) = delete;

  /// Why edits are not stored, such as a folder that cannot be written; empty if they are.
  [[nodiscard]] const std::string& problem() const { return problem_.empty() ? file_.problem() : problem_; }
  /// Whether another session edits the file.
  [[nodiscard]] bool is_taken() const { return file_.is_taken(); }

  /// What is stored. A line that was not written completely is not used, and no step after it.
  [[nodiscard]] std::optional<StoredEdits> stored() const;

  /// Begins with the bytes of the file and the steps since, in place of what was stored.
  void begin(const std::string& base, const std::vector<EditStep>& steps);
  void add(const EditStep& step);
  /// Forgets everything; without edits, the journal is removed at the end.
  void clear();
  [[nodiscard]] bool has_begun() const { return has_begun_; }

 private:
  LockedFile file_;
  std::string problem_;  ///< of the folder
  bool has_begun_ = false;
};

/// `$XDG_STATE_HOME/edsc`, or `~/.local/state/edsc`; empty without a home folder.
[[nodiscard]] std::string journal_folder();

}  // namespace edsc::edit
