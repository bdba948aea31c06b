// SPDX-License-Identifier: Apache-2.0
#include "core/base/files.h"
#include "core/base/sha256.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "tests/core/child.h"
#include "tests/core/image_io/scratch_folder.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

constexpr uid_t kNobody = 65534;

template <typename T>
std::string outcome(const Result<T>& result) {
  return result ? "done" : result.error().message();
}

// The kind of an error as an integer that compares and prints; -1 for success.
template <typename T>
int kind_of(const Result<T>& result) {
  return result ? -1 : static_cast<int>(result.error().kind);
}
constexpr int kCannotCreate = static_cast<int>(ErrorKind::kCannotCreate);
constexpr int kInputOutput = static_cast<int>(ErrorKind::kInputOutput);
constexpr int kNoInput = static_cast<int>(ErrorKind::kNoInput);
constexpr int kBadData = static_cast<int>(ErrorKind::kBadData);

TEST(WriteFile, ReplacesTheFileAndLeavesNothingBesideIt) {
  const ScratchFolder folder;
  const fs::path file = folder / "a.json";
  for (const std::string& bytes :
       {std::string("of before"), std::string("now\0with a zero", 15), std::string()}) {
    const Result<void> written = write_file(file, bytes);
    ASSERT_TRUE(written) << written.error().message();
    EXPECT_EQ(bytes_of(file), bytes);
    EXPECT_FALSE(fs::exists(folder / "a.json.partial"));
  }
}

TEST(WriteFile, LeavesTheOldFileWhenTheNewOneMayNotGrow) {
  const ScratchFolder folder;
  put_bytes(folder / "old.json", "of before");
  for (const std::string name : {"old.json", "new.json"}) {
    const std::string said = said_by_child([&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit = {1000, 1000};
      if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return std::string("no limit");
      const Result<void> written = write_file(folder / name, std::string(100'000, 'x'));
      return (kind_of(written) == kInputOutput ? "input/output: " : "another kind: ") + outcome(written);
    });
    EXPECT_THAT(said,
                StartsWith("input/output: cannot write: " + (folder / name).string() + ": File too large."));
    EXPECT_FALSE(fs::exists(folder / (name + ".partial")));
  }
  EXPECT_EQ(bytes_of(folder / "old.json"), "of before");
  EXPECT_FALSE(fs::exists(folder / "new.json"));
}

TEST(WriteFile, LeavesTheOldFileOnAFullDisk) {
  const ScratchFolder folder;
  put_bytes(folder / "a.json", "of before");
  fs::create_symlink("/dev/full", folder / "a.json.partial");
  const Result<void> written = write_file(folder / "a.json", "new");
  EXPECT_EQ(kind_of(written), kInputOutput);
  EXPECT_THAT(outcome(written), HasSubstr("No space left on device. free disk space"));
  EXPECT_EQ(bytes_of(folder / "a.json"), "of before");
  EXPECT_FALSE(fs::is_symlink(folder / "a.json.partial"));
}

TEST(WriteFile, SaysThatAFileCannotBeCreated) {
  const ScratchFolder folder;
  put_bytes(folder / "file", "no folder");
  fs::create_directory(folder / "folder");
  const std::string long_name(300, 'n');
  for (const std::string& name :
       {std::string("missing/a"), std::string("file/a"), std::string("folder"), long_name}) {
    const Result<void> written = write_file(folder / name, "new");
    EXPECT_EQ(kind_of(written), kCannotCreate) << outcome(written);
    EXPECT_THAT(outcome(written), HasSubstr((folder / name).string()));
  }
}

TEST(CannotWrite, TellsAFullDiskFromAForbiddenFolder) {
  for (const int error : {ENOSPC, EDQUOT, EFBIG, EIO}) {
    EXPECT_EQ(cannot_write("a", error).kind, ErrorKind::kInputOutput) << system_reason(error);
  }
  for (const int error : {EACCES, EPERM, EROFS, ENOENT, ENOTDIR, EEXIST, ENOTEMPTY}) {
    EXPECT_EQ(cannot_write("a", error).kind, ErrorKind::kCannotCreate) << system_reason(error);
  }
  EXPECT_EQ(cannot_write("a", ENOSPC).why, "No space left on device");
}

TEST(PublishFolder, MovesAWholeFolder) {
  const ScratchFolder folder;
  fs::create_directories(folder / "a.partial/deep");
  put_bytes(folder / "a.partial/deep/map.exr", "pixels");
  const Result<void> published = publish_folder(folder / "a.partial", folder / "a");
  ASSERT_TRUE(published) << published.error().message();
  EXPECT_EQ(bytes_of(folder / "a/deep/map.exr"), "pixels");
  EXPECT_FALSE(fs::exists(folder / "a.partial"));
}

TEST(PublishFolder, RefusesATargetThatIsThereEvenAnEmptyOne) {
  const ScratchFolder folder;
  fs::create_directories(folder / "new");
  put_bytes(folder / "new/map.exr", "new");
  fs::create_directories(folder / "empty");
  fs::create_directories(folder / "full");
  put_bytes(folder / "full/map.exr", "old");
  put_bytes(folder / "file", "old");
  for (const char* target : {"empty", "full", "file"}) {
    EXPECT_EQ(kind_of(publish_folder(folder / "new", folder / target)), kCannotCreate) << target;
  }
  EXPECT_TRUE(fs::is_empty(folder / "empty"));
  EXPECT_EQ(bytes_of(folder / "full/map.exr"), "old");
  EXPECT_EQ(bytes_of(folder / "file"), "old");
  EXPECT_EQ(bytes_of(folder / "new/map.exr"), "new");
}

TEST(PublishFolder, ReportsWhatItCannotMove) {
  const ScratchFolder folder;
  fs::create_directories(folder / "new");
  EXPECT_EQ(kind_of(publish_folder(folder / "new", folder / "missing/a")), kCannotCreate);
  EXPECT_FALSE(publish_folder(folder / "nothing", folder / "a"));
  EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(PublishFolder, ReportsANameThatIsTooLong) {
  const ScratchFolder folder;
  fs::create_directories(folder / "new");
  std::string said = "an exception";
  EXPECT_NO_THROW(said = outcome(publish_folder(folder / "new", folder / std::string(300, 'n'))));
  EXPECT_THAT(said, HasSubstr("File name too long. choose a shorter name"));
}

TEST(PartialFolder, TakesANameWithASlashAtItsEnd) {
  const ScratchFolder folder;
  EXPECT_EQ(absolute_folder(folder / "a/./b/"), folder / "a/b");
  PartialFolder partial(folder / "new/");
  ASSERT_TRUE(make_writable_folder(partial.path()));
  EXPECT_FALSE(is_there(folder / "new"));
  const Result<void> published = partial.publish();
  ASSERT_TRUE(published) << published.error().message();
  EXPECT_TRUE(is_there(folder / "new"));
}

TEST(MakeWritableFolder, MakesParentsAndAcceptsAFolderThatIsThere) {
  const ScratchFolder folder;
  for (int i = 0; i < 2; ++i) EXPECT_TRUE(make_writable_folder(folder / "a/b/c"));
  EXPECT_TRUE(fs::is_directory(folder / "a/b/c"));
}

TEST(MakeWritableFolder, RefusesAFileInItsPlaceAndAFolderOfAnotherUser) {
  const ScratchFolder folder;
  put_bytes(folder / "file", "no folder");
  EXPECT_EQ(kind_of(make_writable_folder(folder / "file")), kCannotCreate);
  EXPECT_EQ(kind_of(make_writable_folder(folder / "file/a")), kCannotCreate);
  fs::create_directory(folder / "theirs");
  fs::permissions(folder / "theirs", fs::perms::owner_read | fs::perms::owner_exec);
  const std::string said = said_by_child([&] {
    // The effective user alone, as the system asks for it when a file is made.
    if (geteuid() == 0 && seteuid(kNobody) != 0) return std::string("cannot become another user");
    return outcome(make_writable_folder(folder / "theirs"));
  });
  if (said == "cannot become another user") GTEST_SKIP() << said;
  EXPECT_THAT(said, StartsWith("cannot create: " + (folder / "theirs").string() + ": Permission denied."));
}

TEST(ReadText, ReadsAFileUpToItsLimit) {
  const ScratchFolder folder;
  const std::string text(200'000, 't');
  put_bytes(folder / "a", text);
  const Result<std::string> whole = read_text(folder / "a", 200'000);
  ASSERT_TRUE(whole) << whole.error().message();
  EXPECT_TRUE(*whole == text) << whole->size() << " bytes";
  const Result<std::string> over = read_text(folder / "a", 199'999);
  EXPECT_EQ(kind_of(over), kBadData);
  EXPECT_THAT(outcome(over), HasSubstr("over 199999 bytes"));
  EXPECT_EQ(kind_of(read_text("/dev/zero", 1000)), kBadData) << "a file without end";
}

TEST(ReadText, SaysWhyAFileIsNoInput) {
  const ScratchFolder folder;
  EXPECT_EQ(kind_of(read_text(folder / "missing")), kNoInput);
  EXPECT_THAT(outcome(read_text(folder / "missing")), HasSubstr("No such file or directory"));
  EXPECT_EQ(kind_of(read_text(folder / "")), kNoInput);
  EXPECT_THAT(outcome(read_text(folder / "")), HasSubstr("Is a directory"));
}

TEST(ReadText, SaysThatThisUserMayNotReadAFile) {
  const ScratchFolder folder;
  put_bytes(folder / "a", "secret");
  fs::permissions(folder / "a", fs::perms::none);
  const std::string said = said_by_child([&] {
    if (geteuid() == 0 && setuid(kNobody) != 0) return std::string("cannot become another user");
    const Result<std::string> read = read_text(folder / "a");
    const Result<std::string> digest = sha256_of_file(folder / "a");
    return (kind_of(read) == kNoInput && kind_of(digest) == kNoInput ? "no input: " : "another kind: ") +
           outcome(read);
  });
  if (said == "cannot become another user") GTEST_SKIP() << said;
  EXPECT_EQ(said, "no input: cannot read: " + (folder / "a").string() +
                      ": Permission denied. give this user the right to read it.");
}

// FIPS 180-4 and the examples NIST publishes with it.
TEST(Sha256, AgreesWithTheStandard) {
  EXPECT_EQ(sha256_of(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFileIsThatOfItsBytesAroundTheBlockSize) {
  const ScratchFolder folder;
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kBlock - 1, kBlock, kBlock + 1}) {
    const std::string bytes(size, 'w');
    put_bytes(folder / "a", bytes);
    const Result<std::string> digest = sha256_of_file(folder / "a");
    ASSERT_TRUE(digest) << digest.error().message();
    EXPECT_EQ(*digest, sha256_of(bytes)) << size << " bytes";
  }
  EXPECT_EQ(kind_of(sha256_of_file(folder / "missing")), kNoInput);
  EXPECT_EQ(kind_of(sha256_of_file(folder / "")), kNoInput) << "a folder";
}

TEST(LookFor, TellsWhatIsNotThereFromWhatCannotBeSeen) {
  const ScratchFolder folder;
  fs::create_symlink("/nowhere", folder / "link");
  EXPECT_TRUE(look_for(folder / "link").value()) << "a link that leads nowhere is there";
  EXPECT_FALSE(look_for(folder / "nothing").value());
  EXPECT_FALSE(look_for(folder / "nothing" / "below it").value());
  const Result<bool> unseen = look_for(folder / std::string(300, 'x'));
  ASSERT_FALSE(unseen);
  EXPECT_EQ(unseen.error().kind, ErrorKind::kInputOutput);
}

TEST(AreOnOneDisk, LooksAtTheNearestParentsThatAreThere) {
  const ScratchFolder folder;
  EXPECT_TRUE(are_on_one_disk(folder / "a", folder / "b" / "c"));
  EXPECT_FALSE(are_on_one_disk(folder / "", "/proc/self"));
}

TEST(FreeDiskBytes, OfAPathThatIsNotThereYetAreThoseOfItsParent) {
  const ScratchFolder folder;
  const auto here = static_cast<double>(free_disk_bytes(folder / ""));
  const auto later = static_cast<double>(free_disk_bytes(folder / "not/yet/there.weft"));
  EXPECT_GT(here, 0);
  EXPECT_NEAR(later, here, 0.1 * here) << "others may write to the disk meanwhile";
  EXPECT_GT(free_disk_bytes("not-there-either"), 0U);
  EXPECT_GT(free_disk_bytes("/not/there"), 0U);
}

TEST(Memory, IsMeasuredInBytes) {
  EXPECT_GT(available_memory_bytes(), std::uint64_t{1} << 20);
  EXPECT_GT(peak_memory_bytes(), std::uint64_t{1} << 20);
  EXPECT_LT(peak_memory_bytes(), std::uint64_t{1} << 48);
}

}  // namespace
}  // namespace weft
