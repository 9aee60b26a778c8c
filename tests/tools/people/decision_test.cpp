// Decision records of candidates.
#include "tools/people/decision.h"

#include <set>

#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

TEST(Rules, HaveUniqueNamesAndTexts) {
  std::set<std::string_view> names;
  for (int i = 0; i < static_cast<int>(Rule::kCount); ++i) {
    names.insert(NameRule(static_cast<Rule>(i)));
    EXPECT_GT(DescribeRule(static_cast<Rule>(i)).size(), 20U) << i;
  }
  EXPECT_EQ(names.size(), static_cast<size_t>(Rule::kCount));
  EXPECT_EQ(NameOutcome(FindOutcome(Rule::kTooSmall)), "excluded");
  EXPECT_EQ(NameOutcome(FindOutcome(Rule::kEnoughObservations)), "confirmed");
}

// The decisions by geometry on an object that stands free in an empty room.
std::vector<Rule> ExcludedBy(const std::vector<tests::Box>& boxes) {
  PeopleOptions options;
  options.trace_surfaces = true;
  PeopleState state;
  std::vector<Rule> rules;
  for (const Decision& decision : Propose(Shot({}, 0, boxes), state, options).excluded) {
    const bool of_wall = decision.place_m.z() > 4.0 || decision.area_m2 > 3;
    if (!of_wall) rules.push_back(decision.rule);
  }
  return rules;
}

TEST(Decisions, SmallObjectIsRejectedAsTooSmall) {
  EXPECT_EQ(ExcludedBy({{{-0.08, -0.1, 2.5}, {0.08, 0.1, 2.6}}}),
            std::vector<Rule>{Rule::kTooSmall});
}

TEST(Decisions, FurnitureIsRejectedAsFurniture) {  // a wardrobe's front
  EXPECT_EQ(ExcludedBy({{{-0.6, -1.0, 2.5}, {0.6, 0.8, 3.0}}}),
            std::vector<Rule>{Rule::kFurniture});
}

TEST(Decisions, LongStationaryObjectIsRejectedAsBackground) {
  PeopleOptions options;
  options.trace_surfaces = true;
  PeopleState state;
  const std::vector<tests::Box> thing = {{{-0.15, -0.9, 2.5}, {0.15, 0.5, 2.8}}};
  std::vector<Decision> excluded;
  for (int f = 0; f <= options.scene.background.steady_frames; ++f) {
    const Proposed proposed = Propose(Shot({}, f, thing), state, options);
    EXPECT_EQ(proposed.candidates.empty(), f == options.scene.background.steady_frames) << f;
    Confirm(proposed, {}, f / 30.0, state);
    excluded = proposed.excluded;
  }
  const auto thing_at =
      std::find_if(excluded.begin(), excluded.end(), [](const Decision& decision) {
        return decision.rule == Rule::kBackground && decision.place_m.z() < 3;
      });
  ASSERT_NE(thing_at, excluded.end());
  EXPECT_NEAR(thing_at->size_m.x(), 0.3, 0.05);
}

}  // namespace
}  // namespace ossa::people
