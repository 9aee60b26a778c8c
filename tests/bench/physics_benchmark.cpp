// A 30 Hz frame of the character as a filter, 10 substeps, one core: one person and six, moved by
// the papers' forces and by servo motors; with hinges and joint limits.
#include <benchmark/benchmark.h>

#include "physics/character_filter.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

void FilterPerFrame(benchmark::State& state, const CharacterFilterOptions& options, int people) {
  std::vector<CharacterFilter> filters;
  for (int k = 0; k < people; ++k) filters.emplace_back(test::Lengths(), options);
  int frame = 0;
  for (auto _ : state) {
    for (int k = 0; k < people; ++k) {
      const auto target = test::DancingPerson(test::kFrame_s * (frame + 37 * k));
      benchmark::DoNotOptimize(
          filters[static_cast<size_t>(k)].Step(target, {}, test::Ground(), test::kFrame_s));
    }
    ++frame;
  }
}

CharacterFilterOptions With(Control control, bool joints) {
  CharacterFilterOptions options;
  options.control = control;
  options.hinges = options.joint_limits = joints;
  return options;
}

const int kRegistered = [] {
  for (const auto& [name, control] :
       {std::pair("pd", Control::kPaper), {"motor", Control::kMotor}}) {
    for (const int people : {1, 6}) {
      const std::string title = std::string("FilterPerFrame/") + name + "/people:";
      benchmark::RegisterBenchmark((title + std::to_string(people)).c_str(), FilterPerFrame,
                                   With(control, false), people)
          ->Iterations(600)
          ->Unit(benchmark::kMillisecond);
    }
  }
  benchmark::RegisterBenchmark("FilterPerFrame/pd/hinges and limits", FilterPerFrame,
                               With(Control::kPaper, true), 1)
      ->Iterations(600)
      ->Unit(benchmark::kMillisecond);
  return 0;
}();

}  // namespace
}  // namespace ossa::physics
