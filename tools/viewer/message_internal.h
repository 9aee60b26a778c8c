#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "recon/fit/body_mesh.h"
#include "tools/viewer/moment.h"

namespace ossa::viewer {

/// A moment on its way to browsers: what is said of it as the members of a JSON object, without the
/// braces, and its pictures one behind the other.
struct PackedMoment {
  std::string members;  // "frame":0,"time_s":0.0,"camera":{...},"layers":{...},...
  int width = 0, height = 0;
  int planes = 0;        // 0: no pictures, 1: depth, 3: depth, users and parts
  std::string pictures;  // depth, two bytes a pixel, little-endian mm; users and parts, one byte
  /// Of each of the members' "meshes" the corners of its skin one behind the other: x, y, z in
  /// camera space, each a little-endian int16 of half millimetres.
  std::string meshes;
};

/// `parts`: those of the moment, or found since. Fitted bodies wear the skin of `body`; null: they
/// are not shown.
PackedMoment Pack(const Moment& moment, const depth::Image<uint8_t>& parts,
                  const recon::BodyMesh* body = nullptr);

/// The binary message of a moment begins so: the length of the header (4 bytes, little-endian), the
/// header (JSON, filled up with spaces to a multiple of four bytes). The pictures, of which every
/// `step`th pixel and row is sent, and the meshes follow. `number` is its place in the recording,
/// or how many were shown before it; `state` is a JSON object that goes into the header.
std::string HeadOf(const PackedMoment& moment, int64_t number, int step, std::string_view state);

/// Every `step`th pixel and row of the pictures.
std::string ThinPictures(const PackedMoment& moment, int step);

}  // namespace ossa::viewer
