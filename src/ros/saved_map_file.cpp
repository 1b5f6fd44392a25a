#include "saved_map_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace fiimap {
namespace {

constexpr std::size_t kMaxLine = 256;

/// A pipe would wait for ever, a directory reads as nothing.
void requireFile(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    SavedMapFile::fail("cannot be read: it is no file");
  }
}

}  // namespace

SavedMapFile::SavedMapFile(const std::string& path) {
  requireFile(path);
  stream_.open(path, std::ios::binary);
  if (!stream_) fail(std::string("cannot be read: ") + std::strerror(errno));
}

std::string SavedMapFile::line() {
  std::string line;
  for (char c = take<char>(); c != '\n'; c = take<char>()) {
    if (line.size() == kMaxLine) fail("is damaged: its header has a line that is too long");
    line.push_back(c);
  }
  return line;
}

void SavedMapFile::requireEnd() {
  if (stream_.peek() != std::ifstream::traits_type::eof()) {
    fail("is damaged: it goes on after its last voxel");
  }
}

void SavedMapFile::fail(const std::string& why) { throw std::runtime_error(why); }

void SavedMapFile::takeBytes(char* bytes, std::size_t count) {
  if (!stream_.read(bytes, static_cast<std::streamsize>(count))) {
    fail("is damaged: it ends too early");
  }
}

}  // namespace fiimap
