#include "tools/people/decision.h"

#include <array>

namespace ossa::people {
namespace {

struct RuleEntry {
  Rule rule;
  std::string_view name;
  Outcome outcome;
  std::string_view text;
};

constexpr std::array<RuleEntry, static_cast<size_t>(Rule::kCount)> kRules = {{
    {Rule::kTooSmall, "too_small", Outcome::kExcluded, "less surface than head and shoulders have"},
    {Rule::kFurniture, "furniture", Outcome::kExcluded,
     "a wall or furniture: flatter, more level or wider than a body"},
    {Rule::kBackground, "background", Outcome::kExcluded,
     "this surface stood here before and was nobody's"},
    {Rule::kCandidateLimit, "candidate_limit", Outcome::kRejected,
     "more candidates than are classified in a frame, and this is not among the largest"},
    {Rule::kRejectedBefore, "rejected_before", Outcome::kRejected,
     "it scored low a moment ago and is not classified again yet"},
    {Rule::kMerged, "merged", Outcome::kMerged,
     "with another candidate it looks more like one person than alone"},
    {Rule::kSplitAtHeads, "split_at_heads", Outcome::kMerged,
     "the forest sees several heads, and the pieces around them are people"},
    {Rule::kPlanar, "planar", Outcome::kTentative,
     "all but one plane, as a seat's back, a box or a screen, and the score is too low"},
    {Rule::kFirstLook, "first_look", Outcome::kTentative,
     "seen for the first time, and the score is too low for a person at first sight"},
    {Rule::kFewObservations, "few_observations", Outcome::kTentative,
     "too few observations yet; what stands still needs them without a gap"},
    {Rule::kLowMeanScore, "low_mean_score", Outcome::kTentative,
     "the mean score of the observations is too low"},
    {Rule::kTrackLowScore, "track_low_score", Outcome::kRejected,
     "it was a person a moment ago, but the mean score is too low by now"},
    {Rule::kPieceLowScore, "piece_low_score", Outcome::kRejected,
     "a piece cut off around another head, and the score is too low"},
    {Rule::kUserLimit, "user_limit", Outcome::kRejected, "more people than are followed at a time"},
    {Rule::kUnlikeABody, "unlike_a_body", Outcome::kRejected,
     "accepted at the first look, but no body's surface explains what is seen of it"},
    {Rule::kTrackContinued, "track_continued", Outcome::kConfirmed,
     "it was a person a moment ago, and the mean score is high enough"},
    {Rule::kTrackRests, "track_rests", Outcome::kConfirmed,
     "it was a person for sure not long ago, and is not the room as it was"},
    {Rule::kFreshScene, "fresh_scene", Outcome::kConfirmed,
     "high score in the first frame of a scene"},
    {Rule::kReturning, "returning", Outcome::kConfirmed,
     "high score where somebody who went out of view is expected"},
    {Rule::kEntered, "entered", Outcome::kConfirmed,
     "high score, and it stands before what was seen of the room"},
    {Rule::kEnoughObservations, "enough_observations", Outcome::kConfirmed,
     "the mean score of several observations is high enough"},
    {Rule::kPieceWithHead, "piece_with_head", Outcome::kConfirmed,
     "a piece around one of several heads, and the score is high enough"},
    {Rule::kJoinedPieces, "joined_pieces", Outcome::kConfirmed,
     "pieces that something nearer divides, or the image's border leaves, look like a person"},
}};

constexpr bool EntriesAreInOrder() {
  for (size_t i = 0; i < kRules.size(); ++i) {
    if (static_cast<size_t>(kRules[i].rule) != i) return false;
  }
  return true;
}
static_assert(EntriesAreInOrder());

const RuleEntry& Entry(Rule rule) { return kRules.at(static_cast<size_t>(rule)); }

}  // namespace

std::string_view NameRule(Rule rule) { return Entry(rule).name; }
std::string_view DescribeRule(Rule rule) { return Entry(rule).text; }
Outcome FindOutcome(Rule rule) { return Entry(rule).outcome; }

std::string_view NameOutcome(Outcome outcome) {
  switch (outcome) {
    case Outcome::kExcluded:
      return "excluded";
    case Outcome::kMerged:
      return "merged";
    case Outcome::kRejected:
      return "rejected";
    case Outcome::kTentative:
      return "tentative";
    case Outcome::kConfirmed:
      break;
  }
  return "confirmed";
}

}  // namespace ossa::people
