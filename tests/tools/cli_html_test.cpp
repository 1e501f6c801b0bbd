// SPDX-License-Identifier: Apache-2.0
// slf html, with the viewer's page in the program and without.
#include "cli_support.h"

namespace slf::cli_html_test {
namespace {

constexpr const char* kWithoutPage =
    "this program was built without web/dist/one_file.html: web/build.sh makes it, or says what it "
    "lacks; then build slf again (tools/test.sh does both)";

class CliHtmlTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    ASSERT_EQ(slf("synth die -o die --size 32x32").code, 0);
    ASSERT_EQ(slf("encode die -o x.slf --effort 1 --grid-bits 5 --quiet").code, 0);
    first_ = slf("html x.slf -o x.html --json --title '</title><b>&'");
  }
  bool has_page() const { return first_.code != 6; }
  Ran first_;
};

TEST_F(CliHtmlTest, AProgramWithoutThePageNamesWhatToBuildAndWritesNothing) {
  if (has_page()) GTEST_SKIP() << "this program has the page";
  EXPECT_NE(first_.err.find("web/dist/one_file.html"), std::string::npos) << first_.err;
  EXPECT_NE(first_.err.find("npm run build"), std::string::npos) << first_.err;
  EXPECT_FALSE(exists("x.html"));
}

TEST_F(CliHtmlTest, ThePageHoldsTheFilePosterAndTitleAndAsksNobody) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  ASSERT_EQ(first_.code, 0) << first_.err;
  const std::string page = read("x.html"), file = shell("base64 -w0 x.slf").out;
  EXPECT_NE(page.find(">" + file + "</script>"), std::string::npos);
  EXPECT_NE(page.find("<title>&lt;/title&gt;&lt;b&gt;&amp;</title>"), std::string::npos);
  EXPECT_NE(page.find("\\u003c/title>"), std::string::npos);
  EXPECT_NE(page.find("src=\"data:image/jpeg;base64,"), std::string::npos);
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(page.find("{{slf:"), std::string::npos);
  const auto report = nlohmann::json::parse(first_.out);
  EXPECT_EQ(report["bytes"], page.size());
  EXPECT_EQ(report["file"], file.size());
}

TEST_F(CliHtmlTest, WithoutAPosterThePageIsSmaller) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  ASSERT_EQ(slf("html x.slf -o bare.html --no-poster --quiet").code, 0);
  EXPECT_LT(read("bare.html").size(), read("x.html").size());
  EXPECT_EQ(read("bare.html").find("data:image/jpeg"), std::string::npos);
}

TEST_F(CliHtmlTest, ABackgroundThatNobodyChoseIsThatOfTheHour) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  const std::string night =
      "<source media=\"(prefers-color-scheme: dark)\" srcset=\"data:image/jpeg";
  EXPECT_NE(read("x.html").find(night), std::string::npos);
  EXPECT_EQ(read("x.html").find("\"background\":"), std::string::npos);
  ASSERT_EQ(slf("html x.slf -o grey.html --background 808080 --quiet").code, 0);
  EXPECT_EQ(read("grey.html").find(night), std::string::npos);
  EXPECT_NE(read("grey.html").find("\"background\":\"808080\""), std::string::npos);
}

TEST_F(CliHtmlTest, TheFirstViewIsTheCameraThatWasNamed) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  ASSERT_EQ(slf("html x.slf -o camera.html --camera die/cameras.json:1 --quiet").code, 0);
  EXPECT_NE(read("camera.html").find("\"rotation\":["), std::string::npos);
  EXPECT_EQ(read("x.html").find("\"rotation\":["), std::string::npos);
}

TEST_F(CliHtmlTest, WrongOptionsAndDamagedFilesAreRefusedAndLeaveNothing) {
  write("bad.slf", read("x.slf").substr(0, 100));
  const std::pair<const char*, int> cases[] = {
      {"html x.slf -o y.html --background red", 2},
      {"html x.slf -o y.html --poster a.png --no-poster", 2},
      {"html x.slf -o y.html --camera die/cameras.json --azimuth 4", 2},
      {"html x.slf -o y.html --fov 0", 2},
      {"html bad.slf -o y.html", has_page() ? 4 : 6},
      {"html none.slf -o y.html", has_page() ? 3 : 6},
      {"html x.slf -o y.html --poster none.png", has_page() ? 3 : 6}};
  for (const auto& [arguments, code] : cases) {
    EXPECT_EQ(slf(arguments).code, code) << arguments;
    EXPECT_FALSE(exists("y.html")) << arguments;
  }
}

TEST_F(CliHtmlTest, AFileThatNoPageHoldsIsRefusedBeforeItIsRead) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  ASSERT_EQ(shell("truncate -s 268435457 big.slf").code, 0);  // sparse
  expect_failure(slf("html big.slf -o y.html"), 5, "big.slf",
                 "its 268,435,457 bytes are more than the 268,435,456 that one page holds");
  expect_failure(slf("html - -o y.html <big.slf"), 5, "standard input", "268435456 bytes");
  EXPECT_FALSE(exists("y.html"));
}

TEST_F(CliHtmlTest, APosterThatIsTooLargeIsRefusedByItsHeader) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  write("wide.ppm", "P6\n4097 1\n255\n" + std::string(3 * 4097, 'x'));
  expect_failure(slf("html x.slf -o y.html --poster wide.ppm"), 5, "wide.ppm",
                 "4,097 x 1 pixels, more than the 4,096 a side that a poster may have");
  write("most.ppm", "P6\n4096 1\n255\n" + std::string(3 * 4096, 'x'));
  EXPECT_EQ(slf("html x.slf -o most.html --poster most.ppm").code, 0);
  ASSERT_EQ(shell("truncate -s 8388609 long.png").code, 0);
  expect_failure(slf("html x.slf -o y.html --poster long.png"), 5, "long.png",
                 "larger than the 8,388,608 bytes that a poster may have");
  EXPECT_FALSE(exists("y.html"));
}

TEST_F(CliHtmlTest, ATitleFromTheFileIsCutToALine) {
  if (!has_page()) GTEST_SKIP() << kWithoutPage;
  std::string title;
  while (title.size() < 3000) title += "\u00e9";
  ASSERT_EQ(
      slf("encode die -o t.slf --effort 1 --grid-bits 5 --quiet --metadata 'title=" + title + "'")
          .code,
      0);
  ASSERT_EQ(slf("html t.slf -o t.html --no-poster --quiet").code, 0);
  EXPECT_NE(read("t.html").find("<title>" + title.substr(0, 256) + "\u2026</title>"),
            std::string::npos);
}

}  // namespace
}  // namespace slf::cli_html_test
