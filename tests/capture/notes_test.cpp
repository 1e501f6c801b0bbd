// SPDX-License-Identifier: Apache-2.0
// Notes are checked as web/viewer/notes.js does it, and every mistake is told by its place.
#include "slf/notes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace slf::notes_test {
namespace {

Result<std::string, InputError> checked(const std::string& json) {
  return checked_notes("notes.json", std::vector<std::uint8_t>(json.begin(), json.end()));
}

std::string error_of(const std::string& json) {
  const auto notes = checked(json);
  return notes ? "accepted" : notes.error().message;
}

/// A file with one annotation and one track of these members.
std::string with(const std::string& annotation, const std::string& track = R"("name":"T",
    "stops":[{"view":{}}])") {
  return R"({"version":1,"annotations":[{)" + annotation + R"(}],"tracks":[{)" + track + "}]}";
}

constexpr const char* kNote = R"("at":[1,2,3],"title":"Rim")";

std::string stop(const std::string& members) {
  return with(kNote, R"("name":"T","stops":[{)" + members + "}]");
}

TEST(Notes, SoundOnesAreKeptAsTheyAreWithoutTheSpaceBetweenValues) {
  const auto notes = checked(
      "\n{ \"version\": 1,\t\"annotations\": [\r\n  {\"at\": [0, -1.5, 2e3], \"title\": \" a \\\" "
      "b "
      "\\\\\", \"text\": \"x < y & z > 1\\nnew\"}],\n \"mine\": {\"a\": null} }\n");
  ASSERT_TRUE(notes) << notes.error().message;
  EXPECT_EQ(*notes, R"({"version":1,"annotations":[{"at":[0,-1.5,2e3],"title":" a \" b \\",)"
                    R"("text":"x < y & z > 1\nnew"}],"mine":{"a":null}})");
  EXPECT_EQ(*checked(*notes), *notes);
  EXPECT_TRUE(checked(R"({"version":1})"));
  EXPECT_TRUE(checked(stop(R"("view":{"azimuth":-360,"elevation":90,"fov":1,"zoom":50,
      "target":[0,0,0]},"seconds":0,"pause":600,"annotation":0)")));
}

TEST(Notes, MistakesAreToldByFileAndPlace) {
  const std::pair<std::string, const char*> cases[] = {
      {"[]", "notes.json: an object is expected, not an array"},
      {R"({"annotations":[]})", "notes.json: 'version' is missing"},
      {R"({"version":2})", "notes.json: version: 2 is not 1"},
      {R"({"version":1,"annotations":{}})", "notes.json: annotations: an array is expected"},
      {with(R"("title":"Rim")"), "notes.json: annotations[0]: 'at' is missing"},
      {with(R"("at":[1,2],"title":"Rim")"), "notes.json: annotations[0].at: 3 items are expected"},
      {with(R"("at":[1,2,"3"],"title":"Rim")"), "notes.json: annotations[0].at[2]: a number"},
      {with(R"("at":[1,2,3],"title":7)"), "notes.json: annotations[0].title: a string"},
      {with(std::string(kNote).append(R"(,"view":"front")")),
       "notes.json: annotations[0].view: an obj"},
      {with(std::string(kNote).append(R"(,"view":{"zoom":0})")),
       "notes.json: annotations[0].view.zoom: 0 is not in the range 0.05 to 50"},
      {with(kNote, R"("stops":[{"view":{}}])"), "notes.json: tracks[0]: 'name' is missing"},
      {with(kNote, R"("name":"T","stops":[])"), "notes.json: tracks[0].stops: empty"},
      {with(kNote, R"("name":"T","loop":1,"stops":[])"), "notes.json: tracks[0].loop: "},
      {stop(R"("seconds":1)"), "notes.json: tracks[0].stops[0]: 'view' is missing"},
      {stop(R"("view":{},"seconds":601)"), "notes.json: tracks[0].stops[0].seconds: 601"},
      {stop(R"("view":{},"annotation":1)"), "notes.json: tracks[0].stops[0].annotation: is no "},
      {stop(R"("view":{},"annotation":0.5)"), "notes.json: tracks[0].stops[0].annotation: is no "},
      {R"({"version":1,"version":1})", "notes.json: "},
      {R"({"version":1)", "notes.json: version: not valid JSON at byte 13"},
      {"", "notes.json: not valid JSON"},
      {R"({"version":1e999)",
       "notes.json: version: not valid JSON at byte 16: number overflow parsing"},
      {"{\"version\":1,\"a\":\"\xff\"}", "notes.json: a: not valid JSON at byte 19"}};
  for (const auto& [json, message] : cases)
    EXPECT_EQ(error_of(json).find(message), 0u) << json << "\n" << error_of(json);
}

TEST(Notes, MarkupIsRefusedAndSignsThatAreNoneAreNot) {
  for (const char* text :
       {"<b>bent</b>", "see <a href='x'>", "a</i>", "<!--", "<!doctype html>", "x <script"}) {
    const std::string json = with(R"("at":[1,2,3],"title":"T","text":")" + std::string(text) + '"');
    EXPECT_EQ(error_of(json).find("notes.json: annotations[0].text: has markup, '<"), 0u) << text;
  }
  EXPECT_EQ(error_of(with(R"("at":[1,2,3],"title":"\u003cimg src=x\u003e")")),
            "notes.json: annotations[0].title: has markup, '<img', and notes are plain text");
  for (const char* text : {"a < b", "a<3", "<", "<-", "5 > 4", "R&D;", "<\xc3\xa4>", "< b>"})
    EXPECT_EQ(error_of(with(R"("at":[1,2,3],"title":")" + std::string(text) + '"')), "accepted");
}

TEST(Notes, LengthsAndNumbersAreTheViewers) {
  const auto titled = [](const std::string& title) {
    return with(R"("at":[1,2,3],"title":")" + title + '"');
  };
  std::string wide;  // two UTF-16 units each
  for (int i = 0; i < 100; ++i) wide += "\xf0\x9f\x8f\xba";
  EXPECT_EQ(error_of(titled(wide)), "accepted");
  EXPECT_NE(error_of(titled(wide + "x")), "accepted");
  std::string notes;
  for (int i = 0; i < 200; ++i) notes += std::string(i ? ",{" : "{") + kNote + "}";
  EXPECT_EQ(error_of(R"({"version":1,"annotations":[)" + notes + "]}"), "accepted");
  EXPECT_EQ(error_of(R"({"version":1,"annotations":[)" + notes + ",{}]}"),
            "notes.json: annotations: more than 200 entries");
  EXPECT_EQ(error_of(std::string(kMostNoteBytes + 1, ' ')),
            "notes.json: more than 1048576 bytes of notes");
}

TEST(Notes, EveryTruncationIsRefused) {
  const std::string whole = stop(R"("view":{"target":[0,0,0]},"annotation":0)");
  ASSERT_EQ(error_of(whole), "accepted");
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(error_of(whole.substr(0, size)), "accepted") << size;
}

}  // namespace
}  // namespace slf::notes_test
