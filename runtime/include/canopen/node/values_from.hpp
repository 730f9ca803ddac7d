/// A mailbox among the handlers of a node. Files without one do not include node/mailbox.hpp: `<atomic>` brings strings
/// and mutexes with it.
#pragma once

#include "canopen/od/object.hpp"

namespace canopen {

template <DictionaryObject... Objects>
class Mailbox;

/// A mailbox of a node, passed with its handlers.
template <class MailboxType>
struct ValuesFrom {
  MailboxType* mailbox;
};

namespace mailbox_detail {

template <class Handler>
inline constexpr bool is_values_from = false;
template <class MailboxType>
inline constexpr bool is_values_from<ValuesFrom<MailboxType>> = true;

}  // namespace mailbox_detail

}  // namespace canopen
