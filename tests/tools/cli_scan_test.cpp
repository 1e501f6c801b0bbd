// SPDX-License-Identifier: Apache-2.0
// Scans of other formats, read by PDAL's program: with one that stands in for it, and with the real
// one where it is installed.
#include "cli_support.h"

namespace slf::cli_scan_test {
namespace {

/// Two metres of a plane at a place on a map, 0.1 m apart.
/// @param most  of a colour, 16 bits
std::string plane_ply(int most, const char* type) {
  std::string body;
  int count = 0;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y, ++count)
      body += std::to_string(400000 + x / 10.0) + " " + std::to_string(5700000 + y / 10.0) +
              " 100.5 " + std::to_string(most) + " " + std::to_string(most / 2) + " 0\n";
  std::string header = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
  for (const char* axis : {"x", "y", "z"}) header += std::string("property double ") + axis + "\n";
  for (const char* channel : {"red", "green", "blue"})
    header += "property " + std::string(type) + " " + channel + "\n";
  return header + "end_header\n" + body;
}

class ScanTest : public CliTest {
 protected:
  /// Says what pdal says of scan.laz, and gives out scan.ply, or eight.ply where 8 bits are wanted.
  void stand_in(const std::string& translate =
                    "case \"$*\" in *Red=uint8_t*) cat eight.ply > \"$3\" ;; *) cat scan.ply > "
                    "\"$3\" ;; esac") {
    std::filesystem::create_directory(path("bin"));
    write("summary.json",
          R"({"summary": {"dimensions": "X, Y, Z, Intensity, Red, Green, Blue", "num_points": 400,
              "srs": {"compoundwkt": "", "wkt": "PROJCS[\"UTM 32N\",UNIT[\"metre\",1]]"}}})");
    write("bin/pdal", "#!/bin/sh\necho \"$*\" >> words\ncase $1 in info) cat summary.json ;;\n*) " +
                          translate + " ;;\nesac\n");
    std::filesystem::permissions(path("bin/pdal"), std::filesystem::perms::owner_all);
    write("scan.laz", "LASF");
  }
  Ran encode(const std::string& scan) const {
    return slf("encode " + scan + " -o x.slf --quality 1", "PATH=\"$PWD/bin:$PATH\"");
  }
  /// What `decode --dump` gives, of a cloud in a file.
  std::string decoded(const std::string& file) const {
    EXPECT_EQ(slf("decode " + file + " --dump dump").code, 0);
    return read("dump/positions.npy") + read("dump/components.npy");
  }
};

TEST_F(ScanTest, ComesThroughPdalWithItsColoursAndItsSystem) {
  stand_in();
  write("scan.ply", plane_ply(51400, "ushort"));
  const Ran ran = encode("scan.laz");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto info = parsed(slf("info x.slf --json").out);
  EXPECT_EQ(info["points"], 400);
  EXPECT_NE(info["metadata"].dump().find("PROJCS[\\\"UTM 32N"), std::string::npos);
  EXPECT_NE(read("words").find("--writers.ply.dims=X=double,Y=double,Z=double,Red=uint16_t,"
                               "Green=uint16_t,Blue=uint16_t\n"),
            std::string::npos)
      << read("words");
  const std::string of_scan = decoded("x.slf");
  ASSERT_EQ(slf("encode scan.ply -o y.slf --quality 1").code, 0);
  EXPECT_EQ(of_scan, decoded("y.slf"));
}

TEST_F(ScanTest, EightBitsInSixteenAreNotBlack) {
  stand_in();
  write("scan.ply", plane_ply(200, "ushort"));
  write("eight.ply", plane_ply(200, "uchar"));
  ASSERT_EQ(encode("scan.laz").code, 0);
  const std::string of_scan = decoded("x.slf");
  ASSERT_EQ(slf("encode eight.ply -o y.slf --quality 1").code, 0);
  EXPECT_EQ(of_scan, decoded("y.slf"));
}

TEST_F(ScanTest, IsRefusedWithWhatPdalSaid) {
  stand_in("echo 'PDAL: readers.las: Unexpected end of file.' >&2; exit 1");
  expect_failure(encode("scan.laz"), 4, "scan.laz", "translate: PDAL: readers.las: Unexpected end");
  EXPECT_FALSE(exists("x.slf"));
  write("summary.json", "<html>");
  expect_failure(encode("scan.laz"), 4, "pdal info", "");
  stand_in("kill -9 $$");
  expect_failure(encode("scan.laz"), 4, "scan.laz", "exit code 137");
}

TEST_F(ScanTest, WhosePointsAreDamagedIsNamedItself) {
  stand_in();
  write("scan.ply", plane_ply(51400, "ushort").substr(0, 400));
  const Ran ran = encode("scan.laz");
  expect_failure(ran, 4, "scan.laz", "more than the file holds");
  EXPECT_EQ(ran.err.find("/dev/fd"), std::string::npos) << ran.err;
}

TEST_F(ScanTest, APdalThatCannotBeStartedDoesNotAskForItsPackage) {
  write("scan.laz", "LASF");
  std::filesystem::create_directory(path("bin"));
  write("bin/pdal", "#!/no/such/shell");
  std::filesystem::permissions(path("bin/pdal"), std::filesystem::perms::owner_read);
  const Ran ran = slf("encode scan.laz -o x.slf", "PATH=\"$PWD/bin\"");
  expect_failure(ran, 3, "scan.laz", "pdal: Permission denied");
}

TEST_F(ScanTest, AnInterruptEndsPdalToo) {
  stand_in("echo $$ > pdal.pid; exec sleep 60");
  const Ran cut = shell("PATH=\"$PWD/bin:$PATH\" '" SLF_PROGRAM
                        "' encode scan.laz -o x.slf & p=$!; "
                        "while kill -0 $p 2>.kill && ! test -s pdal.pid; do sleep 0.05; done; "
                        "kill -TERM $p; wait $p");
  EXPECT_EQ(cut.code, 130) << cut.err;
  EXPECT_FALSE(exists("x.slf"));
  const Ran left = shell(
      "i=0; while kill -0 $(cat pdal.pid) 2>.kill && test $i -lt 100; do i=$((i+1)); sleep 0.05; "
      "done; kill -0 $(cat pdal.pid)");
  EXPECT_NE(left.code, 0) << "it runs still";
}

TEST_F(ScanTest, WithoutPdalNamesThePackage) {
  write("scan.laz", "LASF");
  const Ran ran = slf("encode scan.laz -o x.slf", "PATH=\"$PWD\"");
  expect_failure(ran, 6, "scan.laz", "package pdal");
}

TEST_F(ScanTest, ComesThroughTheRealPdal) {
  if (shell("command -v pdal").code != 0) GTEST_SKIP() << "PDAL's program pdal is not there";
  write("scan.ply", plane_ply(51400, "ushort"));
  std::string options = " --writers.las.dataformat_id=2 --writers.las.a_srs=EPSG:25832";
  for (const char* axis : {"x", "y", "z"})
    options += std::string(" --writers.las.scale_") + axis + "=0.001 --writers.las.offset_" + axis +
               "=auto";
  ASSERT_EQ(shell("pdal translate scan.ply scan.laz" + options).code, 0) << read(".err");
  const Ran ran = slf("encode scan.laz -o x.slf --quality 1");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string of_scan = decoded("x.slf");
  ASSERT_EQ(slf("encode scan.ply -o y.slf --quality 1").code, 0);
  EXPECT_EQ(of_scan, decoded("y.slf"));
}

}  // namespace
}  // namespace slf::cli_scan_test
