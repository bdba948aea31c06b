// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/frame_pictures.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "core/rig/session.h"
#include "tests/app/server/scripted_rig.h"

namespace weft::app {
namespace {

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
  return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(FramePictures, KeepThoseOfTheNewestFramesHoweverManyAreMade) {
  ScriptedRig scripted("pictures");
  scripted.leave_unfinished("a");
  const Session session = read_session(scripted.session("a")).value();
  const auto frame = [&](int i) {  // the same one under many names
    return FrameFile{session.path_of(session.shots[0]), fmt::format("{:064x}", i)};
  };
  const std::filesystem::path folder = scripted.rig.daemon.state / "pictures";
  FramePictures pictures(folder, 20);
  std::ptrdiff_t most = 0;
  for (int i = 0; i < 40; ++i) {
    const Result<std::string> made = pictures.thumbnail(frame(i));
    ASSERT_TRUE(made) << made.error().message();
    most = std::max(most, files_in(folder));
  }
  EXPECT_LE(most, 2 * (20 + 2)) << "files";
  EXPECT_FALSE(pictures.ready_histogram(frame(0)));
  for (int i = 22; i < 40; ++i) EXPECT_TRUE(pictures.ready_histogram(frame(i))) << i;
}

TEST(FramePictures, AreGivenTheHistogramThatWasCountedAlready) {
  ScriptedRig scripted("counted");
  scripted.leave_unfinished("a");
  const Session session = read_session(scripted.session("a")).value();
  FrameFile frame = {session.path_of(session.shots[0]), session.shots[0].sha256};
  frame.histogram.emplace();
  (*frame.histogram)[1].bins[7] = 11;
  FramePictures pictures(scripted.rig.daemon.state / "pictures");
  EXPECT_EQ(pictures.histogram(frame).value(), to_json(*frame.histogram));
}

}  // namespace
}  // namespace weft::app
