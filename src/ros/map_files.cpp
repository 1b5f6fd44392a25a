#include "fiimap/ros/map_files.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <stdexcept>

namespace fiimap {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuseFile(const std::string& what) { throw std::runtime_error(what); }

void requireName(const std::string& name) {
  const bool allowed = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '-' || c == '.';
  });
  if (!name.empty() && name.front() != '.' && allowed) return;
  std::string printable = name;  // a 0 would end the message
  std::replace_if(
      printable.begin(), printable.end(), [](unsigned char c) { return !std::isprint(c); }, '?');
  refuseFile("name '" + printable +
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
    refuseFile(file + ": " + error.what());
  }
  if (std::rename(partial.c_str(), file.c_str()) != 0) {
    const std::string why = std::strerror(errno);
    std::remove(partial.c_str());
    refuseFile(file + ": cannot be written: " + why);
  }
}

void requireDirectory(const std::string& directory) {
  if (directory.empty()) refuseFile("the parameter save_directory is not set");
}

}  // namespace

std::string saveMap(const Snapshot& snapshot, const std::string& directory,
                    const std::string& name) {
  requireName(name);
  requireDirectory(directory);
  if (snapshot.count(Plane::kOccupied) == 0) refuseFile("the map has no occupied voxel yet");
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

SavedMap readMap(const std::string& directory, const std::string& name) {
  requireName(name);
  requireDirectory(directory);
  const std::string octomap = directory + "/" + name + ".bt";
  const std::string pcd = directory + "/" + name + "_occupied.pcd";
  const bool is_octomap = fs::exists(octomap) || !fs::exists(pcd);
  const std::string file = is_octomap ? octomap : pcd;
  try {
    SavedMap map = is_octomap ? readOctomap(file) : readPcd(file);
    map.file = file;
    return map;
  } catch (const std::exception& error) {
    refuseFile(file + ": " + error.what());
  }
}

}  // namespace fiimap
