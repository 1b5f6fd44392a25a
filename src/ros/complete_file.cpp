#include "complete_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace fiimap {
namespace {

[[noreturn]] void fail() {
  throw std::runtime_error(std::string("cannot be written: ") + std::strerror(errno));
}

/// Before a file gets its final name: else a vehicle that loses power finds it there, and empty.
void bringToDisk(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail();
  const bool done = ::fsync(descriptor) == 0;
  ::close(descriptor);
  if (!done) fail();
}

}  // namespace

void writeCompleteFile(const std::string& file, const std::function<void(std::ostream&)>& write) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) fail();
  write(stream);
  // A disk that is full may show only when the last buffer goes out.
  stream.close();
  if (!stream) fail();
  bringToDisk(file);
}

}  // namespace fiimap
