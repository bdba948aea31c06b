// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/base/files.h"
#include "core/image_io/color_profile.h"
#include "core/image_io/grey_jpeg.h"
#include "core/image_io/image_source.h"
#include "core/image_io/jpeg_library.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

void keep_complaint(j_common_ptr any) {
  auto* words = reinterpret_cast<JpegWords*>(any->err);
  if (words->complaint[0] == 0) any->err->format_message(any, words->complaint.data());
}

/// Photographs store what is left of light in CMYK and not the ink.
std::uint8_t lit(std::uint8_t color, std::uint8_t black) {
  constexpr float kUnit = 1.0f / 255;
  const float light = kUnit * static_cast<float>(color) * (kUnit * static_cast<float>(black));
  return static_cast<std::uint8_t>(std::lround(255 * light));
}

void rgb_of_cmyk(std::uint8_t* row, int width) {
  std::uint8_t* out = row;
  for (const std::uint8_t* in = row; width > 0; --width, in += 4, out += 3) {
    const std::uint8_t black = in[3];
    for (int c = 0; c < 3; ++c) out[c] = lit(in[c], black);
  }
}

class JpegSource : public ImageSource {
 public:
  explicit JpegSource(const fs::path& file) : file_(std::fopen(file.c_str(), "rbe")) {}
  ~JpegSource() override {
    if (is_made_) jpeg_destroy_decompress(&jpeg_);
    if (file_ != nullptr) std::fclose(file_);
  }

  bool is_open() const { return file_ != nullptr; }

  std::string open() {
    jpeg_.err = &words_.manager;
    const bool done = jpeg_does(words_, [this] {
      jpeg_create_decompress(&jpeg_);
      is_made_ = true;
      jpeg_stdio_src(&jpeg_, file_);
      jpeg_save_markers(&jpeg_, JPEG_APP0 + 2, 0xFFFF);  // profiles
      jpeg_read_header(&jpeg_, TRUE);
      if (is_cmyk()) jpeg_.out_color_space = JCS_CMYK;
      jpeg_calc_output_dimensions(&jpeg_);
      is_progressive_ = jpeg_has_multiple_scans(&jpeg_) != FALSE;
    });
    if (!done || words_.complaint[0] != 0) return library_reason(words_.complaint.data());
    info_.size = {static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height)};
    info_.type = SampleType::kUint8;
    info_.format = "jpeg";
    if (jpeg_.output_components == 1) {
      info_.channels = {"Y"};
    } else if (jpeg_.output_components == 3 || is_cmyk()) {
      info_.channels = {"R", "G", "B"};
    } else {
      return "it has neither one component nor three or four";
    }
    const double unit_mm = jpeg_.density_unit == 1 ? 25.4 : jpeg_.density_unit == 2 ? 10 : 0;
    info_.pitch_mm = pitch_of_density(jpeg_.X_density, jpeg_.Y_density, unit_mm);
    info_.color = color();
    return "";
  }

  /// Scans that refine each other need all coefficients of the image.
  double scratch_bytes() const override {
    return static_cast<double>(row_bytes()) +
           (is_progressive_ ? 2.0 * jpeg_.num_components * static_cast<double>(info_.size.pixels()) : 0);
  }

  std::string read(Image<float>& planes) override {
    std::vector<std::uint8_t> row(row_bytes());
    const bool done = jpeg_does(words_, [this, samples = row.data(), &planes] {
      jpeg_start_decompress(&jpeg_);
      for (int y = 0; y < planes.height(); ++y) {
        JSAMPROW line = samples;
        jpeg_read_scanlines(&jpeg_, &line, 1);
        if (is_cmyk()) rgb_of_cmyk(samples, planes.width());
        for (int c = 0; c < planes.planes(); ++c)
          unpack_counts(samples + c, static_cast<std::size_t>(planes.planes()),
                        planes.plane(c).crop({0, y, planes.width(), y + 1}));
      }
      jpeg_finish_decompress(&jpeg_);
    });
    return done && words_.complaint[0] == 0 ? "" : library_reason(words_.complaint.data());
  }

 private:
  bool is_cmyk() const { return jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK; }
  std::size_t row_bytes() const {
    return std::size_t{jpeg_.output_width} * static_cast<std::size_t>(jpeg_.output_components);
  }

  ColorSpace color() {
    JOCTET* profile = nullptr;
    unsigned bytes = 0;
    jpeg_does(words_, [&] { jpeg_read_icc_profile(&jpeg_, &profile, &bytes); });
    words_.complaint = {};  // a profile that is broken says nothing of the pixels
    const ColorSpace told =
        profile == nullptr ? ColorSpace::kData : color_of_profile({profile, std::size_t{bytes}});
    std::free(profile);  // NOLINT: libjpeg takes it from malloc
    if (told != ColorSpace::kData) info_.color_by = "its ICC profile";
    return told == ColorSpace::kData ? ColorSpace::kSrgb : told;
  }

  JpegWords words_;
  std::FILE* file_;
  jpeg_decompress_struct jpeg_ = {};
  bool is_made_ = false;
  bool is_progressive_ = false;
};

}  // namespace

JpegWords::JpegWords() {
  jpeg_std_error(&manager);
  manager.output_message = keep_complaint;
  manager.error_exit = [](j_common_ptr any) {
    keep_complaint(any);
    std::longjmp(reinterpret_cast<JpegWords*>(any->err)->out, 1);  // NOLINT: libjpeg knows no other way
  };
}

Result<std::unique_ptr<ImageSource>> open_jpeg(const fs::path& file) {
  auto source = std::make_unique<JpegSource>(file);
  if (!source->is_open()) return cannot_read(file, errno);
  if (std::string why = source->open(); !why.empty()) return bad_image(file, std::move(why));
  return std::unique_ptr<ImageSource>(std::move(source));
}

constexpr std::uint64_t kMostOfAPreview = std::uint64_t{64} << 20;

std::optional<Image<std::uint8_t>> grey_of_jpeg(std::string_view jpeg) {
  struct Decoder : jpeg_decompress_struct {
    ~Decoder() { jpeg_destroy_decompress(this); }
  };
  JpegWords words;
  Decoder decoder = {};
  decoder.err = &words.manager;
  const bool is_read = jpeg_does(words, [&] {
    jpeg_create_decompress(&decoder);
    jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(jpeg.data()), jpeg.size());
    jpeg_read_header(&decoder, TRUE);
    decoder.out_color_space = JCS_GRAYSCALE;
    jpeg_start_decompress(&decoder);
  });
  if (is_read && std::uint64_t{decoder.output_width} * decoder.output_height > kMostOfAPreview)
    return std::nullopt;
  Image<std::uint8_t> picture;
  if (is_read)
    picture = Image<std::uint8_t>(
        {static_cast<int>(decoder.output_width), static_cast<int>(decoder.output_height)});
  const bool is_whole = is_read && jpeg_does(words, [&] {
                          while (decoder.output_scanline < decoder.output_height) {
                            JSAMPROW row = picture.plane().row(static_cast<int>(decoder.output_scanline));
                            jpeg_read_scanlines(&decoder, &row, 1);
                          }
                        });
  if (!is_whole) return std::nullopt;
  return picture;
}

}  // namespace weft
