#pragma once

#include <limits>
#include <optional>
#include <string>

#include "arfm_vo/hardware/byte_stream.h"
#include "arfm_vo/hardware/ptu_protocol.h"

namespace arfm_vo {

/// What went over the line, for diagnostics.
struct PtuLinkCounts {
  int num_commands = 0;
  int num_timeouts = 0;  ///< no reply in time
  int num_garbled = 0;   ///< a reply that does not fit its command, or two that disagree
  int num_resyncs = 0;   ///< times the replies had to be matched to commands anew
  int num_limit_hits = 0;
};

/// Asks a PTU and keeps replies with their commands. The protocol's replies carry no number: after
/// a reply that is late or does not fit, those still under way could be taken for answers to what
/// is asked next. So the link then counts as out of step, and answers nothing more until it has
/// asked for something whose reply cannot be mistaken and thrown away all that came before it.
class PtuLink {
 public:
  PtuLink(ByteStream& stream, double reply_timeout_s)
      : stream_(stream), reply_timeout_s_(reply_timeout_s) {}

  /// Sets the mode that all else needs: no echo, terse, axes independent; then reads the text that
  /// marks the end of old replies. False where the unit does not answer as it should.
  bool Initialize();

  /// A command that is answered by "*". Returns nothing where it was, else why not.
  std::optional<std::string> Command(const std::string& command);

  struct Answer {
    double value = 0;
    double time_s = 0;  ///< middle of the round trip, on the stream's clock
    double round_trip_s = 0;
  };
  /// The number that a query is answered with; nothing on any failure, then the link is out of
  /// step.
  std::optional<Answer> Query(PtuAxis axis, char letter);

  /// As Query, for values that stand still: two equal answers in a row, within a few attempts.
  std::optional<double> QueryTwice(PtuAxis axis, char letter);

  /// Back in step where the link is out of it; false where the unit does not answer.
  bool Synchronize();
  /// To be called where the caller finds an answer impossible.
  void MarkOutOfStep();

  /// Sends the reset; its end is awaited by PollReset.
  void StartReset();
  /// True once the reset is confirmed. Waits at most the reply's timeout.
  bool PollReset();

  /// Takes in what has come unasked. True where a limit was hit since the last call.
  bool TakeLimitHit();
  const PtuLinkCounts& counts() const { return counts_; }
  /// When a reply was last late or garbled, on the stream's clock; -infinity where never.
  double last_fault_s() const { return last_fault_s_; }

 private:
  std::optional<PtuReply> AwaitReply(double timeout_s);
  std::optional<PtuReply> TakeReply();
  std::optional<PtuReply> Ask(const std::string& command);
  void Drain();

  ByteStream& stream_;
  const double reply_timeout_s_;
  PtuReplyParser parser_;
  std::string
      fence_text_;      ///< reply to the pan resolution's query: it has a point, counts have none
  double asked_s_ = 0;  ///< when the last command began to leave
  double last_fault_s_ = -std::numeric_limits<double>::infinity();
  bool is_in_step_ = false;
  bool has_limit_hit_ = false;
  PtuLinkCounts counts_;
};

}  // namespace arfm_vo
