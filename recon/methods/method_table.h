#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// The default method.
inline constexpr std::string_view kDefaultMethod = "best";

/// Whether a method uses a kind of model.
enum class Reads {
  kNothing,   // it is not used
  kOptional,  // the method is better with it
  kRequired,  // the method does not work without it
};

/// A method of reconstruction as methods.inc describes it, without the code.
struct MethodInfo {
  std::string_view name;             // as --method takes it
  Reads database = Reads::kNothing;  // postures, recon/database/posture_database.h
  Reads learned = Reads::kNothing;   // of a sensor's errors, recon/models/learned_models.h
  bool prior = false;  // completes by a pose prior, recon/models/posture_prior.h, where it has one
  bool refined = false;      // starts from joints refined at the depth image where there are any
  bool keeps_bones = false;  // a person's bone lengths are constant in the results
  bool smoothed_in_files = false;          // recordings are smoothed by later frames by default
  std::string_view smoothing = "default";  // preset that goes with it: a filter needs no second one
};

/// All methods, in the order of `ossa track --help`.
std::span<const MethodInfo> MethodTable();

/// Names of all methods, in the same order.
const std::vector<std::string>& ReconstructionMethods();

/// Null when there is no method of that name.
const MethodInfo* FindMethod(std::string_view name);

/// Throws InputError that names all methods when there is none of that name.
const MethodInfo& RequireMethod(std::string_view name);

}  // namespace ossa::recon
