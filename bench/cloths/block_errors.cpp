// SPDX-License-Identifier: Apache-2.0
#include "bench/cloths/block_errors.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/base/vec.h"
#include "core/image_io/solve_maps.h"
#include "core/solve/solve_record.h"

namespace weft::bench {
namespace {

constexpr int kBlock = 64;
constexpr double kFewestPixels = 200;

struct Sum {
  double error = 0, other2 = 0, pixels = 0;
};

// By block, row by row.
Result<std::vector<Sum>> sums_of(const std::filesystem::path& solve, const Image<float>& truth) {
  const Result<SolveMaps> maps = SolveMaps::open(solve);
  if (!maps) return maps.error();
  const Result<LoadedImage> normal = maps->normal(), sigma = maps->sigma();
  const Result<Image<std::uint16_t>> status = maps->status();
  if (!normal) return normal.error();
  if (!sigma) return sigma.error();
  if (!status) return status.error();
  const Size size = maps->size();
  const int scale = truth.width() / size.width, columns = (size.width + kBlock - 1) / kBlock;
  const View<const float> n[3] = {normal->channel("X"), normal->channel("Y"), normal->channel("Z")};
  const View<const float> all = sigma->channel("normal_deg"), model = sigma->channel("normal_deg.model");
  std::vector<Sum> sums(static_cast<std::size_t>(columns * ((size.height + kBlock - 1) / kBlock)));
  for (int y = kUncountedEdge; y < truth.height() - kUncountedEdge; ++y) {
    for (int x = kUncountedEdge; x < truth.width() - kUncountedEdge; ++x) {
      const int u = x / scale, v = y / scale;
      if ((*status)(u, v) & kNoSolution) continue;
      Sum& sum = sums[static_cast<std::size_t>(v / kBlock * columns + u / kBlock)];
      sum.error +=
          angle_deg({n[0](u, v), n[1](u, v), n[2](u, v)}, {truth(x, y, 0), truth(x, y, 1), truth(x, y, 2)});
      const auto s = static_cast<double>(all(u, v)), m = static_cast<double>(model(u, v));
      sum.other2 += s * s - m * m;
      ++sum.pixels;
    }
  }
  return sums;
}

}  // namespace

Result<void> append_blocks(const BlocksOf& whose, const solve::SolveReport& solved, const Image<float>& truth,
                           const std::filesystem::path& file) {
  const Result<std::vector<Sum>> sums = sums_of(solved.folder, truth);
  if (!sums) return sums.error();
  std::ofstream lines(file, std::ios::app);
  for (std::size_t i = 0; i < sums->size() && i < solved.blocks.size(); ++i) {
    const Sum& sum = (*sums)[i];
    if (sum.pixels < kFewestPixels) continue;
    lines << Json{{"cloth", whose.cloth},
                  {"seed", whose.seed},
                  {"quality", whose.quality},
                  {"session", whose.of_session},
                  {"facts", solved.blocks[i]},
                  {"error", sum.error / sum.pixels},
                  {"other2", std::max(0.0, sum.other2 / sum.pixels)},
                  {"pixels", sum.pixels}}
                 .dump()
          << '\n';
  }
  lines.flush();
  if (!lines) return cannot_write(file, errno);
  return {};
}

Result<std::vector<BlockError>> read_blocks(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  std::vector<BlockError> blocks;
  std::map<std::string, double> pixels;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("facts", Json()).size() != solver::kBlockFacts) {
      return Error{ErrorKind::kBadData, "no blocks of solves", file.string(),
                   fmt::format("line {} has not the facts of a block", blocks.size() + 1),
                   "make the file by weft bench cloths --blocks of this version"};
    }
    BlockError block;
    block.quality = json["quality"];
    block.solve = fmt::format("{} {} {} {}", json["cloth"].get<std::string>(), json["seed"].get<int>(),
                              block.quality, json["session"].get<bool>());
    block.facts = json["facts"];
    block.error_deg = json["error"];
    block.other2 = json["other2"];
    block.pixels = json["pixels"];
    pixels[block.solve] += block.pixels;
    blocks.push_back(block);
  }
  for (BlockError& block : blocks) block.weight = block.pixels / pixels[block.solve];
  return blocks;
}

}  // namespace weft::bench
