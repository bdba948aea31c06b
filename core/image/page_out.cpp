// SPDX-License-Identifier: Apache-2.0
#include "core/image/page_out.h"

#include <sys/mman.h>

#include <cstddef>

namespace weft {

// What a shared map lets go of stays in its file.
void page_out(const Image<float>& on_disk) {
  const View<const float> first = on_disk.plane(0), last = on_disk.plane(on_disk.planes() - 1);
  const float *begin = first.row(0), *end = last.row(last.height() - 1) + last.width();
  madvise(const_cast<float*>(begin), static_cast<std::size_t>(end - begin) * sizeof(float), MADV_DONTNEED);
}

}  // namespace weft
