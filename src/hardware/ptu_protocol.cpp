#include "arfm_vo/hardware/ptu_protocol.h"

#include <algorithm>
#include <boost/algorithm/string/trim.hpp>
#include <cctype>
#include <regex>

namespace arfm_vo {
namespace {

/// No reply of the unit is longer; what is, is noise.
constexpr size_t kMaxReply = 160;

char AxisLetter(PtuAxis axis) { return axis == PtuAxis::kPan ? 'p' : 't'; }

bool IsLineEnd(char c) { return c == '\r' || c == '\n'; }

}  // namespace

const char* ToString(PtuAxis axis) { return axis == PtuAxis::kPan ? "pan" : "tilt"; }

std::string FormatPtuQuery(PtuAxis axis, char letter) {
  return {AxisLetter(axis), static_cast<char>(std::tolower(letter)), ' '};
}

std::string FormatPtuSet(PtuAxis axis, char letter, int value) {
  std::string command = FormatPtuQuery(axis, letter);
  command.insert(2, std::to_string(value));
  return command;
}

bool operator==(const PtuReply& a, const PtuReply& b) {
  return a.kind == b.kind && a.text == b.text && a.axis == b.axis;
}

void PtuReplyParser::Feed(const std::string& bytes) {
  for (const char c : bytes)
    if (c != '\0') buffer_ += c;
}

std::optional<PtuReply> PtuReplyParser::TakeLimitHit() {
  for (size_t i = buffer_.find('!'); i != std::string::npos; i = buffer_.find('!', i + 1)) {
    if (i + 1 >= buffer_.size()) break;
    const char letter = buffer_[i + 1];
    if (letter != 'P' && letter != 'T') continue;
    buffer_.erase(i, 2);
    return PtuReply{PtuReplyKind::kLimitHit, {}, letter == 'P' ? PtuAxis::kPan : PtuAxis::kTilt};
  }
  return std::nullopt;
}

std::optional<PtuReply> PtuReplyParser::Next() {
  if (const auto hit = TakeLimitHit()) return hit;
  const size_t start = buffer_.find_first_of("*!");
  buffer_.erase(0, start);  // all of it where there is none
  if (buffer_.size() < 2) return std::nullopt;
  if (buffer_[0] == '*' && (buffer_[1] == '*' || buffer_[1] == '!')) {
    buffer_.erase(0, 1);
    return PtuReply{};
  }
  const auto end = std::find_if(buffer_.begin(), buffer_.end(), IsLineEnd);
  if (end == buffer_.end()) {
    if (buffer_.size() > kMaxReply) buffer_.clear();
    return std::nullopt;
  }
  const bool is_error = buffer_[0] == '!';
  PtuReply reply{is_error ? PtuReplyKind::kError : PtuReplyKind::kDone,
                 boost::trim_copy(std::string(buffer_.begin() + 1, end))};
  if (!is_error && !reply.text.empty()) reply.kind = PtuReplyKind::kValue;
  buffer_.erase(buffer_.begin(), end + 1);
  return reply;
}

std::optional<double> ParsePtuNumber(const std::string& text) {
  // No exponent, no hexadecimal, no "nan".
  static const std::regex number("[+-]?[0-9]+(\\.[0-9]+)?");
  if (text.size() > 16 || !std::regex_match(text, number)) return std::nullopt;
  return std::stod(text);
}

}  // namespace arfm_vo
