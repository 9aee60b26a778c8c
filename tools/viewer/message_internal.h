#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "recon/fit/body_mesh.h"
#include "tools/viewer/display_frame.h"

namespace ossa::viewer {

/// A frame encoded for browsers: the members of a JSON object, without the braces, and its
/// pictures one after another.
struct PackedFrame {
  std::string members;  // "frame":0,"time_s":0.0,"camera":{...},"layers":{...},...
  int width = 0, height = 0;
  int planes = 0;        // 0: no pictures, 1: depth, 3: depth, users and parts
  std::string pictures;  // depth, two bytes a pixel, little-endian mm; users and parts, one byte
  /// The vertices of each of the members' "meshes", one after another: x, y, z in camera space,
  /// each a little-endian int16 of half millimetres.
  std::string meshes;
};

/// `parts`: of the frame, or found later. Fitted bodies have the mesh of `body`; null: they are
/// not shown.
PackedFrame Pack(const DisplayFrame& display, const depth::Image<uint8_t>& parts,
                 const recon::BodyMesh* body = nullptr);

/// The begin of the binary message of a frame: the length of the header (4 bytes, little-endian)
/// and the header (JSON, padded with spaces to a multiple of four bytes). The pictures, with every
/// `step`th pixel and row, and the meshes follow. `number` is its index in the recording, or the
/// number of frames shown before it; `state` is a JSON object to include in the header.
std::string HeadOf(const PackedFrame& display, int64_t number, int step, std::string_view state);

/// Every `step`th pixel and row of the pictures.
std::string ThinPictures(const PackedFrame& display, int step);

}  // namespace ossa::viewer
