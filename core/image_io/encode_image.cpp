// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/encode_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <vector>

#include "core/image_io/oiio.h"

namespace weft {

Result<std::string> encode_image(std::span<const std::uint8_t> samples, Size size, int channels,
                                 PictureFormat format) {
  prepare_oiio();
  const auto refused = [](const std::string& why) {
    return Error{ErrorKind::kInternal, "the picture cannot be encoded", "", oiio_reason(why), ""};
  };
  const char* name = format == PictureFormat::kJpeg ? "x.jpg" : "x.png";
  OIIO::ImageSpec spec(size.width, size.height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("compression", format == PictureFormat::kJpeg ? "jpeg:92" : "zip:1");
  spec.attribute("jpeg:subsampling", "4:4:4");
  spec.attribute("oiio:ColorSpace", "sRGB");
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput sink(bytes);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name);
  if (!output) return refused(OIIO::geterror());
  if (!output->set_ioproxy(&sink) || !output->open(name, spec)) return refused(output->geterror());
  if (!output->write_image(OIIO::TypeDesc::UINT8, samples.data())) return refused(output->geterror());
  if (!output->close()) return refused(output->geterror());
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace weft
