#include "bag_check.h"

#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

namespace fiimap {
namespace {

constexpr char kMagic[] = "#ROSBAG V2.0\n";
/// Of one record; that of the bag's own header is the largest, a few hundred bytes.
constexpr std::uint64_t kMostHeaderBytes = 1 << 20;
/// Of one chunk, uncompressed: rosbag writes 768 kB, or one message that is larger.
constexpr std::uint32_t kMostChunkBytes = 1 << 30;

enum Op : std::uint8_t {
  kMessage = 2,
  kBag = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

/// A part of the file, [begin, end).
struct Part {
  std::uint64_t begin, end;
  std::uint64_t size() const { return end - begin; }
};

struct Record {
  std::uint64_t begin = 0;
  std::map<std::string, std::string> fields;
  Part data{0, 0};
};

/// Offsets in a chunk at which messages may begin.
struct Chunk {
  bool compressed = false;
  std::uint32_t size = 0;
  std::set<std::uint64_t> records;  // of one that is not compressed

  bool holds(std::uint32_t offset) const {
    return compressed ? offset < size : records.count(offset) != 0;
  }
};

class BagCheck {
 public:
  explicit BagCheck(const std::string& file) : file_(file), stream_(file, std::ios::binary) {
    stream_.seekg(0, std::ios::end);
    size_ = stream_ ? static_cast<std::uint64_t>(stream_.tellg()) : 0;
  }

  bool hasFormat2() {
    constexpr std::size_t kLength = sizeof(kMagic) - 1;
    return size_ >= kLength && read({0, kLength}) == kMagic;
  }

  void run() {
    for (std::uint64_t at = sizeof(kMagic) - 1; at < size_;) {
      const Record record = readRecord({at, size_});
      records_.insert(at);
      check(record);
      at = record.data.end;
    }
    for (const auto& [at, position] : positions_) {
      if (records_.count(position) == 0) damaged(at, "points to where no record begins");
    }
  }

 private:
  [[noreturn]] void damaged(std::uint64_t at, const std::string& what) const {
    throw std::invalid_argument("the bag " + file_ + " is damaged: the record at byte " +
                                std::to_string(at) + " " + what +
                                "; rosbag reindex or rosbag fix may repair it");
  }

  std::string read(const Part& part) {
    std::string bytes(part.size(), '\0');
    stream_.seekg(static_cast<std::streamoff>(part.begin));
    stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream_) throw std::invalid_argument("cannot read the bag " + file_);
    return bytes;
  }

  /// The bytes after a length, which must lie in `room`.
  Part readLength(const Part& room, std::uint64_t record) {
    std::uint32_t length = 0;
    if (room.size() < sizeof(length)) damaged(record, "ends early");
    std::memcpy(&length, read({room.begin, room.begin + sizeof(length)}).data(), sizeof(length));
    const Part part{room.begin + sizeof(length), room.begin + sizeof(length) + length};
    if (part.end > room.end) damaged(record, "is longer than the file or the chunk around it");
    return part;
  }

  Record readRecord(const Part& room) {
    Record record;
    record.begin = room.begin;
    const Part header = readLength(room, room.begin);
    if (header.size() > kMostHeaderBytes) damaged(room.begin, "has a header of that many bytes");
    record.fields = fieldsOf(read(header), room.begin);
    record.data = readLength({header.end, room.end}, room.begin);
    return record;
  }

  /// Length, name, '=' and value of each field.
  std::map<std::string, std::string> fieldsOf(const std::string& header, std::uint64_t record) {
    std::map<std::string, std::string> fields;
    for (std::size_t at = 0; at < header.size();) {
      std::uint32_t length = 0;
      if (header.size() - at < sizeof(length)) damaged(record, "has half a field");
      std::memcpy(&length, header.data() + at, sizeof(length));
      at += sizeof(length);
      if (length > header.size() - at) damaged(record, "has a field longer than its header");
      const std::string field = header.substr(at, length);
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos) damaged(record, "has a field without a value");
      fields[field.substr(0, equals)] = field.substr(equals + 1);
      at += length;
    }
    return fields;
  }

  template <typename Number>
  Number number(const Record& record, const std::string& name) const {
    const auto field = record.fields.find(name);
    Number value = 0;
    if (field == record.fields.end() || field->second.size() != sizeof(value)) {
      damaged(record.begin, "lacks the field " + name);
    }
    std::memcpy(&value, field->second.data(), sizeof(value));
    return value;
  }

  void check(const Record& record) {
    switch (number<std::uint8_t>(record, "op")) {
      case kBag:
        // Zero in a recording that was not closed; rosbag refuses it.
        if (const auto index = number<std::uint64_t>(record, "index_pos"); index != 0) {
          positions_[record.begin] = index;
        }
        break;
      case kChunk:
        checkChunk(record);
        break;
      case kIndex:
        checkIndex(record);
        break;
      case kChunkInfo:
        positions_[record.begin] = number<std::uint64_t>(record, "chunk_pos");
        break;
      case kConnection:
        checkConnection(record);
        break;
      default:
        break;
    }
  }

  void checkConnection(const Record& record) {
    number<std::uint32_t>(record, "conn");
    if (record.data.size() > kMostHeaderBytes) damaged(record.begin, "describes a type endlessly");
    fieldsOf(read(record.data), record.begin);
  }

  void checkChunk(const Record& record) {
    chunk_ = {};
    const auto compression = record.fields.find("compression");
    chunk_.compressed = compression != record.fields.end() && compression->second != "none";
    chunk_.size = number<std::uint32_t>(record, "size");
    if (chunk_.size > kMostChunkBytes) damaged(record.begin, "is a chunk of more than 1 GB");
    if (chunk_.compressed) return;
    if (chunk_.size != record.data.size()) damaged(record.begin, "is a chunk of another size");
    for (std::uint64_t at = record.data.begin; at < record.data.end;) {
      const Record inner = readRecord({at, record.data.end});
      chunk_.records.insert(at - record.data.begin);
      if (number<std::uint8_t>(inner, "op") == kConnection) checkConnection(inner);
      at = inner.data.end;
    }
  }

  /// Of the chunk before it.
  void checkIndex(const Record& record) {
    constexpr std::uint64_t kEntryBytes = 12, kTimeBytes = 8;
    const std::uint64_t count = number<std::uint32_t>(record, "count");
    if (count * kEntryBytes != record.data.size()) damaged(record.begin, "has another length");
    const std::string entries = read(record.data);
    for (std::uint64_t i = 0; i < count; ++i) {
      std::uint32_t offset = 0;
      std::memcpy(&offset, entries.data() + i * kEntryBytes + kTimeBytes, sizeof(offset));
      if (!chunk_.holds(offset)) damaged(record.begin, "points out of its chunk");
    }
  }

  std::string file_;
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  Chunk chunk_;
  std::set<std::uint64_t> records_;
  std::map<std::uint64_t, std::uint64_t> positions_;  // of records, by that which names them
};

}  // namespace

void requireSoundBag(const std::string& file) {
  BagCheck check(file);
  if (check.hasFormat2()) check.run();
}

void openBag(const std::string& file, rosbag::Bag* bag) {
  requireSoundBag(file);
  try {
    bag->open(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::invalid_argument(
        "cannot read the bag " + file +
        ": it is missing, cut off or no bag (rosbag reindex may mend it): " + error.what());
  }
}

}  // namespace fiimap
