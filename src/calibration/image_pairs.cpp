#include "arfm_vo/calibration/image_pairs.h"

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <map>
#include <set>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

namespace fs = std::filesystem;

bool IsImage(const fs::path& path) {
  static const std::set<std::string> extensions = {".png", ".jpg", ".jpeg", ".pgm",
                                                   ".ppm", ".bmp", ".tif",  ".tiff"};
  return extensions.count(boost::to_lower_copy(path.extension().string())) > 0;
}

/// The stem without a leading `camera` and what joins it: "left_07" -> "07".
std::string NameWithoutSide(const fs::path& path, const std::string& side) {
  std::string name = path.stem().string();
  if (boost::istarts_with(name, side)) name.erase(0, side.size());
  const size_t start = name.find_first_not_of("_-. ");
  return start == std::string::npos ? "" : name.substr(start);
}

/// The last number in a name, or the name where there is none: "Im_L_7" -> "7".
std::string LastNumber(const std::string& name) {
  const size_t last = name.find_last_of("0123456789");
  if (last == std::string::npos) return name;
  const size_t before = name.find_last_not_of("0123456789", last);
  const size_t first = before == std::string::npos ? 0 : before + 1;
  return name.substr(first, last + 1 - first);
}

/// Numbers in names compare as numbers: 2 before 10, and 07 is 7.
bool ComesBefore(const std::string& a, const std::string& b) {
  const auto is_number = [](const std::string& text) {
    return !text.empty() && text.size() < 18 &&
           text.find_first_not_of("0123456789") == std::string::npos;
  };
  if (is_number(a) && is_number(b) && std::stoll(a) != std::stoll(b))
    return std::stoll(a) < std::stoll(b);
  return a < b;
}

using Files = std::map<std::string, fs::path, decltype(&ComesBefore)>;

void Add(Files& files, const std::string& name, const fs::path& path) {
  const auto [found, is_new] = files.emplace(name, path);
  Require(is_new, "image pairs: '" + path.string() + "' and '" + found->second.string() +
                      "' have the same name");
}

/// Image files of one camera by name; all in `folder` where it is the camera's own.
Files FindFiles(const fs::path& folder, const std::string& side, bool is_own_folder) {
  Files files(&ComesBefore);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const fs::path& path = entry.path();
    if (!entry.is_regular_file() || !IsImage(path)) continue;
    if (is_own_folder || boost::istarts_with(path.filename().string(), side))
      Add(files, NameWithoutSide(path, side), path);
  }
  return files;
}

bool ShareAName(const Files& left, const Files& right) {
  return std::any_of(left.begin(), left.end(),
                     [&](const auto& file) { return right.count(file.first) > 0; });
}

Files NameByLastNumber(const Files& files) {
  Files renamed(&ComesBefore);
  for (const auto& [name, path] : files) Add(renamed, LastNumber(name), path);
  return renamed;
}

}  // namespace

std::vector<ImagePair> FindImagePairs(const fs::path& folder) {
  Require(fs::is_directory(folder), "image pairs: no folder '" + folder.string() + "'");
  const bool has_folders = fs::is_directory(folder / "left") && fs::is_directory(folder / "right");
  Files left = FindFiles(has_folders ? folder / "left" : folder, "left", has_folders);
  Files right = FindFiles(has_folders ? folder / "right" : folder, "right", has_folders);
  Require(!left.empty() || !right.empty(),
          "image pairs: '" + folder.string() +
              "' holds neither files left*, right* nor image folders left/, right/");
  if (!ShareAName(left, right)) {
    left = NameByLastNumber(left);
    right = NameByLastNumber(right);
  }
  const std::string counts = " (" + std::to_string(left.size()) + " left images, " +
                             std::to_string(right.size()) + " right images)";
  std::vector<ImagePair> pairs;
  for (const auto& [name, path] : left) {
    const auto partner = right.find(name);
    Require(partner != right.end(),
            "image pairs: no right image to '" + path.string() + "'" + counts);
    pairs.push_back({name, path, partner->second});
  }
  for (const auto& [name, path] : right)
    Require(left.count(name) > 0, "image pairs: no left image to '" + path.string() + "'" + counts);
  return pairs;
}

}  // namespace arfm_vo
