#include <algorithm>
#include <iterator>

#include "tools/experiments/experiments_internal.h"

namespace ossa::tools {
namespace {

constexpr Experiment kExperiments[] = {
    {"body", "pictures of the 31 parts and of retargeted motions", ReadBodyParameters, RunBody},
    {"sensor", "simulated depth sensors compared with real ones", ReadSensorParameters, RunSensor},
    {"person-classifier", "fits the classifier of people and furniture",
     ReadPersonClassifierParameters, RunPersonClassifier},
    {"indoor-scenes",
     "the tracker in rendered indoor scenes: detection, split and false bodies, identity switches, "
     "joints",
     ReadIndoorScenesParameters, RunIndoorScenes},
    {"first-frames", "people found in single images, with objects held or in front",
     ReadFirstFramesParameters, RunFirstFrames},
    {"real", "each stage of the tracker on real depth images, with truth and without",
     ReadRealParameters, RunReal},
    {"fit", "the surface fit on real stills, with each of its terms and without", ReadFitParameters,
     RunFit},
    {"sdk", "every method on every real recording; the SDK's skeletons as the baseline",
     ReadSdkParameters, RunSdk},
    {"shum-ho-2012", "the physical character: the paper's scenes, the filter, fig. 5",
     ReadShumHo2012Parameters, RunShumHo2012},
    {"shotton-2011", "body parts: accuracy against images and depth, precision by joint",
     ReadShotton2011Parameters, RunShotton2011},
    {"shum-2013", "posture reconstruction: tables III and IV, figs. 8 and 9",
     ReadShum2013Parameters, RunShum2013},
    {"plantard-2016", "filtered pose graph: ten occluded scenarios, figs. 5-7 and 9, tests",
     ReadPlantard2016Parameters, RunPlantard2016},
    {"liu-2016", "local Gaussian processes: tables 3-5, figs. 3, 7 and 8", ReadLiu2016Parameters,
     RunLiu2016},
};

}  // namespace

std::span<const Experiment> Experiments() { return kExperiments; }

const Experiment* FindExperiment(std::string_view name) {
  if (name == "rooms") name = "indoor-scenes";
  if (name == "person-signs") name = "person-classifier";
  const auto found = std::ranges::find(kExperiments, name, &Experiment::name);
  return found == std::end(kExperiments) ? nullptr : &*found;
}

}  // namespace ossa::tools
