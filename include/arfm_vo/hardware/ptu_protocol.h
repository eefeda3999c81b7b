#pragma once

#include <optional>
#include <string>

namespace arfm_vo {

/// The ASCII protocol of FLIR / Directed Perception pan-tilt units (PTU-D46 User's Manual 2.14,
/// section 4): commands end with a space; the unit answers "*", "* VALUE" or "! TEXT", each closed
/// by a carriage return, and reports limits that it hits at any time as "!P" and "!T".
enum class PtuAxis { kPan, kTilt };

/// "pan" or "tilt".
const char* ToString(PtuAxis axis);

/// "pp " asks for pan's P; the letters are P position, R resolution, N minimum, X maximum, S speed,
/// L lowest and U highest speed.
std::string FormatPtuQuery(PtuAxis axis, char letter);
/// "pp-2500 " sets pan's position to -2500 counts.
std::string FormatPtuSet(PtuAxis axis, char letter, int value);

enum class PtuReplyKind {
  kDone,      ///< "*"
  kValue,     ///< "* TEXT"
  kError,     ///< "! TEXT"
  kLimitHit,  ///< "!P" or "!T", belongs to no command
};

struct PtuReply {
  PtuReplyKind kind = PtuReplyKind::kDone;
  std::string text;              ///< of a value or an error, without what surrounds it
  PtuAxis axis = PtuAxis::kPan;  ///< of a limit hit
};

bool operator==(const PtuReply& a, const PtuReply& b);

/// Cuts the unit's bytes into replies, in whatever pieces they come. Echoed commands and garbage
/// before "*" and "!" are skipped; a limit hit within a reply's text is taken out of it.
class PtuReplyParser {
 public:
  void Feed(const std::string& bytes);
  /// The next whole reply, oldest first.
  std::optional<PtuReply> Next();
  /// True where a lone "*" has come that only more bytes or silence can tell from a value.
  bool IsAtBareStar() const { return buffer_ == "*"; }
  void Clear() { buffer_.clear(); }

 private:
  std::optional<PtuReply> TakeLimitHit();

  std::string buffer_;  ///< not yet cut
};

/// The number in a value's text, in terse feedback ("-2500", "185.1428"). Nothing where the text is
/// anything else, such as a garbled number or a sentence of verbose feedback.
std::optional<double> ParsePtuNumber(const std::string& text);

}  // namespace arfm_vo
