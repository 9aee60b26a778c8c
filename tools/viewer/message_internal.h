#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "recon/fit/body_mesh.h"
#include "tools/viewer/moment.h"

namespace ossa::viewer {

/// A moment encoded for browsers: the members of a JSON object, without the braces, and its
/// pictures one after another.
struct PackedMoment {
  std::string members;  // "frame":0,"time_s":0.0,"camera":{...},"layers":{...},...
  int width = 0, height = 0;
  int planes = 0;        // 0: no pictures, 1: depth, 3: depth, users and parts
  std::string pictures;  // depth, two bytes a pixel, little-endian mm; users and parts, one byte
  /// The vertices of each of the members' "meshes", one after another: x, y, z in camera space,
  /// each a little-endian int16 of half millimetres.
  std::string meshes;
};

/// `parts`: of the moment, or found later. Fitted bodies have the mesh of `body`; null: they are
/// not shown.
PackedMoment Pack(const Moment& moment, const depth::Image<uint8_t>& parts,
                  const recon::BodyMesh* body = nullptr);

/// The begin of the binary message of a moment: the length of the header (4 bytes, little-endian)
/// and the header (JSON, padded with spaces to a multiple of four bytes). The pictures, with every
/// `step`th pixel and row, and the meshes follow. `number` is its index in the recording, or the
/// number of moments shown before it; `state` is a JSON object to include in the header.
std::string HeadOf(const PackedMoment& moment, int64_t number, int step, std::string_view state);

/// Every `step`th pixel and row of the pictures.
std::string ThinPictures(const PackedMoment& moment, int step);

}  // namespace ossa::viewer
