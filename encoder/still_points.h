// SPDX-License-Identifier: Apache-2.0
// What stands still from frame to frame keeps its view map: it does not flicker, and takes hardly
// a byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "slf/frames.h"

namespace slf {

/// Frames in their order, one after the other.
class StillPoints {
 public:
  /// Compares the photographs of a frame with the last ones that showed anything else at a pixel: a
  /// change that creeps is found once it has added up.
  /// @errors those of load_image. Holds a photograph of every camera.
  Result<Done, InputError> see(const LoadedFrame& frame, int threads);

  /// Points that were there in the frame before, and where no camera sees a change, become what
  /// they were. O(points * cameras)
  /// @param field  of the frame seen last; its functions are those of the frame before
  /// @return how many points are held
  std::size_t hold(const LoadedFrame& frame, LightField& field, int threads);

 private:
  struct View {
    Camera camera;  ///< in the world
    Image image;    ///< each pixel as it was when it changed
    std::vector<std::uint8_t> changed;
  };
  static Result<Done, InputError> see(View& view, const Camera& camera, Image image);
  bool changed_at(const Vec3& world) const;

  std::map<std::string, View> views_;  // by the camera's name
  std::vector<Voxel> positions_;       // of the frame before
  std::vector<std::int32_t> components_;
};

}  // namespace slf
