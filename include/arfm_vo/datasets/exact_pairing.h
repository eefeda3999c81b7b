#pragma once

#include <algorithm>
#include <boost/shared_ptr.hpp>
#include <deque>
#include <functional>
#include <iterator>
#include <tuple>
#include <utility>

namespace arfm_vo {

/// Brings together messages of exactly one header.stamp, one of each topic. Stamps may go back:
/// what waits is in the order in which it came. (message_filters' ExactTime keeps the newest
/// stamps: a few incomplete sets that lie ahead keep all others out until their time comes.)
template <class... Messages>
class ExactPairing {
 public:
  using Callback = std::function<void(const boost::shared_ptr<const Messages>&...)>;

  /// At most `max_waiting` messages of each topic wait for the others.
  ExactPairing(size_t max_waiting, Callback callback)
      : max_waiting_(max_waiting), callback_(std::move(callback)) {}

  template <size_t topic, class Message>
  void Add(const boost::shared_ptr<const Message>& message) {
    auto& own = std::get<topic>(waiting_);
    own.push_back(message);
    if (own.size() > max_waiting_) own.pop_front();
    std::apply([&](auto&... queues) { CallWhereWhole(message->header.stamp, queues...); },
               waiting_);
  }

 private:
  template <class Queue, class Stamp>
  static auto Find(Queue& queue, const Stamp& stamp) {
    return std::find_if(queue.begin(), queue.end(),
                        [&](const auto& message) { return message->header.stamp == stamp; });
  }
  template <class Stamp, class... Queues>
  void CallWhereWhole(const Stamp& stamp, Queues&... queues) {
    if (((Find(queues, stamp) == queues.end()) || ...)) return;
    const std::tuple set(*Find(queues, stamp)...);
    (queues.erase(queues.begin(), std::next(Find(queues, stamp))), ...);
    std::apply(callback_, set);
  }

  const size_t max_waiting_;
  const Callback callback_;
  std::tuple<std::deque<boost::shared_ptr<const Messages>>...> waiting_;
};

}  // namespace arfm_vo
