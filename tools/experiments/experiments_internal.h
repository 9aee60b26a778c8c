#pragma once
#include "tools/experiments/experiment.h"

namespace ossa::tools {

// Two functions per experiment, in its own file: one reads all parameters
// (Experiment::read_parameters), one runs it.

/// The body's parts and motions on it, as pictures.
void ReadBodyParameters(ExperimentContext& context);
std::vector<Table> RunBody(ExperimentContext& context);
/// The simulated sensor beside real frames: depth steps, noise, shadows, holes.
void ReadSensorParameters(ExperimentContext& context);
std::vector<Table> RunSensor(ExperimentContext& context);
/// Real depth: each stage of the tracker on every real set, with truth and without.
void ReadRealParameters(ExperimentContext& context);
std::vector<Table> RunReal(ExperimentContext& context);
void ReadFitParameters(ExperimentContext& context);
std::vector<Table> RunFit(ExperimentContext& context);
/// Every method on every real recording, the SDK's own skeletons as the baseline.
void ReadSdkParameters(ExperimentContext& context);
std::vector<Table> RunSdk(ExperimentContext& context);
/// Fits the weights in tools/people/person_classifier_weights.inc.
void ReadPersonClassifierParameters(ExperimentContext& context);
std::vector<Table> RunPersonClassifier(ExperimentContext& context);
/// One to six people in rendered indoor scenes: who is found, cut in two, invented, mixed up.
void ReadIndoorScenesParameters(ExperimentContext& context);
std::vector<Table> RunIndoorScenes(ExperimentContext& context);
/// Single images: who is found in them, whatever they hold or stand behind.
void ReadFirstFramesParameters(ExperimentContext& context);
std::vector<Table> RunFirstFrames(ExperimentContext& context);
/// Shum & Ho 2012: scenes with objects, the character as a filter, dimensions of a posture search.
void ReadShumHo2012Parameters(ExperimentContext& context);
std::vector<Table> RunShumHo2012(ExperimentContext& context);

/// Shum et al. 2013: tables I to IV, figures 8 and 9, tilted cameras.
void ReadShum2013Parameters(ExperimentContext& context);
std::vector<Table> RunShum2013(ExperimentContext& context);
/// Plantard et al. 2016: ten occluded scenarios, figures 5 to 7 and 9, tests of section 8.2.
void ReadPlantard2016Parameters(ExperimentContext& context);
std::vector<Table> RunPlantard2016(ExperimentContext& context);
/// Liu et al. 2016: tables 3 to 5, figures 3, 7 and 8.
void ReadLiu2016Parameters(ExperimentContext& context);
std::vector<Table> RunLiu2016(ExperimentContext& context);
/// Shotton et al. 2011: accuracy against images and depth, precision by joint.
void ReadShotton2011Parameters(ExperimentContext& context);
std::vector<Table> RunShotton2011(ExperimentContext& context);

}  // namespace ossa::tools
