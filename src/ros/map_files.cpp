#include "fiimap/ros/map_files.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>
#include <stdexcept>

namespace fiimap {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

void requireName(const std::string& name) {
  const bool allowed = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.';
  });
  if (!name.empty() && name.front() != '.' && allowed) return;
  std::string printable = name;  // a 0 would end the message
  std::replace_if(
      printable.begin(), printable.end(), [](unsigned char c) { return !std::isprint(c); }, '?');
  refuse("name '" + printable +
         "': must consist of letters, digits, '_', '-' and '.', and not begin with '.'");
}

/// Writes beside the file first, so that a crash or a full disk leaves no half file of that name.
void replaceFile(const std::string& directory, const std::string& name,
                 const std::function<void(const std::string&)>& write) {
  const std::string file = directory + "/" + name;
  const std::string partial = directory + "/." + name + ".part";
  try {
    write(partial);
  } catch (const std::exception& error) {
    std::remove(partial.c_str());
    refuse(file + ": " + error.what());
  }
  if (std::rename(partial.c_str(), file.c_str()) != 0) {
    const std::string why = std::strerror(errno);
    std::remove(partial.c_str());
    refuse(file + ": cannot be written: " + why);
  }
}

}  // namespace

std::string saveMap(const Snapshot& snapshot, const std::string& directory,
                    const std::string& name) {
  requireName(name);
  if (directory.empty()) refuse("the parameter save_directory is not set");
  if (snapshot.count(Plane::kOccupied) == 0) refuse("the map has no occupied voxel yet");
  replaceFile(directory, name + "_occupied.pcd",
              [&snapshot](const std::string& file) { writePcd(snapshot, Plane::kOccupied, file); });
  replaceFile(directory, name + "_inflated.pcd",
              [&snapshot](const std::string& file) { writePcd(snapshot, Plane::kInflated, file); });
  replaceFile(directory, name + ".bt",
              [&snapshot](const std::string& file) { writeOctomap(snapshot, file); });
  return "wrote " + name + "_occupied.pcd (" + std::to_string(snapshot.count(Plane::kOccupied)) +
         " voxels), " + name + "_inflated.pcd (" +
         std::to_string(snapshot.count(Plane::kInflated)) + " voxels) and " + name + ".bt to " +
         directory;
}

}  // namespace fiimap
