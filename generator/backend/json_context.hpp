/// A JSON view as the template library sees it, without a copy of it: names are looked up when a template asks for them.
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

  /// The library enters the section of something that `get` has given it, or of one item of such a list.
  void push(const Data* data) override { nodes_.push_back(node_of(data)); }
  void pop() override { nodes_.pop_back(); }

  /// Numbers are text; null is false. What is given lives until something else is asked for at the same depth.
  const Data* get(const std::string& name) const override;
  const Data* get_partial(const std::string&) const override { return nullptr; }

 private:
  /// Something given to the library that it may enter as a section.
  struct Given {
    std::size_t depth;  ///< of the sections that were open then
    const Json* node;
    Data data;
  };

  [[nodiscard]] const Json* find(const std::string& name) const;
  [[nodiscard]] const Json* node_of(const Data* data) const;
  const Data* give(const Json* node, Data data) const;

  std::vector<const Json*> nodes_;  ///< of the open sections; null for a condition, which has no names of its own
  mutable std::deque<Given> given_;
  mutable Data text_;
};

}  // namespace edsc
