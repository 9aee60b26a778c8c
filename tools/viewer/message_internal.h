#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "tools/viewer/moment.h"

namespace ossa::viewer {

/// A moment on its way to browsers: what is said of it as the members of a JSON object, without the
/// braces, and its pictures one behind the other.
struct PackedMoment {
  std::string members;  // "frame":0,"time_s":0.0,"camera":{...},"layers":{...},...
  int width = 0, height = 0;
  int planes = 0;        // 0: no pictures, 1: depth, 3: depth, users and parts
  std::string pictures;  // depth, two bytes a pixel, little-endian mm; users and parts, one byte
};

PackedMoment Pack(const Moment& moment);

/// The binary message of a moment: the length of the header (4 bytes, little-endian), the header
/// (JSON, filled up with spaces to a multiple of four bytes), the pictures, of which every `step`th
/// pixel and row. `number` is its place in the recording, or how many were shown before it; `state`
/// is a JSON object that goes into the header.
std::string MessageOf(const PackedMoment& moment, int64_t number, int step, std::string_view state);

}  // namespace ossa::viewer
