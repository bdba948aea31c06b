// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/pixel_tables.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "app/server/http/error_reply.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solve/levels/frame.h"
#include "solve/photographs/tile_reader.h"
#include "solver/in_double/pixel.h"
#include "solver/in_double/pixelwise.h"

namespace weft::app {
namespace {

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

Json why(solver::ReadingUse use) {
  switch (use) {
    case solver::ReadingUse::kUsed:
      return nullptr;
    case solver::ReadingUse::kSaturated:
      return "saturated";
    case solver::ReadingUse::kMissing:
      return "missing";
    case solver::ReadingUse::kShadowed:
      return "shadowed";
    case solver::ReadingUse::kRejected:
      return "rejected";
  }
  return nullptr;
}

// Numbers that JSON can hold; null for others.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json names_of(std::uint16_t status) {
  Json names = Json::array();
  for (const StatusName& each : kStatusNames) {
    if ((status & each.bit) != 0) names.push_back(each.name);
  }
  return names;
}

Error changed_since(const std::filesystem::path& session, const char* what) {
  return {ErrorKind::kBadData, "the readings of this solve are no longer there", session.string(), what,
          "solve the session again"};
}

// Which lights these photographs of a session were taken under.
Result<std::vector<int>> lights_of(const std::filesystem::path& folder,
                                   const std::vector<DistantPhotograph>& photographs) {
  const Result<Session> session = read_session(folder);
  if (!session) return session.error();
  std::vector<int> lights;
  for (const DistantPhotograph& photograph : photographs) {
    const auto shot = std::ranges::find(session->shots, photograph.file, &Shot::file);
    if (shot == session->shots.end()) return changed_since(folder, "its photographs are others");
    lights.push_back(shot->led);
  }
  return lights;
}

constexpr std::chrono::minutes kHeld(2);
constexpr int kReaders = 2;  // threads: a scan may run beside

}  // namespace

Result<std::unique_ptr<PixelTable>> PixelTable::read(const std::filesystem::path& session,
                                                     const SolveFacts& solve, const JobContext& context) {
  solve::SessionOptions options;
  options.folder = session;
  const SolveInput input = solve.input.value_or(SolveInput());
  for (const SolvedShot& shot : input.shots) {
    if (shot.led > 0 && std::ranges::find(options.leds, shot.led) == options.leds.end())
      options.leds.push_back(shot.led);
  }
  if (!input.photographs.empty()) {
    Result<std::vector<int>> lights = lights_of(session, input.photographs);
    if (!lights) return std::move(lights).error();
    options.leds = std::move(*lights);
  }
  if (options.leds.empty())
    return Error{ErrorKind::kBadData, "the solve has no readings", session.string(),
                 "it was not made from a session", "ask a solve of a session"};
  Result<solve::SolvePlan> plan = solve::plan_session(options);
  if (!plan) return std::move(plan).error();
  if (plan->input.calibration != input.calibration)
    return changed_since(session, "it was solved with another calibration than the session has");
  if (plan->input.shots != input.shots || plan->input.photographs != input.photographs)
    return changed_since(session, "its shots are others");

  Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return std::move(loaded).error();
  std::unique_ptr<PixelTable> table(new PixelTable);
  table->method_ = solve.method;
  table->photographs_ = std::move(*loaded);
  table->whole_shots_ = table->photographs_.conditions.facts.left_out;
  std::vector<std::size_t> moved;
  for (const RegisteredShot& shot : solve.registration.value_or(std::vector<RegisteredShot>())) {
    const std::vector<int>& leds = table->photographs_.leds;
    const auto led = std::ranges::find(leds, shot.led);
    if (!shot.is_corrected || led == leds.end()) continue;
    moved.push_back(static_cast<std::size_t>(led - leds.begin()));
    table->whole_shots_.push_back({*led, "moved"});
  }
  if (Result<void> ok = solve::leave_out(moved, table->photographs_); !ok) return std::move(ok).error();
  if (table->photographs_.size != solve.size) {
    Result<solve::Photographs> half = solve::half_size(table->photographs_, context.threads);
    if (!half) return std::move(half).error();
    table->photographs_ = std::move(*half);
  }
  if (table->photographs_.size != solve.size) return changed_since(session, "its frames have another size");
  return table;
}

Json PixelTable::at(int x, int y) const {
  const int x0 = x / kRowGroup * kRowGroup;
  const Rect around = {x0, y, std::min(x0 + kRowGroup, photographs_.size.width), y + 1};
  solve::TileReader reader(photographs_, {.width = kRowGroup, .height = 1});
  const solver::TileInput input = reader.read(around);
  std::vector<solver::PixelRow> rows(input.field->count());
  solver::read_pixel(input, x - x0, 0, rows);
  solver::PixelOptions options = solver::pixel_options_of(method_);
  options.planes = input.planes;
  options.noise = input.noise;
  options.plane_weights = input.plane_weights;
  std::vector<solver::ReadingStory> stories(rows.size());
  const solver::PixelSolution solution = solver::PixelSolver(options).explain(rows, stories);

  const solve::Mosaics* mosaics = photographs_.mosaics();
  Json readings = Json::array();
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const solver::ReadingStory& story = stories[k];
    const Vec3 l = rows[k].direction;
    const bool is_used = story.use == solver::ReadingUse::kUsed;
    const int led = k < photographs_.leds.size() ? photographs_.leds[k] : static_cast<int>(k) + 1;
    readings.push_back({{"led", led},
                        {"counts", mosaics != nullptr ? Json(mosaics->frames[k].counts(x, y)) : Json()},
                        {"reading", number(story.reading)},
                        {"model", number(story.predicted)},
                        {"sigma", number(story.sigma)},
                        {"residual_sigma",
                         story.sigma > 0 ? number((story.reading - story.predicted) / story.sigma) : Json()},
                        {"used", is_used},
                        {"left_out", why(story.use)},
                        {"light_dir", {l.x, l.y, l.z}},
                        {"strength", rows[k].strength[input.planes == 1 ? 0 : 1]}});
  }
  for (const UnusedLed& shot : whole_shots_)
    readings.push_back({{"led", shot.led}, {"used", false}, {"left_out", shot.why}});
  Json albedo = Json::array();
  for (int p = 0; p < input.planes; ++p)
    albedo.push_back(number(solution.albedo[static_cast<std::size_t>(p)]));
  const Vec3 n = solution.normal;
  const bool is_mosaic = input.planes == 1;
  return {
      {"x", x},
      {"y", y},
      {"channel", is_mosaic ? Json(kChannels[static_cast<std::size_t>(input.cfa.channel_at(x, y))]) : Json()},
      {"counts_dark", mosaics != nullptr && mosaics->dark ? Json(mosaics->dark->counts(x, y)) : Json()},
      {"solved",
       {{"normal", {n.x, n.y, n.z}},
        {"albedo", std::move(albedo)},
        {"sigma_normal_deg", number(solution.sigma_normal_deg)},
        {"residual", number(solution.residual)},
        {"status", names_of(solution.status)}}},
      {"readings", std::move(readings)}};
}

PixelTables::PixelTables() : thread_([this](const std::stop_token& stop) { run(stop); }) {}

PixelTables::~PixelTables() = default;

Result<std::optional<Json>> PixelTables::at(const std::filesystem::path& session, const SolveFacts& solve,
                                            int x, int y) {
  if (x < 0 || y < 0 || x >= solve.size.width || y >= solve.size.height)
    return Error{ErrorKind::kNoInput, "the place is outside the maps", "", "",
                 "see the solve for their size"};
  std::shared_ptr<const PixelTable> table;
  {
    const std::lock_guard lock(mutex_);
    asked_ = std::chrono::steady_clock::now();
    const bool is_there = id_ == solve.id;
    if (is_there && error_) {
      id_.clear();
      return *std::exchange(error_, std::nullopt);
    }
    if (!is_there || table_ == nullptr) {
      wanted_ = Wanted{session, solve};
      changed_.notify_all();
      return std::optional<Json>();
    }
    table = table_;
  }
  return std::optional(table->at(x, y));
}

void PixelTables::run(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (!changed_.wait_for(lock, stop, std::chrono::seconds(5), [&] { return wanted_.has_value(); })) {
      if (std::chrono::steady_clock::now() - asked_ > kHeld) table_.reset();
      continue;
    }
    const Wanted wanted = *std::exchange(wanted_, std::nullopt);
    if (id_ == wanted.solve.id && table_ != nullptr) continue;
    table_.reset();  // before others are read: both may be large
    error_.reset();
    id_.clear();
    lock.unlock();
    Result<std::unique_ptr<PixelTable>> read = [&]() -> Result<std::unique_ptr<PixelTable>> {
      try {
        return PixelTable::read(wanted.session, wanted.solve, {.threads = kReaders, .stop = stop});
      } catch (const std::exception& thrown) {
        return error_of_exception(thrown, wanted.session.string());
      }
    }();
    lock.lock();
    id_ = wanted.solve.id;
    if (read) {
      table_ = std::move(*read);
    } else {
      error_ = read.error();
    }
  }
}

}  // namespace weft::app
