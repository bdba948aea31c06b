// SPDX-License-Identifier: Apache-2.0
#include "material/finish/lock_in.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <deque>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"
#include "material/cubic.h"
#include "material/smooth_map.h"

namespace weft::material {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kWaves = 6;
constexpr int kHarmonics = 6, kReference_px = 512;
constexpr double kFinest = 0.35;  ///< cycles a pixel
constexpr int kNodesInSigma = 4;
// The low pass flattens bends; the second round sees only what the first one left of them.
constexpr int kRounds = 3;

// A wave of the lattice, and what the slopes at the frame's centre hold of it.
struct Wave {
  Vec2 cycles;  ///< a pixel
  std::array<Complex, 2> reference;
  double power = 0;
};

Vec2 from_centre(Size frame, double x, double y) {
  return {x - (frame.width - 1) / 2.0, (frame.height - 1) / 2.0 - y};
}

double slope_at(const Surface& surface, int x, int y, int channel) {
  return (surface.status(x, y) & kNoSolution) != 0 ? 0 : static_cast<double>(surface.slope(x, y, channel));
}

// exp(-2 pi i cycles . place) along a row, without a sine for each pixel.
class Phasor {
 public:
  Phasor(Vec2 cycles, Vec2 place, Vec2 step = {1, 0})
      : value_(std::polar(1.0, -2 * kPi * dot(cycles, place))),
        step_(std::polar(1.0, -2 * kPi * dot(cycles, step))) {}
  Complex next() {
    const Complex here = value_;
    value_ *= step_;
    return here;
  }

 private:
  Complex value_, step_;
};

Size nodes_of(Size frame, int step) {
  return {(frame.width + step - 1) / step, (frame.height + step - 1) / step};
}

double hann(int i, int n) {
  const double s = std::sin(kPi * (i + 0.5) / n);
  return s * s;
}

void take_reference(const Surface& surface, Wave& wave) {
  const Size size = surface.size();
  const int w = std::min(size.width, kReference_px), h = std::min(size.height, kReference_px);
  const int x0 = (size.width - w) / 2, y0 = (size.height - h) / 2;
  for (int y = 0; y < h; ++y) {
    Phasor phasor(wave.cycles, from_centre(size, x0, y0 + y));
    std::array<Complex, 2> row = {};
    for (int x = 0; x < w; ++x) {
      const Complex turned = hann(x, w) * phasor.next();
      for (int c = 0; c < 2; ++c)
        row[static_cast<std::size_t>(c)] += slope_at(surface, x0 + x, y0 + y, c) * turned;
    }
    for (std::size_t c = 0; c < 2; ++c) wave.reference[c] += hann(y, h) * row[c];
  }
  for (Complex& each : wave.reference) each /= static_cast<double>(w) * h / 4;
  wave.power = std::norm(wave.reference[0]) + std::norm(wave.reference[1]);
}

std::vector<Wave> strongest_waves(const Surface& surface, const Cell& weave, int threads) {
  const Vec2 along_a = (1 / weave.area()) * Vec2{weave.b.y, -weave.b.x},
             along_b = (1 / weave.area()) * Vec2{-weave.a.y, weave.a.x};
  std::vector<Wave> waves;
  for (int v = 0; v <= kHarmonics; ++v) {
    for (int u = v == 0 ? 1 : -kHarmonics; u <= kHarmonics; ++u) {
      const Vec2 cycles = u * along_a + v * along_b;
      if (length(cycles) < kFinest) waves.push_back({cycles, {}, 0});
    }
  }
  parallel_for(waves.size(), threads, [&](std::size_t i, int) { take_reference(surface, waves[i]); });
  std::ranges::stable_sort(waves, [](const Wave& a, const Wave& b) { return a.power > b.power; });
  waves.resize(std::min(waves.size(), kWaves));
  return waves;
}

// The wave's part of the slopes around each node, real and imaginary part, where the cloth is pulled by
// `known`: what remains is the phase of what is not known yet.
Image<float> demodulated(const Surface& surface, const Wave& wave, const Displacement& known, int step,
                         double sigma_px, int threads) {
  const Size size = surface.size();
  Image<float> nodes(nodes_of(size, step), 2);
  const std::array<Complex, 2> against = {std::conj(wave.reference[0]), std::conj(wave.reference[1])};
  parallel_for(static_cast<std::size_t>(nodes.height()), threads, [&](std::size_t row, int) {
    const int j = static_cast<int>(row), y1 = std::min((j + 1) * step, size.height);
    std::vector<Complex> sums(static_cast<std::size_t>(nodes.width()));
    for (int y = j * step; y < y1; ++y) {
      Vec2 place = from_centre(size, 0, y), lattice = place + known.at(place);
      for (int i = 0; i < nodes.width(); ++i) {
        // The displacement is as good as linear between nodes.
        const Vec2 next = place + Vec2{static_cast<double>(step), 0}, lattice_next = next + known.at(next);
        Phasor phasor(wave.cycles, lattice, (1.0 / step) * (lattice_next - lattice));
        for (int x = i * step; x < std::min((i + 1) * step, size.width); ++x) {
          const Complex turned = phasor.next();
          sums[static_cast<std::size_t>(i)] +=
              (slope_at(surface, x, y, 0) * against[0] + slope_at(surface, x, y, 1) * against[1]) * turned;
        }
        place = next;
        lattice = lattice_next;
      }
    }
    for (int i = 0; i < nodes.width(); ++i) {
      const Complex sum = sums[static_cast<std::size_t>(i)] / (static_cast<double>(step) * step * wave.power);
      nodes(i, j, 0) = static_cast<float>(sum.real());
      nodes(i, j, 1) = static_cast<float>(sum.imag());
    }
  });
  for (int p = 0; p < 2; ++p) smooth(nodes.plane(p), sigma_px / step, threads);
  return nodes;
}

// The displacement at a node that is closest to `predicted` among those that the phases allow.
Vec2 displacement_at(const std::vector<Wave>& waves, const std::vector<Image<float>>& parts, int i, int j,
                     Vec2 predicted) {
  // Where the weave is not seen at all the prediction stands.
  constexpr double kHold = 1e-3;
  double xx = 0, xy = 0, yy = 0, all = 0;
  Vec2 right;
  for (std::size_t k = 0; k < waves.size(); ++k) {
    const Complex part = {static_cast<double>(parts[k](i, j, 0)), static_cast<double>(parts[k](i, j, 1))};
    const Vec2 f = waves[k].cycles;
    const double turns = std::arg(part) / (2 * kPi) - dot(f, predicted), off = turns - std::round(turns);
    const double weight = waves[k].power * std::abs(part);
    xx += weight * f.x * f.x;
    xy += weight * f.x * f.y;
    yy += weight * f.y * f.y;
    right = right + weight * off * f;
    all += waves[k].power * dot(f, f);
  }
  xx += kHold * all;
  yy += kHold * all;
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 0)) return predicted;
  return predicted + (1 / determinant) * Vec2{yy * right.x - xy * right.y, xx * right.y - xy * right.x};
}

// Node after node from the centre outwards, each predicted from its neighbours that are known.
Image<float> followed(const std::vector<Wave>& waves, const std::vector<Image<float>>& parts) {
  const Size size = parts[0].size();
  Image<float> field(size, 2);
  Image<std::uint8_t> state(size);  // 1 waits, 2 is known
  const std::array<std::array<int, 2>, 4> beside = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  const auto is_inside = [&](int i, int j) { return i >= 0 && j >= 0 && i < size.width && j < size.height; };
  std::deque<std::array<int, 2>> queue = {{size.width / 2, size.height / 2}};
  state(size.width / 2, size.height / 2) = 1;
  while (!queue.empty()) {
    const auto [i, j] = queue.front();
    queue.pop_front();
    Vec2 predicted;
    int known = 0;
    for (const auto& [di, dj] : beside) {
      if (!is_inside(i + di, j + dj)) continue;
      std::uint8_t& other = state(i + di, j + dj);
      if (other == 2) {
        predicted = predicted + Vec2{field(i + di, j + dj, 0), field(i + di, j + dj, 1)};
        ++known;
      } else if (other == 0) {
        other = 1;
        queue.push_back({i + di, j + dj});
      }
    }
    const Vec2 found = displacement_at(waves, parts, i, j, known > 0 ? (1.0 / known) * predicted : Vec2{});
    field(i, j, 0) = static_cast<float>(found.x);
    field(i, j, 1) = static_cast<float>(found.y);
    state(i, j) = 2;
  }
  return field;
}

void add(const Image<float>& more, Image<float>& field) {
  for (int p = 0; p < field.planes(); ++p) {
    for (int y = 0; y < field.height(); ++y) {
      for (int x = 0; x < field.width(); ++x) field(x, y, p) += more(x, y, p);
    }
  }
}

}  // namespace

Displacement::Displacement(Image<float> field, int step, Size frame)
    : field_(std::move(field)), step_(step), frame_(frame) {}

Vec2 Displacement::at(Vec2 place) const {
  if (field_.empty()) return {};
  const auto node = [&](double px, int count) {
    return std::clamp((px - (step_ - 1) / 2.0) / step_, 0.0, count - 1.0);
  };
  const double x = node(place.x + (frame_.width - 1) / 2.0, field_.width()),
               y = node((frame_.height - 1) / 2.0 - place.y, field_.height());
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  Vec2 sum;
  for (int l = -1; l <= 2; ++l) {
    for (int k = -1; k <= 2; ++k) {
      const int column = std::clamp(i + k, 0, field_.width() - 1),
                row = std::clamp(j + l, 0, field_.height() - 1);
      sum = sum + cubic_weight(i + k - x) * cubic_weight(j + l - y) *
                      Vec2{field_(column, row, 0), field_(column, row, 1)};
    }
  }
  return sum;
}

Displacement lock_in(const Surface& surface, const Cell& weave, double sigma_px, int threads) {
  const int step = std::max(1, static_cast<int>(sigma_px / kNodesInSigma));
  const std::vector<Wave> waves = strongest_waves(surface, weave, threads);
  if (waves.empty()) return {};
  Displacement known;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Image<float>> parts;
    for (const Wave& wave : waves)
      parts.push_back(demodulated(surface, wave, known, step, sigma_px, threads));
    Image<float> field = followed(waves, parts);
    if (round > 0) add(known.field(), field);
    known = {std::move(field), step, surface.size()};
  }
  return known;
}

}  // namespace weft::material
