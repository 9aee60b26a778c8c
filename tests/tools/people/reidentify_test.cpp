// Re-identification: a person who comes into view is a lost track or a new one.
#include "tools/people/reidentify.h"

#include <numeric>
#include <random>

#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

// An adult's: head 1.6 m above the floor.
FrameMeasures Adult() { return {1.60F, 0.34F, 0.32F, 0.25F, 0.39F, 0.40F}; }
FrameMeasures Child() { return {1.15F, 0.25F, 0.23F, 0.18F, 0.28F, 0.28F}; }

BodyMeasures KnownAs(const FrameMeasures& body) {
  BodyMeasures known;
  for (int i = 0; i < 10; ++i) known.Add(body);
  return known;
}

TEST(BodyMeasures, DistinguishAChildFromAnAdult) {
  EXPECT_GT(CompareMeasures(KnownAs(Adult()), Adult()), 1.0);
  EXPECT_LT(CompareMeasures(KnownAs(Adult()), Child()), -3.0);
}

TEST(BodyMeasures, AreEmptyWithoutOrWithInvalidObservations) {
  EXPECT_EQ(CompareMeasures(KnownAs(Adult()), FrameMeasures{}), 0.0);
  EXPECT_EQ(CompareMeasures(BodyMeasures{}, Adult()), 0.0);
  FrameMeasures absurd = Adult();
  absurd[static_cast<size_t>(Measure::kThigh)] = 30.0F;
  EXPECT_GT(CompareMeasures(KnownAs(Adult()), absurd), 0.0);
}

TEST(BodyMeasures, OccludedFramesWeighLess) {
  const BodyMeasures known = KnownAs(Adult());
  EXPECT_LT(CompareMeasures(known, Child()), CompareMeasures(known, Child(), true));
  EXPECT_GT(CompareMeasures(known, Adult()), CompareMeasures(known, Adult(), true));
}

TEST(BodyMeasures, AverageTheFramesThatShowThem) {
  BodyMeasures known;
  known.Add({1.5F});
  known.Add({});
  known.Add({1.7F});
  EXPECT_NEAR(known.mean_m[0], 1.6F, 1e-6F);
  EXPECT_EQ(known.frames[0], 2);
  EXPECT_EQ(known.frames[1], 0);
}

double Sum(const std::vector<std::vector<double>>& weight, const std::vector<int>& column_of) {
  double sum = 0;
  for (size_t row = 0; row < weight.size(); ++row) {
    if (column_of[row] >= 0) sum += weight[row][static_cast<size_t>(column_of[row])];
  }
  return sum;
}

// Brute force: every order of rows, each taking the best column left; one of the orders is the best
// assignment.
double BestOfAllOrders(const std::vector<std::vector<double>>& weight, size_t columns) {
  std::vector<size_t> order(columns + weight.size());
  std::iota(order.begin(), order.end(), 0U);
  double best = 0;
  do {
    double sum = 0;
    for (size_t row = 0; row < weight.size(); ++row)
      sum += order[row] < columns ? std::max(0.0, weight[row][order[row]]) : 0.0;
    best = std::max(best, sum);
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

TEST(FindBestAssignment, EqualsTheOptimumOfBruteForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-2, 3);
  for (const auto& [rows, columns] : {std::pair<size_t, size_t>{1, 1}, {2, 3}, {3, 2}, {3, 4}}) {
    for (int i = 0; i < 20; ++i) {
      std::vector<std::vector<double>> weight(rows, std::vector<double>(columns));
      for (auto& row : weight)
        std::generate(row.begin(), row.end(), [&] { return uniform(random); });
      const std::vector<int> column_of = FindBestAssignment(weight, columns);
      EXPECT_NEAR(Sum(weight, column_of), BestOfAllOrders(weight, columns), 1e-9);
      for (size_t row = 0; row < rows; ++row)
        EXPECT_LE(
            column_of[row] < 0 ? 0 : std::count(column_of.begin(), column_of.end(), column_of[row]),
            1);
    }
  }
}

TEST(FindBestAssignment, OmitsNegativeWeights) {
  EXPECT_EQ(FindBestAssignment({{-1, -0.5}}, 2), std::vector<int>{-1});
  EXPECT_EQ(FindBestAssignment({{5, 4}, {4.5, 0}}, 2),
            (std::vector<int>{1, 0}));  // not the 5 first
}

// A track lost some time ago in the middle, and a person seen `x_m` to the side.
class Lost : public testing::Test {
 protected:
  double Ratio(float x_m, double gone_s, Entrance entrance) const {
    return ComputeLostTrackLogOdds(PointGrid{}, track_, {x_m, 0.2F, 4.0F}, body_, entrance,
                                   1.0 + gone_s, {});
  }
  void SetUp() override {
    track_.mean_m = {0, 0, 4};
    track_.last_seen_s = 1.0;
    track_.lost_behind = true;
  }
  Track track_;
  FrameMeasures body_{};
};

TEST_F(Lost, WalkerReturnsFartherAlongThePath) {
  EXPECT_LT(Ratio(1.7F, 1.2, Entrance::kOpen), 0.0);
  track_.velocity_m_s = {1.4F, 0, 0};
  track_.velocity_frames = 1;
  const double rough = Ratio(1.7F, 1.2, Entrance::kOpen);
  track_.velocity_frames = 20;
  EXPECT_GT(Ratio(1.7F, 1.2, Entrance::kOpen), 0.0);
  EXPECT_GT(Ratio(1.7F, 1.2, Entrance::kOpen), rough);
  EXPECT_LT(Ratio(-1.7F, 1.2, Entrance::kOpen), 0.0);
}

TEST_F(Lost, PersonAppearingFromBehindAnotherIsALostTrack) {
  EXPECT_GT(Ratio(1.2F, 1.2, Entrance::kBehind), 0.0);
  EXPECT_LT(Ratio(1.2F, 1.2, Entrance::kBorder), 0.0);
}

TEST_F(Lost, TrackNotLostBehindAnotherHardlyReturnsFromBehind) {
  const double went_behind = Ratio(1.2F, 1.2, Entrance::kBehind);
  track_.lost_behind = false;
  EXPECT_LT(Ratio(1.2F, 1.2, Entrance::kBehind), went_behind - 1.0);
}

TEST_F(Lost, DifferentBodyAtTheSamePlaceIsAnotherPerson) {
  track_.measures = KnownAs(Adult());
  body_ = Adult();
  EXPECT_GT(Ratio(0.3F, 1.2, Entrance::kOpen), 0.0);
  body_ = Child();
  EXPECT_LT(Ratio(0.3F, 1.2, Entrance::kOpen), 0.0);
}

TEST_F(Lost, IsDeletedSoonerThanATrackLostBehindAnother) {
  EXPECT_FALSE(IsForgotten(track_, 1.0 + 4.0, {}));
  EXPECT_TRUE(IsForgotten(track_, 1.0 + 6.0, {}));
  track_.lost_behind = false;
  EXPECT_TRUE(IsForgotten(track_, 1.0 + 4.0, {}));
}

// Where the farther of two people stands.
Entrance FindEntranceOfFarther(double x_m) {
  const CapsuleRender render = Shot({PersonAt(0.5, 1.8), PersonAt(x_m, 3.6)});
  const PointGrid grid = GridOf(render);
  std::vector<int> person_of, cells;
  std::vector<float> z_m;
  for (int i = 0; i < grid.cells(); ++i) {
    const int who = render.person.at(i % grid.width * grid.step, i / grid.width * grid.step);
    person_of.push_back(grid.valid(i) ? who - 1 : -1);
    if (person_of.back() == 1) cells.push_back(i), z_m.push_back(grid.z(i));
  }
  return FindEntrance(grid, cells, z_m, person_of, 1);
}

TEST(FindEntrance, DistinguishesBehindAPersonOpenAndTheBorder) {
  EXPECT_EQ(FindEntranceOfFarther(-0.2), Entrance::kBehind);
  EXPECT_EQ(FindEntranceOfFarther(-1.0), Entrance::kOpen);
  EXPECT_EQ(FindEntranceOfFarther(-1.8), Entrance::kBorder);
}

}  // namespace
}  // namespace ossa::people
