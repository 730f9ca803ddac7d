/// Adapts a JSON view to the template library without copying it: names are looked up when a template uses them.
#pragma once

#include <cstddef>
#include <deque>
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace edsc {

class JsonContext : public kainjow::mustache::basic_context<std::string> {
 public:
  using Data = kainjow::mustache::data;
  using Json = nlohmann::ordered_json;

  /// `view` is an object and must outlive the context.
  explicit JsonContext(const Json& view) : nodes_{&view} {}

  /// The library enters the section of a value returned by `get`, or of one item of such a list.
  void push(const Data* data) override { nodes_.push_back(node_of(data)); }
  void pop() override { nodes_.pop_back(); }

  /// Numbers are text; null is false. The result is valid until the next call at the same depth. Throws
  /// std::runtime_error if no open section has the name.
  const Data* get(const std::string& name) const override;
  const Data* get_partial(const std::string&) const override { return nullptr; }

 private:
  /// A value given to the library, which it may enter as a section.
  struct Given {
    std::size_t depth;  ///< of open sections at that time
    const Json* node;
    Data data;
  };

  [[nodiscard]] const Json* find(const std::string& name) const;
  [[nodiscard]] const Json* node_of(const Data* data) const;
  const Data* give(const Json* node, Data data) const;

  std::vector<const Json*> nodes_;  ///< of the open sections; null for a condition, which does not have names
  mutable std::deque<Given> given_;
  mutable Data text_;
};

}  // namespace edsc
