#include "arfm_vo/datasets/png_image.h"

#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/whole_file.h"

namespace arfm_vo {
namespace {

// PNG specification, section 5: a signature of 8 bytes, then chunks of
// [length, 4 bytes][type, 4 bytes][data][checksum, 4 bytes], the first IHDR, the last IEND.
constexpr char kSignature[] = "\x89PNG\r\n\x1a\n";
constexpr size_t kSignatureSize = 8;
constexpr size_t kHeaderSize = 33;  // signature and the whole IHDR
constexpr size_t kBitDepthAt = 24;

uint32_t ReadBigEndian(const std::string& bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = at; i < at + 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes[i]);
  return value;
}

void CheckHeader(const std::string& bytes, const std::string& path) {
  Require(!bytes.empty(), path + ": is empty");
  Require(bytes.compare(0, kSignatureSize, kSignature, kSignatureSize) == 0,
          path + ": is not a PNG file");
  Require(bytes.size() >= kHeaderSize, path + ": PNG file is truncated");
  Require(bytes.compare(kSignatureSize + 4, 4, "IHDR") == 0, path + ": PNG file is corrupted");
}

/// Checks that whole chunks with right checksums follow each other up to IEND.
void CheckChunks(const std::string& bytes, const std::string& path) {
  size_t chunk = kSignatureSize;
  std::string type;
  while (type != "IEND") {
    Require(chunk + 12 <= bytes.size(), path + ": PNG file is truncated");
    type = bytes.substr(chunk + 4, 4);
    const size_t length = ReadBigEndian(bytes, chunk);
    Require(length <= bytes.size() - chunk - 12, path + ": PNG file is truncated");
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data()) + chunk + 4;
    Require(crc32_z(0, data, length + 4) == ReadBigEndian(bytes, chunk + 8 + length),
            path + ": PNG file is corrupted");
    chunk += length + 12;
  }
}

cv::Mat Decode(const std::string& bytes, int flags) {
  const cv::Mat buffer(1, static_cast<int>(bytes.size()), CV_8UC1,
                       const_cast<char*>(bytes.data()));  // imdecode only reads it
  try {
    return cv::imdecode(buffer, flags);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

cv::Size ReadPngSize(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Require(file.is_open(), path + ": cannot be read");
  std::string header(kHeaderSize, '\0');
  file.read(header.data(), header.size());
  header.resize(file.gcount());
  CheckHeader(header, path);
  return cv::Size(ReadBigEndian(header, 16), ReadBigEndian(header, 20));
}

cv::Mat ReadGreyPng(const std::string& path, GreyWindow& window) {
  const std::string bytes = ReadWholeFile(path);
  CheckHeader(bytes, path);
  CheckChunks(bytes, path);
  const bool is_deep = bytes[kBitDepthAt] > 8;
  const cv::Mat image =
      Decode(bytes, is_deep ? cv::IMREAD_GRAYSCALE | cv::IMREAD_ANYDEPTH : cv::IMREAD_GRAYSCALE);
  Require(!image.empty(), path + ": PNG file is corrupted");
  return is_deep ? window.Apply(image) : image;
}

}  // namespace arfm_vo
