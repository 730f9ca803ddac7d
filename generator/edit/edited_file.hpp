/// The file that a person edits, in one state: what its bytes describe, and what a change makes of them.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "device/options/options.hpp"
#include "diagnostics/diagnostics.hpp"
#include "edit/edit_history.hpp"
#include "edit/edit_parts.hpp"
#include "text/source_file.hpp"

namespace edsc::edit {

/// A change that is not made, with what the page shows.
struct EditRejection {
  std::optional<std::size_t> index;  ///< of the request in its list
  std::string message;
  Json findings = Json::array();
  bool can_force = false;
};

struct EditRequests {
  const nlohmann::json& list;
  bool is_forced = false;
  const SourceFile* imported = nullptr;  ///< the text of another file; null without one
};

class EditedFile;

/// The file after a change, or why it is not made.
struct ChangedFile {
  std::optional<EditRejection> rejection;
  EditStep step;  ///< without edits if the change changes nothing
  std::string bytes;
  std::unique_ptr<const EditedFile> after;
};

struct EditedFileFacts {
  std::string_view kind;            ///< `eds`, `dcf`, `overlay`, `network`
  std::optional<std::string> base;  ///< of an overlay
  bool is_committed = false;        ///< whether there is a file in git HEAD to compare with
};

/// It does not change. It uses no clock and no sockets, and reads files only.
class EditedFile {
 public:
  virtual ~EditedFile() = default;

  /// The file with other bytes; null if they cannot be edited, with the reason in `problem`.
  [[nodiscard]] virtual std::unique_ptr<const EditedFile> with_bytes(const std::string& bytes,
                                                                     std::string& problem) const = 0;
  /// All requests are one step; if one is rejected, none is made.
  [[nodiscard]] virtual ChangedFile changed(const EditRequests& requests) const = 0;

  /// Whether files that it names have changed since, so that the same bytes describe something else.
  [[nodiscard]] virtual bool is_outdated() const { return false; }

  [[nodiscard]] virtual EditedFileFacts facts() const = 0;
  [[nodiscard]] virtual const Diagnostics& diagnostics() const = 0;
  /// A finding as JSON, without fixes.
  [[nodiscard]] virtual Json finding(const Diagnostic& one) const = 0;
  /// What breaks masters, PDO partners or source code since git HEAD.
  [[nodiscard]] virtual Json broken_since_commit() const = 0;
  /// Requests that raise the major revision; an empty list if the file does not have one.
  [[nodiscard]] virtual nlohmann::json requests_for_major_revision() const = 0;
  /// Lines that have no meaning, and are kept.
  [[nodiscard]] virtual Json unreadable_lines() const = 0;
  /// All parts but `file` and `status`.
  virtual void add_parts(EditParts& parts) const = 0;
  /// Title, first line and lines of a section; null if the file does not have it.
  [[nodiscard]] virtual Json section(std::string_view title) const = 0;
};

/// What is edited, apart from its bytes.
struct EditedFileSettings {
  std::string path;
  Options options;                       ///< of the device
  std::optional<std::string> committed;  ///< the bytes of the file in git HEAD
};

/// Reads a file of any kind that can be edited; null for another one, with the reason in `problem`.
[[nodiscard]] std::unique_ptr<const EditedFile> open_edited_file(EditedFileSettings settings, const std::string& bytes,
                                                                 std::string& problem);

}  // namespace edsc::edit
