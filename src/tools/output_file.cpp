#include "output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace fiimap {
namespace {

std::string partialOf(const std::string& file) { return file + ".partial"; }

[[noreturn]] void refuse(const std::string& file) {
  const std::string reason = std::strerror(errno);
  std::remove(partialOf(file).c_str());
  throw std::runtime_error("cannot write " + file + ": " + reason);
}

}  // namespace

void checkWritable(const std::string& file) {
  if (!std::ofstream(partialOf(file))) refuse(file);
  std::remove(partialOf(file).c_str());
}

void writeWhole(const std::string& file, const std::string& text) {
  std::ofstream stream(partialOf(file), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream || std::rename(partialOf(file).c_str(), file.c_str()) != 0) refuse(file);
}

}  // namespace fiimap
