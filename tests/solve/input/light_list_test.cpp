// SPDX-License-Identifier: Apache-2.0
#include "solve/input/light_list.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "solve/input/light_json.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// Three directions of unit length to the last digit.
constexpr const char* kRows = "a.tif 0 0 1\nb.tif 0.6 0 0.8\nc.tif 0 -0.6 0.8\n";

Result<LightList> parsed(std::string_view bytes, const char* name = "l.lp") {
  return parse_light_list(bytes, fs::path("/nowhere") / name);
}

/// "a.tif 0 0 1; b.tif 0.6 0 0.8": names and directions with three digits.
std::string said(const Result<LightList>& list) {
  if (!list) return list.error().message();
  std::string words;
  for (const ListedLight& light : list->lights) {
    const Vec3 d = light.direction();
    words += fmt::format("{}{} {:.3g} {:.3g} {:.3g}", words.empty() ? "" : "; ", light.name, d.x, d.y, d.z);
  }
  return words;
}
constexpr const char* kSaid = "a.tif 0 0 1; b.tif 0.6 0 0.8; c.tif 0 -0.6 0.8";

std::string utf16(std::string_view text, bool low_first, bool has_mark) {
  std::string bytes;
  const auto put = [&](unsigned unit) {
    const char low = static_cast<char>(unit & 0xFFU), high = static_cast<char>(unit >> 8U);
    bytes += low_first ? low : high;
    bytes += low_first ? high : low;
  };
  if (has_mark) put(0xFEFF);
  for (const char c : text) put(static_cast<unsigned char>(c));
  return bytes;
}

std::string with(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string npy(const std::string& heading, const std::vector<double>& numbers) {
  std::string bytes = std::string("\x93NUMPY\x01", 7) + '\0';
  bytes += static_cast<char>(heading.size());
  bytes += '\0';
  bytes += heading;
  for (const double number : numbers) {
    std::array<char, 8> raw = {};
    std::memcpy(raw.data(), &number, raw.size());
    bytes.append(raw.data(), raw.size());
  }
  return bytes;
}

TEST(LightList, ReadsALightFileAsPeopleWriteIt) {
  const std::string plain = "3\n" + std::string(kRows);
  struct Case {
    const char* what;
    std::string bytes;
    std::vector<std::string> assumed;
  };
  for (const Case& each : std::vector<Case>{
           {"as it should be", plain, {}},
           {"Windows", with(plain, "\n", "\r\n"), {}},
           {"old Macintosh", with(plain, "\n", "\r"), {}},
           {"no end of the last line", plain.substr(0, plain.size() - 1), {}},
           {"comments and blank lines",
            "\n# made by hand\n\n// twice\n; and\n3\n\n" + with(kRows, "b.tif", "\n%x\n\nb.tif"),
            {}},
           {"tabs", with(plain, " ", "\t"), {}},
           {"many blanks", with(plain, " ", "   "), {}},
           {"quotes", with(plain, "a.tif", "\"a.tif\""), {}},
           {"a byte order mark", "\xEF\xBB\xBF" + plain, {"a byte order mark was passed over"}},
           {"UTF-16, low byte first", utf16(plain, true, true), {"it is UTF-16 with a byte order mark"}},
           {"UTF-16, high byte first", utf16(plain, false, true), {"it is UTF-16 with a byte order mark"}},
           {"UTF-16 without a mark", utf16(plain, true, false), {"it is UTF-16 without a byte order mark"}},
           {"commas between", "3\n" + with(kRows, " ", ", "), {}},
           {"commas without blanks", "3\n" + with(kRows, " ", ","), {}},
           {"no count", kRows, {"the first line has no count: 3 lights are listed"}},
           {"another count", "4\n" + std::string(kRows), {"it announces 4 photographs and lists 3"}},
           {"decimal commas",
            "3\na.tif 0,0 0,0 1,0\nb.tif 0,6 0,0 0,8\nc.tif 0,0 -0,6 0,8\n",
            {"decimal commas"}},
           {"semicolons and decimal commas",
            "a.tif;0;0;1\nb.tif;0,6;0;0,8\nc.tif;0;-0,6;0,8\n",
            {"decimal commas", "the first line has no count: 3 lights are listed"}},
           {"a heading",
            "file,x,y,z\n" + with(kRows, " ", ","),
            {"the first line has no count: 3 lights are listed"}},
       }) {
    const Result<LightList> list = parsed(each.bytes);
    EXPECT_EQ(said(list), kSaid) << each.what;
    if (!list) continue;
    EXPECT_EQ(list->assumed, each.assumed) << each.what;
    EXPECT_FALSE(list->are_positions) << each.what;
  }
}

TEST(LightList, TakesVectorsOfOtherLengthsAsPositions) {
  const Result<LightList> list = parsed("2\na.tif 2,23 0,27 2,68\nb.tif -1,50 0,00 2,00\n");
  ASSERT_TRUE(list) << list.error().message();
  EXPECT_TRUE(list->are_positions);
  EXPECT_EQ(list->lights[0].toward.x, 2.23);
  EXPECT_NEAR(list->lights[1].direction().z, 0.8, 1e-12);
  EXPECT_THAT(list->assumed,
              ElementsAre("decimal commas", HasSubstr("2.5 to 3.5 long are taken as positions")));
}

TEST(LightList, KeepsNamesOfOtherMachinesAndBlanksInThem) {
  EXPECT_EQ(said(parsed("2\nC:\\Users\\anna\\RTI\\jpeg exports\\a 1.jpg 0 0 1\n..\\x\\b 2.jpg 0.6 0 0.8\n")),
            "C:\\Users\\anna\\RTI\\jpeg exports\\a 1.jpg 0 0 1; ..\\x\\b 2.jpg 0.6 0 0.8");
  EXPECT_EQ(said(parsed("2\n\"my photo 1.jpg\" 0 0 1\nm 2.jpg 0.6 0 0.8\n")),
            "my photo 1.jpg 0 0 1; m 2.jpg 0.6 0 0.8");
}

TEST(LightList, TakesAFourthNumberAsStrengthOrAsACount) {
  const Result<LightList> strong = parsed("2\na.tif 0 0 1 2\nb.tif 0.6 0 0.8 0.5\n");
  ASSERT_TRUE(strong) << strong.error().message();
  EXPECT_EQ(strong->lights[1].strength_rgb, (std::array<double, 3>{0.5, 0.5, 0.5}));
  EXPECT_THAT(strong->assumed,
              ElementsAre("four numbers a line: the fourth is taken as the light's strength"));
  const Result<LightList> counted = parsed("2\na.tif 0 0 1 1\nb.tif 0.6 0 0.8 2\n");
  ASSERT_TRUE(counted) << counted.error().message();
  EXPECT_FALSE(counted->have_strengths);
  EXPECT_THAT(counted->assumed, ElementsAre(HasSubstr("counts lines")));
  const Result<LightList> rgb = parsed("1\na.tif 0 0 1 2 3 4\n");
  ASSERT_TRUE(rgb) << rgb.error().message();
  EXPECT_EQ(rgb->lights[0].strength_rgb, (std::array<double, 3>{2, 3, 4}));
}

TEST(LightList, ReadsTablesWithAHeading) {
  const Result<LightList> angles =
      parsed("name;azimuth;elevation;note\na;0;90;top\nb;90;30,5;low\n", "lights.csv");
  ASSERT_TRUE(angles) << angles.error().message();
  EXPECT_NEAR(angles->lights[1].toward.y, std::cos(30.5 * kPi / 180), 1e-12);
  EXPECT_NEAR(angles->lights[1].toward.z, std::sin(30.5 * kPi / 180), 1e-12);
  EXPECT_THAT(angles->assumed,
              ElementsAre("columns passed over: note", "decimal commas", HasSubstr("both in degrees")));
  EXPECT_THAT(said(parsed("name,azimuth,elevation\na,0,1.5\nb,1.57,0.5\n", "l.csv")),
              HasSubstr("look like radians"));
  EXPECT_THAT(said(parsed("name,azimuth_rad,elevation\na,0,90\n", "l.csv")), HasSubstr("radians"));
  const Result<LightList> strong = parsed("x,y,z,intensity\n0,0,1,2.5\n0.6,0,0.8,3\n", "lights.csv");
  ASSERT_TRUE(strong) << strong.error().message();
  EXPECT_EQ(strong->lights[1].strength_rgb[2], 3);
}

TEST(LightList, ReadsListsOfDirectionsUprightAndLyingDown) {
  const char* lying = "0 0.6 0 0\n0 0 -0.6 0.6\n1 0.8 0.8 0.8\n";
  EXPECT_EQ(said(parsed("4\n0 0 1\n0.6 0 0.8\n0 -0.6 0.8\n0 0.6 0.8\n", "lights.txt")),
            said(parsed(lying, "light_directions.txt")));
  EXPECT_THAT(parsed(lying, "light_directions.txt").value().assumed,
              ElementsAre(HasSubstr("a light is a column")));
  EXPECT_EQ(said(parsed("0,0,1\n0.6,0,0.8\n", "light_directions.txt")), " 0 0 1;  0.6 0 0.8");
}

TEST(LightList, ReadsArraysOfNumPyAndNamesThoseItDoesNot) {
  const std::string head = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
  const std::vector<double> numbers = {0, 0, 1, 0.6, 0, 0.8};
  EXPECT_EQ(said(parsed(npy(head, numbers), "l.npy")), " 0 0 1;  0.6 0 0.8");
  EXPECT_EQ(said(parsed(npy(with(head, "False", "True"), {0, 0.6, 0, 0, 1, 0.8}), "l.npy")),
            " 0 0 1;  0.6 0 0.8");
  struct Case {
    std::string heading;
    const char* why;
  };
  for (const Case& each : std::vector<Case>{{with(head, "<f8", ">f8"), "'>f8'"},
                                            {with(head, "<f8", "<i8"), "'<i8'"},
                                            {with(head, "(2, 3)", "(6,)"), "two dimensions"},
                                            {with(head, "(2, 3)", "(3, 3)"), "72 bytes, and 48 follow"}})
    EXPECT_THAT(said(parsed(npy(each.heading, numbers), "l.npy")), HasSubstr(each.why));
  EXPECT_THAT(said(parsed(npy(head, {0, 0, 1, NAN, 0, 0.8}), "l.npy")), HasSubstr("row 2"));
}

TEST(LightList, ReadsRelightLab) {
  const char* dome =
      R"({"label": "d", "domeDiameter": 500.0, "lightConfiguration": "directional",
          "directions": [{"x": 0, "y": 0, "z": 1}, {"x": 0.6, "y": 0, "z": 0.8}], "positionsSphere": [],
          "positions3d": [], "ledAdjust": [{"r": 1, "g": 2, "b": 4}, {"r": 1, "g": 1, "b": 1}]})";
  const Result<LightList> list = parsed(dome, "d.dome");
  ASSERT_TRUE(list) << list.error().message();
  EXPECT_EQ(said(list), " 0 0 1;  0.6 0 0.8");
  EXPECT_EQ(list->lights[0].strength_rgb, (std::array<double, 3>{1, 0.5, 0.25}))
      << "photographs are multiplied by it";
  const char* project =
      R"({"application": "RelightLab", "folder": "../img", "width": 9, "height": 9,
          "images": [{"filename": "a.jpg", "skip": false}, {"filename": "b.jpg", "skip": true},
                     {"filename": "c.jpg", "skip": false}],
          "dome": {"lightConfiguration": "lights3d", "directions": [{"x": 0, "y": 0, "z": 1}],
                   "positions3d": [{"x": 0, "y": 0, "z": 250}, {"x": 9, "y": 9, "z": 9},
                                   {"x": 150, "y": 0, "z": 200}]}})";
  const Result<LightList> near = parsed(project, "p.relight");
  ASSERT_TRUE(near) << near.error().message();
  EXPECT_EQ(said(near), "../img/a.jpg 0 0 1; ../img/c.jpg 0.6 0 0.8");
  EXPECT_TRUE(near->are_positions);
  EXPECT_THAT(near->assumed,
              ElementsAre(HasSubstr("1 photographs that the project skips"), HasSubstr("positions")));
  EXPECT_THAT(said(parsed(with(project, "{\"x\": 9, \"y\": 9, \"z\": 9},", ""), "p.relight")),
              HasSubstr("a.jpg"))
      << "lights of those alone that are not skipped";
  EXPECT_THAT(said(parsed(R"({"dome": {"directions": []}})", "p.relight")), HasSubstr("there is no light"));
  EXPECT_THAT(said(parsed(R"({"directions": [{"x": 0, "y": 0, "z": 0}]})", "p.dome")),
              HasSubstr("no length"));
  EXPECT_THAT(said(parsed(R"({"directions": [{"x": 0, "y": 0}]})", "p.dome")), HasSubstr("directions[0]"));
}

TEST(LightList, ReadsMeshroomAndTurnsItsAxes) {
  const char* views =
      R"({"lights": [{"viewId": "12", "type": "directional", "direction": ["0.6", "0", "-0.8"],
                                      "intensity": ["2", "2", "2"]},
                                     {"viewId": "13", "direction": ["0", "0.6", "-0.8"], "intensity": ["1", "1", "1"]}]})";
  const Result<LightList> list = parsed(views, "lights.json");
  ASSERT_TRUE(list) << list.error().message();
  EXPECT_EQ(said(list), " 0.6 -0 0.8;  0 -0.6 0.8");
  EXPECT_EQ(list->lights[0].strength_rgb[1], 2);
  EXPECT_THAT(list->assumed, ElementsAre(HasSubstr("turned round")));
  EXPECT_THAT(said(parsed(R"({"lights": {"img_1": {"direction": [0, 0, -1], "intensity": 1}}})", "l.json")),
              HasSubstr("img_1 0 -0 1"));
  EXPECT_THAT(said(parsed(R"({"lights": [{"direction": [1,2,3,4,5,6,7,8,9]}]})", "l.json")),
              HasSubstr("harmonics"));
}

TEST(LightList, NamesTheViewsOfMeshroomByItsSfm) {
  LightList list = {.lights = {{.view = "13"}, {.view = "12"}}};
  const auto named = [&](const char* sfm) {
    const Result<bool> has_all = name_views(sfm, "a.sfm", list);
    return has_all ? std::string(*has_all ? "all" : "lacks one") : has_all.error().message();
  };
  EXPECT_EQ(named(R"({"views": [{"viewId": "12", "path": "/x/a.png"}]})"), "lacks one");
  EXPECT_EQ(list.lights[1].name, "") << "nothing is given where one lacks";
  EXPECT_THAT(named(R"({"cameras": []})"), HasSubstr("no list of views"));
  EXPECT_THAT(named(R"({"views": [)"), HasSubstr("a.sfm"));
  EXPECT_EQ(named(R"({"views": [{"viewId": 12, "path": "/x/a.png"}, {"viewId": "13", "path": "/x/b.png"}]})"),
            "all");
  EXPECT_EQ(list.lights[0].name + " " + list.lights[1].name, "/x/b.png /x/a.png");
}

TEST(LightList, RefusesByName) {
  struct Case {
    std::string bytes;
    const char* why;
  };
  for (const Case& each : std::vector<Case>{
           {"", "nothing in it"},
           {"3\n", "not three numbers"},
           {"hello\n", "is not \"file x y z\""},
           {"-1\na.tif 0 0 1\n", "first line is not the number of photographs: \"-1\""},
           {"3 lights\na.tif 0 0 1\n", "first line is not the number of photographs: \"3 lights\""},
           {"2\na.tif 0 0 1\nb.tif 0 1\n", "line 3: \"b.tif 0 1\" is not"},
           {"2\na.tif 0 0 1\nb.tif 0 1 nan\n", "line 3 has not three numbers: \"nan\""},
           {"2\na.tif 0 0 1\nb.tif 0 1 2,68\n", "\"2,68\" has a decimal comma"},
           {"2\na.tif 0 0 1\nb.tif 0 1 1e400\n", "beyond"},
           {"2\na.tif 0 0 1\nb.tif 0 0 0\n", "light 2: a direction has no length"},
           {"2\na.tif 0 0 1\nb.tif 0 0 1 5\n", "line 3 is not three numbers, as those before: it has 4"},
           {",,\n,,\n", "no line of numbers"},
           {"2\na.tif 0 0 1\nb.tif 0 0 1e300\n", "light 2 is 1e+300 long"},
           {"2\na.tif 0 0 1\nb.tif 0 0 1e-300\n", "light 2: a direction has no length"},
           {"1\na.tif 0 0 1 0\nb.tif 0 1 0 -2\n", "intensity of 0"},
           {"1\na.tif 0 0 1 2 3\n", "5 numbers"},
           {"a.tif,0,5,0,2,0,8\nb.tif,0,1,0,2,0,9\n", "decimal commas or six whole ones"},
           {"MATLAB 5.0 MAT-file", "-ascii"},
           {std::string("PNG\x1A\0\1\2", 7), "no text"},
           {"{\"a\": 1}", "neither directions nor lights"},
           {"{\"a\": ", "not valid JSON"},
           {"[[0, 0, 1]]", "neither directions nor lights"},
       }) {
    const Result<LightList> list = parsed(each.bytes);
    ASSERT_FALSE(list) << each.bytes;
    EXPECT_EQ(list.error().kind, ErrorKind::kBadData) << each.bytes;
    EXPECT_THAT(list.error().message(), HasSubstr(each.why));
    EXPECT_THAT(list.error().message(), HasSubstr("l.lp"));
  }
}

/// A folder with photographs that nobody looks into.
class LightFolder : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text = "x") const {
    fs::create_directories((folder_.path() / name).parent_path());
    ASSERT_TRUE(write_file(folder_.path() / name, text));
  }
  Result<LightList> found(const std::string& file, const std::string& photographs = "",
                          bool skips = false) const {
    return find_lights(file.empty() ? fs::path() : folder_.path() / file,
                       {photographs.empty() ? fs::path() : folder_.path() / photographs, skips});
  }
  /// The photographs below the folder, in the order of their lights, or the error.
  std::string photographs(const Result<LightList>& list) const {
    if (!list) return list.error().message();
    std::string words;
    for (const ListedLight& light : list->lights)
      words += (words.empty() ? "" : " ") +
               fs::absolute(light.photograph).lexically_normal().lexically_relative(folder_.path()).string();
    return words;
  }

  const TemporaryFolder folder_;
};

TEST_F(LightFolder, FindsPhotographsWhereverTheirNamesSayTheyWere) {
  for (const char* name : {"a.jpg", "b.jpg"}) put("rti/jpeg-exports/" + std::string(name));
  struct Case {
    const char *names, *assumed;
  };
  for (const Case& each :
       std::vector<Case>{{"..\\jpeg-exports\\{}.jpg", "photographs are in rti"},
                         {"../jpeg-exports/{}.jpg", ""},
                         {"C:\\Users\\anna\\RTI\\jpeg-exports\\{}.jpg", "names are of another folder"},
                         {"/mnt/anna/rti/jpeg-exports/{}.jpg", "names are of another folder"},
                         {"/mnt/anna/other/{}.jpg",
                          "names are of another folder: the photographs of these names in jpeg-exports"},
                         {"{}.jpg", "photographs are in jpeg-exports"},
                         {"{}.JPG", "2 names have other capitals"},
                         {"{}.tif", "2 names have another ending: b.jpg for b.tif"},
                         {"\"{}.jpg\"", "photographs are in jpeg-exports"}}) {
    put("rti/assembly-files/x.lp",
        fmt::format("2\n{} 0 0 1\n{} 0.6 0 0.8\n", with(each.names, "{}", "b"), with(each.names, "{}", "a")));
    const Result<LightList> list = found("rti/assembly-files/x.lp");
    EXPECT_EQ(photographs(list), "rti/jpeg-exports/b.jpg rti/jpeg-exports/a.jpg") << each.names;
    EXPECT_THAT(list ? words_of(*list) : "", HasSubstr(each.assumed)) << each.names;
    EXPECT_EQ(photographs(found("", "rti/jpeg-exports")), "rti/jpeg-exports/b.jpg rti/jpeg-exports/a.jpg")
        << each.names;
    EXPECT_EQ(photographs(found("", "rti")), "rti/jpeg-exports/b.jpg rti/jpeg-exports/a.jpg") << each.names;
  }
}

TEST_F(LightFolder, TellsPhotographsOfOneNameByTheirFolders) {
  for (const char* name : {"1/img.png", "2/img.png"}) put("p/" + std::string(name));
  put("p/l.lp", "2\n/mnt/x/2/img.png 0 0 1\n/mnt/x/1/img.png 0.6 0 0.8\n");
  EXPECT_EQ(photographs(found("p/l.lp")), "p/2/img.png p/1/img.png");
}

TEST_F(LightFolder, RefusesWhatIsMissingOrMayBeTwo) {
  put("p/a.png");
  put("p/c.png");
  put("p/l.lp", "3\na.png 0 0 1\nb.png 0.6 0 0.8\nc.png 0 0.6 0.8\n");
  const Result<LightList> missing = found("p/l.lp");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(missing.error().message(),
              HasSubstr("1 of 3 are not there: b.png; looked for in " + (folder_.path() / "p").string()));
  EXPECT_THAT(missing.error().remedy, HasSubstr("--skip-missing"));
  const Result<LightList> skipped = found("p/l.lp", "", true);
  EXPECT_EQ(photographs(skipped), "p/a.png p/c.png");
  EXPECT_THAT(skipped.value().assumed,
              ElementsAre(HasSubstr("1 lights without a photograph are left out: b.png")));
  put("p/l.lp", "2\na.png 0 0 1\na.png 0.6 0 0.8\n");
  EXPECT_THAT(photographs(found("p/l.lp")), HasSubstr("a.png is named by lights 1 and 2"));
  put("q/l.lp", "1\nx.png 0 0 1\n");
  put("q/small/x.png");
  put("q/full/x.png");
  EXPECT_THAT(photographs(found("q/l.lp")), HasSubstr("have them all"));
  EXPECT_EQ(photographs(found("q/l.lp", "q/full")), "q/full/x.png");
}

TEST_F(LightFolder, CountsAsPeopleDoWhereNoNamesAreSaid) {
  std::string lights = "12\n", order;
  for (int k = 0; k < 12; ++k) {
    put(fmt::format("uw/cat/cat.{}.png", k));
    lights += fmt::format("0 {} 1\n", k);
    order += fmt::format("{}uw/cat/cat.{}.png", k == 0 ? "" : " ", k);
  }
  put("uw/cat/cat.mask.png");
  put("uw/cat/normal.png");
  put("uw/lights.txt", lights);
  const Result<LightList> list = found("", "uw/cat");
  EXPECT_EQ(photographs(list), order);
  EXPECT_THAT(words_of(list.value()), HasSubstr("lights are those of lights.txt in uw"));
  EXPECT_THAT(words_of(list.value()), HasSubstr("in the order of their names, cat.0.png to cat.11.png"));
  EXPECT_EQ(photographs(found("uw/lights.txt", "uw/cat")), order);
  EXPECT_THAT(photographs(found("uw/lights.txt")), HasSubstr("names no photograph"));
  fs::remove(folder_.path() / "uw/cat/cat.7.png");
  fs::remove(folder_.path() / "uw/cat/normal.png");
  EXPECT_THAT(photographs(found("", "uw/cat")),
              HasSubstr("12 lights and no names, and there are 11 photographs"));
}

TEST_F(LightFolder, ReadsTheBenchmarksLayoutAndItsVariants) {
  for (const char* name : {"001.png", "002.png", "010.png"}) put("d/" + std::string(name));
  put("d/light_directions.txt", "0 0 1\n0.6 0 0.8\n0 0.6 0.8\n");
  EXPECT_EQ(photographs(found("", "d")), "d/001.png d/002.png d/010.png");
  put("d/filenames.txt", "010.png\n002.png\n001.png\n");
  EXPECT_EQ(photographs(found("", "d")), "d/010.png d/002.png d/001.png");
  struct Case {
    const char *text, *strength;
  };
  for (const Case& each : std::vector<Case>{{"1 2 3\n4 5 6\n7 8 9\n", "4 5 6"},
                                            {"1\n4\n7\n", "4 4 4"},
                                            {"1, 2, 3\n4, 5, 6\n7, 8, 9\n", "4 5 6"},
                                            {"1 4 7\n", "4 4 4"}}) {
    put("d/light_intensities.txt", each.text);
    const Result<LightList> list = found("", "d");
    ASSERT_TRUE(list) << each.text << list.error().message();
    const std::array<double, 3>& s = list->lights[1].strength_rgb;
    EXPECT_EQ(fmt::format("{} {} {}", s[0], s[1], s[2]), each.strength) << each.text;
  }
  put("d/light_intensities.txt", "1\n4\n");
  EXPECT_THAT(photographs(found("", "d")),
              HasSubstr("filenames.txt has 3 lines, light_directions.txt 3, light_intensities.txt 2"));
}

TEST_F(LightFolder, RefusesSeveralLightFilesThatDiffer) {
  put("d/a.png");
  put("d/one.lp", "1\na.png 0 0 1\n");
  put("d/two.lp", "1\na.png 0 0 1\n");
  put("d/lighting notes.txt", "the left one is dim\n");
  EXPECT_EQ(photographs(found("", "d")), "d/a.png") << "both say the same";
  put("d/two.lp", "1\na.png 0.6 0 0.8\n");
  EXPECT_THAT(photographs(found("", "d")), HasSubstr("one.lp, two.lp say different things"));
  EXPECT_THAT(photographs(found("", "none")), HasSubstr("No such file"));
  fs::create_directories(folder_.path() / "e/f");
  EXPECT_THAT(photographs(found("", "e/f")), HasSubstr("there is no light file"));
}

}  // namespace
}  // namespace weft::solve
