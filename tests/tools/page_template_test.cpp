// SPDX-License-Identifier: Apache-2.0
// The page that `slf html` fills in.
#include "tools/page_template.h"

#include <gtest/gtest.h>

namespace slf::tools::page_template_test {
namespace {

TEST(PageTemplate, EveryNameIsReplacedAndWhatIsPutInIsNotLookedAtAgain) {
  EXPECT_EQ(filled_template("<a>{{slf:x}}</a>{{slf:y}}{{slf:x}}", {{"x", "{{slf:y}}"}, {"y", "2"}}),
            "<a>{{slf:y}}</a>2{{slf:y}}");
}

TEST(PageTemplate, UnknownNamesVanishAndOtherBracesStay) {
  EXPECT_EQ(filled_template("{{other}} {{slf:none}}{ {{slf:", {{"x", "1"}}), "{{other}} { {{slf:");
}

TEST(PageTemplate, TextCannotLeaveItsTagOrQuotes) {
  EXPECT_EQ(escaped_html("</title><script>\"'&"), "&lt;/title&gt;&lt;script&gt;&quot;&#39;&amp;");
}

// Test vectors of RFC 4648, section 10.
TEST(Rfc4648_10, Base64) {
  const std::pair<const char*, const char*> cases[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : cases)
    EXPECT_EQ(base64(plain, std::string_view(plain).size()), coded);
  const unsigned char high[] = {0xfb, 0xff, 0xbf};
  EXPECT_EQ(base64(high, 3), "+/+/");
}

}  // namespace
}  // namespace slf::tools::page_template_test
