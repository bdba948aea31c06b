// SPDX-License-Identifier: Apache-2.0
#include "solve/input/npy_matrix.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "core/base/number.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "\x93NUMPY";

Error bad_npy(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "lights cannot be read", file.string(), std::move(why),
          "save two dimensions of float64 by numpy.save, or text by numpy.savetxt"};
}

/// The bytes after "'key':" of the heading, a Python dictionary.
std::string_view value_of(std::string_view heading, std::string_view key) {
  const std::size_t at = heading.find(fmt::format("'{}'", key));
  if (at == heading.npos) return {};
  const std::size_t colon = heading.find(':', at);
  if (colon == heading.npos) return {};
  const std::size_t begin = heading.find_first_not_of(' ', colon + 1);
  return begin == heading.npos ? std::string_view() : heading.substr(begin);
}

/// "(10, 3)".
std::optional<std::array<std::size_t, 2>> shape_of(std::string_view value) {
  const std::size_t comma = value.find(','), end = value.find(')');
  if (!value.starts_with('(') || comma == value.npos || end == value.npos || comma > end) return std::nullopt;
  const std::string_view second = value.substr(comma + 1, end - comma - 1);
  const std::size_t begin = second.find_first_not_of(' ');
  if (begin == second.npos) return std::nullopt;
  const auto rows = as_whole_number<std::uint32_t>(value.substr(1, comma - 1));
  const auto columns = as_whole_number<std::uint32_t>(second.substr(begin));
  if (!rows || !columns) return std::nullopt;
  return std::array<std::size_t, 2>{*rows, *columns};
}

template <typename Float>
double number_at(std::string_view bytes, std::size_t index) {
  Float number = 0;
  std::memcpy(&number, bytes.data() + index * sizeof(Float), sizeof(Float));
  return static_cast<double>(number);
}

}  // namespace

bool is_npy(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

Result<std::vector<std::vector<double>>> read_npy_matrix(std::string_view bytes, const fs::path& file) {
  if (!is_npy(bytes) || bytes.size() < 12) return bad_npy(file, "it is no array of NumPy");
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(bytes[i])}; };
  const std::size_t version = byte(6), head = version == 1 ? 10 : 12;
  std::size_t length = byte(8) | byte(9) << 8U;
  if (version > 1) length |= byte(10) << 16U | byte(11) << 24U;
  if (version < 1 || version > 3 || length > bytes.size() - head) return bad_npy(file, "its heading is cut");
  const std::string_view heading = bytes.substr(head, length), numbers = bytes.substr(head + length);
  const std::string_view kind = value_of(heading, "descr");
  const bool is_double = kind.starts_with("'<f8'");
  if (!is_double && !kind.starts_with("'<f4'")) {
    return bad_npy(file, fmt::format("its numbers are {}, and \"<f4\" and \"<f8\" are read",
                                     kind.substr(0, kind.find(','))));
  }
  const bool by_columns = value_of(heading, "fortran_order").starts_with("True");
  const auto shape = shape_of(value_of(heading, "shape"));
  if (!shape) return bad_npy(file, "it has not two dimensions");
  const auto [rows, columns] = *shape;
  const std::size_t size = is_double ? 8 : 4;
  if (numbers.size() != rows * columns * size) {
    return bad_npy(file, fmt::format("{} x {} numbers are {} bytes, and {} follow its heading", rows, columns,
                                     rows * columns * size, numbers.size()));
  }
  std::vector<std::vector<double>> matrix(rows, std::vector<double>(columns));
  for (std::size_t i = 0; i < rows * columns; ++i) {
    const double number = is_double ? number_at<double>(numbers, i) : number_at<float>(numbers, i);
    const std::size_t row = by_columns ? i % rows : i / columns, column = by_columns ? i / rows : i % columns;
    if (!std::isfinite(number))
      return bad_npy(file, fmt::format("row {} has a number that is not finite", row + 1));
    matrix[row][column] = number;
  }
  return matrix;
}

}  // namespace weft::solve
