// Any bytes as a bag, through the reader of fiimap_eval.

#include "bag_player.h"
#include "evaluation_input.h"
#include "scan_feed.h"
#include "temporary_input.h"

namespace fiimap::fuzz {
namespace {

/// Counts scans where the player does.
void play(const std::string& bag) {
  InputOptions options;
  options.bag = bag;
  const EvaluationInput input(options);
  ScanFeed feed(smallMap(), input.node());
  BagPlayer player(input.bag(), input.topics(), input.node());
  player.play(&feed, &feed.counters());
  feed.finish();
}

}  // namespace
}  // namespace fiimap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fiimap::fuzz::TemporaryInput file("recording.bag");
  file.write(data, size);
  try {
    fiimap::fuzz::play(file.path());
  } catch (const std::exception& error) {
    fiimap::fuzz::require(error.what()[0] != '\0', "refused without a word");
  }
  return 0;
}
