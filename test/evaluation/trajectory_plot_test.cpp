#include "arfm_vo/evaluation/trajectory_plot.h"

#include <gmock/gmock.h>

namespace arfm_vo {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

PlottedPath MakePath() {
  PlottedPath path;
  path.estimate.resize(5);
  for (size_t i = 0; i < 5; ++i) path.estimate[i].translation.z() = static_cast<double>(i);
  path.truth = path.estimate;
  return path;
}

TEST(WritePlotScript, DashesToAndFromLostPairs) {
  PlottedPath path = MakePath();
  path.is_tracked = {true, true, false, true, true};
  const std::string script = WritePlotScript(path, "a.png");
  EXPECT_THAT(script, HasSubstr("$estimate << END\n0 0 0\n0 1 1\n0 2 NaN\n0 3 3\n0 4 4\nEND\n"));
  EXPECT_THAT(script, HasSubstr("$estimate using 1:3 with lines lw 2"));
  EXPECT_THAT(script, HasSubstr("$estimate with lines dt 2"));
}

TEST(WritePlotScript, DashesNothingWhereAllIsTracked) {
  const std::string script = WritePlotScript(MakePath(), "a.png");
  EXPECT_THAT(script, HasSubstr("$estimate << END\n0 0 0\n0 1 1\n0 2 2\n0 3 3\n0 4 4\nEND\n"));
  EXPECT_THAT(script, Not(HasSubstr("interpolated")));
}

}  // namespace
}  // namespace arfm_vo
