// Renders the recorded way of the Cow_and_Lady camera through a room of like size, as a bag in the
// form of that recording: for those who do not have it.

#include <algorithm>
#include <boost/program_options.hpp>
#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>

#include "progress_bar.h"
#include "room_recording.h"

namespace {

namespace po = boost::program_options;

constexpr char kUsage[] =
    "Renders a bag in the form of the Cow_and_Lady recording: its camera's recorded way through a "
    "room\n"
    "of like size, with the same sensor, rate, gaps and delays (docs/cow_and_lady.md).\n\n"
    "  fiimap_cow_room TRAJECTORY -o BAG [options]\n\n"
    "TRAJECTORY has a line for each scan: stamp tx ty tz qx qy qz qw time-of-recording (s, m), the "
    "pose\n"
    "that of the marker body.\n\n";

struct Options {
  std::string trajectory, bag;
  std::size_t scans = 0;
  fiimap::RoomRecordingOptions recording;
};

po::options_description describe(Options* options) {
  fiimap::RoomRecordingOptions* recording = &options->recording;
  po::options_description visible("Options");
  visible.add_options()("help,h", "this text")(
      "output,o", po::value(&options->bag)->value_name("BAG"), "where to write it")(
      "scans", po::value(&options->scans)->value_name("N"), "only the first ones")(
      "pixel-step", po::value(&recording->pixel_step)->value_name("PIXELS"),
      "keep every n-th pixel of every n-th row of 640 x 480 (2, as the map does by default)")(
      "seed", po::value(&recording->seed)->value_name("N"), "of the sensor's errors (1)")(
      "compression", po::value(&recording->compression)->value_name("NAME"),
      "lz4, bz2 (smaller, and slow to read) or none (lz4)");
  return visible;
}

/// \return false when help was asked for, and given.
bool parse(int argc, char** argv, Options* options) {
  const po::options_description visible = describe(options);
  po::options_description all;
  all.add(visible).add_options()("trajectory", po::value(&options->trajectory));
  po::positional_options_description positions;
  positions.add("trajectory", 1);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positions).run(), values);
  po::notify(values);
  if (values.count("help") > 0) {
    std::cout << kUsage << visible;
    return false;
  }
  if (options->trajectory.empty())
    throw std::invalid_argument("no trajectory is given; see --help");
  if (options->bag.empty()) throw std::invalid_argument("-o BAG is missing; see --help");
  return true;
}

void render(const Options& options) {
  std::vector<fiimap::RecordedScan> scans = fiimap::readTrajectory(options.trajectory);
  if (options.scans > 0) scans.resize(std::min(scans.size(), options.scans));
  fiimap::ProgressBar bar(scans.size());
  const fiimap::RoomRecordingFigures figures = fiimap::writeRoomRecording(
      scans, options.recording, options.bag, [&bar](std::size_t done) { bar.show(done); });
  bar.end();
  std::cout << options.bag << ": " << figures.scans << " scans in " << figures.duration
            << " s, no depth at " << figures.invalid_share
            << " of the pixels, camera never nearer to a surface than " << figures.least_clearance
            << " m\n";
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    if (parse(argc, argv, &options)) render(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
}
