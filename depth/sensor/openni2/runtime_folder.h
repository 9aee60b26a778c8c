#pragma once
#include <filesystem>

namespace ossa::depth {

/// The folder of ossa's OpenNI2: a link to libOpenNI2.so.0 and beside it OpenNI2/Drivers with the
/// drivers to load, including ours (OpenNI2 looks nowhere else). It is beside our library, in the
/// build tree as after installation; the environment variable OSSA_OPENNI2 overrides it. Throws
/// InputError if it does not exist.
std::filesystem::path OpenNiRuntimeFolder();

}  // namespace ossa::depth
