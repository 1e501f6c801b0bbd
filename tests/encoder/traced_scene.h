// SPDX-License-Identifier: Apache-2.0
// A synthetic scene in memory: photographs of rings of cameras, and its exact points.
#pragma once

#include <vector>

#include "slf/capture.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"
#include "tools/synth/trace.h"

namespace slf::test {

struct TracedScene {
  Capture capture;  ///< without points
  std::vector<int> cameras;
  PointCloud exact;
  double step = 0, radius = 0;  ///< of the points, of the scene

  TracedScene(const char* name, int rings, int per_ring, int side, int points,
              int supersampling = 2) {
    const auto scene = synth::make_scene(name);
    radius = scene->bounds().radius;
    capture.cameras = synth::make_rings(rings, per_ring, side, side, radius).cameras;
    for (const Camera& camera : capture.cameras) {
      cameras.push_back(int(cameras.size()));
      capture.images.push_back(synth::trace_image(*scene, camera, supersampling));
    }
    exact = synth::sample_points(*scene, points, 2, &step);
  }
};

}  // namespace slf::test
