// Every fault of faults.yaml that is a message or its stamp, through the nodelet's mapping thread.

#include <algorithm>
#include <numeric>

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <gtest/gtest.h>

#include "fault_catalogue.h"
#include "message_faults.h"

namespace fiimap {
namespace {

constexpr int kFramesBefore = 6;  // the map is settled then

using Counts = std::map<std::string, std::uint64_t>;

Counts countsOf(const ScanCounters& counters) {
  Counts counts = {{"poses refused", counters.refused_poses},
                   {"transforms refused", counters.refused_transforms},
                   {"displaced", counters.displaced_inputs}};
  for (int i = 0; i < kDropReasonCount; ++i) {
    counts[nameOf(static_cast<DropReason>(i))] = counters.dropped(static_cast<DropReason>(i));
  }
  return counts;
}

std::vector<VoxelIndex> voxelsOf(const RigState& state, Plane plane) {
  if (state.snapshot == nullptr) return {};
  return state.snapshot->voxels(plane, state.snapshot->window());
}

bool sameMap(const RigState& a, const RigState& b) {
  const auto same = [&](Plane plane) { return voxelsOf(a, plane) == voxelsOf(b, plane); };
  return same(Plane::kOccupied) && same(Plane::kKnown) && same(Plane::kInflated);
}

bool holds(const std::vector<std::string>& texts, const std::string& part) {
  return std::any_of(texts.begin(), texts.end(), [&part](const std::string& text) {
    return text.find(part) != std::string::npos;
  });
}

std::string joined(const std::vector<std::string>& texts) {
  return std::accumulate(texts.begin(), texts.end(), std::string(),
                         [](const std::string& a, const std::string& b) { return a + b + "\n"; });
}

int levelOf(const std::string& name) {
  using diagnostic_msgs::DiagnosticStatus;
  static const std::map<std::string, int> levels = {{"ok", DiagnosticStatus::OK},
                                                    {"warn", DiagnosticStatus::WARN},
                                                    {"error", DiagnosticStatus::ERROR}};
  return levels.at(name);
}

/// What /diagnostics says of the time between two moments; its texts are added to `texts`.
int diagnosedLevel(const FaultRig& rig, const RigState& before, const RigState& now,
                   std::vector<std::string>* texts) {
  const MapUpdate* update = now.update ? &*now.update : nullptr;
  int level = 0;
  for (const DiagnosticSummary& summary : {summarizeInputs(rig.topics(), before.totals, now.totals),
                                           summarizeMap(update, before.totals, now.totals)}) {
    texts->push_back(summary.text);
    level = std::max<int>(level, summary.level);
  }
  return level;
}

class MessageFaultTest : public testing::TestWithParam<Fault> {
 protected:
  /// Exactly the counters of the row moved, and every scan that was sent is in one of them.
  static void expectCounters(const RigState& before, const RigState& after, std::uint64_t flown) {
    const Fault& fault = GetParam();
    const Counts old_counts = countsOf(before.totals.counters);
    for (const auto& [name, count] : countsOf(after.totals.counters)) {
      EXPECT_EQ(count > old_counts.at(name), fault.moves(name)) << name;
    }
    const std::uint64_t integrated =
        after.totals.counters.integrated - before.totals.counters.integrated;
    EXPECT_EQ(integrated > flown, fault.moves("integrated")) << integrated;
    EXPECT_GE(integrated, flown);
    EXPECT_EQ(after.totals.counters.received, after.sent);
    EXPECT_TRUE(after.totals.counters.conserved());
  }

  static void expectMap(const RigState& before, const RigState& now,
                        const std::vector<std::string>& texts) {
    const std::string& map = GetParam().map;
    EXPECT_EQ(holds(texts, "the map was forgotten"), map == "forgotten") << joined(texts);
    EXPECT_EQ(map == "none", now.snapshot == nullptr);
    const bool may_differ = map == "forgotten" || map == "none";
    if (!may_differ) {
      EXPECT_EQ(sameMap(before, now), map == "kept");
    }
  }

  static void expectTexts(const std::vector<std::string>& texts) {
    for (const std::string& part : GetParam().says) {
      EXPECT_TRUE(holds(texts, part)) << part << "\nis not in\n" << joined(texts);
    }
    for (const auto& [reason, remedy] : documentedRemedies()) {
      EXPECT_EQ(holds(texts, reason + ": "), GetParam().moves(reason)) << reason << joined(texts);
      EXPECT_EQ(holds(texts, remedy), GetParam().moves(reason)) << remedy << joined(texts);
    }
  }
};

TEST_P(MessageFaultTest, IsCountedToldAndSurvived) {
  const MessageFault& fault = messageFaults().at(GetParam().id);
  FaultRig rig(fault.inputs, fault.clock);
  if (!fault.at_start) rig.fly(kFramesBefore);
  const RigState before = rig.state();
  ASSERT_EQ(before.totals.counters.integrated, rig.flown());
  rig.takeTexts();

  const std::uint64_t flown_before = rig.flown();
  fault.make(&rig);
  rig.settle();
  const RigState during = rig.state();
  std::vector<std::string> texts = rig.takeTexts();
  EXPECT_EQ(diagnosedLevel(rig, before, during, &texts), levelOf(GetParam().level))
      << joined(texts);
  expectTexts(texts);
  expectMap(before, during, texts);

  rig.fly(1);
  const RigState after = rig.state();
  expectCounters(before, after, rig.flown() - flown_before);
  ASSERT_NE(after.snapshot, nullptr);
  EXPECT_GT(after.snapshot->count(Plane::kKnown), 0);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, MessageFaultTest, testing::ValuesIn(faultsOf("messages")),
                         [](const auto& info) { return info.param.id; });

TEST(MessageFaultsTest, EveryFaultHasItsRow) {
  const std::vector<Fault> rows = faultsOf("messages");
  EXPECT_EQ(rows.size(), messageFaults().size());
  for (const auto& [id, fault] : messageFaults()) {
    const auto has_id = [&id = id](const Fault& row) { return row.id == id; };
    EXPECT_EQ(std::count_if(rows.begin(), rows.end(), has_id), 1) << id;
  }
}

TEST(MessageFaultsTest, TheRemediesAreThoseOfTheCode) {
  const auto remedies = documentedRemedies();
  EXPECT_EQ(remedies.size(), static_cast<std::size_t>(kDropReasonCount));
  for (int i = 0; i < kDropReasonCount; ++i) {
    const auto reason = static_cast<DropReason>(i);
    EXPECT_EQ(remedies.at(nameOf(reason)), remedyFor(reason));
  }
}

TEST(MessageFaultsTest, EveryReasonHasAFault) {
  const std::vector<Fault> rows = faultsOf("messages");
  for (const auto& [reason, remedy] : documentedRemedies()) {
    const auto moves = [&reason = reason](const Fault& row) { return row.moves(reason); };
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), moves)) << reason;
  }
}

}  // namespace
}  // namespace fiimap
