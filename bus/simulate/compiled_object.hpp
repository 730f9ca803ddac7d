/// Object files that need not be compiled again.
#pragma once

#include <string>
#include <vector>

namespace edsc {

/// An object file, with the files beside it that state how it was made: `NAME.d`, the dependency file of the compiler,
/// and `NAME.command`.
class CompiledObject {
 public:
  explicit CompiledObject(std::string path);

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& dependency_file() const { return dependency_file_; }

  /// Whether the object was completed by this command, and is not older than a file that it was compiled from.
  [[nodiscard]] bool is_up_to_date(const std::vector<std::string>& command) const;

  /// The compiler begins; until `complete` the object is not up to date.
  void begin() const;
  void complete(const std::vector<std::string>& command) const;

 private:
  std::string path_, dependency_file_, command_file_;
};

}  // namespace edsc
