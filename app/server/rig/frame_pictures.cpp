// SPDX-License-Identifier: Apache-2.0
#include "app/server/rig/frame_pictures.h"

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "app/server/http/error_reply.h"
#include "capture/frames/raw_picture.h"
#include "capture/raw/decode_raw.h"
#include "capture/scan/histogram.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/image_io/linear_image.h"
#include "core/rig/calibration.h"
#include "report/downsampler.h"
#include "report/preview.h"

namespace weft::app {
namespace {

constexpr int kThumbnailSide = 320;
constexpr std::size_t kMostWanted = 64;   // frames of a few sessions
constexpr std::size_t kMostWaiting = 24;  // threads that stand still for a picture, of the server's 64
constexpr std::size_t kMostBytes = std::size_t{4} << 20;

bool is_digest(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Removes all but the newest `most` frames of a folder.
void prune(const std::filesystem::path& folder, std::size_t most) {
  std::error_code error;
  std::map<std::string, std::filesystem::file_time_type> written;  // by digest
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    auto& newest = written[entry.path().stem().string()];
    newest = std::max(newest, entry.last_write_time(error));
  }
  std::vector<std::pair<std::filesystem::file_time_type, std::string>> frames;
  for (const auto& [digest, time] : written) frames.emplace_back(time, digest);
  std::ranges::sort(frames, std::greater{});
  for (std::size_t i = most; i < frames.size(); ++i) {
    // First the one that says that both are there.
    for (const char* ending : {".json", ".png"})
      std::filesystem::remove(folder / (frames[i].second + ending), error);
  }
}

Image<float> reduced(Image<float> picture) {
  report::Downsampler averages(picture.size(), 3, kThumbnailSide);
  std::vector<View<const float>> planes;
  for (int c = 0; c < 3; ++c) {
    const View<float> plane = picture.plane(c);
    for (int y = 0; y < plane.height(); ++y) {
      for (float& v : std::span(plane.row(y), static_cast<std::size_t>(plane.width()))) v = std::min(v, 1.0F);
    }
    planes.emplace_back(plane);
  }
  averages.add_rows(planes);
  Image<float> small(averages.averages().size(), 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < small.height(); ++y) {
      std::copy_n(averages.averages().plane(c).row(y), small.width(), small.plane(c).row(y));
    }
  }
  return small;
}

/// What makes the picture grey on average; of a frame without light that would only colour its noise.
std::array<float, 3> grey_gains(const Image<float>& picture) {
  std::array<double, 3> mean = {};
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x)
        mean[static_cast<std::size_t>(c)] += std::max(0.0F, picture(x, y, c));
    }
    mean[static_cast<std::size_t>(c)] /= static_cast<double>(picture.size().pixels());
  }
  std::array<float, 3> gains = {1, 1, 1};
  for (std::size_t c = 0; c < 3 && mean[1] > 1e-3; ++c) {
    gains[c] = static_cast<float>(std::clamp(mean[1] / std::max(mean[c], 1e-6), 0.5, 4.0));
  }
  return gains;
}

void encode(Image<float>& picture, const std::array<float, 3>& gains) {
  for (int c = 0; c < 3; ++c) {
    const float gain = gains[static_cast<std::size_t>(c)];
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) {
        picture(x, y, c) = report::srgb_from_linear(gain * picture(x, y, c));
      }
    }
  }
}

struct SmallFrame {
  Image<float> picture;
  HistogramRgb histogram;
};

Result<SmallFrame> small_raw(const FrameFile& frame, const std::filesystem::path& calibration) {
  const Result<RawFrame> raw = capture::decode_raw(frame.file);
  if (!raw) return raw.error();
  SmallFrame small = {reduced(capture::half_size_picture(*raw, Response{})),
                      frame.histogram ? *frame.histogram : capture::histogram_rgb(*raw)};
  const std::optional<std::array<float, 3>> white = frame_gains(frame.file, calibration);
  encode(small.picture, white ? *white : grey_gains(small.picture));
  return small;
}

// A photograph that somebody developed has its colours, and no counts.
Result<SmallFrame> small_photograph(const std::filesystem::path& file) {
  Result<Image<float>> read = read_linear_image(file, Transfer::kAuto, Clipped::kKeep);
  if (!read) return std::move(read).error();
  SmallFrame small = {reduced(std::move(*read)), {}};
  encode(small.picture, {1, 1, 1});
  return small;
}

}  // namespace

std::optional<std::array<float, 3>> frame_gains(const std::filesystem::path& frame,
                                                const std::filesystem::path& calibration) {
  for (const auto& folder : {frame.parent_path().parent_path() / "calibration", calibration}) {
    const Result<Calibration> known = read_calibration(folder);
    const auto gains = known && known->lights ? white_gains(*known->lights) : std::nullopt;
    if (gains)
      return std::array{static_cast<float>((*gains)[0]), static_cast<float>((*gains)[1]),
                        static_cast<float>((*gains)[2])};
  }
  return std::nullopt;
}

Json to_json(const HistogramRgb& histogram) {
  constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
  Json json = Json::object();
  for (std::size_t c = 0; c < 3; ++c) {
    json[kChannels[c]] = {{"bins", histogram[c].bins}, {"clipped", histogram[c].clipped}};
  }
  return json;
}

FramePictures::FramePictures(std::filesystem::path folder, std::size_t most, CalibrationFolder calibration)
    : folder_(std::move(folder)), most_(most), calibration_(std::move(calibration)) {
  prune(folder_, most_);
  thread_ = std::thread([this] { run(); });
}

FramePictures::~FramePictures() {
  stop();
  thread_.join();
}

void FramePictures::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

void FramePictures::prepare(FrameFile frame) {
  {
    const std::lock_guard lock(mutex_);
    if (wanted_.size() >= kMostWanted) return;
    wanted_.push_back(std::move(frame));
  }
  changed_.notify_all();
}

Result<std::string> FramePictures::thumbnail(const FrameFile& frame) {
  if (Result<void> made = make(frame); !made) return std::move(made).error();
  return read_text(path_of(frame, ".png"), kMostBytes);
}

Result<Json> FramePictures::histogram(const FrameFile& frame) {
  if (Result<void> made = make(frame); !made) return std::move(made).error();
  if (auto histogram = ready_histogram(frame)) return std::move(*histogram);
  return Error{ErrorKind::kTryAgain, "the histogram is gone", frame.file.string(),
               "its folder was emptied meanwhile", "ask again"};
}

std::optional<Json> FramePictures::ready_histogram(const FrameFile& frame) const {
  if (!is_digest(frame.sha256)) return std::nullopt;
  const Result<std::string> text = read_text(path_of(frame, ".json"), kMostBytes);
  Json document = text ? Json::parse(*text, nullptr, false) : Json();
  return document.is_object() ? std::optional(std::move(document)) : std::nullopt;
}

std::filesystem::path FramePictures::path_of(const FrameFile& frame, const char* ending) const {
  return folder_ / (frame.sha256 + ending);
}

Result<void> FramePictures::make(const FrameFile& frame) {
  if (!is_digest(frame.sha256)) {
    return Error{ErrorKind::kBadData, "the frame has no digest", frame.file.string(), "",
                 "check the session's session.json"};
  }
  std::unique_lock lock(mutex_);
  if (is_there(path_of(frame, ".json"))) return {};
  if (waiting_ >= kMostWaiting) {
    return Error{ErrorKind::kTryAgain, "too many pictures are being made", frame.file.string(), "",
                 "ask again in a second"};
  }
  ++waiting_;
  changed_.wait(lock, [&] { return stopping_ || !making_; });
  --waiting_;
  if (stopping_) return Error{ErrorKind::kInterrupted, "interrupted", "", "the daemon is ending", ""};
  if (is_there(path_of(frame, ".json"))) return {};
  making_ = true;
  lock.unlock();
  Result<void> made = make_files(frame);
  if (made && ++made_ > most_ / 10) {
    prune(folder_, most_);
    made_ = 0;
  }
  lock.lock();
  making_ = false;
  changed_.notify_all();
  return made;
}

Result<void> FramePictures::make_files(const FrameFile& frame) try {
  const Result<SmallFrame> small =
      is_linear_image(frame.file) ? small_photograph(frame.file) : small_raw(frame, calibration_());
  if (!small) return small.error();
  const Image<float>& picture = small->picture;
  if (Result<void> made = make_writable_folder(folder_); !made) return made;
  const std::vector<View<const float>> planes = {picture.plane(0), picture.plane(1), picture.plane(2)};
  WriteOptions options;
  options.type = SampleType::kUint8;
  if (Result<void> ok = write_image(path_of(frame, ".png"), planes, {"R", "G", "B"}, options); !ok) return ok;
  // The last of the two: where it is, both are.
  return write_file(path_of(frame, ".json"), to_json(small->histogram).dump());
} catch (const std::exception& thrown) {
  return error_of_exception(thrown, frame.file.string());
}

void FramePictures::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || !wanted_.empty(); });
    if (stopping_) return;
    const FrameFile frame = std::move(wanted_.front());
    wanted_.pop_front();
    lock.unlock();
    // Why a picture cannot be made is said to whoever asks for it, not here.
    static_cast<void>(make(frame).has_value());
    lock.lock();
  }
}

}  // namespace weft::app
