// SPDX-License-Identifier: Apache-2.0
// The set-up of two photographs as Bundler, Metashape and openMVG write it.
#pragma once

#include "capture/radial_distortion.h"
#include "capture_formats.h"

namespace slf::test {

// y and z of the rows and of t change sign. The second of three cameras was not registered.
inline const std::string kBundleOut =
    "# Bundle file v0.3\n3 2\n"
    "30 -0.1 0.02\n-0.48 -0.64 -0.6\n-0.36 -0.48 0.8\n-0.8 0.6 0\n0.1 0.2 -3\n"
    "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
    "30 0 0\n1 0 0\n0 -1 0\n0 0 -1\n0 0 -4\n"
    "0 0 0\n10 20 30\n1 0 5 0.5 0.5\n"
    "0.125 0.25 0\n1 2 3\n2 0 1 0.5 0.5 1 2 0.5 0.5\n";

inline void write_bundler(const fs::path& root, const std::string& place,
                          const std::string& text = kBundleOut) {
  write_images(root / "images");
  write_text(root / place, text);
  write_text(root / "list.txt", "images/a.png\nimages/c.png 0 30\nimages/b.png 0 30\n");
}

// The component doubles, turns by 90 degrees about z and moves by (1, 2, 3): x_world = 2 (-y, x, z)
// + (1, 2, 3). Camera to chunk is (R^T, centre) of the set-up with that taken back.
inline const std::string kMetashapeXml = R"(<?xml version="1.0" encoding="UTF-8"?>
<!-- made by hand -->
<document version="2.0.0">
  <chunk label="Chunk 1" enabled="true">
    <sensors next_id="1">
      <sensor id="0" label="one" type="frame">
        <resolution width="16" height="12"/>
        <calibration type="frame" class="initial"><f>1</f></calibration>
        <calibration type="frame" class="adjusted">
          <resolution width="16" height="12"/>
          <f>60</f><cx>0.5</cx><cy>0.5</cy><b1>-30</b1>
        </calibration>
      </sensor>
    </sensors>
    <components><component id="4"><transform>
      <rotation>0 -1 0 1 0 0 0 0 1</rotation><translation>1 2 3</translation><scale>2</scale>
    </transform></component></components>
    <cameras next_id="3">
      <camera id="0" sensor_id="0" component_id="4" label="a">
        <transform>-0.64 0.48 -0.6 -0.02 0.48 -0.36 -0.8 1.64 -0.6 -0.8 0 -1.55 0 0 0 1</transform>
      </camera>
      <camera id="1" sensor_id="0" label="lost"/>
      <group label="&lt;all&gt;"><camera id="2" sensor_id="0" component_id="4" label="b.png">
        <transform>0 1 0 -1 -1 0 0 0.5 0 0 1 -3.5 0 0 0 1</transform>
      </camera></group>
    </cameras>
  </chunk>
</document>
)";

inline void write_metashape(const fs::path& root, const std::string& xml = kMetashapeXml) {
  write_images(root / "images");
  write_points(root / "points.ply");
  write_text(root / "cameras.xml", xml);
}

inline const std::string kSfmData = R"({"sfm_data_version": "0.3", "root_path": "/elsewhere",
 "views": [
  {"key": 0, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 1, "data":
   {"local_path": "", "filename": "a.png", "width": 16, "height": 12,
    "id_view": 0, "id_intrinsic": 0, "id_pose": 7}}}},
  {"key": 1, "value": {"polymorphic_id": 1073741824, "ptr_wrapper": {"id": 2, "data":
   {"local_path": "", "filename": "c.png", "width": 16, "height": 12,
    "id_view": 1, "id_intrinsic": 0, "id_pose": 4294967295}}}},
  {"key": 2, "value": {"ptr_wrapper": {"id": 3, "data": {"value0":
   {"local_path": "images", "filename": "b.png", "width": 16, "height": 12,
    "id_view": 2, "id_intrinsic": 1, "id_pose": 3}}}}}],
 "intrinsics": [
  {"key": 0, "value": {"polymorphic_id": 2147483649, "polymorphic_name": "pinhole_radial_k3",
   "ptr_wrapper": {"id": 4, "data": {"width": 16, "height": 12, "focal_length": 30,
    "principal_point": [8.5, 6.5], "disto_k3": [-0.1, 0.02, 0]}}}},
  {"key": 1, "value": {"polymorphic_id": 2147483650, "ptr_wrapper": {"id": 5, "data": {"value0":
   {"value0": {"width": 16, "height": 12}, "focal_length": 30, "principal_point": [8.5, 6.5]},
   "disto_t2": [0.1, 0, 0, 0.01, 0.02]}}}}],
 "extrinsics": [
  {"key": 7, "value": {"rotation": [[-0.48, -0.64, -0.6], [0.36, 0.48, -0.8], [0.8, -0.6, 0]],
   "center": [-2.28, 1.96, -0.1]}},
  {"key": 3, "value": {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "center": [0, 0, -4]}}],
 "structure": [{"key": 5, "value": {"X": [0, 0, 0], "observations": []}},
               {"key": 6, "value": {"X": [0.125, 0.25, 0], "observations": []}}],
 "control_points": []})";

inline void write_openmvg(const fs::path& root, const std::string& json = kSfmData) {
  write_images(root / "images");
  write_text(root / "sfm_data.json", json);
}

}  // namespace slf::test
