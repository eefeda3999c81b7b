#include "arfm_vo/hardware/ptu_link.h"

#include <algorithm>

namespace arfm_vo {
namespace {

/// Silence after which the unit has nothing more to say, and the longest wait for it.
constexpr double kQuiet_s = 0.05, kMaxDrain_s = 0.5;
/// A reply's "*" counts as complete after this silence even without its line end.
constexpr double kBareStar_s = 0.1;
constexpr int kAttempts = 4;
constexpr PtuAxis kFenceAxis = PtuAxis::kPan;
constexpr char kFenceLetter = 'R';

}  // namespace

std::optional<PtuReply> PtuLink::TakeReply() {
  while (const auto reply = parser_.Next()) {
    if (reply->kind != PtuReplyKind::kLimitHit) return reply;
    has_limit_hit_ = true;
    ++counts_.num_limit_hits;
  }
  return std::nullopt;
}

std::optional<PtuReply> PtuLink::AwaitReply(double timeout_s) {
  const double deadline = stream_.Now() + timeout_s;
  while (true) {
    if (const auto reply = TakeReply()) return reply;
    const double left = deadline - stream_.Now();
    if (left <= 0) return std::nullopt;
    const bool is_bare = parser_.IsAtBareStar();
    const std::string bytes = stream_.Read(is_bare ? std::min(left, kBareStar_s) : left);
    if (bytes.empty() && is_bare) {
      parser_.Clear();
      return PtuReply{};
    }
    parser_.Feed(bytes);
  }
}

std::optional<PtuReply> PtuLink::Ask(const std::string& command) {
  parser_.Feed(stream_.Read(0));
  if (TakeReply()) MarkOutOfStep();  // nothing is asked: not an answer to what comes next
  if (!Synchronize()) return std::nullopt;
  ++counts_.num_commands;
  asked_s_ = stream_.Now();
  stream_.Write(command, reply_timeout_s_);
  const auto reply = AwaitReply(reply_timeout_s_);
  if (!reply) {
    ++counts_.num_timeouts;
    last_fault_s_ = stream_.Now();
    is_in_step_ = false;
  }
  return reply;
}

void PtuLink::Drain() {
  const double start = stream_.Now();
  double last_byte = start;
  while (stream_.Now() - last_byte < kQuiet_s && stream_.Now() - start < kMaxDrain_s) {
    const std::string bytes = stream_.Read(kQuiet_s);
    parser_.Feed(bytes);
    if (!bytes.empty()) last_byte = stream_.Now();
  }
  while (TakeReply()) {
  }
  parser_.Clear();
}

void PtuLink::MarkOutOfStep() {
  ++counts_.num_garbled;
  last_fault_s_ = stream_.Now();
  is_in_step_ = false;
}

bool PtuLink::Synchronize() {
  if (is_in_step_) return true;
  if (fence_text_.empty()) return false;
  ++counts_.num_resyncs;
  Drain();
  stream_.Write(" " + FormatPtuQuery(kFenceAxis, kFenceLetter), reply_timeout_s_);
  const double deadline = stream_.Now() + reply_timeout_s_;
  while (const auto reply = AwaitReply(deadline - stream_.Now())) {
    if (reply->kind != PtuReplyKind::kValue || reply->text != fence_text_) continue;
    Drain();  // an older fence's reply may have been taken for this one's
    is_in_step_ = true;
    return true;
  }
  ++counts_.num_timeouts;
  last_fault_s_ = stream_.Now();
  return false;
}

bool PtuLink::Initialize() {
  fence_text_.clear();
  is_in_step_ = false;
  stream_.Write(" ", reply_timeout_s_);  // closes a command that an earlier user left half sent
  Drain();
  for (const char* command : {"ft ", "ed ", "ci "}) {
    stream_.Write(command, reply_timeout_s_);
    AwaitReply(reply_timeout_s_);
    Drain();
  }
  std::string before;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    stream_.Write(FormatPtuQuery(kFenceAxis, kFenceLetter), reply_timeout_s_);
    const auto reply = AwaitReply(reply_timeout_s_);
    Drain();
    if (!reply || reply->kind != PtuReplyKind::kValue) continue;
    const auto value = ParsePtuNumber(reply->text);
    if (value && *value > 0 && reply->text == before) {
      fence_text_ = reply->text;
      is_in_step_ = true;
      return true;
    }
    before = reply->text;
  }
  return false;
}

std::optional<std::string> PtuLink::Command(const std::string& command) {
  const auto reply = Ask(command);
  if (!reply) return "the unit does not answer";
  if (reply->kind == PtuReplyKind::kDone) return std::nullopt;
  if (reply->kind == PtuReplyKind::kError) return "the unit refuses: " + reply->text;
  MarkOutOfStep();
  return "the unit answers something else: " + reply->text;
}

std::optional<PtuLink::Answer> PtuLink::Query(PtuAxis axis, char letter) {
  const auto reply = Ask(FormatPtuQuery(axis, letter));
  if (!reply) return std::nullopt;
  const double end_s = stream_.Now();
  const auto value =
      reply->kind == PtuReplyKind::kValue ? ParsePtuNumber(reply->text) : std::nullopt;
  if (!value) {
    MarkOutOfStep();
    return std::nullopt;
  }
  return Answer{*value, (asked_s_ + end_s) / 2, end_s - asked_s_};
}

std::optional<double> PtuLink::QueryTwice(PtuAxis axis, char letter) {
  std::optional<double> before;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const auto answer = Query(axis, letter);
    if (answer && before == answer->value) return before;
    before = answer ? std::optional(answer->value) : std::nullopt;
  }
  return std::nullopt;
}

void PtuLink::StartReset() {
  Drain();
  is_in_step_ = false;
  stream_.Write("r ", reply_timeout_s_);
}

bool PtuLink::PollReset() {
  const auto reply = AwaitReply(reply_timeout_s_);
  return reply && reply->kind == PtuReplyKind::kDone;
}

bool PtuLink::TakeLimitHit() {
  const bool had = has_limit_hit_;
  has_limit_hit_ = false;
  return had;
}

}  // namespace arfm_vo
