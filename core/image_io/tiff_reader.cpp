// SPDX-License-Identifier: Apache-2.0

#include <Imath/half.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "core/image/image.h"
#include "core/image_io/color_profile.h"
#include "core/image_io/image_io.h"
#include "core/image_io/image_source.h"
#include "core/image_io/tiff_library.h"

namespace weft {
namespace {

/// How a TIFF stores a number.
struct TiffSample {
  enum class Kind { kCount, kSigned, kFloat } kind = Kind::kCount;
  int bits = 8;

  bool is_known() const;
  SampleType type() const;
};

/// Numbers below a byte, or astride of two, begin at the high bit.
std::uint32_t bits_at(const std::byte* row, std::size_t at, int bits) {
  std::uint32_t value = 0;
  for (int i = 0; i < bits; ++i, ++at) {
    const auto byte = std::to_integer<unsigned>(row[at / 8]);
    value = value << 1 | (byte >> (7 - at % 8) & 1U);
  }
  return value;
}

template <typename Number>
Number number_at(const std::byte* row, std::size_t at) {
  Number number;
  std::memcpy(&number, row + at * sizeof(Number), sizeof(Number));
  return number;
}

template <typename Number, typename Value>
void unpack_as(const std::byte* row, std::size_t first, std::size_t step, View<float> out,
               const Value& value) {
  float* samples = out.row(0);
  for (int x = 0; x < out.width(); ++x, first += step) samples[x] = value(number_at<Number>(row, first));
}

template <typename Number>
void unpack_scaled(const std::byte* row, std::size_t first, std::size_t step, View<float> out) {
  constexpr double kFull = std::numeric_limits<Number>::max();
  unpack_as<Number>(row, first, step, out,
                    [](Number n) { return static_cast<float>(static_cast<double>(n) / kFull); });
}

void unpack_floats(const std::byte* row, int bits, std::size_t first, std::size_t step, View<float> out) {
  if (bits == 16) {
    unpack_as<std::uint16_t>(row, first, step, out, imath_half_to_float);
  } else if (bits == 32) {
    unpack_as<float>(row, first, step, out, [](float v) { return v; });
  } else {
    unpack_as<double>(row, first, step, out, [](double v) { return static_cast<float>(v); });
  }
}

void unpack_signed(const std::byte* row, int bits, std::size_t first, std::size_t step, View<float> out) {
  if (bits == 8) {
    unpack_scaled<std::int8_t>(row, first, step, out);
  } else if (bits == 16) {
    unpack_scaled<std::int16_t>(row, first, step, out);
  } else {
    unpack_scaled<std::int32_t>(row, first, step, out);
  }
}

bool TiffSample::is_known() const {
  switch (kind) {
    case Kind::kCount:
      return (bits >= 1 && bits <= 16) || bits == 32;
    case Kind::kSigned:
      return bits == 8 || bits == 16 || bits == 32;
    case Kind::kFloat:
      return bits == 16 || bits == 32 || bits == 64;
  }
  return false;
}

SampleType TiffSample::type() const {
  if (kind == Kind::kFloat) return bits == 16 ? SampleType::kHalf : SampleType::kFloat;
  if (kind == Kind::kSigned || bits > 16) return SampleType::kFloat;
  return bits > 8 ? SampleType::kUint16 : SampleType::kUint8;
}

/// Numbers `first`, `first + step` ... of a decoded row that holds them all, of a known kind; counts and
/// signed ones by their full scale.
void unpack_tiff(const std::byte* row, TiffSample sample, std::size_t first, std::size_t step,
                 View<float> out) {
  if (sample.kind == TiffSample::Kind::kFloat) return unpack_floats(row, sample.bits, first, step, out);
  if (sample.kind == TiffSample::Kind::kSigned) return unpack_signed(row, sample.bits, first, step, out);
  if (sample.bits == 8) return unpack_counts(reinterpret_cast<const std::uint8_t*>(row) + first, step, out);
  if (sample.bits == 16) return unpack_counts(reinterpret_cast<const std::uint16_t*>(row) + first, step, out);
  if (sample.bits == 32) return unpack_scaled<std::uint32_t>(row, first, step, out);
  const double full = static_cast<double>((1U << sample.bits) - 1);
  float* samples = out.row(0);
  for (int x = 0; x < out.width(); ++x, first += step)
    samples[x] =
        static_cast<float>(bits_at(row, first * static_cast<std::size_t>(sample.bits), sample.bits) / full);
}

/// The first `count` counts of such a row, unscaled; at most 16 bits each.
void unpack_indices(const std::byte* row, int bits, std::size_t count, std::vector<std::uint16_t>& out) {
  out.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = bits == 16 ? number_at<std::uint16_t>(row, i)
                                           : bits_at(row, i * static_cast<std::size_t>(bits), bits);
    out[i] = static_cast<std::uint16_t>(index);
  }
}

namespace fs = std::filesystem;

constexpr int kMostPages = 1000;  // that are looked at
constexpr std::uint32_t kMostAcross = std::numeric_limits<int>::max() / 2;

constexpr std::array<std::pair<std::uint32_t, const char*>, 12> kTexts = {
    {{TIFFTAG_IMAGEDESCRIPTION, "ImageDescription"},
     {TIFFTAG_ARTIST, "Artist"},
     {TIFFTAG_COPYRIGHT, "Copyright"},
     {TIFFTAG_DATETIME, "DateTime"},
     {TIFFTAG_DOCUMENTNAME, "DocumentName"},
     {TIFFTAG_HOSTCOMPUTER, "HostComputer"},
     {TIFFTAG_MAKE, "Make"},
     {TIFFTAG_MODEL, "Model"},
     {TIFFTAG_PAGENAME, "PageName"},
     {TIFFTAG_PIXAR_TEXTUREFORMAT, "textureformat"},
     {TIFFTAG_PIXAR_WRAPMODES, "wrapmodes"},
     {TIFFTAG_SOFTWARE, "Software"}}};

template <typename Value>
Value field_or(TIFF* tiff, std::uint32_t tag, Value otherwise) {
  Value value = otherwise;
  return TIFFGetFieldDefaulted(tiff, tag, &value) != 0 ? value : otherwise;
}

/// How the numbers of a file become planes.
enum class Meaning {
  kPlain,     ///< as they are
  kInverted,  ///< 0 is white
  kPalette,   ///< indices into a table of colours
  kInk,       ///< cyan, magenta, yellow and black
  kRaster     ///< libtiff alone knows: its own conversion to 8 bits
};

/// The part of a strip or tile inside of the image, and the plane it belongs to.
struct Unit {
  int plane = 0;
  Rect part;
};

class TiffSource : public ImageSource {
 public:
  explicit TiffSource(const fs::path& file) : tiff_(TIFFOpenExt(file.c_str(), "rm", words_.options())) {}

  std::string open(const fs::path& file) {
    if (!tiff_ || !words_.complaint().empty()) return words_.reason();
    if (TIFFLastDirectory(tiff_.get()) == 0) choose_page(file);
    if (!words_.complaint().empty()) return words_.reason();
    if (std::string why = read_layout(); !why.empty()) return why;
    if (std::string why = objection(); !why.empty()) return why;
    read_meaning();
    name_channels();
    read_words();
    return words_.complaint().empty() ? "" : words_.reason();
  }

  double scratch_bytes() const override {
    return meaning_ == Meaning::kRaster ? 4.0 * static_cast<double>(info_.size.pixels())
                                        : static_cast<double>(unit_bytes());
  }

  std::string read(Image<float>& planes) override {
    return meaning_ == Meaning::kRaster ? read_raster(planes) : read_units(planes);
  }

 private:
  void choose_page(const fs::path& file);
  std::string read_layout();
  std::string objection();
  void read_meaning();
  void name_channels();
  void read_words();
  ColorSpace color();
  std::string read_raster(Image<float>& planes);
  std::string read_units(Image<float>& planes);
  bool decode(const Unit& unit, std::vector<std::byte>& bytes);
  void unpack(const std::byte* row, const Unit& unit, int y, Image<float>& planes);
  void unpack_colors(const std::byte* row, Rect line, Image<float>& planes);
  void unpack_ink(const std::byte* row, Rect line, Image<float>& planes);

  std::uint64_t unit_bytes() const {
    return is_tiled_ ? TIFFTileSize64(tiff_.get()) : TIFFStripSize64(tiff_.get());
  }
  std::uint64_t row_bytes() const {
    return is_tiled_ ? TIFFTileRowSize64(tiff_.get()) : TIFFScanlineSize64(tiff_.get());
  }

  TiffWords words_;
  TiffFile tiff_;
  TiffSample sample_;
  Meaning meaning_ = Meaning::kPlain;
  int samples_ = 1;  ///< of a pixel
  bool is_separate_ = false;
  bool is_tiled_ = false;
  std::uint32_t unit_width_ = 0, unit_height_ = 0;
  std::uint16_t photometric_ = PHOTOMETRIC_MINISBLACK;
  std::array<std::uint16_t*, 3> table_ = {};
  std::vector<std::uint16_t> indices_;
};

/// Goes to the page that is the picture. Another page that is damaged matters to nobody, so that this one
/// looks at them by itself.
void TiffSource::choose_page(const fs::path& file) {
  TiffWords words;
  const TiffFile pages(TIFFOpenExt(file.c_str(), "rm", words.options()));
  if (!pages) return;
  TIFF* tiff = pages.get();
  std::vector<PicturePart> found;
  for (int page = 0; page < kMostPages; ++page) {
    const auto width = field_or<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
    const auto height = field_or<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
    const auto kind = field_or<std::uint32_t>(tiff, TIFFTAG_SUBFILETYPE, 0);
    const bool is_picture = (kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0 && width > 0 &&
                            height > 0 && width < kMostAcross && height < kMostAcross;
    if (is_picture)
      found.push_back({page,
                       {static_cast<int>(width), static_cast<int>(height)},
                       fmt::format("page {}, {} x {} pixels", page + 1, width, height)});
    if (TIFFReadDirectory(tiff) == 0) break;
  }
  const int chosen = choose_part(std::move(found), info_);
  if (chosen > 0) TIFFSetDirectory(tiff_.get(), static_cast<tdir_t>(chosen));
}

std::string TiffSource::read_layout() {
  TIFF* tiff = tiff_.get();
  const auto width = field_or<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH, 0);
  const auto height = field_or<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH, 0);
  samples_ = field_or<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  if (width < 1 || height < 1 || samples_ < 1 || width > kMostAcross || height > kMostAcross)
    return "it has no pixels";
  info_.size = {static_cast<int>(width), static_cast<int>(height)};
  is_separate_ =
      samples_ > 1 && field_or<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG, 1) == PLANARCONFIG_SEPARATE;
  is_tiled_ = TIFFIsTiled(tiff) != 0;
  unit_width_ = is_tiled_ ? field_or<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH, 0) : width;
  unit_height_ = is_tiled_ ? field_or<std::uint32_t>(tiff, TIFFTAG_TILELENGTH, 0)
                           : std::min(field_or<std::uint32_t>(tiff, TIFFTAG_ROWSPERSTRIP, height), height);
  photometric_ = field_or<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC,
                                         samples_ >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  const auto format = field_or<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  sample_.kind = format == SAMPLEFORMAT_IEEEFP ? TiffSample::Kind::kFloat
                 : format == SAMPLEFORMAT_INT  ? TiffSample::Kind::kSigned
                                               : TiffSample::Kind::kCount;
  sample_.bits = field_or<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  return unit_width_ > 0 && unit_height_ > 0 ? "" : "its strips or tiles have no pixels";
}

std::string TiffSource::objection() {
  TIFF* tiff = tiff_.get();
  if (field_or<std::uint32_t>(tiff, TIFFTAG_IMAGEDEPTH, 1) > 1) return "its pixels have depth";
  if (field_or<std::uint32_t>(tiff, TIFFTAG_SUBFILETYPE, 0) == FILETYPE_REDUCEDIMAGE)
    return "its first image is a thumbnail, as in a camera's raw file";
  if (is_tiled_ && tile_is_too_large(unit_width_, unit_height_, info_.size))
    return fmt::format("its tiles of {} x {} pixels are larger than the image", unit_width_, unit_height_);
  const auto compression = field_or<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  if (TIFFIsCODECConfigured(compression) == 0)
    return fmt::format("its compression {} is not known", compression);
  const bool is_cmyk = samples_ == 4 && !is_separate_ &&
                       field_or<std::uint16_t>(tiff, TIFFTAG_INKSET, INKSET_CMYK) == INKSET_CMYK;
  if (photometric_ == PHOTOMETRIC_SEPARATED && !is_cmyk)
    return "its inks are others than cyan, magenta, yellow and black side by side";
  const auto format = field_or<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  if (!sample_.is_known() || format == SAMPLEFORMAT_COMPLEXINT || format == SAMPLEFORMAT_COMPLEXIEEEFP)
    return fmt::format("its samples of {} bits are not known", sample_.bits);
  return "";
}

void TiffSource::read_meaning() {
  TIFF* tiff = tiff_.get();
  const auto compression = field_or<std::uint16_t>(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  const bool is_ycbcr = photometric_ == PHOTOMETRIC_YCBCR;
  if (compression == COMPRESSION_JPEG && is_ycbcr && !is_separate_) {
    TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
  } else if (compression == COMPRESSION_OJPEG || is_ycbcr || photometric_ == PHOTOMETRIC_CIELAB ||
             photometric_ == PHOTOMETRIC_ICCLAB || photometric_ == PHOTOMETRIC_ITULAB ||
             photometric_ == PHOTOMETRIC_LOGL || photometric_ == PHOTOMETRIC_LOGLUV) {
    meaning_ = Meaning::kRaster;
    sample_ = {TiffSample::Kind::kCount, 8};
  }
  const bool has_table = photometric_ == PHOTOMETRIC_PALETTE && samples_ == 1 &&
                         sample_.kind == TiffSample::Kind::kCount && sample_.bits <= 16 &&
                         TIFFGetField(tiff, TIFFTAG_COLORMAP, &table_[0], &table_[1], &table_[2]) != 0;
  if (has_table) meaning_ = Meaning::kPalette;
  if (photometric_ == PHOTOMETRIC_SEPARATED) meaning_ = Meaning::kInk;
  if (photometric_ == PHOTOMETRIC_MINISWHITE && sample_.kind == TiffSample::Kind::kCount)
    meaning_ = Meaning::kInverted;
}

void TiffSource::name_channels() {
  info_.type = meaning_ == Meaning::kPalette ? SampleType::kUint8 : sample_.type();
  if (meaning_ == Meaning::kPalette || meaning_ == Meaning::kInk || meaning_ == Meaning::kRaster) {
    info_.channels = {"R", "G", "B"};
    return;
  }
  std::uint16_t extra = 0;
  std::uint16_t* kinds = nullptr;
  if (TIFFGetField(tiff_.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds) == 0) extra = 0;
  const int colors = samples_ - std::min<int>(extra, samples_);
  const auto is_alpha = [&](int c) {
    return c >= colors &&
           (kinds[c - colors] == EXTRASAMPLE_ASSOCALPHA || kinds[c - colors] == EXTRASAMPLE_UNASSALPHA);
  };
  static constexpr std::array kNames = {"R", "G", "B"};
  bool has_alpha = false;
  for (int c = 0; c < samples_; ++c) {
    const bool alpha = is_alpha(c) && !std::exchange(has_alpha, true);
    info_.channels.push_back(alpha   ? "A"
                             : c < 3 ? kNames[static_cast<std::size_t>(c)]
                                     : fmt::format("channel{}", c));
  }
  if (samples_ == 1 || (samples_ == 2 && has_alpha)) info_.channels[0] = "Y";
}

void TiffSource::read_words() {
  TIFF* tiff = tiff_.get();
  info_.format = "tiff";
  info_.is_mosaic = photometric_ == PHOTOMETRIC_CFA;
  info_.color = color();
  ImageAttributes texts;
  for (const auto& [tag, name] : kTexts) {
    const char* text = nullptr;
    if (TIFFGetField(tiff, tag, &text) != 0 && text != nullptr && *text != 0) texts[name] = text;
  }
  info_.attributes = attributes_of_texts(std::move(texts));
  const float x = field_or(tiff, TIFFTAG_XRESOLUTION, 0.0f), y = field_or(tiff, TIFFTAG_YRESOLUTION, 0.0f);
  const auto unit = field_or<std::uint16_t>(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_INCH);
  const double unit_mm = unit == RESUNIT_INCH ? 25.4 : unit == RESUNIT_CENTIMETER ? 10 : 0;
  info_.pitch_mm = pitch_of_density(static_cast<double>(x), static_cast<double>(y), unit_mm);
}

ColorSpace TiffSource::color() {
  std::uint32_t bytes = 0;
  const std::uint8_t* profile = nullptr;
  if (TIFFGetField(tiff_.get(), TIFFTAG_ICCPROFILE, &bytes, &profile) == 0) return ColorSpace::kData;
  const ColorSpace told = color_of_profile({profile, bytes});
  if (told != ColorSpace::kData) info_.color_by = "its ICC profile";
  return told;
}

std::string TiffSource::read_raster(Image<float>& planes) {
  const auto width = static_cast<std::uint32_t>(planes.width()),
             height = static_cast<std::uint32_t>(planes.height());
  std::vector<std::uint32_t> raster(static_cast<std::size_t>(info_.size.pixels()));
  const auto orientation = field_or<std::uint16_t>(tiff_.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  const bool read = TIFFReadRGBAImageOriented(tiff_.get(), width, height, raster.data(), orientation, 1) != 0;
  if (!read || !words_.complaint().empty()) return words_.reason();
  for (int c = 0; c < 3; ++c) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(raster.data()) + c;
    for (int y = 0; y < planes.height(); ++y, bytes += 4 * std::size_t{width})
      unpack_counts(bytes, 4, planes.plane(c).crop({0, y, planes.width(), y + 1}));
  }
  return "";
}

std::string TiffSource::read_units(Image<float>& planes) {
  const int width = info_.size.width, height = info_.size.height;
  const auto across = std::min<std::uint32_t>(unit_width_, static_cast<std::uint32_t>(width));
  const auto down = std::min<std::uint32_t>(unit_height_, static_cast<std::uint32_t>(height));
  const int step_x = static_cast<int>(across), step_y = static_cast<int>(down);
  std::vector<std::byte> bytes(unit_bytes());
  Unit unit;
  for (unit.plane = 0; unit.plane < (is_separate_ ? samples_ : 1); ++unit.plane) {
    for (std::int64_t y = 0; y < height; y += unit_height_) {
      for (std::int64_t x = 0; x < width; x += unit_width_) {
        const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
        unit.part = {x0, y0, x0 + std::min(step_x, width - x0), y0 + std::min(step_y, height - y0)};
        if (!decode(unit, bytes) || !words_.complaint().empty()) return words_.reason();
        const std::byte* row = bytes.data();
        for (int line = y0; line < unit.part.y1; ++line, row += row_bytes()) unpack(row, unit, line, planes);
      }
    }
  }
  return "";
}

bool TiffSource::decode(const Unit& unit, std::vector<std::byte>& bytes) {
  TIFF* tiff = tiff_.get();
  const auto x = static_cast<std::uint32_t>(unit.part.x0), y = static_cast<std::uint32_t>(unit.part.y0);
  const auto plane = static_cast<std::uint16_t>(unit.plane);
  const auto rows =
      static_cast<std::uint64_t>(is_tiled_ ? static_cast<int>(unit_height_) : unit.part.height());
  const auto wanted = static_cast<tmsize_t>(rows * row_bytes());
  if (static_cast<std::uint64_t>(wanted) > bytes.size()) return false;
  const tmsize_t got =
      is_tiled_ ? TIFFReadEncodedTile(tiff, TIFFComputeTile(tiff, x, y, 0, plane), bytes.data(), wanted)
                : TIFFReadEncodedStrip(tiff, TIFFComputeStrip(tiff, y, plane), bytes.data(), wanted);
  return got >= wanted;
}

void TiffSource::unpack(const std::byte* row, const Unit& unit, int y, Image<float>& planes) {
  const Rect line = {unit.part.x0, y, unit.part.x1, y + 1};
  if (meaning_ == Meaning::kPalette) return unpack_colors(row, line, planes);
  if (meaning_ == Meaning::kInk) return unpack_ink(row, line, planes);
  const int first = is_separate_ ? unit.plane : 0, last = is_separate_ ? unit.plane : samples_ - 1;
  const auto step = static_cast<std::size_t>(is_separate_ ? 1 : samples_);
  for (int c = first; c <= last; ++c) {
    const View<float> out = planes.plane(c).crop(line);
    unpack_tiff(row, sample_, static_cast<std::size_t>(c - first), step, out);
    if (meaning_ != Meaning::kInverted || info_.channels[static_cast<std::size_t>(c)] == "A") continue;
    for (int x = 0; x < out.width(); ++x) out(x, 0) = 1 - out(x, 0);
  }
}

void TiffSource::unpack_colors(const std::byte* row, Rect line, Image<float>& planes) {
  unpack_indices(row, sample_.bits, static_cast<std::size_t>(line.width()), indices_);
  std::vector<std::uint8_t> colors(indices_.size());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < indices_.size(); ++i)
      colors[i] = static_cast<std::uint8_t>(table_[c][indices_[i]] >> 8);
    unpack_counts(colors.data(), 1, planes.plane(static_cast<int>(c)).crop(line));
  }
}

void TiffSource::unpack_ink(const std::byte* row, Rect line, Image<float>& planes) {
  Image<float> black({line.width(), 1});
  unpack_tiff(row, sample_, 3, 4, black.plane());
  for (int c = 0; c < 3; ++c) {
    const View<float> out = planes.plane(c).crop(line);
    unpack_tiff(row, sample_, static_cast<std::size_t>(c), 4, out);
    for (int x = 0; x < out.width(); ++x) out(x, 0) = (1 - out(x, 0)) * (1 - black(x, 0));
  }
}

}  // namespace

TiffWords::TiffWords() : options_(TIFFOpenOptionsAlloc()) {
  TIFFOpenOptionsSetErrorHandlerExtR(options_, keep, this);
  TIFFOpenOptionsSetWarningHandlerExtR(
      options_, [](TIFF*, void*, const char*, const char*, va_list) { return 1; }, nullptr);
}

int TiffWords::keep(TIFF*, void* words, const char* module, const char* format, va_list values) {
  std::string& complaint = static_cast<TiffWords*>(words)->complaint_;
  if (!complaint.empty()) return 1;
  std::array<char, 512> text = {};
  std::vsnprintf(text.data(), text.size(), format, values);
  // Where a module is the file, the error names it already.
  const bool is_path = module == nullptr || std::string_view(module).find('/') != std::string_view::npos;
  complaint = is_path ? text.data() : fmt::format("{}: {}", module, text.data());
  if (complaint.empty()) complaint = "the file format library gives no reason";
  return 1;
}

std::string TiffWords::reason() const {
  return library_reason(complaint_);
}

Result<std::unique_ptr<ImageSource>> open_tiff(const fs::path& file) {
  auto source = std::make_unique<TiffSource>(file);
  if (std::string why = source->open(file); !why.empty()) return bad_image(file, std::move(why));
  return std::unique_ptr<ImageSource>(std::move(source));
}

}  // namespace weft
