// Who comes into view: somebody who went out of it, or somebody new.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "depth/scene/body_measures.h"
#include "depth/scene/reidentify_internal.h"
#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

// An adult's: head 1.6 m above the floor.
MeasuredBody Adult() { return {1.60F, 0.34F, 0.32F, 0.25F, 0.39F, 0.40F}; }
MeasuredBody Child() { return {1.15F, 0.25F, 0.23F, 0.18F, 0.28F, 0.28F}; }

BodyMeasures KnownAs(const MeasuredBody& body) {
  BodyMeasures known;
  for (int i = 0; i < 10; ++i) known.Add(body);
  return known;
}

TEST(BodyMeasures, TellAChildFromAnAdult) {
  EXPECT_GT(LogLikelihoodRatio(KnownAs(Adult()), Adult()), 1.0);
  EXPECT_LT(LogLikelihoodRatio(KnownAs(Adult()), Child()), -3.0);
}

TEST(BodyMeasures, SayNothingWhereNothingIsSeenOrAllIsWrong) {
  EXPECT_EQ(LogLikelihoodRatio(KnownAs(Adult()), MeasuredBody{}), 0.0);
  EXPECT_EQ(LogLikelihoodRatio(BodyMeasures{}, Adult()), 0.0);
  MeasuredBody absurd = Adult();
  absurd[static_cast<size_t>(Measure::kThigh)] = 30.0F;
  EXPECT_GT(LogLikelihoodRatio(KnownAs(Adult()), absurd), 0.0);
}

TEST(BodyMeasures, OfSomebodyHalfHiddenSayLess) {
  const BodyMeasures known = KnownAs(Adult());
  EXPECT_LT(LogLikelihoodRatio(known, Child()), LogLikelihoodRatio(known, Child(), true));
  EXPECT_GT(LogLikelihoodRatio(known, Adult()), LogLikelihoodRatio(known, Adult(), true));
}

TEST(BodyMeasures, AreTheMeanOfTheLooksThatShowThem) {
  BodyMeasures known;
  known.Add({1.5F});
  known.Add({});
  known.Add({1.7F});
  EXPECT_NEAR(known.mean_m[0], 1.6F, 1e-6F);
  EXPECT_EQ(known.looks[0], 2);
  EXPECT_EQ(known.looks[1], 0);
}

double SumOf(const std::vector<std::vector<double>>& weight, const std::vector<int>& column_of) {
  double sum = 0;
  for (size_t row = 0; row < weight.size(); ++row) {
    if (column_of[row] >= 0) sum += weight[row][static_cast<size_t>(column_of[row])];
  }
  return sum;
}

// Every row in every order takes the best column left: one of the orders is the best assignment.
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

TEST(BestAssignment, IsAsGoodAsTheBestOfAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-2, 3);
  for (const auto& [rows, columns] : {std::pair<size_t, size_t>{1, 1}, {2, 3}, {3, 2}, {3, 4}}) {
    for (int i = 0; i < 20; ++i) {
      std::vector<std::vector<double>> weight(rows, std::vector<double>(columns));
      for (auto& row : weight)
        std::generate(row.begin(), row.end(), [&] { return uniform(random); });
      const std::vector<int> column_of = BestAssignment(weight, columns);
      EXPECT_NEAR(SumOf(weight, column_of), BestOfAllOrders(weight, columns), 1e-9);
      for (size_t row = 0; row < rows; ++row)
        EXPECT_LE(
            column_of[row] < 0 ? 0 : std::count(column_of.begin(), column_of.end(), column_of[row]),
            1);
    }
  }
}

TEST(BestAssignment, LeavesOutWhatSpeaksAgainstIt) {
  EXPECT_EQ(BestAssignment({{-1, -0.5}}, 2), std::vector<int>{-1});
  EXPECT_EQ(BestAssignment({{5, 4}, {4.5, 0}}, 2), (std::vector<int>{1, 0}));  // not the 5 first
}

// Lost a while ago at the middle, seen again `x_m` to the side.
class Lost : public testing::Test {
 protected:
  double Ratio(float x_m, double gone_s, Way way) const {
    Candidate newcomer;
    newcomer.region.mean_m = {x_m, 0.2F, 4.0F};
    newcomer.body = body_;
    return LogLikelihoodRatio(PointGrid{}, user_, newcomer, way, 1.0 + gone_s, {});
  }
  void SetUp() override {
    user_.mean_m = {0, 0, 4};
    user_.seen_s = 1.0;
    user_.lost_behind = true;
  }
  UserTrack user_;
  MeasuredBody body_{};
};

TEST_F(Lost, WhoWalksOnComesBackFartherOn) {
  EXPECT_LT(Ratio(1.7F, 1.2, Way::kOpen), 0.0);
  user_.velocity_m_s = {1.4F, 0, 0};
  user_.steps = 1;
  const double rough = Ratio(1.7F, 1.2, Way::kOpen);
  user_.steps = 20;
  EXPECT_GT(Ratio(1.7F, 1.2, Way::kOpen), 0.0);
  EXPECT_GT(Ratio(1.7F, 1.2, Way::kOpen), rough);
  EXPECT_LT(Ratio(-1.7F, 1.2, Way::kOpen), 0.0);
}

TEST_F(Lost, NobodyNewComesOutFromBehindSomebodyInTheMiddleOfTheRoom) {
  EXPECT_GT(Ratio(1.2F, 1.2, Way::kBehind), 0.0);
  EXPECT_LT(Ratio(1.2F, 1.2, Way::kBorder), 0.0);
}

TEST_F(Lost, WhoDidNotGoBehindAnybodyHardlyComesOutFromBehind) {
  const double went_behind = Ratio(1.2F, 1.2, Way::kBehind);
  user_.lost_behind = false;
  EXPECT_LT(Ratio(1.2F, 1.2, Way::kBehind), went_behind - 1.0);
}

TEST_F(Lost, AnotherBodyAtTheSamePlaceIsSomebodyElse) {
  user_.body = KnownAs(Adult());
  body_ = Adult();
  EXPECT_GT(Ratio(0.3F, 1.2, Way::kOpen), 0.0);
  body_ = Child();
  EXPECT_LT(Ratio(0.3F, 1.2, Way::kOpen), 0.0);
}

TEST_F(Lost, IsForgottenSoonerThanWhoWentBehindSomebody) {
  EXPECT_FALSE(IsForgotten(user_, 1.0 + 4.0, {}));
  EXPECT_TRUE(IsForgotten(user_, 1.0 + 6.0, {}));
  user_.lost_behind = false;
  EXPECT_TRUE(IsForgotten(user_, 1.0 + 4.0, {}));
}

// Where the farther of two people stands.
Way WayOfFarther(double x_m) {
  const CapsuleRender render = Shot({PersonAt(0.5, 1.8), PersonAt(x_m, 3.6)});
  const PointGrid grid = GridOf(render);
  std::vector<int> person_of, cells;
  std::vector<float> z_m;
  for (int i = 0; i < grid.cells(); ++i) {
    const int who = render.person.at(i % grid.width * grid.step, i / grid.width * grid.step);
    person_of.push_back(grid.valid(i) ? who - 1 : -1);
    if (person_of.back() == 1) cells.push_back(i), z_m.push_back(grid.z(i));
  }
  return WayOf(grid, cells, z_m, person_of, 1);
}

TEST(WayOf, IsBehindAtSomebodysOutlineAndElsewhereOpenOrTheBorder) {
  EXPECT_EQ(WayOfFarther(-0.2), Way::kBehind);
  EXPECT_EQ(WayOfFarther(-1.0), Way::kOpen);
  EXPECT_EQ(WayOfFarther(-1.8), Way::kBorder);
}

// A few cells in the middle of the image, said to be `x_m` to the side.
Candidate SomebodyFarOff(const PointGrid& grid, float x_m) {
  Candidate person;
  person.region = MakeRegion(grid, {grid.cell(40, 40), grid.cell(41, 40)});
  person.region.mean_m.x() = x_m;
  return person;
}

Scene EmptyScene() {
  Scene scene;
  scene.grid = GridOf(Shot({}));
  return scene;
}

TEST(ConfirmUsers, GivesNobodyTheIdOfSomebodyRemembered) {
  const Scene scene = EmptyScene();
  SceneState state;
  state.next_id = 255;  // the last; then from 1 again
  for (const int id : {255, 1, 3}) {
    UserTrack user;
    user.id = id;
    user.mean_m = {50, 0, 3};
    state.users.push_back(user);
  }
  const Candidate a = SomebodyFarOff(scene.grid, -20), b = SomebodyFarOff(scene.grid, 20);
  EXPECT_EQ(ConfirmUsers(scene, {&a, &b}, 0.1, state), (std::vector<int>{2, 4}));
}

// Nobody is forgotten where time stands still, as of an application that gives none.
TEST(ConfirmUsers, AnyNumberOfVisitorsHaveDifferentIdsThatFitAByte) {
  const Scene scene = EmptyScene();
  SceneState state;
  for (int i = 0; i < 300; ++i) {
    const Candidate visitor = SomebodyFarOff(scene.grid, 20.0F * static_cast<float>(i));
    const int id = ConfirmUsers(scene, {&visitor}, 0.0, state).at(0);
    EXPECT_TRUE(id >= 1 && id <= 255) << id;
    const auto has_it = [&](const UserTrack& user) { return user.id == id; };
    EXPECT_EQ(std::count_if(state.users.begin(), state.users.end(), has_it), 1) << i;
  }
}

}  // namespace
}  // namespace ossa::depth
