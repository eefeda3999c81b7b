#include "arfm_vo/image/png_image.h"

#include <png.h>

#include <csetjmp>
#include <cstring>
#include <new>
#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"

// By libpng itself: OpenCV's imgcodecs brings GDAL and a hundred libraries, 45 MB of each process.

namespace arfm_vo {
namespace {

constexpr size_t kSignatureSize = 8;  // PNG specification, section 5
// Deflated data (RFC 1951) hold at most 258 bytes in 2 bits.
constexpr size_t kMaxDeflation = 1032;
// Rec. 601, as OpenCV turns colours to grey; blue is the rest.
constexpr double kRed = 0.299, kGreen = 0.587;

/// The bytes of a file, and how far they are read.
struct PngSource {
  const std::string& bytes;
  size_t at = 0;
  bool is_truncated = false;
};

void Read(png_structp png, png_bytep to, size_t size) {
  auto& source = *static_cast<PngSource*>(png_get_io_ptr(png));
  source.is_truncated = size > source.bytes.size() - source.at;
  if (source.is_truncated) png_error(png, "truncated");
  std::memcpy(to, source.bytes.data() + source.at, size);
  source.at += size;
}

[[noreturn]] void OnError(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void OnWarning(png_structp, png_const_charp) {}

class PngReader {
 public:
  explicit PngReader(PngSource& source)
      : source_(source),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, OnError, OnWarning)),
        info_(png_create_info_struct(png_)) {
    if (info_ == nullptr) throw std::bad_alloc();
    png_set_read_fn(png_, &source, Read);
  }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// CV_8UC1 or CV_16UC1 as the file has it; empty where it is not a whole picture.
  cv::Mat Decode() {
    const bool is_whole = ReadHeader() && ReadRows();
    return is_whole ? image_ : cv::Mat();
  }

 private:
  // libpng jumps back to setjmp() at an error: nothing with a destructor lives in between.
  bool ReadHeader() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_read_info(png_, info_);
    height_ = png_get_image_height(png_, info_);
    if (png_get_rowbytes(png_, info_) > kMaxDeflation * source_.bytes.size() / height_) {
      return false;
    }
    MakeGrey();
    png_read_update_info(png_, info_);
    return png_get_channels(png_, info_) == 1;
  }

  void MakeGrey() {
    const int depth = png_get_bit_depth(png_, info_);
    const int color = png_get_color_type(png_, info_);
    if (color == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
    if (color == PNG_COLOR_TYPE_GRAY && depth < 8) png_set_expand_gray_1_2_4_to_8(png_);
    png_set_strip_alpha(png_);  // also that of a palette
    if ((color & PNG_COLOR_MASK_COLOR) != 0) {
      png_set_rgb_to_gray(png_, PNG_ERROR_ACTION_NONE, kRed, kGreen);
    }
    if (depth == 16 && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__) png_set_swap(png_);
    png_set_interlace_handling(png_);
  }

  bool ReadRows() {
    image_.create(static_cast<int>(height_), static_cast<int>(png_get_image_width(png_, info_)),
                  png_get_bit_depth(png_, info_) == 16 ? CV_16UC1 : CV_8UC1);
    for (int y = 0; y < image_.rows; ++y) rows_.push_back(image_.ptr(y));
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows_.data());
    png_read_end(png_, nullptr);
    return true;
  }

  const PngSource& source_;
  png_structp png_;
  png_infop info_;
  size_t height_ = 0;
  cv::Mat image_;
  std::vector<png_bytep> rows_;
};

}  // namespace

cv::Mat ReadGreyPng(const std::string& path, GreyWindow& window) {
  const std::string bytes = ReadWholeFile(path);
  Require(!bytes.empty(), path + ": is empty");
  Require(bytes.size() >= kSignatureSize &&
              png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, kSignatureSize) == 0,
          path + ": is not a PNG file");
  PngSource source{bytes};
  const cv::Mat image = PngReader(source).Decode();
  Require(!source.is_truncated, path + ": PNG file is truncated");
  Require(!image.empty(), path + ": PNG file is corrupted");
  return image.depth() == CV_16U ? window.Apply(image) : image;
}

}  // namespace arfm_vo
