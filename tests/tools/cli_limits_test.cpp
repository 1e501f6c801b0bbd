// SPDX-License-Identifier: Apache-2.0
// Limits, partial files and foreign text through the program.
#include <sys/stat.h>

#include "bitstream/units.h"
#include "cli_support.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"
#include "slf/encoder.h"

namespace slf::cli_limits_test {
namespace {

using nlohmann::json;

/// good.slf with a base, slices and colours; partial.slf ends behind two thirds of its units.
class LimitsTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    const auto whole = conformance::base_stream(true);
    write("good.slf", {whole.begin(), whole.end()});
    const auto units = *split_units(whole);
    const auto end = units.units[units.units.size() * 2 / 3].offset;
    write("partial.slf", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(end)});
    const Ran cut = slf("truncate good.slf --levels 3 -o cut.slf");
    ASSERT_EQ(cut.code, 0) << cut.err;
    ASSERT_EQ(cut.err.find("warning"), std::string::npos);
  }

  static constexpr std::array<const char*, 6> kVerbs = {"info FILE",
                                                        "decode FILE -o out.ply",
                                                        "render FILE -o out.png --size 16x16",
                                                        "export FILE -o out.spz",
                                                        "export FILE --mean -o out.ply",
                                                        "truncate FILE --groups 1 -o out.slf"};

  static std::string with(const char* verb, const std::string& file) {
    std::string command = verb;
    return command.replace(command.find("FILE"), 4, file);
  }
};

TEST_F(LimitsTest, PartialFilesSaySoInEveryVerb) {
  for (const char* verb : kVerbs)
    for (const char* file : {"partial.slf", "cut.slf"}) {
      const Ran ran = slf(with(verb, file));
      EXPECT_EQ(ran.code, 0) << verb << ran.err;
      EXPECT_NE(ran.err.find("slf: warning: " + std::string(file) + ": partial"), std::string::npos)
          << verb << ran.err;
      const Ran as_json = slf(with(verb, file) + " --json");
      EXPECT_EQ(parsed(as_json.out)["partial"], true) << verb;
      const bool cuts = std::string_view(verb).starts_with("truncate");
      EXPECT_EQ(parsed(slf(with(verb, "good.slf") + " --json").out)["partial"], cuts) << verb;
    }
}

TEST_F(LimitsTest, StrictRefusesPartialFiles) {
  for (const char* verb : kVerbs) {
    std::filesystem::remove(path("out.ply"));
    for (const char* file : {"partial.slf", "cut.slf"})
      expect_failure(slf(with(verb, file) + " --strict"), 4, file, "--strict");
    EXPECT_FALSE(exists("out.ply"));
    EXPECT_EQ(slf(with(verb, "good.slf") + " --strict").code, 0) << verb;
  }
}

TEST_F(LimitsTest, AreNamedWithWhatTheFileTakes) {
  for (const char* verb :
       {"decode FILE -o out.ply", "render FILE -o out.png", "info FILE", "info FILE --syntax",
        "truncate FILE -o out.slf", "truncate FILE --region 0,0,0,9,9,9 -o out.slf"}) {
    const std::string command = with(verb, "good.slf");
    expect_failure(slf(command + " --max-memory 64K"), 5, "good.slf", "--max-memory");
    expect_failure(slf(command + " --max-points 10"), 5, "good.slf", "--max-points");
    expect_failure(slf(command + " --max-work 100"), 5, "good.slf", "--max-work");
  }
  EXPECT_EQ(slf("decode good.slf -o out.ply --max-memory 1G --max-points 100000").code, 0);
  EXPECT_FALSE(exists("out.slf"));
}

TEST_F(LimitsTest, MemoryIsAWholeNumberOfBytes) {
  for (const char* wrong : {"none", "-1", "-5", "-1M", "0", "1.5M", "8E", "99999999999T", "1KB"})
    expect_failure(slf("decode good.slf -o out.ply --max-memory=" + std::string(wrong)), 2, wrong,
                   "--max-memory");
  for (const char* right : {"100000000", "100000K", "100m", "1G", "1T"})
    EXPECT_EQ(slf("decode good.slf -o out.ply --max-memory=" + std::string(right)).code, 0);
}

TEST_F(LimitsTest, AFileLargerThanTheMemoryIsALimitToo) {
  const auto bytes = std::to_string(read("good.slf").size() - 1);
  for (const char* verb : {"info FILE", "decode FILE -o out.ply"})
    expect_failure(slf(with(verb, "good.slf") + " --max-memory " + bytes), 5, "good.slf",
                   "bytes of --max-memory");
}

TEST_F(LimitsTest, APartOfAFileBeyondThemCanBeCutOut) {
  const json whole = parsed(slf("info good.slf --json -j 1").out)["decode"];
  const std::uint64_t work = whole["work"];
  const std::string less = " --max-work " + std::to_string(work - 1);
  expect_failure(slf("truncate good.slf -o part.slf" + less), 5, "good.slf", "--max-work");
  EXPECT_EQ(slf("truncate good.slf --levels 1 -o part.slf" + less).code, 0);
}

TEST_F(LimitsTest, BytesWithoutRoomForTheHeadersAreAUsageError) {
  for (const char* verb : {"decode FILE -o out.ply", "truncate FILE -o out.slf"})
    expect_failure(slf(with(verb, "good.slf") + " --max-bytes 10"), 2, "good.slf",
                   "--max-bytes 10 has no room for its headers");
}

TEST_F(LimitsTest, NothingIsNotRendered) {
  expect_failure(slf("render good.slf --region 1000,1000,1000,1001,1001,1001 -o out.png"), 4,
                 "good.slf", "no points");
  EXPECT_FALSE(exists("out.png"));
  const Ran part = slf("render good.slf --levels 3 --size 16x16 -o out.png");
  EXPECT_NE(part.err.find("PARTIAL"), std::string::npos) << part.err;
}

TEST_F(LimitsTest, InfoSaysWhatWasKept) {
  ASSERT_EQ(slf("truncate good.slf --max-bytes " + std::to_string(read("good.slf").size() / 2) +
                " -o half.slf")
                .code,
            0);
  const std::string said = slf("info half.slf --quiet").out;
  EXPECT_NE(said.find("groups all, layers all, slices all; its end may be cut"), std::string::npos)
      << said;
  EXPECT_NE(said.find("bits per point of the whole"), std::string::npos) << said;
}

TEST_F(LimitsTest, InfoForetellsMemory) {
  const json whole = parsed(slf("info good.slf --json -j 1").out)["decode"];
  const std::uint64_t most = whole["memory_most"];
  EXPECT_LE(whole["memory"], most);
  // A page has its textures twice while it opens, beside 24 MiB of its own.
  const std::uint64_t graphics = whole["page"]["graphics"], memory = whole["memory"];
  EXPECT_GT(graphics, 0u);
  EXPECT_EQ(whole["page"]["memory"], (24u << 20) + memory + 2 * graphics);
  EXPECT_EQ(slf("decode good.slf -o a.ply -j 1 --max-memory " + std::to_string(most)).code, 0);
  EXPECT_EQ(slf("decode good.slf -o a.ply -j 1 --max-memory " + std::to_string(most / 2)).code, 5);
  EXPECT_EQ(slf("decode good.slf -o a.ply -j 1 --max-work " +
                std::to_string(whole["work"].get<std::uint64_t>()))
                .code,
            0);
}

// AddressSanitizer maps terabytes of addresses before the program begins: it limits what is
// resident.
#if defined(__SANITIZE_ADDRESS__)
#define SLF_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SLF_ADDRESS_SANITIZER 1
#endif
#endif
#ifdef SLF_ADDRESS_SANITIZER
const std::string kFourGigabytes = "ASAN_OPTIONS=$ASAN_OPTIONS:hard_rss_limit_mb=4000";
#else
const std::string kFourGigabytes = "ulimit -v 4000000;";
#endif

TEST_F(LimitsTest, PipesAndDevicesAreNotWaitedFor) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  for (const char* verb : {"info FILE", "decode FILE -o out.ply", "pack FILE -o out.slf"}) {
    expect_failure(slf(with(verb, "pipe"), "timeout 20"), 3, "pipe", "not a regular file");
    expect_failure(slf(with(verb, "/dev/zero"), "timeout 20"), 3, "/dev/zero", "regular");
  }
  // What the caller opened may be a pipe.
  EXPECT_EQ(shell("cat good.slf | '" SLF_PROGRAM "' info -").code, 0);
  EXPECT_EQ(shell("cat good.slf | '" SLF_PROGRAM "' info /dev/stdin").code, 0);
  EXPECT_EQ(slf("info - --max-memory 1M < /dev/zero", kFourGigabytes).code, 5);
}

TEST_F(TinyCaptureTest, APipeAsImageIsRefused) {
  const json cameras = parsed(read("tiny/cameras.json"));
  const std::string image = "tiny/" + cameras["splits"]["dense"][0].get<std::string>();
  std::filesystem::remove(path(image));
  ASSERT_EQ(mkfifo(path(image).c_str(), 0600), 0);
  expect_failure(slf("encode tiny -o out.slf --quiet", "timeout 20"), 4, image,
                 "not a regular file");
}

/// Bytes that a terminal takes as commands, a line end aside.
bool steers(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && byte != '\n') || byte == 0x7F) return true;
    if (byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0)
      return true;
    if (text.compare(i, 3, "\xE2\x80\xAE") == 0) return true;
  }
  return false;
}

TEST_F(LimitsTest, TextOfFilesNeverReachesATerminalUnescaped) {
  CodingParameters parameters = conformance::with_steps(1, 4);
  parameters.metadata = {{"\x1b]0;owned\x07", "\x1b[2J"},
                         {"c1 \xC2\x9B", "\xC2\x9B 31m, \x7F"},
                         {"turned \xE2\x80\xAE", "\xE2\x80\xAE txt.exe"},
                         {"plain \xC3\xA4", "\xE2\x82\xAC"}};
  const auto stream = *pack(conformance::field(conformance::sphere(3), 3, 1), parameters);
  write("steers.slf", {stream.begin(), stream.end()});
  const Ran shown = slf("info steers.slf"), as_json = slf("info steers.slf --json");
  EXPECT_EQ(shown.code, 0);
  EXPECT_FALSE(steers(shown.out)) << shown.out;
  EXPECT_FALSE(steers(as_json.out)) << as_json.out;
  EXPECT_NE(shown.out.find("plain \xC3\xA4"), std::string::npos);
  EXPECT_EQ(parsed(as_json.out)["metadata"][0]["value"], "\x1b[2J");
  EXPECT_EQ(parsed(as_json.out)["metadata"][3]["value"], "\xE2\x82\xAC");
  const Ran missing = slf("info 'no\x1b[2Jne\xC2\x9B.slf'");
  EXPECT_EQ(missing.code, 3);
  EXPECT_FALSE(steers(missing.err)) << missing.err;
}

TEST_F(LimitsTest, ADumpIsThereWholeOrNotAtAll) {
  ASSERT_EQ(slf("decode good.slf --dump dump").code, 0);
  const std::string positions = read("dump/positions.npy");
  ASSERT_EQ(slf("decode cut.slf --dump dump --quiet").code, 0);
  EXPECT_NE(read("dump/positions.npy"), positions);
  // A limit on the size of files stands for a full disk: old positions stay beside their own
  // components.
  ASSERT_EQ(slf("decode good.slf --dump dump").code, 0);
  const std::string components = read("dump/components.npy");
  const Ran full = slf("decode cut.slf --dump dump --quiet", "ulimit -f 1;");
  expect_failure(full, 7, "dump/", "cannot be written");
  EXPECT_EQ(full.err.find(".tmp"), std::string::npos) << full.err;
  EXPECT_EQ(read("dump/positions.npy"), positions);
  EXPECT_EQ(read("dump/components.npy"), components);
  EXPECT_TRUE(leftovers().empty());
  expect_failure(slf("decode good.slf --dump fresh", "ulimit -f 1;"), 7, "fresh", "");
  EXPECT_FALSE(exists("fresh"));
}

TEST_F(LimitsTest, ADirectoryThatCannotBeLookedAtIsAFailedWrite) {
  const std::string long_name(300, 'a');
  expect_failure(slf("decode good.slf --dump " + long_name), 7, long_name, "cannot be written");
  expect_failure(slf("decode good.slf -o good.slf/x.ply"), 7, "good.slf", "is not a directory");
}

TEST_F(LimitsTest, LinesOfTextFromFilesEnd) {
  CodingParameters parameters = conformance::with_steps(1, 4);
  parameters.metadata = {{"long", std::string(100000, 'x')}};
  const auto stream = *pack(conformance::field(conformance::sphere(3), 3, 1), parameters);
  write("long.slf", {stream.begin(), stream.end()});
  const std::string shown = slf("info long.slf").out;
  EXPECT_LT(shown.size(), 10000u);
  EXPECT_NE(shown.find("95,904 more bytes"), std::string::npos) << shown;
}

TEST_F(LimitsTest, ADumpLeavesWhatElseIsInADirectory) {
  std::filesystem::create_directory(path("mine"));
  write("mine/notes.txt", "mine");
  ASSERT_EQ(slf("decode good.slf --dump mine").code, 0);
  ASSERT_EQ(slf("decode cut.slf --dump mine/ --quiet").code, 0);
  EXPECT_EQ(read("mine/notes.txt"), "mine");
  EXPECT_EQ(parsed(read("mine/light_field.json"))["partial"], true);
  write("file", "mine");
  expect_failure(slf("decode good.slf --dump file"), 7, "file", "not a directory");
  EXPECT_EQ(read("file"), "mine");
}

TEST_F(LimitsTest, PointsBeyondAFloatAreNotWrittenAsInfinities) {
  LightField field = conformance::field(conformance::sphere(3), 3, 1);
  for (const double step : {1.0, 1e300}) {
    field.header.grid = {{1.7e308, 0, 0}, step, 3};
    const auto stream = *pack(field, conformance::with_steps(1, 4));
    write("far.slf", {stream.begin(), stream.end()});
    const Ran ran = slf("decode far.slf -o far.ply");
    EXPECT_EQ(ran.code, step == 1 ? 0 : 4) << ran.err;
    EXPECT_EQ(exists("far.ply"), step == 1);
    EXPECT_EQ(slf("decode far.slf --dump far").code, 0);
    std::filesystem::remove(path("far.ply"));
  }
}

TEST_F(LimitsTest, NormalsOfNoPointsCanBeDumped) {
  LightField field = conformance::field(conformance::sphere(3), 3, 1);
  field.normals.bits = 5;
  field.normals.octahedral.assign(field.num_points(), {3, 30});
  const auto whole = *pack(field, conformance::with_steps(1, 4));
  const auto end = (*split_units(whole)).units[1].offset;
  write("nothing.slf", {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(end)});
  const Ran ran = slf("decode nothing.slf --dump dump -o out.ply");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(exists("dump/octahedral.npy"));
}

}  // namespace
}  // namespace slf::cli_limits_test
