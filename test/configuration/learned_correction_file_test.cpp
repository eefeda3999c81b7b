#include "arfm_vo/configuration/learned_correction_file.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>

#include "arfm_vo/base/whole_file.h"
#include "base/folder_test.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

const StereoCamera kCamera{707.0912, 707.0912, 601.8873, 183.1104, 0.537150, 1226, 370};

class LearnedCorrectionFileTest : public FolderTest {
 protected:
  LearnedCorrectionFileTest() {
    belief_ = CorrectionBelief::OfCalibration(kCamera);
    belief_.mean.coefficients_px.setLinSpaced(-0.3, 1.4);
  }

  void ExpectRefused(const std::string& from, const std::string& to, const std::string& why) {
    WriteLearnedCorrection(path_, kCamera, belief_);
    std::string text = ReadWholeFile(path_);
    const size_t place = text.find(from);
    ASSERT_NE(place, std::string::npos);
    WriteWholeFile(path_, text.replace(place, from.size(), to));
    EXPECT_THAT(RefusalOf([&] { ReadLearnedCorrection(path_, kCamera); }),
                testing::AllOf(testing::HasSubstr(path_.string()), testing::HasSubstr(why)));
  }

  const std::filesystem::path path_ = folder_ / "deep" / "camera.yaml";
  CorrectionBelief belief_;
};

TEST_F(LearnedCorrectionFileTest, ComesBackAsThatOfAnEarlierDrive) {
  EXPECT_FALSE(ReadLearnedCorrection(path_, kCamera));
  WriteLearnedCorrection(path_, kCamera, belief_);
  const auto back = ReadLearnedCorrection(path_, kCamera);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->mean.coefficients_px, belief_.mean.coefficients_px);
  EXPECT_EQ(back->covariance, belief_.covariance);
  EXPECT_TRUE(back->is_of_earlier_drive);
}

TEST_F(LearnedCorrectionFileTest, BelongsToItsCameraAlone) {
  WriteLearnedCorrection(path_, kCamera, belief_);
  StereoCamera other = kCamera;
  other.baseline_m = 0.54;
  EXPECT_FALSE(ReadLearnedCorrection(path_, other));
  EXPECT_NE(NameLearnedCorrection(other), NameLearnedCorrection(kCamera));
  EXPECT_EQ(NameLearnedCorrection(kCamera), NameLearnedCorrection(kCamera));
}

TEST_F(LearnedCorrectionFileTest, ErrorsNameFileAndKey) {
  ExpectRefused(
      "mean_px: [", "mean_px: [7, ",
      "mean_px must be a list of " + std::to_string(StereoCorrection::kSize) + " numbers");
  ExpectRefused("mean_px: [", "# ", "mean_px must be a list");
  ExpectRefused("mean_px: [-0.3", "mean_px: [nan", "mean_px");
  ExpectRefused("mean_px", "mean", "mean_px");
  ExpectRefused("covariance_px2: [", "covariance_px2: [-", "covariance");
  ExpectRefused("camera: [", "camera: {", "camera.yaml");
  ExpectRefused("# What", ",", "more than one YAML document");
}

}  // namespace
}  // namespace arfm_vo
