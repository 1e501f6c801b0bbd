// SPDX-License-Identifier: Apache-2.0
// Wrote libe57format.e57, with libE57Format 3.4: four points as doubles with a pose, and four as
// thousandths. No build has it:
// g++ write_e57.cpp -lE57Format -lxerces-c && ./a.out libe57format.e57
#include <E57SimpleWriter.h>

#include <cmath>

namespace {

void write(e57::Writer& writer, bool whole, bool posed) {
  e57::Data3D scan;
  scan.name = whole ? "thousandths" : "doubles";
  scan.guid = whole ? "{b}" : "{a}";
  scan.pointCount = 4;
  if (posed) {
    scan.pose.rotation.w = scan.pose.rotation.z = std::sqrt(0.5);  // a quarter turn: x becomes y
    scan.pose.translation.x = 10;
    scan.pose.translation.y = 20;
    scan.pose.translation.z = 30;
  }
  auto& fields = scan.pointFields;
  fields.cartesianXField = fields.cartesianYField = fields.cartesianZField = true;
  fields.colorRedField = fields.colorGreenField = fields.colorBlueField = true;
  fields.pointRangeNodeType =
      whole ? e57::NumericalNodeType::ScaledInteger : e57::NumericalNodeType::Double;
  fields.pointRangeScale = 0.001;
  fields.pointRangeMinimum = -2;
  fields.pointRangeMaximum = 2;
  scan.colorLimits.colorRedMaximum = scan.colorLimits.colorGreenMaximum =
      scan.colorLimits.colorBlueMaximum = whole ? 65535 : 255;
  e57::Data3DPointsDouble points(scan);
  for (int i = 0; i < 4; ++i) {
    points.cartesianX[i] = 0.125 * i;
    points.cartesianY[i] = -0.25 * i;
    points.cartesianZ[i] = 0.5 * i;
    points.colorRed[i] = static_cast<std::uint16_t>((whole ? 257 : 1) * 200);
    points.colorGreen[i] = static_cast<std::uint16_t>((whole ? 257 : 1) * 120);
    points.colorBlue[i] = static_cast<std::uint16_t>((whole ? 257 : 1) * 40);
  }
  writer.WriteData3DData(scan, points);
}

}  // namespace

int main(int, char** argv) {
  e57::WriterOptions options;
  options.guid = "{slf}";
  e57::Writer writer(argv[1], options);
  write(writer, false, true);
  write(writer, true, false);
  return writer.Close() ? 0 : 1;
}
