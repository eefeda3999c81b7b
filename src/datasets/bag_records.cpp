#include "arfm_vo/datasets/bag_records.h"

#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

constexpr std::string_view kFormat = "#ROSBAG V2.0\n";
enum Operation { kFileHeader = 3, kIndex = 4, kChunk = 5, kChunkInfo = 6, kConnection = 7 };

struct Record {
  std::map<std::string_view, std::string_view> header;
  std::string_view data;
};

template <class Number>
Number Read(std::string_view bytes) {
  Number number;
  Require(bytes.size() >= sizeof(number), "a number is cut off");
  std::memcpy(&number, bytes.data(), sizeof(number));
  return number;
}

/// What follows its length, which is taken off `bytes` with it.
std::string_view Take(std::string_view& bytes) {
  const auto length = Read<uint32_t>(bytes);
  bytes.remove_prefix(sizeof(length));
  Require(length <= bytes.size(), "a length goes beyond the end");
  const std::string_view taken = bytes.substr(0, length);
  bytes.remove_prefix(length);
  return taken;
}

std::map<std::string_view, std::string_view> ReadHeader(std::string_view bytes) {
  std::map<std::string_view, std::string_view> fields;
  while (!bytes.empty()) {
    const std::string_view field = Take(bytes);
    const size_t name_length = field.find('=');
    Require(name_length != std::string_view::npos, "a field of a header has no name");
    fields[field.substr(0, name_length)] = field.substr(name_length + 1);
  }
  return fields;
}

std::string_view Field(const Record& record, const std::string& name) {
  const auto field = record.header.find(name);
  Require(field != record.header.end(), "it has no field " + name);
  return field->second;
}

/// Calls visit(record, offset) for one record of `bytes` after the other until that returns false.
template <class Visitor>
void FollowRecords(std::string_view bytes, Visitor&& visit) {
  const size_t size = bytes.size();
  while (!bytes.empty()) {
    const size_t offset = size - bytes.size();
    const bool goes_on = Within("the record at byte " + std::to_string(offset), [&] {
      Record record;
      record.header = ReadHeader(Take(bytes));
      record.data = Take(bytes);
      return visit(record, offset);
    });
    if (!goes_on) return;
  }
}

/// Of the records of a file after its first line.
class RecordCheck {
 public:
  bool operator()(const Record& record, size_t offset) {
    const uint64_t position = kFormat.size() + offset;
    is_index_reached_ |= position == index_;
    switch (Read<uint8_t>(Field(record, "op"))) {
      case kFileHeader:
        index_ = Read<uint64_t>(Field(record, "index_pos"));
        return index_ != 0;  // 0: it was never closed
      case kChunk:
        chunks_.insert(position);
        ReadChunk(record);
        break;
      case kIndex:
        CheckIndex(record);
        break;
      case kChunkInfo:
        Require(chunks_.count(Read<uint64_t>(Field(record, "chunk_pos"))) > 0,
                "there is no chunk where it says");
        break;
      case kConnection:
        ReadHeader(record.data);
        break;
    }
    return true;
  }
  void CheckIndexPosition(uint64_t end) const {
    Require(index_ == 0 || index_ == end || is_index_reached_,
            "there is no index where its header says");
  }

 private:
  void ReadChunk(const Record& record) {
    messages_.reset();
    if (Field(record, "compression") != "none") return;
    messages_.emplace();
    FollowRecords(record.data, [&](const Record& inner, size_t offset) {
      if (Read<uint8_t>(Field(inner, "op")) == kConnection) ReadHeader(inner.data);
      messages_->insert(static_cast<uint32_t>(offset));
      return true;
    });
  }

  /// Of a connection's messages in the last chunk: a time and an offset each.
  void CheckIndex(const Record& record) const {
    constexpr size_t kEntrySize = 12, kTimeSize = 8;
    const auto count = Read<uint32_t>(Field(record, "count"));
    Require(record.data.size() == kEntrySize * count, "it does not hold as many as it says");
    if (!messages_) return;
    for (size_t i = 0; i < count; ++i) {
      Require(messages_->count(Read<uint32_t>(record.data.substr(kEntrySize * i + kTimeSize))) > 0,
              "there is no message where it says");
    }
  }

  uint64_t index_ = 0;  ///< where the connections and chunks are told of, in the file
  bool is_index_reached_ = false;
  std::set<uint64_t> chunks_;                   ///< where they begin in the file
  std::optional<std::set<uint32_t>> messages_;  ///< where they begin in the last chunk
};

}  // namespace

void CheckBagRecords(const std::string& path) {
  namespace ipc = boost::interprocess;
  Within("the bag is truncated or damaged", [&] {
    Require(std::filesystem::file_size(path) >= kFormat.size(), "it is no bag of format 2.0");
    const ipc::mapped_region file(ipc::file_mapping(path.c_str(), ipc::read_only), ipc::read_only);
    std::string_view bytes(static_cast<const char*>(file.get_address()), file.get_size());
    Require(bytes.substr(0, kFormat.size()) == kFormat, "it is no bag of format 2.0");
    bytes.remove_prefix(kFormat.size());
    RecordCheck check;
    FollowRecords(bytes, std::ref(check));
    check.CheckIndexPosition(file.get_size());
  });
}

}  // namespace arfm_vo
