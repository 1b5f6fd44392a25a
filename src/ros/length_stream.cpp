#include "length_stream.h"

#include <new>
#include <stdexcept>
#include <string>

namespace fiimap {
namespace {

constexpr int kBits = 7;  // of a number in a byte
constexpr std::uint8_t kMoreFollow = 1 << kBits;

}  // namespace

void LengthWriter::add(std::uint64_t length) {
  for (; length >= kMoreFollow; length >>= kBits) {
    bytes_.push_back(static_cast<std::uint8_t>(length | kMoreFollow));
  }
  bytes_.push_back(static_cast<std::uint8_t>(length));
}

std::vector<std::uint8_t> LengthWriter::finish() const {
  if (bytes_.empty()) return {};
  uLongf size = compressBound(static_cast<uLong>(bytes_.size()));
  std::vector<std::uint8_t> compressed(size);
  const int result =
      compress(compressed.data(), &size, bytes_.data(), static_cast<uLong>(bytes_.size()));
  if (result != Z_OK) throw std::bad_alloc();  // the only way to fail with a buffer of that size
  compressed.resize(size);
  return compressed;
}

LengthReader::LengthReader(const std::vector<std::uint8_t>& bytes) : at_end_(bytes.empty()) {
  // zlib declares no pointer to constant bytes, but changes none.
  stream_.next_in = const_cast<Bytef*>(bytes.data());
  stream_.avail_in = static_cast<uInt>(bytes.size());
  if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
}

LengthReader::~LengthReader() { inflateEnd(&stream_); }

bool LengthReader::next(std::uint64_t* length) {
  std::uint8_t byte = 0;
  if (!nextByte(&byte)) return false;
  *length = 0;
  for (int shift = 0;; shift += kBits) {
    const std::uint64_t bits = byte & (kMoreFollow - 1u);
    if (shift >= 64 || bits << shift >> shift != bits) {
      throw std::invalid_argument("a number of more than 64 bits");
    }
    *length |= bits << shift;
    if (byte < kMoreFollow) return true;
    if (!nextByte(&byte)) throw std::invalid_argument("the last number has no end");
  }
}

bool LengthReader::nextByte(std::uint8_t* byte) {
  while (next_ == end_) {
    if (at_end_) return false;
    decompress();
  }
  *byte = buffer_[next_++];
  return true;
}

/// Fills the buffer anew.
void LengthReader::decompress() {
  stream_.next_out = buffer_.data();
  stream_.avail_out = static_cast<uInt>(buffer_.size());
  const int result = inflate(&stream_, Z_NO_FLUSH);
  next_ = 0;
  end_ = buffer_.size() - stream_.avail_out;
  at_end_ = result == Z_STREAM_END;
  if (result != Z_OK && result != Z_STREAM_END) {
    throw std::invalid_argument(stream_.msg != nullptr
                                    ? std::string("no zlib stream: ") + stream_.msg
                                    : "a zlib stream without its end");
  }
  if (at_end_ && stream_.avail_in > 0) {
    throw std::invalid_argument(std::to_string(stream_.avail_in) + " bytes after the zlib stream");
  }
}

}  // namespace fiimap
