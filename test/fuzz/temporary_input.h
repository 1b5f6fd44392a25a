#pragma once

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

namespace fiimap::fuzz {

/// The fuzzer's bytes as a file, for code that reads files; of this process alone.
class TemporaryInput {
 public:
  explicit TemporaryInput(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("fiimap_fuzz_" + std::to_string(getpid()) + "_" + name)) {}
  ~TemporaryInput() { std::remove(path_.c_str()); }
  TemporaryInput(const TemporaryInput&) = delete;
  TemporaryInput& operator=(const TemporaryInput&) = delete;

  std::string path() const { return path_.string(); }
  void write(const std::uint8_t* data, std::size_t size) const {
    std::ofstream stream(path_, std::ios::binary | std::ios::trunc);
    stream.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  }

 private:
  std::filesystem::path path_;
};

}  // namespace fiimap::fuzz
