#include "backend/json_context.hpp"

#include <functional>
#include <stdexcept>

namespace edsc {

const JsonContext::Data* JsonContext::get(const std::string& name) const {
  const Json* node = find(name);
  if (node == nullptr) throw std::runtime_error{"{{" + name + "}}: the view does not have this name"};
  switch (node->type()) {
    case Json::value_t::string: text_ = Data{node->get_ref<const std::string&>()}; return &text_;
    case Json::value_t::number_integer:
    case Json::value_t::number_unsigned:
    case Json::value_t::number_float: text_ = Data{node->dump()}; return &text_;
    case Json::value_t::array: return give(node, Data{kainjow::mustache::list(node->size(), Data{true})});
    case Json::value_t::object: return give(node, Data{true});
    case Json::value_t::boolean: return give(nullptr, Data{node->get<bool>()});
    case Json::value_t::null:
    case Json::value_t::binary:
    case Json::value_t::discarded: break;
  }
  return give(nullptr, Data{false});
}

/// The innermost section with this name; `.` is the section itself.
const JsonContext::Json* JsonContext::find(const std::string& name) const {
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    if (*node == nullptr) continue;
    if (name == ".") return *node;
    if (!(*node)->is_object()) continue;
    if (const auto member = (*node)->find(name); member != (*node)->end()) return &*member;
  }
  return nullptr;
}

/// Stores a value that the library may enter. Earlier values at this depth or deeper are no longer in use.
const JsonContext::Data* JsonContext::give(const Json* node, Data data) const {
  while (!given_.empty() && given_.back().depth >= nodes_.size()) given_.pop_back();
  given_.push_back({nodes_.size(), node, std::move(data)});
  return &given_.back().data;
}

const JsonContext::Json* JsonContext::node_of(const Data* data) const {
  for (auto given = given_.rbegin(); given != given_.rend(); ++given) {
    if (data == &given->data) return given->node;
    if (!given->data.is_non_empty_list()) continue;
    const auto& list = given->data.list_value();
    const Data* const first = list.data();
    const std::less_equal<> not_behind;
    if (not_behind(first, data) && !not_behind(first + list.size(), data)) {
      return &(*given->node)[static_cast<std::size_t>(data - first)];
    }
  }
  return nullptr;
}

}  // namespace edsc
