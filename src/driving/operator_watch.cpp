#include "arfm_vo/driving/operator_watch.h"

#include <algorithm>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// At the longest round trip and the longest time-out, three answers in a row may be lost.
constexpr double kPeriod_s = 0.1;

}  // namespace

std::optional<Challenge> OperatorWatch::Advance(double steady_s, uint64_t number) {
  now_s_ = steady_s;
  while (!sent_.empty() && steady_s - sent_.front().sent_s > options_.max_round_trip_s)
    sent_.pop_front();
  if (steady_s < due_s_) return std::nullopt;
  due_s_ = steady_s + kPeriod_s;
  sent_.push_back({{options_.rover, ++num_sent_, number}, steady_s});
  return sent_.back().challenge;
}

bool OperatorWatch::ObserveAnswer(double steady_s, const Challenge& answer) {
  const auto sent = std::find_if(sent_.begin(), sent_.end(), [&](const Sent& one) {
    return one.challenge.sequence == answer.sequence;
  });
  const bool is_ours = answer.rover == options_.rover && answer.sequence <= num_sent_ &&
                       (sent == sent_.end() || sent->challenge.number == answer.number);
  if (!is_ours) return ++answers_.num_foreign, false;
  if (sent == sent_.end() || steady_s - sent->sent_s > options_.max_round_trip_s)
    return ++answers_.num_late, false;
  if (sent->is_answered) return ++answers_.num_repeated, false;
  sent->is_answered = true;
  ++answers_.num_taken;
  answered_s_ = std::max(answered_s_, sent->sent_s);
  round_trip_s_ = steady_s - sent->sent_s;
  return true;
}

std::string OperatorWatch::DescribeRefused() const {
  const auto& [num_taken, num_late, num_repeated, num_foreign] = answers_;
  if (num_late + num_repeated + num_foreign == 0) return "";
  return Format("(answers refused: %ld late, %ld repeated, %ld foreign)", num_late, num_repeated,
                num_foreign);
}

}  // namespace arfm_vo
