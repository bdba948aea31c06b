// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/forecast.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "bench/sanity/drawn_cloth.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::bench {
namespace {

using Eigen::ArrayXd, Eigen::ArrayXXd, Eigen::MatrixXd, Eigen::VectorXd;
using solver::kBlockFacts;

constexpr std::size_t kNetworks = 4, kNeurons = ErrorNetwork::kHidden / kNetworks;
constexpr int kSteps = 1500;
constexpr double kRate = 0.01, kDecay = 1e-3, kMostMisfit = 0.7, kLeastScatter = 0.05;
constexpr double kLeastError_deg = 1e-3, kLeastFactor = 0.2, kMostFactor = 12;
constexpr auto kInputs = static_cast<Eigen::Index>(kBlockFacts);

// Blocks in columns: facts over their scatter and a one, and what they are to come to.
struct Lesson {
  MatrixXd inputs;
  ArrayXd model2, other2, log_rms, weight;
  VectorXd mean, scatter;
};

Lesson lesson_of(const std::vector<BlockError>& blocks) {
  const auto n = static_cast<Eigen::Index>(blocks.size());
  Lesson lesson = {MatrixXd(kInputs + 1, n), ArrayXd(n), ArrayXd(n), ArrayXd(n), ArrayXd(n), {}, {}};
  for (Eigen::Index i = 0; i < n; ++i) {
    const BlockError& block = blocks[static_cast<std::size_t>(i)];
    for (Eigen::Index f = 0; f < kInputs; ++f)
      lesson.inputs(f, i) = static_cast<double>(block.facts[static_cast<std::size_t>(f)]);
    lesson.model2(i) = std::exp(2 * static_cast<double>(block.facts[solver::kLogModel]));
    lesson.other2(i) = block.other2;
    lesson.log_rms(i) = std::log(std::max(block.error_deg, kLeastError_deg) / solver::kMeanOfRms);
    lesson.weight(i) = block.weight;
  }
  lesson.weight /= lesson.weight.sum();
  const auto facts = lesson.inputs.topRows(kInputs);
  lesson.mean = facts.rowwise().mean();
  lesson.scatter =
      ((facts.colwise() - lesson.mean).array().square().rowwise().mean().sqrt()).max(kLeastScatter).matrix();
  lesson.inputs.topRows(kInputs) =
      ((facts.colwise() - lesson.mean).array().colwise() / lesson.scatter.array()).matrix();
  lesson.inputs.row(kInputs).setOnes();
  return lesson;
}

// Weights with what Adam remembers of them.
struct Learned {
  MatrixXd value, mean, square;

  explicit Learned(MatrixXd first)
      : value(std::move(first)),
        mean(MatrixXd::Zero(value.rows(), value.cols())),
        square(MatrixXd::Zero(value.rows(), value.cols())) {}

  void step(const MatrixXd& gradient, double rate, int t) {
    constexpr double kOfMean = 0.9, kOfSquare = 0.999;
    mean = kOfMean * mean + (1 - kOfMean) * gradient;
    square = kOfSquare * square + (1 - kOfSquare) * gradient.cwiseAbs2();
    const double m = 1 - std::pow(kOfMean, t), s = 1 - std::pow(kOfSquare, t);
    value.array() -= rate * (mean.array() / m) / ((square.array() / s).sqrt() + 1e-9);
  }
};

struct Network {
  MatrixXd hidden;  // by neuron: weights and bias
  VectorXd sum;     // and bias
};

Network learn(const Lesson& lesson, std::uint32_t seed) {
  Draws draws(seed);
  const auto neurons = static_cast<Eigen::Index>(kNeurons);
  const auto drawn = [&](double scatter) { return scatter * draws.normal(); };
  const double first = 1 / std::sqrt(static_cast<double>(kInputs));
  Learned hidden(MatrixXd::NullaryExpr(neurons, kInputs + 1, [&](Eigen::Index, Eigen::Index column) {
    return column < kInputs ? drawn(first) : 0.0;
  }));
  Learned sum(MatrixXd::NullaryExpr(
      neurons + 1, 1, [&](Eigen::Index row, Eigen::Index) { return row < neurons ? drawn(0.1) : 0.0; }));
  for (int t = 1; t <= kSteps; ++t) {
    const MatrixXd fired = (hidden.value * lesson.inputs).array().tanh().matrix();
    const ArrayXd log_factor =
        (fired.transpose() * sum.value.topRows(neurons)).array() + sum.value(neurons, 0);
    const ArrayXd model2 = (2 * log_factor.min(4.0).max(-4.0)).exp() * lesson.model2;
    const ArrayXd all2 = model2 + lesson.other2;
    const ArrayXd misfit = 0.5 * all2.log() - lesson.log_rms;
    const ArrayXd slope = misfit.min(kMostMisfit).max(-kMostMisfit) * lesson.weight * model2 / all2;
    MatrixXd of_sum(neurons + 1, 1), decays = kDecay * hidden.value;
    of_sum.topRows(neurons) = fired * slope.matrix() + kDecay * sum.value.topRows(neurons);
    of_sum(neurons, 0) = slope.sum();
    decays.col(kInputs).setZero();
    const MatrixXd back =
        ((sum.value.topRows(neurons) * slope.matrix().transpose()).array() * (1 - fired.array().square()))
            .matrix();
    const double rate = kRate * (0.5 * (1 + std::cos(kPi * t / kSteps)) + 0.01);
    hidden.step(back * lesson.inputs.transpose() + decays, rate, t);
    sum.step(of_sum, rate, t);
  }
  return {hidden.value, sum.value.col(0)};
}

// What one solve erred by in the mean, over what was foretold.
struct Told {
  std::string quality;
  double error = 0, by_formula = 0, by_learned = 0;
};

double foretold(const BlockError& block, double log_factor) {
  const double factor = std::clamp(std::exp(log_factor), kLeastFactor, kMostFactor);
  const double model = factor * std::exp(static_cast<double>(block.facts[solver::kLogModel]));
  return solver::kMeanOfRms * std::sqrt(model * model + block.other2);
}

Json row_of(const std::string& quality, const std::vector<Told>& solves) {
  Json row = {{"quality", quality}, {"solves", solves.size()}};
  for (const auto& [name, told] :
       {std::pair{"formula", &Told::by_formula}, std::pair{"learned", &Told::by_learned}}) {
    double within_1_3 = 0, within_2 = 0, over_3 = 0, worst = 0;
    const auto n = static_cast<double>(solves.size());
    for (const Told& solve : solves) {
      const double ratio = solve.error / (solve.*told), off = std::abs(std::log(ratio));
      within_1_3 += off <= std::log(1.3) ? 1 / n : 0;
      within_2 += off <= std::log(2.0) ? 1 / n : 0;
      over_3 += ratio > 3 ? 1 / n : 0;
      worst = std::max(worst, ratio);
    }
    row[fmt::format("{}_within_1.3", name)] = within_1_3;
    row[fmt::format("{}_within_2", name)] = within_2;
    row[fmt::format("{}_over_3", name)] = over_3;
    row[fmt::format("{}_worst", name)] = worst;
  }
  return row;
}

Result<std::vector<BlockError>> read_all(const std::vector<std::filesystem::path>& files) {
  std::vector<BlockError> all;
  for (const std::filesystem::path& file : files) {
    Result<std::vector<BlockError>> read = read_blocks(file);
    if (!read) return read;
    std::ranges::move(*read, std::back_inserter(all));
  }
  return all;
}

}  // namespace

ErrorNetwork teach(const std::vector<BlockError>& blocks, std::uint64_t seed) {
  const Lesson lesson = lesson_of(blocks);
  ErrorNetwork forecast;
  for (std::size_t f = 0; f < kBlockFacts; ++f) {
    forecast.mean[f] = lesson.mean(static_cast<Eigen::Index>(f));
    forecast.scatter[f] = lesson.scatter(static_cast<Eigen::Index>(f));
  }
  for (std::size_t i = 0; i < kNetworks; ++i) {
    const Network network = learn(lesson, static_cast<std::uint32_t>(seed + i));
    for (std::size_t neuron = 0; neuron < kNeurons; ++neuron) {
      const auto row = static_cast<Eigen::Index>(neuron);
      for (std::size_t f = 0; f <= kBlockFacts; ++f)
        forecast.hidden[i * kNeurons + neuron][f] = network.hidden(row, static_cast<Eigen::Index>(f));
      forecast.sum[i * kNeurons + neuron] = network.sum(row) / static_cast<double>(kNetworks);
    }
    forecast.sum[ErrorNetwork::kHidden] +=
        network.sum(network.sum.size() - 1) / static_cast<double>(kNetworks);
  }
  return forecast;
}

Result<Rows> forecast_table(const ForecastOptions& asked, const StudyOptions& options) {
  const Result<std::vector<BlockError>> lessons = read_all(asked.taught_on), held = read_all(asked.held);
  if (!lessons) return lessons.error();
  if (!held) return held.error();
  const ErrorNetwork learned = teach(*lessons, options.seed);
  std::map<std::string, Told> solves;
  for (const BlockError& block : *held) {
    Told& told = solves[block.solve];
    told.quality = block.quality;
    told.error += block.pixels * block.error_deg;
    told.by_formula += block.pixels * foretold(block, 0);
    told.by_learned += block.pixels * foretold(block, learned.log_factor(block.facts));
  }
  Rows rows;
  for (const solver::MethodName& level : solver::method_names()) {
    std::vector<Told> of_level;
    for (const auto& [name, told] : solves) {
      if (told.quality == level.name) of_level.push_back(told);
    }
    if (!of_level.empty()) rows.push_back(row_of(level.name, of_level));
  }
  return rows;
}

}  // namespace weft::bench
