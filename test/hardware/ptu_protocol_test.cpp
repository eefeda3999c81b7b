#include "arfm_vo/hardware/ptu_protocol.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace arfm_vo {
namespace {

constexpr PtuAxis kPan = PtuAxis::kPan, kTilt = PtuAxis::kTilt;

std::vector<PtuReply> ParseAll(const std::string& bytes) {
  PtuReplyParser parser;
  parser.Feed(bytes);
  std::vector<PtuReply> replies;
  while (const auto reply = parser.Next()) replies.push_back(*reply);
  return replies;
}

PtuReply Done() { return {}; }
PtuReply Value(const std::string& text) { return {PtuReplyKind::kValue, text}; }
PtuReply Error(const std::string& text) { return {PtuReplyKind::kError, text}; }
PtuReply Hit(PtuAxis axis) { return {PtuReplyKind::kLimitHit, {}, axis}; }

TEST(PtuCommand, BytesAreThoseOfTheManual) {
  EXPECT_EQ(FormatPtuQuery(kPan, 'P'), "pp ");
  EXPECT_EQ(FormatPtuQuery(kTilt, 'P'), "tp ");
  EXPECT_EQ(FormatPtuSet(kPan, 'P', -2500), "pp-2500 ");
  EXPECT_EQ(FormatPtuSet(kPan, 'P', 2500), "pp2500 ");
  EXPECT_EQ(FormatPtuSet(kTilt, 'P', 0), "tp0 ");
  EXPECT_EQ(FormatPtuQuery(kPan, 'R'), "pr ");
  EXPECT_EQ(FormatPtuQuery(kTilt, 'N'), "tn ");
  EXPECT_EQ(FormatPtuQuery(kTilt, 'X'), "tx ");
  EXPECT_EQ(FormatPtuSet(kPan, 'S', 1900), "ps1900 ");
  EXPECT_EQ(FormatPtuSet(kTilt, 'S', 600), "ts600 ");
}

TEST(PtuReplyParser, TerseRepliesOfTheManualAndLimitHitsBetweenAndWithinThem) {
  const std::pair<const char*, std::vector<PtuReply>> rows[] = {
      {"*\r\n", {Done()}},
      {"* 22\r\n", {Value("22")}},
      {"* -2500\r", {Value("-2500")}},
      {"* 185.1428\r\n", {Value("185.1428")}},
      {"!T!T!P!P*\r\n", {Hit(kTilt), Hit(kTilt), Hit(kPan), Hit(kPan), Done()}},  // a reset
      {"!P* 22\r\n!T", {Hit(kPan), Hit(kTilt), Value("22")}},
      {"* 25!P00\r\n", {Hit(kPan), Value("2500")}},
      {"*!P\r\n", {Hit(kPan), Done()}}};
  for (const auto& [bytes, replies] : rows) EXPECT_EQ(ParseAll(bytes), replies) << bytes;
}

TEST(PtuReplyParser, RepliesOfTheManualInVerboseModeWithEcho) {
  const auto replies = ParseAll(
      "PP-2500 *\r\nA *\r\nPP * Current Pan position is -2500\r\n"
      "PR * 185.1428 seconds arc per Pan position\r\n"
      "PN * Minimum Pan position is -3090\r\nTX * Maximum Tilt position is 604\r\n"
      "PP3200 ! Maximum allowable Pan position is 3090\r\n"
      "PS3300 ! Pan speed cannot exceed 2902 positions/sec\r\n");
  EXPECT_EQ(replies, (std::vector{Done(), Done(), Value("Current Pan position is -2500"),
                                  Value("185.1428 seconds arc per Pan position"),
                                  Value("Minimum Pan position is -3090"),
                                  Value("Maximum Tilt position is 604"),
                                  Error("Maximum allowable Pan position is 3090"),
                                  Error("Pan speed cannot exceed 2902 positions/sec")}));
}

TEST(PtuReplyParser, PiecesOfAnySizeGiveTheSameReplies) {
  const std::string bytes = "!Ppp * 22\r\n*\r\n! Illegal command entered\r\n* -7\r\n!T";
  PtuReplyParser parser;
  std::vector<PtuReply> replies;
  for (const char c : bytes) {
    parser.Feed(std::string(1, c));
    while (const auto reply = parser.Next()) replies.push_back(*reply);
  }
  EXPECT_EQ(replies, (std::vector{Hit(kPan), Value("22"), Done(), Error("Illegal command entered"),
                                  Value("-7"), Hit(kTilt)}));
}

TEST(PtuReplyParser, AnUnfinishedValueWaits) {
  PtuReplyParser parser;
  parser.Feed("* 25");
  EXPECT_FALSE(parser.Next());
  parser.Feed("00\r");
  EXPECT_EQ(parser.Next(), Value("2500"));
  parser.Feed("*");
  EXPECT_FALSE(parser.Next());
  EXPECT_TRUE(parser.IsAtBareStar());
}

TEST(PtuReplyParser, EndlessNoiseDoesNotGrow) {
  PtuReplyParser parser;
  for (int i = 0; i < 1000; ++i) {
    parser.Feed("* 123456789 abcdefgh");
    while (parser.Next()) {
    }
  }
  parser.Feed("\r\n* 5\r\n");
  std::vector<PtuReply> replies;
  while (const auto reply = parser.Next()) replies.push_back(*reply);
  ASSERT_FALSE(replies.empty());
  EXPECT_EQ(replies.back(), Value("5"));
}

TEST(PtuNumber, IsAPlainNumberAndNothingElse) {
  EXPECT_EQ(ParsePtuNumber("-3090"), -3090);
  EXPECT_EQ(ParsePtuNumber("185.1428"), 185.1428);
  for (const char* bad : {"", "-", "12x4", "1 2", "12-3", "0x10", "1e3", "nan", "Pan 5", "12z",
                          "--5", ".", "5.", "12345678901234567", "Current Pan position is 5"})
    EXPECT_FALSE(ParsePtuNumber(bad)) << bad;
}

}  // namespace
}  // namespace arfm_vo
