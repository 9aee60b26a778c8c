#pragma once
#include <filesystem>

namespace ossa::depth {

/// The folder with ossa's OpenNI2: a link to libOpenNI2.so.0 and beside it OpenNI2/Drivers with the
/// drivers it shall load, ours among them (OpenNI2 looks nowhere else). It lies beside our own
/// library, in the build tree as after installation; the environment's OSSA_OPENNI2 overrides.
/// Throws InputError when it is not there.
std::filesystem::path OpenNiRuntimeFolder();

}  // namespace ossa::depth
