// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/virtual_rig.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <fstream>
#include <mutex>
#include <numeric>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/base/files.h"
#include "virtual_rig/board/foreign_device.h"
#include "virtual_rig/board/virtual_board.h"
#include "virtual_rig/control_socket.h"
#include "virtual_rig/light/exposed_frame.h"
#include "virtual_rig/light/light_faults.h"
#include "virtual_rig/light/live_picture.h"
#include "virtual_rig/ptp/virtual_camera.h"
#include "virtual_rig/rig_folder.h"
#include "virtual_rig/table/knock.h"
#include "virtual_rig/table/table.h"
#include "virtual_rig/terminal/port_name.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;

constexpr int kLedOutputs = 10;  // of the board
constexpr int kMostShots = 1000000;
constexpr double kMostBlur_px = 32;
constexpr auto kLookTime = std::chrono::milliseconds(50);

struct BoardCommand {
  const char* name;
  VirtualBoardFault fault;
  const char* does;
};
constexpr std::array kBoardCommands = {
    BoardCommand{"unplug", VirtualBoardFault::kUnplug, "its cable is pulled: no terminal, no light"},
    BoardCommand{"replug", VirtualBoardFault::kReplug, "and put in again"},
    BoardCommand{"reset", VirtualBoardFault::kReset, "its button is pressed"},
    BoardCommand{"hang", VirtualBoardFault::kHang, "its firmware hangs until the watchdog ends that"},
    BoardCommand{"garbage", VirtualBoardFault::kGarbage, "noise in both directions for 100 ms"},
    BoardCommand{"deaf", VirtualBoardFault::kDeaf, "nothing reaches it, until hear"},
    BoardCommand{"hear", VirtualBoardFault::kHear, "ends deaf, slow and wrong_baud"},
    BoardCommand{"slow", VirtualBoardFault::kSlow, "each reply is 150 ms late, until hear"},
    BoardCommand{"wrong_baud", VirtualBoardFault::kWrongBaud, "it hears garbled bytes, until hear"},
};

Error refusal(const std::string& line, std::string why, std::string remedy) {
  return {ErrorKind::kUsage, "no such command", line, std::move(why), std::move(remedy)};
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Json json_of(const std::vector<CommandWords>& commands) {
  Json all = Json::array();
  for (const auto& [line, does, example] : commands)
    all.push_back({{"line", line}, {"does", does}, {"example", example}});
  return all;
}

std::optional<int> shot_of(const std::string& word) {
  int shot = 0;
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), shot);
  if (wrong != std::errc() || end != word.data() + word.size() || shot < 1 || shot > kMostShots) return {};
  return shot;
}

/// The count of the camera of a rig that lived in this folder before: bodies do not count anew.
std::uint32_t last_image_number(const fs::path& log) {
  std::ifstream in(log);
  std::uint32_t last = 0;
  for (std::string line; std::getline(in, line);) {
    const Json exposure = Json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (exposure.is_object()) last = std::max(last, exposure.value("image_number", std::uint32_t{0}));
  }
  return last;
}

Result<void> check_leds(const LightFrames& frames) {
  if (frames.leds() <= kLedOutputs) return {};
  return Error{ErrorKind::kBadData, "too many LEDs for a board", "scene",
               fmt::format("it has {} and the board {} outputs", frames.leds(), kLedOutputs),
               "take some out of the scene's section [lights]"};
}

/// The light on the cloth, as a camera sees it that is focused as it is.
struct SceneLight {
  LightFrames frames;
  std::optional<LightFrames> matt;  ///< what it scatters alone, behind films, where a polariser parts the two
};

Result<SceneLight> light_of(simulator::Scene scene, const VirtualRigOptions& options) {
  scene.films = {};  // they are the rig's: add_films()
  Result<LightFrames> frames = LightFrames::open(scene, options.cache, options.render);
  if (!frames) return frames.error();
  std::optional<LightFrames> matt;
  if (options.polariser && scene.effects.reflectance) {
    scene.films = {.states = simulator::FilmStates::kCrossed, .leak = 0};
    Result<LightFrames> without_gloss = LightFrames::open(scene, options.cache, options.render);
    if (!without_gloss) return without_gloss.error();
    matt = std::move(*without_gloss);
  }
  return SceneLight{std::move(*frames), std::move(matt)};
}

std::optional<double> pixels_in(const std::string& word) {
  double pixels = 0;
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), pixels);
  if (wrong != std::errc() || end != word.data() + word.size() || !(pixels >= 0 && pixels <= kMostBlur_px))
    return {};
  return pixels;
}

std::optional<StopCounts> counts_in(const std::vector<std::string>& words) {
  StopCounts counts = {};
  if (words.size() != counts.size()) return {};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const char* const last = words[i].data() + words[i].size();
    const auto [end, wrong] = std::from_chars(words[i].data(), last, counts[i]);
    if (wrong != std::errc() || end != last) return {};
  }
  return counts;
}

class RunningRig : public VirtualRig {
 public:
  RunningRig(const VirtualRigOptions& options, RigTable table, SceneLight light, RigFolder folder)
      : options_(options),
        table_(std::move(table)),
        seen_(light.frames.scene()),
        light_(std::make_shared<const SceneLight>(std::move(light))),
        folder_(std::move(folder)) {}

  ~RunningRig() override {
    control_.reset();  // nobody commands what goes
    camera_.reset();
    beside_.reset();
    board_.reset();
    for (const int fd : {end_, log_}) {
      if (fd >= 0) ::close(fd);
    }
  }

  Result<void> start() {
    end_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (end_ < 0) return cannot_write(folder_.path(), errno);
    log_ = ::open(in_folder(kExposureLog).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (log_ < 0) return cannot_write(in_folder(kExposureLog), errno);
    using Step = Result<void> (RunningRig::*)();
    for (const Step step : {&RunningRig::start_board, &RunningRig::start_camera, &RunningRig::write_files,
                            &RunningRig::start_control}) {
      if (Result<void> ok = (this->*step)(); !ok) return ok;
    }
    for (const std::string& line : options_.first) {
      if (Result<std::string> done = command(line); !done) return std::move(done).error();
    }
    return {};
  }

  const LightFrames& frames() const override { return light_->frames; }
  const std::vector<std::string>& environment() const override { return environment_; }
  int end_descriptor() const override { return end_; }

  Result<std::string> command(const std::string& line) override {
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) return refusal(line, "the line is empty", "say status");
    const std::string& kind = words[0];
    if (kind == "status" && words.size() == 1) return status().dump();
    if (kind == "commands" && words.size() == 1) return json_of(virtual_rig_commands()).dump();
    if (kind == "end" && words.size() == 1) return end();
    const auto done = [&]() -> Result<void> {
      if (kind == "focus" && words.size() == 2) return change_focus(line, words[1]);
      if (kind == "stops") return change_stops(line, {words.begin() + 1, words.end()});
      if (kind == "table") return change_table({words.begin() + 1, words.end()});
      if (kind == "knock") return change_place({words.begin() + 1, words.end()});
      if (kind == "light") return change_light({words.begin() + 1, words.end()});
      if (kind == "board" && words.size() == 2) return inject_board(line, words[1]);
      if (kind == "disk" && words.size() == 2) return fill_disk(line, words[1]);
      if (kind == "camera" && (words.size() == 2 || words.size() == 3)) return inject_camera(line, words);
      return refusal(
          line,
          "a line is board NAME, camera NAME [SHOT], disk full, disk room, focus PIXELS, stops RED "
          "GREEN BLUE, knock ..., light ..., table ..., status, commands or end",
          "see weft-virtual-rig --help");
    }();
    if (!done) return done.error();
    return std::string("ok");
  }

 private:
  fs::path in_folder(const char* name) const { return folder_.path() / name; }

  Result<void> start_board() {
    auto board = VirtualBoard::start(
        {options_.firmware, in_folder("board"), in_folder("modem"), options_.bootloader_s}, pins_);
    if (!board) return board.error();
    board_ = std::move(*board);
    if (options_.beside.empty()) return {};
    auto beside =
        ForeignDevice::start(in_folder(kBeside), in_folder(kBesideModem), talk_of_foreign(options_.beside));
    if (!beside) return beside.error();
    beside_ = std::move(*beside);
    return {};
  }

  Result<void> start_camera() {
    VirtualCameraOptions camera;
    camera.body = options_.body == simulator::Body::kD80 ? CameraBody::kD80 : CameraBody::kD5100;
    camera.serial = options_.serial;
    camera.size = frames().size();
    camera.clock_offset_s = options_.clock_offset_s;
    camera.port = options_.port;
    camera.shots_before = last_image_number(in_folder(kExposureLog));
    camera.readout_s = options_.readout_s;
    camera.away_s = options_.away_s;
    camera.late_s = options_.late_s;
    camera.finder = [this] { return look(); };
    if (options_.usb) camera.usb = in_folder("camera.sock");
    auto started =
        VirtualCamera::start(camera, [this](const CameraExposure& exposure) { return photograph(exposure); });
    if (!started) return started.error();
    camera_ = std::move(*started);
    return {};
  }

  Result<void> write_files() {
    std::string preload;
    for (const fs::path& library : options_.preloads) {
      preload += (preload.empty() ? "" : ":") + library.string();
    }
    std::string modems = in_folder("modem").string();
    if (beside_) modems += ":" + in_folder(kBesideModem).string();
    environment_ = {"HOME=" + in_folder("home").string(), "WEFT_FULL_DISK=" + in_folder(kFullDisk).string(),
                    "WEFT_TERMINAL_MODEM=" + modems, "WEFT_RIG=" + in_folder("rig.toml").string()};
    if (!preload.empty()) environment_.push_back("LD_PRELOAD=" + preload);
    if (options_.usb) environment_.push_back("WEFT_USB_CAMERAS=" + in_folder("camera.sock").string());
    RigFiles files;
    files.board_port = terminal_port_name(in_folder("board"));
    if (!options_.usb) files.camera_port = fmt::format("ptpip:127.0.0.1:{0}:{0}", camera_->port());
    files.camera_serial = options_.serial;
    files.environment = environment_;
    files.below = options_.below;
    files.polariser = options_.polariser;
    files.is_bare = options_.bare;
    return folder_.write(frames(), table_.rig(), files);
  }

  Result<void> start_control() {
    auto control = ControlSocket::listen(in_folder("control"), [this](const std::string& line) {
      const Result<std::string> answer = command(line);
      return answer ? *answer : "error: " + answer.error().message();
    });
    if (!control) return control.error();
    control_ = std::move(*control);
    return {};
  }

  /// On the camera's thread.
  Result<std::vector<std::uint8_t>> photograph(const CameraExposure& exposure) {
    std::vector<double> pins = lit_shares(pins_, exposure.opened, exposure.closed, kOutputs);
    const double below = pins[kBelowBit], crossed = pins[kPolariserBit];
    const std::shared_ptr<const SceneLight> scene = scene_light();
    pins.resize(static_cast<std::size_t>(scene->frames.leds()));
    GatheredLight light = gathered_light(scene->frames, pins, faults(), exposure);
    if (options_.below) add_light_below(light, below, exposure);
    if (options_.polariser) add_films(light, crossed, scene->matt ? &*scene->matt : nullptr);
    if (options_.same_noise) light.noise_key = lit_mask(light);
    light.stops = stops();
    if (Result<void> ok = log(exposure, pins, light); !ok) return ok.error();
    return develop(scene->frames, light, exposure, options_.serial, options_.render.tiles.threads);
  }

  /// What the finder shows of the last twentieth of a second.
  std::vector<std::uint8_t> look() {
    const RigClock::time_point now = RigClock::now();
    CameraExposure moment;
    moment.opened = now - kLookTime;
    moment.closed = now;
    moment.exposure_us = 5e4;
    moment.iso = 100;
    const std::shared_ptr<const SceneLight> scene = scene_light();
    moment.f_number = scene->frames.scene().camera.f_number;
    moment.image_number = ++looks_;
    const std::vector<double> pins = lit_shares(pins_, moment.opened, moment.closed, scene->frames.leds());
    return live_picture(scene->frames, gathered_light(scene->frames, pins, faults(), moment));
  }

  static std::uint32_t lit_mask(const GatheredLight& light) {
    std::uint32_t mask = 0;
    for (std::size_t k = 0; k < light.leds_s.size(); ++k) mask |= (light.leds_s[k] > 0 ? 1U : 0U) << k;
    return mask;
  }

  /// One write a line, so that lines of a rig that was killed are whole.
  Result<void> log(const CameraExposure& exposure, const std::vector<double>& pins,
                   const GatheredLight& light) const {
    const Json exposed = {{"image_number", exposure.image_number},
                          {"date_time", exposure.date_time},
                          {"milliseconds", exposure.milliseconds},
                          {"exposure_us", exposure.exposure_us},
                          {"iso", exposure.iso},
                          {"f_number", exposure.f_number},
                          {"pin_shares", pins},
                          {"light_s", light.leds_s}};
    const std::string line = exposed.dump() + '\n';
    if (::write(log_, line.data(), line.size()) < 0) return cannot_write(in_folder(kExposureLog), errno);
    return {};
  }

  LightFaults faults() const {
    const std::lock_guard hold(mutex_);
    return faults_;
  }

  StopCounts stops() const {
    const std::lock_guard hold(mutex_);
    return stops_;
  }

  std::shared_ptr<const SceneLight> scene_light() const {
    const std::lock_guard hold(mutex_);
    return light_;
  }

  Result<void> change_focus(const std::string& line, const std::string& word) {
    const std::optional<double> pixels = pixels_in(word);
    if (!pixels) {
      return refusal(line, fmt::format("the blur is 0 to {:g} pixels across", kMostBlur_px),
                     "give a number, 0 for the sharpest that the lens can be");
    }
    const std::lock_guard turn(changing_);
    blur_px_ = *pixels;
    return show(seen_);
  }

  Result<void> change_stops(const std::string& line, const std::vector<std::string>& words) {
    const std::optional<StopCounts> stops = counts_in(words);
    if (!stops) return refusal(line, "channels stop at counts", "give three whole numbers, 0 to 65535");
    const std::lock_guard hold(mutex_);
    stops_ = *stops;
    return {};
  }

  Result<void> change_table(const std::vector<std::string>& words) {
    Result<simulator::Scene> scene = table_.with(words);
    if (!scene) return scene.error();
    scene->camera.body = options_.body;
    const std::lock_guard turn(changing_);
    return show(std::move(*scene));
  }

  Result<void> change_place(const std::vector<std::string>& words) {
    const std::lock_guard turn(changing_);
    const Knocks before = knocks_;
    if (Result<void> ok = knock(knocks_, words, frames().leds()); !ok) return ok;
    Result<void> shown = show(seen_);
    if (!shown) knocks_ = before;
    return shown;
  }

  /// Has the camera see this, by a lens that is focused as it is, from where everything was knocked to. What
  /// the cache lacks is rendered while the rig goes on as it was.
  Result<void> show(simulator::Scene scene) {
    Result<simulator::Scene> from_there = knocked(scene, knocks_);
    if (!from_there) return from_there.error();
    if (blur_px_) {
      from_there->effects.defocus = true;
      from_there->camera.blur.defocus_px = *blur_px_;
    }
    Result<SceneLight> light = light_of(std::move(*from_there), options_);
    if (!light) return light.error();
    seen_ = std::move(scene);
    auto shown = std::make_shared<const SceneLight>(std::move(*light));
    const std::lock_guard hold(mutex_);
    light_ = std::move(shown);
    return {};
  }

  Result<void> change_light(const std::vector<std::string>& words) {
    const std::lock_guard hold(mutex_);
    return change_faults(faults_, words, light_->frames.leds());
  }

  Result<void> inject_board(const std::string& line, const std::string& name) {
    std::vector<std::string_view> names;
    for (const BoardCommand& one : kBoardCommands) {
      names.emplace_back(one.name);
      if (name != one.name) continue;
      board_->inject(one.fault);
      return {};
    }
    return refusal(line, fmt::format("a board may {}", fmt::join(names, ", ")), "choose one of these");
  }

  Result<void> inject_camera(const std::string& line, const std::vector<std::string>& words) {
    const std::optional<int> shot = words.size() == 3 ? shot_of(words[2]) : 1;
    if (!shot) return refusal(line, "shots count from 1, the next one", "give a whole number");
    return camera_->inject({words[1], *shot});
  }

  /// What is loaded into a host looks for the file (virtual_rig/disk).
  Result<void> fill_disk(const std::string& line, const std::string& state) const {
    if (state == "full") return write_file(in_folder(kFullDisk), "");
    if (state != "room") return refusal(line, "a disk is full or has room", "say disk full or disk room");
    std::error_code failed;
    fs::remove(in_folder(kFullDisk), failed);
    return failed ? cannot_write(in_folder(kFullDisk), failed.value()) : Result<void>();
  }

  Json status() const {
    std::vector<int> lit;
    const std::uint16_t mask = pins_.now();
    for (int led = 1; led <= kBelowBit + 1; ++led) {
      if ((mask >> (led - 1) & 1) != 0) lit.push_back(led);
    }
    return {{"shots", camera_->shots()},  {"pins", lit},
            {"light", json_of(faults())}, {"disk_full", is_there(in_folder(kFullDisk))},
            {"leds", frames().leds()},    {"size", {frames().size().width, frames().size().height}},
            {"port", camera_->port()},    {"process", ::getpid()}};
  }

  Result<std::string> end() {
    const std::uint64_t one = 1;
    while (::write(end_, &one, sizeof one) < 0 && errno == EINTR) {
    }
    return std::string("ok");
  }

  VirtualRigOptions options_;
  const RigTable table_;
  std::mutex changing_;            // of blur_px_, knocks_ and seen_: one change at a time
  std::optional<double> blur_px_;  // as the focus ring was turned; else as the scene has it
  Knocks knocks_;
  simulator::Scene seen_;
  std::shared_ptr<const SceneLight> light_;  // of what is seen, under mutex_
  RigFolder folder_;
  LitLog pins_;
  mutable std::mutex mutex_;  // of faults_, stops_ and light_
  LightFaults faults_;
  StopCounts stops_ = {};
  std::vector<std::string> environment_;
  std::uint32_t looks_ = 0;  // of the camera's thread
  int end_ = -1, log_ = -1;
  std::unique_ptr<VirtualBoard> board_;
  std::unique_ptr<ForeignDevice> beside_;
  std::unique_ptr<VirtualCamera> camera_;
  std::unique_ptr<ControlSocket> control_;
};

}  // namespace

Result<std::unique_ptr<VirtualRig>> VirtualRig::start(const VirtualRigOptions& options) {
  simulator::Scene scene = options.scene;
  scene.camera.body = options.body;
  Result<RigFolder> folder = RigFolder::take(options.folder, options.keep_log);
  if (!folder) return folder.error();
  Result<SceneLight> light = light_of(scene, options);
  if (!light) return light.error();
  if (Result<void> ok = check_leds(light->frames); !ok) return ok.error();
  Result<RigTable> table = RigTable::of(scene);
  if (!table) return table.error();
  auto rig = std::make_unique<RunningRig>(options, std::move(*table), std::move(*light), std::move(*folder));
  if (Result<void> ok = rig->start(); !ok) return ok.error();
  return std::unique_ptr<VirtualRig>(std::move(rig));
}

std::vector<CommandWords> virtual_rig_commands() {
  std::vector<CommandWords> all = {
      {"status", "shots, pins that are on, faults, as JSON", "status"},
      {"commands", "these lines, as JSON", "commands"},
      {"end", "ends the rig", "end"},
      {"disk full", "no file of a host of this rig takes any more", "disk full"},
      {"disk room", "ends that", "disk room"},
      {"focus PIXELS", "the focus ring is turned: the picture is blurred by so many raw pixels across",
       "focus 3"},
      {"stops RED GREEN BLUE",
       "the camera's channels stop at these counts, below the white that its files say; 0: at white",
       "stops 15500 15500 15800"}};
  for (const BoardCommand& one : kBoardCommands) {
    const std::string line = fmt::format("board {}", one.name);
    all.push_back({line, one.does, line});
  }
  for (const auto& words : {table_words(), knock_words(), light_fault_words()})
    all.insert(all.end(), words.begin(), words.end());
  for (const auto& [name, does] : camera_faults())
    all.push_back({fmt::format("camera {} [SHOT]", name), does, fmt::format("camera {}", name)});
  return all;
}

}  // namespace weft::virtual_rig
