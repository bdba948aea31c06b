// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "core/base/files.h"
#include "core/image_io/color_profile.h"
#include "core/image_io/image_source.h"
#include "core/image_io/png_library.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

/// The chunks of a PNG in the words of other formats.
std::string attribute_of_keyword(const std::string& keyword) {
  if (keyword == "Description") return "ImageDescription";
  if (keyword == "Author") return "Artist";
  if (keyword == "Title") return "DocumentName";
  return keyword;
}

// The name of a chunk that libpng does not know, as it wants it.
constexpr png_byte kCicp[] = {'c', 'I', 'C', 'P', 0};

class PngSource : public ImageSource {
 public:
  explicit PngSource(const fs::path& file)
      : file_(std::fopen(file.c_str(), "rbe")),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &words_, png_fails, png_warns)),
        header_(png_ == nullptr ? nullptr : png_create_info_struct(png_)) {}
  ~PngSource() override {
    png_destroy_read_struct(&png_, &header_, nullptr);
    if (file_ != nullptr) std::fclose(file_);
  }

  bool is_open() const { return file_ != nullptr; }

  std::string open() {
    if (header_ == nullptr) return "the file format library gives no reason";
    const bool done = png_does(png_, [this] {
      png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_ALWAYS, kCicp, 1);
      png_init_io(png_, file_);
      png_read_info(png_, header_);
    });
    if (!done) return library_reason(words_.complaint);
    read_words();  // before libpng makes alpha of transparency
    const bool prepared = png_does(png_, [this] {
      png_set_expand(png_);
      png_set_swap(png_);
      passes_ = png_set_interlace_handling(png_);
      png_read_update_info(png_, header_);
    });
    if (!prepared) return library_reason(words_.complaint);
    static const char* const kNames[] = {"R", "G", "B", "A"};
    const int channels = png_get_channels(png_, header_);
    info_.size = {static_cast<int>(png_get_image_width(png_, header_)),
                  static_cast<int>(png_get_image_height(png_, header_))};
    info_.type = png_get_bit_depth(png_, header_) == 16 ? SampleType::kUint16 : SampleType::kUint8;
    info_.channels.assign(kNames, kNames + channels);
    if (channels < 3)
      info_.channels = channels == 1 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"Y", "A"};
    row_bytes_ = png_get_rowbytes(png_, header_);
    return "";
  }

  double scratch_bytes() const override { return static_cast<double>(row_bytes_) * rows_held(); }

  std::string read(Image<float>& planes) override {
    std::vector<png_byte> rows(row_bytes_ * static_cast<std::size_t>(rows_held()));
    const bool read = passes_ > 1 ? read_interlaced(rows.data(), planes) : read_in_order(rows.data(), planes);
    return read ? "" : library_reason(words_.complaint);
  }

 private:
  /// Passes of an interlaced image fill up its rows.
  int rows_held() const { return passes_ > 1 ? info_.size.height : 1; }

  bool read_in_order(png_byte* row, Image<float>& planes) {
    return png_does(png_, [this, row, &planes] {
      for (int y = 0; y < planes.height(); ++y) {
        png_read_row(png_, row, nullptr);
        unpack(row, y, planes);
      }
      png_read_end(png_, nullptr);
    });
  }

  bool read_interlaced(png_byte* rows, Image<float>& planes) {
    const auto row_at = [this, rows](int y) { return rows + row_bytes_ * static_cast<std::size_t>(y); };
    const bool done = png_does(png_, [this, &row_at, &planes] {
      for (int pass = 0; pass < passes_; ++pass) {
        for (int y = 0; y < planes.height(); ++y) png_read_row(png_, row_at(y), nullptr);
      }
      png_read_end(png_, nullptr);
    });
    for (int y = 0; done && y < planes.height(); ++y) unpack(row_at(y), y, planes);
    return done;
  }

  void unpack(const png_byte* row, int y, Image<float>& planes) const {
    const int channels = planes.planes();
    for (int c = 0; c < channels; ++c) {
      const View<float> line = planes.plane(c).crop({0, y, planes.width(), y + 1});
      const auto step = static_cast<std::size_t>(channels);
      if (info_.type == SampleType::kUint8) {
        unpack_counts(row + c, step, line);
      } else {
        unpack_counts(reinterpret_cast<const std::uint16_t*>(row) + c, step, line);
      }
    }
  }

  void read_words() {
    info_.format = "png";
    info_.color = color();
    png_uint_32 x = 0, y = 0;
    int unit = PNG_RESOLUTION_UNKNOWN;
    if (png_get_pHYs(png_, header_, &x, &y, &unit) != 0 && unit == PNG_RESOLUTION_METER)
      info_.pitch_mm = pitch_of_density(x, y, 1000);
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png_, header_, &texts, &count);
    ImageAttributes attributes;
    for (int i = 0; i < count; ++i) attributes[attribute_of_keyword(texts[i].key)] = texts[i].text;
    info_.attributes = attributes_of_texts(std::move(attributes));
  }

  // The transfer function that cICP names (ITU-T H.273), which stands above all others; kData: none.
  ColorSpace color_of_code_points() {
    png_unknown_chunkp chunks = nullptr;
    const int count = png_get_unknown_chunks(png_, header_, &chunks);
    for (int i = 0; i < count; ++i) {
      if (std::memcmp(chunks[i].name, kCicp, 4) != 0 || chunks[i].size != 4) continue;
      switch (chunks[i].data[1]) {
        case 2:  // unspecified
          return ColorSpace::kData;
        case 4:
          return color_of_gamma(2.2);
        case 8:
          return ColorSpace::kLinearColor;
        case 13:
          return ColorSpace::kSrgb;
        default:
          return ColorSpace::kOther;
      }
    }
    return ColorSpace::kData;
  }

  ColorSpace color() {
    info_.color_by = "its chunk cICP";
    if (const ColorSpace told = color_of_code_points(); told != ColorSpace::kData) return told;
    png_charp name = nullptr;
    png_bytep profile = nullptr;
    png_uint_32 bytes = 0;
    int compression = 0, intent = 0;
    if (png_get_iCCP(png_, header_, &name, &compression, &profile, &bytes) != 0) {
      info_.color_by = "its profile in iCCP";
      const ColorSpace told = color_of_profile({profile, bytes});
      if (told != ColorSpace::kData) return told;
    }
    info_.color_by = "its chunk sRGB";
    if (png_get_sRGB(png_, header_, &intent) != 0) return ColorSpace::kSrgb;
    double encoding = 0;
    const bool is_told = png_get_gAMA(png_, header_, &encoding) != 0 && encoding > 0;
    info_.color_by = is_told ? "its chunk gAMA" : "";
    return is_told ? color_of_gamma(1 / encoding) : ColorSpace::kData;
  }

  PngWords words_;
  std::FILE* file_;
  png_structp png_;
  png_infop header_;
  std::size_t row_bytes_ = 0;
  int passes_ = 1;
};

}  // namespace

[[noreturn]] void png_fails(png_structp png, png_const_charp why) {
  auto* words = static_cast<PngWords*>(png_get_error_ptr(png));
  if (words != nullptr) words->complaint = why;
  png_longjmp(png, 1);
}

void png_warns(png_structp, png_const_charp) {}

Result<std::unique_ptr<ImageSource>> open_png(const fs::path& file) {
  auto source = std::make_unique<PngSource>(file);
  if (!source->is_open()) return cannot_read(file, errno);
  if (std::string why = source->open(); !why.empty()) return bad_image(file, std::move(why));
  return std::unique_ptr<ImageSource>(std::move(source));
}

}  // namespace weft
