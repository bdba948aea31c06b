// SPDX-License-Identifier: Apache-2.0
// weft serve as a process: what starts it, ends it and hears of it.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/server/http/client.h"
#include "app/server/rig/rig_lock.h"
#include "capture/rig.h"
#include "core/base/descriptor.h"
#include "tests/app/server/raw_client.h"
#include "tests/core/places.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;

constexpr auto kStartPatience = seconds(20);  // for a process that begins on a busy machine

template <typename Condition>
bool comes_true(const Condition& condition) {
  const Clock::time_point deadline = Clock::now() + kStartPatience;
  while (!condition()) {
    if (Clock::now() > deadline) return false;
    std::this_thread::sleep_for(milliseconds(5));
  }
  return true;
}

/// A running weft with this verb, its rig and one more option; killed with its owner.
class Daemon {
 public:
  explicit Daemon(const fs::path& rig, const std::string& verb = "serve", const std::string& more = "-q")
      : said_(rig.parent_path() / (verb + ".txt")) {
    const std::string file = rig.string(), said = said_.string();
    pid_ = fork();
    if (pid_ != 0) return;
    dup2(open(said.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDERR_FILENO);
    const int nothing = open("/dev/null", O_WRONLY);
    dup2(nothing, STDOUT_FILENO);
    execl(program_path("weft").c_str(), "weft", verb.c_str(), "--rig", file.c_str(), more.c_str(),
          static_cast<char*>(nullptr));
    _exit(127);
  }
  Daemon(const Daemon&) = delete;
  ~Daemon() {
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  void signal(int number) const { kill(pid_, number); }
  /// Its exit code once it has ended; -1 if it does not, 128 + the signal that killed it.
  int ended() {
    int status = 0;
    if (!comes_true([&] { return waitpid(pid_, &status, WNOHANG) == pid_; })) return -1;
    pid_ = 0;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }
  std::string said() const {
    std::ifstream in(said_);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  fs::path said_;
  pid_t pid_ = 0;
};

struct Ran {
  int exit_code = -1;
  std::string said;
};

/// weft with these words, to its end.
Ran run(const std::string& words) {
  Ran ran;
  FILE* const out = popen((program_path("weft") + " " + words + " 2>&1").c_str(), "re");
  if (out == nullptr) return ran;
  std::array<char, 512> line = {};
  while (fgets(line.data(), static_cast<int>(line.size()), out) != nullptr) ran.said += line.data();
  const int status = pclose(out);
  if (WIFEXITED(status)) ran.exit_code = WEXITSTATUS(status);
  return ran;
}

class Serve : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "rig.toml") << "name = \"north\"\n[board]\nport = \"/dev/no-board\"\n"
                                        << "[camera]\nport = \"ptpip:127.0.0.1:1:1\"\n[daemon]\nport = 0\n";
    rig_ = capture::read_rig(folder_ / "rig.toml").value();
  }
  void TearDown() override { fs::remove_all(folder_); }

  Result<RigClient> client() const {
    std::optional<std::string> address;
    EXPECT_TRUE(comes_true([&] { return (address = address_of_owner(rig_).value()).has_value(); }))
        << "no address";
    return RigClient::connect(address.value_or(""));
  }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("weft_serve_" + std::to_string(getpid()));
  capture::Rig rig_;
};

TEST_F(Serve, AnswersUntilItIsToldToEnd) {
  Daemon daemon(folder_ / "rig.toml");
  const Result<RigClient> client = this->client();
  ASSERT_TRUE(client) << client.error().message() << daemon.said();
  EXPECT_EQ(client->get("/api/v1/rig")->at("rig"), "north");

  RawClient follower(
      std::stoi(address_of_owner(rig_).value()->substr(std::string("http://127.0.0.1:").size())));
  follower.say("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  follower.hear(seconds(5), "\n\n");
  const Clock::time_point told = Clock::now();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.ended(), 0) << daemon.said();
  const double took_s = std::chrono::duration<double>(Clock::now() - told).count();
  RecordProperty("exit_ms", static_cast<int>(1000 * took_s));
  EXPECT_LT(took_s, 3);
  EXPECT_FALSE(fs::exists(rig_.daemon.state / "address"));
}

TEST_F(Serve, SaysThatTheBoardIsNotThereAndWaitsForIt) {
  Daemon daemon(folder_ / "rig.toml");
  const Result<RigClient> client = this->client();
  ASSERT_TRUE(client) << client.error().message() << daemon.said();
  ASSERT_TRUE(client->post("/api/v1/scan", {{"fabric", "satin"}, {"session", "a"}}));
  Json status;
  ASSERT_TRUE(comes_true([&] { return (status = client->get("/api/v1/rig").value())["why"] != ""; }))
      << status.dump();
  EXPECT_EQ(status["state"], "connecting") << status.dump();
  EXPECT_THAT(status["why"].get<std::string>(), testing::HasSubstr("/dev/no-board"));
  ASSERT_TRUE(client->post("/api/v1/scan/cancel"));
  EXPECT_TRUE(comes_true([&] { return client->get("/api/v1/rig").value()["state"] == "idle"; }));
}

TEST_F(Serve, SaysWhatHappensALineAnEvent) {
  Daemon daemon(folder_ / "rig.toml");
  const Result<RigClient> client = this->client();
  ASSERT_TRUE(client) << client.error().message() << daemon.said();
  ASSERT_TRUE(client->post("/api/v1/scan", {{"fabric", "satin"}, {"session", "a"}}));
  EXPECT_TRUE(comes_true([&] { return daemon.said().find("waiting: ") != std::string::npos; }));
  EXPECT_THAT(daemon.said(), testing::AllOf(testing::HasSubstr("daemon_began: rig north"),
                                            testing::HasSubstr("scan_began: a of satin"),
                                            testing::HasSubstr("/dev/no-board")));
}

TEST_F(Serve, AScanThatHearsNoEventsIsStillCancelledByItsPerson) {
  Daemon daemon(folder_ / "rig.toml");
  const Result<RigClient> client = this->client();
  ASSERT_TRUE(client) << client.error().message() << daemon.said();
  const int port = std::stoi(address_of_owner(rig_).value()->substr(std::string("http://127.0.0.1:").size()));
  std::vector<std::unique_ptr<RawClient>> followers;  // as many as may follow
  for (int i = 0; i < 16; ++i) {
    followers.push_back(std::make_unique<RawClient>(port));
    followers.back()->say("GET /api/v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_THAT(followers.back()->hear(seconds(5), "\n\n"), testing::HasSubstr("200"));
  }
  Daemon scan(folder_ / "rig.toml", "scan", "--fabric=satin");
  const auto state = [&] { return client->get("/api/v1/rig").value()["state"]; };
  ASSERT_TRUE(comes_true([&] { return state() == "connecting"; })) << scan.said();
  std::this_thread::sleep_for(seconds(1));  // it was turned away by now
  scan.signal(SIGINT);
  EXPECT_EQ(scan.ended(), 130) << scan.said();
  EXPECT_EQ(state(), "idle");
}

TEST_F(Serve, ASecondOneOfTheRigEndsAtOnce) {
  Daemon first(folder_ / "rig.toml");
  ASSERT_TRUE(client());
  Daemon second(folder_ / "rig.toml");
  EXPECT_EQ(second.ended(), 75);
  EXPECT_THAT(second.said(), testing::HasSubstr("the rig is in use"));
}

TEST_F(Serve, OneThatWasKilledLeavesNothingInTheWay) {
  Daemon first(folder_ / "rig.toml");
  ASSERT_TRUE(client());
  first.signal(SIGKILL);
  EXPECT_EQ(first.ended(), 128 + SIGKILL);
  EXPECT_EQ(address_of_owner(rig_).value(), std::nullopt) << "an address without an owner is none";
  Daemon second(folder_ / "rig.toml");
  const Result<RigClient> again = client();
  EXPECT_TRUE(again) << again.error().message() << second.said();
}

TEST_F(Serve, TheDevicesOfItsRigAreAskedForThroughIt) {
  Daemon daemon(folder_ / "rig.toml");
  ASSERT_TRUE(client());
  const Ran lights = run("rig lights --rig " + rig_.file.string());
  EXPECT_EQ(lights.exit_code, 69) << lights.said;
  EXPECT_THAT(lights.said, testing::HasSubstr("the LED board is not there"));
  const Ran doctor = run("doctor --rig " + rig_.file.string());
  EXPECT_EQ(doctor.exit_code, 0) << doctor.said;
  EXPECT_THAT(doctor.said, testing::HasSubstr("owns the rig and is idle"));
}

TEST_F(Serve, AScanTakesTheNameThatAShellCompletes) {
  const std::string session = (folder_ / "satin.weft").string();
  for (const char* ending : {"", "/", "//"}) {
    const Ran ran =
        run("scan --dry-run --fabric satin --rig " + rig_.file.string() + " -o " + session + ending);
    EXPECT_EQ(ran.exit_code, 0) << ran.said;
    EXPECT_EQ(ran.said, session + "\n");
  }
}

TEST_F(Serve, TellsTheServiceManagerThatItIsReadyAliveAndEnding) {
  const std::string path = (folder_ / "notify").string();
  const Descriptor manager(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(manager.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  const timeval patience = {std::chrono::seconds(kStartPatience).count(), 0};
  setsockopt(manager.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  setenv("WATCHDOG_USEC", "200000", 1);
  Daemon daemon(folder_ / "rig.toml");
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  const auto next = [&] {
    std::array<char, 256> text = {};
    const ssize_t bytes = recv(manager.get(), text.data(), text.size(), 0);
    return std::string(text.data(), bytes > 0 ? static_cast<std::size_t>(bytes) : 0);
  };
  EXPECT_THAT(next(), testing::StartsWith("READY=1\n")) << daemon.said();
  EXPECT_EQ(next(), "WATCHDOG=1");
  EXPECT_EQ(next(), "WATCHDOG=1");
  daemon.signal(SIGTERM);
  std::string last;
  while ((last = next()) == "WATCHDOG=1") {
  }
  EXPECT_EQ(last, "STOPPING=1");
  EXPECT_EQ(daemon.ended(), 0);
}

/// A running weft serve of archives alone, in `home`; killed with its owner.
class ArchiveServer {
 public:
  ArchiveServer(const fs::path& home, const std::vector<fs::path>& archives) {
    std::vector<std::string> words = {"weft", "serve", "--port", "0", "-q"};
    for (const fs::path& archive : archives) words.insert(words.end(), {"--archive", archive.string()});
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const fs::path state = home / "state", address = state / "weft/archive/address";
    pid_ = fork();
    if (pid_ == 0) {
      for (const char* name : {"HOME", "XDG_CONFIG_HOME"}) setenv(name, home.c_str(), 1);
      setenv("XDG_STATE_HOME", state.c_str(), 1);
      unsetenv("WEFT_RIG");
      if (chdir(archives.front().c_str()) != 0) _exit(126);
      execv(program_path("weft").c_str(), arguments.data());
      _exit(127);
    }
    EXPECT_TRUE(comes_true([&] { return fs::exists(address) && fs::file_size(address) > 0; }));
    std::string at;
    std::ifstream(address) >> at;
    if (!at.empty()) port_ = std::stoi(at.substr(at.rfind(':') + 1));
  }
  ~ArchiveServer() {
    if (pid_ == 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  ArchiveServer(const ArchiveServer&) = delete;
  ArchiveServer& operator=(const ArchiveServer&) = delete;

  int port() const { return port_; }
  /// Whether it exits when it is told to.
  bool ends() {
    kill(pid_, SIGTERM);
    int status = 0;
    if (!comes_true([&] { return waitpid(pid_, &status, WNOHANG) == pid_; })) return false;
    pid_ = 0;
    return WIFEXITED(status);
  }

 private:
  pid_t pid_ = 0;
  int port_ = 0;
};

void make_session(const fs::path& folder) {
  fs::create_directories(folder / "raw");
  std::ofstream(folder / "session.json")
      << R"({"schema": "weft.session/1", "fabric": "wool", "cloth_height_mm": 0, "rig": "old", "calibration": "",
             "state": "complete", "shots": []})";
}

TEST_F(Serve, WithoutARigShowsArchivesAndRefusesWhatNeedsOne) {
  make_session(folder_ / "archive" / "2019" / "wool.weft");
  ASSERT_EQ(run("serve --archive " + (folder_ / "none").string() + " -q").exit_code, 66);
  const ArchiveServer server(folder_, {folder_ / "archive"});
  const int port = server.port();
  EXPECT_EQ(ask(port, "GET", "/api/v1/sessions?query=wool").json()["total"], 1);
  EXPECT_EQ(ask(port, "GET", "/api/v1/sessions/wool").json()["fabric"], "wool")
      << "below a folder of the archive";
  EXPECT_EQ(ask(port, "GET", "/api/v1/rig").json()["can"], Json::array());
  EXPECT_EQ(ask(port, "GET", "/api/v1/jobs").status, 200);
  EXPECT_EQ(ask(port, "GET", "/api/v1/doctor").status, 200);
  for (const char* call : {"/api/v1/scan", "/api/v1/rig/devices", "/api/v1/sessions/wool/frames/0/again"}) {
    const Answer refused = ask(port, "POST", call, "{}", {{"Content-Type", "application/json"}});
    EXPECT_EQ(refused.status, 409) << call;
    EXPECT_EQ(refused.json()["error"]["code"], "no_rig") << call;
  }
}

// Whoever opens a file that another process holds a write lease on waits for it, as for a disk that does not
// answer.
TEST_F(Serve, AnArchiveThatHangsIsNamedAndDelaysNobody) {
  const fs::path hanging = folder_ / "hanging";
  make_session(folder_ / "archive" / "wool.weft");
  make_session(hanging / "lost.weft");
  std::signal(SIGIO, SIG_IGN);  // by which the system asks for the lease
  const Descriptor held(hanging / "lost.weft" / "session.json", O_RDWR);
  if (::fcntl(held.get(), F_SETLEASE, F_WRLCK) != 0)
    GTEST_SKIP() << "the file system of " << hanging << " gives no leases: " << std::strerror(errno);
  ArchiveServer server(folder_, {folder_ / "archive", hanging});
  const auto wool = [&] {
    return ask(server.port(), "GET", "/api/v1/sessions?query=wool").json()["total"] == 1;
  };
  EXPECT_TRUE(comes_true(wool));
  const Clock::time_point begin = Clock::now();
  EXPECT_TRUE(wool());
  EXPECT_LT(Clock::now() - begin, seconds(10)) << "it waits for the other, which never answers";
  const auto doctor = [&] { return ask(server.port(), "GET", "/api/v1/doctor").body; };
  EXPECT_TRUE(comes_true([&] { return doctor().find(hanging.string()) != std::string::npos; })) << doctor();
  EXPECT_TRUE(server.ends()) << "all the same";
}

}  // namespace
}  // namespace weft::app
