#pragma once

#include <string>
#include <utility>

#include "arfm_vo/base/random.h"

namespace arfm_vo {

/// Turns the unit's bytes into what a bad line makes of them, reply by reply.
class LineNoise {
 public:
  explicit LineNoise(uint32_t seed) : engine_(seed) {}

  std::string operator()(const std::string& bytes) {
    std::string out;
    for (const char c : bytes) {
      reply_ += c;
      if (c == '\n') out += Disturb(std::exchange(reply_, {}));
    }
    return out;
  }
  int num_replies = 0;

 private:
  uint32_t Below(uint32_t bound) { return RandomBelow(bound, engine_); }
  std::string Disturb(std::string reply) {
    ++num_replies;
    const std::string late = std::exchange(stale_, {});
    const size_t place = Below(static_cast<uint32_t>(reply.size()));
    switch (Below(24)) {
      case 0:
        return late;  // lost
      case 1:
        reply[place] = static_cast<char>(Below(256));
        break;
      case 2:
        reply[place] = static_cast<char>('0' + Below(10));
        break;
      case 3:
        reply.erase(place, 1);
        break;
      case 4:
        reply.insert(place, 1, static_cast<char>('0' + Below(10)));
        break;
      case 5:
        reply.insert(place, Below(2) ? "!P" : "!T");
        break;
      case 6:
        reply += reply;
        break;  // twice
      case 7:
        stale_ = reply;
        return late;  // comes with the next one
      case 8:
        reply = "* " + std::to_string(int(Below(8000)) - 4000) + "\r\n";
        break;
      case 9:
        reply = "! Illegal command entered\r\n";
        break;
      case 10:
        reply = "pp " + reply;
        break;  // echo
      case 11:
        reply = "* Current Pan position is 12\r\n";
        break;
      case 12:
        reply.clear();
        for (int i = Below(40); i > 0; --i) reply += static_cast<char>(Below(256));
        break;
      default:
        break;  // whole
    }
    return late + reply;
  }

  RandomEngine engine_;
  std::string reply_, stale_;
};

}  // namespace arfm_vo
