#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"

namespace arfm_vo {

struct OperatorWatchOptions {
  bool is_required = true;        ///< false only where nobody can be hurt, as in simulation
  std::string rover;              ///< its name in challenges; empty: the computer's host name
  double max_round_trip_s = 0.5;  ///< from a challenge to its answer; a later one is refused
  double timeout_s = 0.9;         ///< counts from the challenge whose answer was the last to count

  void Check() const {
    Require(timeout_s >= 0.2 && timeout_s <= 0.9,
            "operator_watch.timeout_s must be in 0.2..0.9: the rover must stand within 1 s");
    Require(max_round_trip_s >= 0.1 && max_round_trip_s <= timeout_s,
            "operator_watch.max_round_trip_s must be in 0.1..timeout_s");
  }
  ARFM_FIELDS(is_required, rover, max_round_trip_s, timeout_s)
};

/// What the person's program has to send back as it came: only who hears the rover now knows it.
struct Challenge {
  std::string rover;
  uint32_t sequence = 0;
  uint64_t number = 0;
};

/// Answers since the start.
struct AnswerCounts {
  long num_taken = 0;
  long num_late = 0;      ///< refused: the challenge was sent too long ago
  long num_repeated = 0;  ///< refused: the challenge had been answered
  long num_foreign = 0;   ///< refused: another rover's name, or a number that was not sent
};

/// Whether a person attends the rover: a dead-man's handle by challenge and answer. Only the
/// rover's own steady clock counts, s: an answer is as old as its challenge, so that neither a slow
/// link nor a recording can keep the rover driving.
class OperatorWatch {
 public:
  explicit OperatorWatch(const OperatorWatchOptions& options) : options_(options) {
    options_.Check();
  }

  /// Goes on to `steady_s`, to be called at least every 0.1 s. The next challenge where one is due,
  /// ten a second, with `number`, which must not be foreseeable.
  std::optional<Challenge> Advance(double steady_s, uint64_t number);
  /// Says whether the answer counts.
  bool ObserveAnswer(double steady_s, const Challenge& answer);

  bool IsMissing() const { return options_.is_required && !IsAnswered(); }
  /// From the challenge to the answer that was the last to count; nothing where it is too long ago.
  std::optional<double> RoundTrip() const {
    return IsAnswered() ? std::optional(round_trip_s_) : std::nullopt;
  }
  const AnswerCounts& Answers() const { return answers_; }
  /// In words, which answers were refused; empty where none were.
  std::string DescribeRefused() const;

 private:
  struct Sent {
    Challenge challenge;
    double sent_s = 0;
    bool is_answered = false;
  };
  bool IsAnswered() const { return now_s_ - answered_s_ <= options_.timeout_s; }

  OperatorWatchOptions options_;
  std::deque<Sent> sent_;  // those that may still be answered
  uint32_t num_sent_ = 0;
  AnswerCounts answers_;
  double now_s_ = 0, due_s_ = -std::numeric_limits<double>::infinity();
  double answered_s_ = -std::numeric_limits<double>::infinity();  // when its challenge was sent
  double round_trip_s_ = 0;
};

}  // namespace arfm_vo
