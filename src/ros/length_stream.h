#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fiimap {

// The lengths of runs in a MapChanges message: numbers in LEB128 (seven bits a byte, lowest first;
// the top bit says that more follow), and these bytes as a zlib stream (RFC 1950). No byte for no
// number.

class LengthWriter {
 public:
  void add(std::uint64_t length);
  /// All that were added.
  std::vector<std::uint8_t> finish() const;

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Reads lengths one by one from bytes that need not be right. Takes the same memory however many
/// there are.
class LengthReader {
 public:
  /// \param bytes must outlive the reader.
  explicit LengthReader(const std::vector<std::uint8_t>& bytes);
  ~LengthReader();
  LengthReader(const LengthReader&) = delete;
  LengthReader& operator=(const LengthReader&) = delete;

  /// \return false when there are no more.
  /// \throws std::invalid_argument when the bytes are no such stream, end within one, or go on
  /// after it; or a number does not fit into 64 bits.
  bool next(std::uint64_t* length);

 private:
  bool nextByte(std::uint8_t* byte);
  void decompress();

  z_stream stream_{};
  bool at_end_;
  std::array<std::uint8_t, 4096> buffer_;
  std::size_t next_ = 0, end_ = 0;  // of what is in the buffer
};

}  // namespace fiimap
