#pragma once

#include <ros/time.h>

#include <algorithm>
#include <array>
#include <boost/shared_ptr.hpp>
#include <functional>
#include <map>
#include <tuple>
#include <utility>

namespace arfm_vo {

/// Brings together messages of exactly one stamp, one of each topic. As message_filters' ExactTime,
/// but where the stamps of a topic go back, what waits is forgotten: ExactTime keeps the newest
/// stamps, and a few incomplete sets that lie ahead keep all others out until their time comes.
template <class... Messages>
class ExactPairing {
 public:
  using Set = std::tuple<boost::shared_ptr<const Messages>...>;
  using Callback = std::function<void(const boost::shared_ptr<const Messages>&...)>;

  /// At most `max_waiting` incomplete sets wait.
  ExactPairing(size_t max_waiting, Callback callback)
      : max_waiting_(max_waiting), callback_(std::move(callback)) {}

  template <size_t topic>
  void Add(const std::tuple_element_t<topic, Set>& message) {
    const ros::Time stamp = message->header.stamp;
    // Another topic may have gone back before and be ahead by some messages: these wait on.
    if (stamp < last_[topic] && stamp < newest_ && waiting_.count(stamp) == 0) {
      waiting_.clear();
      newest_ = stamp;
    }
    last_[topic] = stamp;
    newest_ = std::max(newest_, stamp);
    Set& set = waiting_[stamp];
    std::get<topic>(set) = message;
    if (IsWhole(set)) {
      const Set whole = set;
      waiting_.erase(waiting_.begin(), waiting_.upper_bound(stamp));
      std::apply(callback_, whole);
    } else if (waiting_.size() > max_waiting_) {
      waiting_.erase(waiting_.begin());
    }
  }

 private:
  static bool IsWhole(const Set& set) {
    return std::apply([](const auto&... messages) { return (messages && ...); }, set);
  }

  const size_t max_waiting_;
  const Callback callback_;
  std::map<ros::Time, Set> waiting_;
  std::array<ros::Time, sizeof...(Messages)> last_;  // stamp of each topic
  ros::Time newest_;                                 // stamp since they went back
};

}  // namespace arfm_vo
