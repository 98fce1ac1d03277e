#include "gravure/formats/contours.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dice.hpp"

namespace gravure::formats {
namespace {

constexpr const char* kTwo = R"({"contours": [
  {"id": 1, "points": [[0, 0, 0], [1, 0.5, 0]], "direction": [0, 0, 1]},
  {"id": 7, "points": [[0, 0, 1], [1, 0, 1], [1, 1, 1]], "direction": [0, 0.6, 0.8]}
]})";

std::string error_of(std::string_view text) {
  const auto file = parse_contours(text, "c.json");
  return file ? "no error" : file.error().message;
}

/// One contour with these values.
std::string one(const std::string& id, const std::string& points, const std::string& direction) {
  return R"({"contours": [{"id": )" + id + R"(, "points": )" + points + R"(, "direction": )" + direction + "}]}";
}

TEST(Contours, ReadsJson) {
  const auto file = parse_contours(kTwo, "c.json");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file.value().contours.size(), 2U);
  EXPECT_TRUE(file.value().notes.empty());
  const Contour& second = file.value().contours[1];
  EXPECT_EQ(second.id, 7);
  ASSERT_EQ(second.points_mm.size(), 3U);
  EXPECT_EQ(second.points_mm[2], (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(second.direction, (std::array<double, 3>{0, 0.6, 0.8}));
}

TEST(Contours, ReadsCsv) {
  const auto file =
      parse_contours("id,x,y,z,u,v,w\n1,0,0,0,0,0,1\n1,1,0.5,0,0,0,1\n7,0,0,1,0,.6,.8\n7,1,0,1,0,.6,.8\n", "c.csv");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file.value().contours.size(), 2U);
  EXPECT_EQ(file.value().contours[0].points_mm[1], (std::array<double, 3>{1, 0.5, 0}));
  EXPECT_EQ(file.value().contours[1].id, 7);
  EXPECT_EQ(file.value().contours[1].direction, (std::array<double, 3>{0, 0.6, 0.8}));
}

TEST(Contours, MakesDirectionsOfLengthOneAndSaysSoWhereTheyWereFarFromIt) {
  const auto file = parse_contours(one("1", "[[0,0,0],[1,0,0]]", "[0, 3, 4]"), "c.json");
  ASSERT_TRUE(file);
  EXPECT_EQ(file.value().contours[0].direction, (std::array<double, 3>{0, 0.6, 0.8}));
  ASSERT_EQ(file.value().notes.size(), 1U);
  EXPECT_EQ(file.value().notes[0], "1 of 1 directions were not of length 1 (1 to 5) and were made so");
  const auto near = parse_contours(one("1", "[[0,0,0],[1,0,0]]", "[0, 0.6000001, 0.8]"), "c.json");
  ASSERT_TRUE(near);
  EXPECT_TRUE(near.value().notes.empty());
  const auto& unit = near.value().contours[0].direction;
  EXPECT_NEAR(std::hypot(unit[1], unit[2]), 1, 1e-15);
}

TEST(Contours, PassesOverKeysItDoesNotKnowAndSaysSo) {
  const auto file = parse_contours(
      R"({"units": {"length": ["mm", [1]]}, "contours": [{"id": 1, "name": "edge", "points": [[0,0,0],[1,0,0]],
          "direction": [0,0,1], "id2": {"points": 3}}]})",
      "c.json");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file.value().notes.size(), 3U);
  EXPECT_EQ(file.value().notes[0], "the key \"units\" is not known and is passed over");
}

TEST(Contours, RefusesWithThePlace) {
  const std::string points = "[[0,0,0],[1,0,0]]";
  EXPECT_EQ(error_of(one("1", "[[0,0,0]]", "[0,0,1]")),
            "c.json: contours[0] (id 1): has 1 point: must have two or more");
  EXPECT_EQ(error_of(one("1", "[[0,0,0],[0,0,0]]", "[0,0,1]")),
            "c.json: contours[0] (id 1): all its points are one: it has no length");
  EXPECT_EQ(error_of(one("1", points, "[0,0,0]")),
            "c.json: contours[0] (id 1): direction has length 0: it must point from the surface towards the head");
  EXPECT_EQ(error_of(one("1", points, "[0,1]")),
            "c.json: contours[0] (id 1): direction has 2 numbers: must have three");
  EXPECT_EQ(error_of(one("1", "[[0,0,0],[1,0,0,0]]", "[0,0,1]")),
            "c.json: contours[0] (id 1): points[1] has 4 numbers: must have three");
  EXPECT_EQ(error_of(one("1", "[[0,0,0],[1,null,0]]", "[0,0,1]")),
            "c.json: contours[0] (id 1): points[1] holds null: must be three numbers (JSON has no NaN)");
  EXPECT_EQ(error_of(one("1", "[[0,0,0],[2e6,0,0]]", "[0,0,1]")),
            "c.json: contours[0] (id 1): points[1]: x = 2000000: must be from -1000000 to 1000000 mm");
  EXPECT_EQ(error_of(one("1.5", points, "[0,0,1]")),
            "c.json: contours[0]: id = 1.5: must be an integer from -(2^53 - 1) to 2^53 - 1");
  EXPECT_NE(error_of(one("9007199254740993", points, "[0,0,1]")).find("must be an integer from -(2^53 - 1)"),
            std::string::npos);  // as a double it is 2^53
  EXPECT_EQ(error_of(one("\"a\"", points, "[0,0,1]")), "c.json: contours[0]: \"id\" is a string: must be an integer");
  EXPECT_EQ(error_of(R"({"contours": [{"id": 1, "points": [[0,0,0],[1,0,0]]}]})"),
            "c.json: contours[0] (id 1): the key \"direction\" is missing");
  EXPECT_EQ(error_of(R"({"contours": [{"id": 1, "id": 1, "points": []}]})"),
            "c.json: contours[0] (id 1): the key \"id\" is there twice");
  EXPECT_EQ(error_of("{}"), "c.json: the key \"contours\" is missing");
  EXPECT_EQ(error_of("{\"contours\": []}"), "c.json: no contour in it");
  EXPECT_EQ(error_of("[1]"), "c.json: is a list: must be an object, {\"contours\": [...]}");
  EXPECT_EQ(error_of("{\"contours\": 3}"), "c.json: \"contours\" is a number: must be a list of contours");
  EXPECT_EQ(error_of("{\"contours\":\n [{\"id\": NaN"), "c.json:2:10: this is no JSON");
  EXPECT_EQ(error_of(one("1", "[[0,0,0],[1e999,0,0]]", "[0,0,1]")).substr(0, 9), "c.json:1:");
}

TEST(Contours, RefusesAnIdThatComesTwice) {
  const std::string message = error_of(R"({"contours": [{"id": 4, "points": [[0,0,0],[1,0,0]], "direction": [0,0,1]},
                                {"id": 4, "points": [[0,0,0],[1,0,0]], "direction": [0,0,1]}]})");
  EXPECT_EQ(message, "c.json: contours[1] (id 4): its id has been there before: give each contour another one");
  EXPECT_EQ(error_of("1,0,0,0,0,0,1\n1,1,0,0,0,0,1\n2,0,0,0,0,0,1\n2,1,0,0,0,0,1\n1,0,0,0,0,0,1\n1,1,0,0,0,0,1\n"),
            "c.json: contours[2] (id 1): its id has been there before: give each contour another one");
}

TEST(Contours, RefusesBadRows) {
  EXPECT_EQ(error_of("id,x,y,z,u,v,w\n1,0,0,nan,0,0,1\n").substr(0, 34), "c.json: contours: line 2: \"1,0,0,n");
  EXPECT_EQ(error_of("1,0,0,0,0,0,1\n1,1,0,0,0,0.1,1\n"),
            "c.json: contours[0] (id 1): points[1]: direction 0, 0.1, 1 differs from that of its first row: all points "
            "of a contour share one direction");
  EXPECT_EQ(error_of(""), "c.json: no contour in it");
}

TEST(Contours, ComeBackBitForBit) {
  SCOPED_TRACE(test::Dice::note());
  test::Dice dice(11);
  const auto number = [&dice] {
    return static_cast<double>(dice.between(-1'000'000'000, 1'000'000'000)) / 9'999'991.0;
  };
  std::vector<Contour> contours(50);
  for (std::size_t i = 0; i < contours.size(); ++i) {
    contours[i].id = static_cast<std::int64_t>(i) - 20;
    contours[i].points_mm.resize(static_cast<std::size_t>(dice.between(2, 9)));
    for (auto& point : contours[i].points_mm) {
      point = {number(), number(), number()};
    }
    const double x = number();
    const double y = number();
    const double length = std::sqrt(x * x + y * y + 1);
    contours[i].direction = {x / length, y / length, 1 / length};
  }
  for (const std::string& text : {contours_to_json(contours), contours_to_csv(contours)}) {
    const auto file = parse_contours(text, "c");
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file.value().contours.size(), contours.size());
    for (std::size_t i = 0; i < contours.size(); ++i) {
      EXPECT_EQ(file.value().contours[i].id, contours[i].id);
      EXPECT_EQ(file.value().contours[i].points_mm, contours[i].points_mm);
      EXPECT_EQ(file.value().contours[i].direction, contours[i].direction);
    }
  }
}

}  // namespace
}  // namespace gravure::formats
