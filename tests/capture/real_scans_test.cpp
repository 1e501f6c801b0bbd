// SPDX-License-Identifier: Apache-2.0
// Scans that other programs wrote (scans/): their points, poses and colours.
#include <gmock/gmock.h>

#include "capture/e57_reader.h"
#include "capture/las_reader.h"

namespace slf::real_scans_test {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::filesystem::path kScans = SLF_SCANS;
auto near(double x, double y, double z) {
  using ::testing::FloatEq;
  return ElementsAre(FloatEq(float(x)), FloatEq(float(y)), FloatEq(float(z)));
}

constexpr int kPoints = 4;  ///< of a scan: (0.125, -0.25, 0.5) times 0, 1, 2, 3

TEST(RealScans, LaspyWroteThePointsThatAreRead) {
  std::vector<std::string> warnings;
  ASSERT_TRUE(is_plain_las(kScans / "laspy.las"));
  const auto scan = read_las(kScans / "laspy.las", &warnings);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_THAT(warnings, IsEmpty());
  const PointCloud& cloud = scan->points.vertices;
  ASSERT_EQ(cloud.positions.size(), std::size_t{kPoints});
  for (int p = 0; p < kPoints; ++p)
    EXPECT_THAT(cloud.positions[static_cast<std::size_t>(p)],
                near(500000 + 0.125 * p, 4000000 - 0.25 * p, 100 + 0.5 * p))
        << p;
  EXPECT_THAT(cloud.colours, Each(ElementsAre(200, 120, 40)));
}

TEST(RealScans, LibE57FormatWroteThePointsThatAreRead) {
  std::vector<std::string> warnings;
  const auto scan = read_e57(kScans / "libe57format.e57", &warnings);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_THAT(warnings, IsEmpty());
  const PointCloud& cloud = scan->points.vertices;
  ASSERT_EQ(cloud.positions.size(), std::size_t{2 * kPoints});
  for (int p = 0; p < kPoints; ++p) {
    const auto row = static_cast<std::size_t>(p);
    // The pose of the first: a quarter turn about z, then (10, 20, 30).
    EXPECT_THAT(cloud.positions[row], near(10 + 0.25 * p, 20 + 0.125 * p, 30 + 0.5 * p)) << p;
    EXPECT_THAT(cloud.positions[kPoints + row], near(0.125 * p, -0.25 * p, 0.5 * p)) << p;
  }
  EXPECT_THAT(cloud.colours, Each(ElementsAre(200, 120, 40)));
}

}  // namespace
}  // namespace slf::real_scans_test
