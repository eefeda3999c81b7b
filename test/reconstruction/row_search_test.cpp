#include "arfm_vo/reconstruction/row_search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/blob_texture.h"

namespace arfm_vo {
namespace {

constexpr int kSize = 240;

RowSearch SearchIn(const cv::Mat& left, const cv::Mat& right) {
  RowSearch search;
  search.SetImages(left, right);
  return search;
}

TEST(RowSearch, FindsTheDisparityToAboutAPixel) {
  const BlobTexture texture(kSize, 1.5, 1);
  const RowSearch search = SearchIn(texture.Render(0, 0, 2, 1), texture.Render(-31.3, 0.4, 2, 2));
  int num_found = 0, num_searched = 0;
  for (int y = 20; y < kSize - 20; y += 10) {
    for (int x = 80; x < kSize - 30; x += 10) {
      const cv::Point2f place(x + 0.3f, y + 0.6f);
      const auto found = search.Find(place, 0.4, 0, 64);
      ++num_searched;
      if (!found) continue;
      ++num_found;
      EXPECT_NEAR(found->x, place.x - 31.3f, 1);
      EXPECT_FLOAT_EQ(found->y, place.y + 0.4f);
    }
  }
  EXPECT_GT(num_found, 0.95 * num_searched);
}

TEST(RowSearch, KeepsToTheGivenDisparities) {
  const BlobTexture texture(kSize, 1.5, 1);
  const RowSearch search = SearchIn(texture.Render(0, 0), texture.Render(-30, 0));
  EXPECT_TRUE(search.Find({150, 100}, 0, 0, 64));
  EXPECT_FALSE(search.Find({150, 100}, 0, 0, 20));
  EXPECT_FALSE(search.Find({150, 100}, 0, 40, 64));
}

TEST(RowSearch, OfARepeatedPatternIsNotUnique) {
  cv::Mat stripes(kSize, kSize, CV_8U);
  for (int x = 0; x < kSize; ++x) stripes.col(x).setTo(128 + 100 * std::sin(2 * CV_PI * x / 16.0));
  EXPECT_FALSE(SearchIn(stripes, stripes).Find({150, 100}, 0, -40, 40));
}

TEST(RowSearch, AtBordersInFlatImagesOrWithoutRangeFindsNothing) {
  const cv::Mat image = BlobTexture(kSize, 1.5, 1).Render(0, 0);
  const RowSearch search = SearchIn(image, image);
  for (const cv::Point2f& place :
       {cv::Point2f(3, 100), cv::Point2f(237, 100), cv::Point2f(100, 3), cv::Point2f(100, 237)}) {
    EXPECT_FALSE(search.Find(place, 0, -20, 20)) << place.x << ", " << place.y;
  }
  EXPECT_FALSE(search.Find({100, 100}, 0, 20, 19));
  const cv::Mat flat(kSize, kSize, CV_8U, cv::Scalar(90));
  EXPECT_FALSE(SearchIn(flat, flat).Find({100, 100}, 0, -20, 20));
}

}  // namespace
}  // namespace arfm_vo
