#pragma once

#include <cstddef>
#include <fstream>
#include <string>

namespace fiimap {

/// A file to be read from its beginning to its end, of which nothing is believed.
class SavedMapFile {
 public:
  /// \throws std::runtime_error when it cannot be opened or is no regular file.
  explicit SavedMapFile(const std::string& path);

  /// Text up to the next end of a line, and over it. At most 256 characters.
  /// \throws std::runtime_error when there is none.
  std::string line();
  /// A number in the byte order of little-endian machines.
  /// \throws std::runtime_error when the file ends before.
  template <typename Number>
  Number take() {
    Number number;
    takeBytes(reinterpret_cast<char*>(&number), sizeof(number));
    return number;
  }
  /// \throws std::runtime_error when the file goes on.
  void requireEnd();

  /// \throws std::runtime_error always.
  [[noreturn]] static void fail(const std::string& why);

 private:
  void takeBytes(char* bytes, std::size_t count);

  std::ifstream stream_;
};

}  // namespace fiimap
