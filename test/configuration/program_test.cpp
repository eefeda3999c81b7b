#include "arfm_vo/configuration/program.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace arfm_vo {
namespace {

class ProgramTest : public testing::Test {
 protected:
  /// The exit status of `copy ARGUMENTS`; fills out_ and error_.
  int Run(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "copy");
    Program program;
    program.name = "copy";
    program.description = "Copies.";
    program.inputs = {{"FROM", &from_}, {"TO", &to_}};
    program.Add("count", count_, "N", "how often");
    program.Add("version", version_, "show the version");
    program.answer = [this] { return version_; };
    program.run = [this] {
      if (from_ == "bad") throw std::invalid_argument("bad: cannot be read");
      has_run_ = true;
    };
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = RunProgram(static_cast<int>(arguments.size()), arguments.data(), program);
    out_ = testing::internal::GetCapturedStdout();
    error_ = testing::internal::GetCapturedStderr();
    return status;
  }
  std::string from_, to_, out_, error_;
  int count_ = 1;
  bool version_ = false, has_run_ = false;
};

TEST_F(ProgramTest, RunsWithInputsAndOptions) {
  EXPECT_EQ(Run({"a", "--count=3", "b"}), 0);
  EXPECT_TRUE(has_run_);
  EXPECT_EQ(from_ + to_, "ab");
  EXPECT_EQ(count_, 3);
}

TEST_F(ProgramTest, HelpSaysEverything) {
  EXPECT_EQ(Run({"--help"}), 0);
  EXPECT_FALSE(has_run_);
  EXPECT_THAT(out_, testing::StartsWith("usage: copy FROM TO [options]\nCopies.\n"));
  EXPECT_THAT(out_, testing::HasSubstr("--count N"));
}

TEST_F(ProgramTest, AnswerNeedsNoInput) {
  EXPECT_EQ(Run({"--version"}), 0);
  EXPECT_FALSE(has_run_);
}

TEST_F(ProgramTest, WrongArgumentsAreTwo) {
  for (const auto& arguments : std::vector<std::vector<const char*>>{
           {}, {"a"}, {"a", "b", "c"}, {"a", "b", "--cou", "3"}, {"a", "b", "--count", "x"}}) {
    EXPECT_EQ(Run(arguments), 2);
    EXPECT_THAT(error_, testing::StartsWith("copy: "));
    EXPECT_FALSE(has_run_);
  }
}

TEST_F(ProgramTest, AnErrorIsOneLine) {
  EXPECT_EQ(Run({"bad", "b"}), 1);
  EXPECT_EQ(error_, "copy: bad: cannot be read\n");
}

}  // namespace
}  // namespace arfm_vo
