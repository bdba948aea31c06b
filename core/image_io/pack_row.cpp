// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/pack_row.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/image_io/pack_row.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace weft {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D, typename Sample>
using SampleOf = hn::Vec<hn::Rebind<Sample, D>>;

struct ToFloat {
  using Sample = float;
  template <class D>
  static HWY_INLINE hn::Vec<D> convert(D, hn::Vec<D> v) {
    return v;
  }
};

// hn::DemoteTo(float16_t) truncates on targets without F16C, so the rounding is spelled out for all of them.
struct ToHalf {
  using Sample = std::uint16_t;
  template <class D>
  static HWY_INLINE SampleOf<D, Sample> convert(D d, hn::Vec<D> v) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const auto infinity = hn::Set(du, 0x7F800000U), largest = hn::Set(du, 0x477FE000U);  // 65504
    const auto smallest_normal = hn::Set(du, 0x38800000U);                               // 2^-14

    const auto bits = hn::BitCast(du, v);
    const auto sign = hn::And(bits, hn::Set(du, 0x80000000U));
    const auto magnitude = hn::Xor(bits, sign);
    const auto a = hn::IfThenElse(hn::Lt(magnitude, infinity), hn::Min(magnitude, largest), magnitude);

    // Normal: the exponent is rebased by 15 - 127 and 13 bits are rounded away, ties to even.
    const auto odd = hn::And(hn::ShiftRight<13>(a), hn::Set(du, 1U));
    const auto normal = hn::ShiftRight<13>(hn::Add(hn::Add(a, odd), hn::Set(du, 0xC8000FFFU)));
    // Subnormal: adding 1/2 brings the last bit of binary16, 2^-24, to the last bit of the sum, which rounds.
    const auto half = hn::Set(d, 0.5f);
    const auto subnormal = hn::Sub(hn::BitCast(du, hn::Add(hn::BitCast(d, a), half)), hn::BitCast(du, half));
    const auto special = hn::IfThenElse(hn::Gt(a, infinity), hn::Set(du, 0x7E00U), hn::Set(du, 0x7C00U));

    const auto finite = hn::IfThenElse(hn::Lt(a, smallest_normal), subnormal, normal);
    const auto rounded = hn::IfThenElse(hn::Lt(a, infinity), finite, special);
    return hn::DemoteTo(hn::Rebind<Sample, D>(), hn::BitCast(di, hn::Or(rounded, hn::ShiftRight<16>(sign))));
  }
};

template <typename Integer>
struct ToInteger {
  using Sample = Integer;
  template <class D>
  static HWY_INLINE SampleOf<D, Sample> convert(D d, hn::Vec<D> v) {
    constexpr float kFullScale = static_cast<float>(std::numeric_limits<Integer>::max());
    const auto positive = hn::IfThenElseZero(hn::Gt(v, hn::Zero(d)), v);
    const auto scaled = hn::Mul(hn::Min(positive, hn::Set(d, 1.0f)), hn::Set(d, kFullScale));
    return hn::DemoteTo(hn::Rebind<Sample, D>(), hn::NearestInt(scaled));
  }
};

// The samples of columns x to x + Lanes(d) - 1 of every plane.
template <class To, class D>
HWY_INLINE void pack_group(D d, std::span<const float* const> planes, std::size_t x,
                           typename To::Sample* packed) {
  const hn::Rebind<typename To::Sample, D> ds;
  const auto samples = [&](std::size_t c) { return To::convert(d, hn::LoadU(d, planes[c] + x)); };
  typename To::Sample* out = packed + x * planes.size();
  switch (planes.size()) {
    case 1:
      hn::StoreU(samples(0), ds, out);
      break;
    case 2:
      hn::StoreInterleaved2(samples(0), samples(1), ds, out);
      break;
    case 3:
      hn::StoreInterleaved3(samples(0), samples(1), samples(2), ds, out);
      break;
    case 4:
      hn::StoreInterleaved4(samples(0), samples(1), samples(2), samples(3), ds, out);
      break;
    default:
      HWY_ALIGN typename To::Sample lanes[hn::MaxLanes(d)];
      for (std::size_t c = 0; c < planes.size(); ++c) {
        hn::Store(samples(c), ds, lanes);
        for (std::size_t i = 0; i < hn::Lanes(d); ++i) out[i * planes.size() + c] = lanes[i];
      }
  }
}

template <class To>
void pack_samples(std::span<const float* const> planes, std::size_t width, std::byte* packed) {
  const hn::ScalableTag<float> d;
  const hn::CappedTag<float, 1> one;
  auto* out = reinterpret_cast<typename To::Sample*>(packed);
  std::size_t x = 0;
  for (; x + hn::Lanes(d) <= width; x += hn::Lanes(d)) pack_group<To>(d, planes, x, out);
  for (; x < width; ++x) pack_group<To>(one, planes, x, out);
}

void pack(std::span<const float* const> planes, std::size_t width, SampleType type, std::byte* packed) {
  switch (type) {
    case SampleType::kUint8:
      return pack_samples<ToInteger<std::uint8_t>>(planes, width, packed);
    case SampleType::kUint16:
      return pack_samples<ToInteger<std::uint16_t>>(planes, width, packed);
    case SampleType::kHalf:
      return pack_samples<ToHalf>(planes, width, packed);
    case SampleType::kFloat:
      return pack_samples<ToFloat>(planes, width, packed);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace weft
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace weft {

HWY_EXPORT(pack);

void pack_row(std::span<const float* const> planes, std::size_t width, SampleType type, std::byte* packed) {
  HWY_DYNAMIC_DISPATCH(pack)(planes, width, type, packed);
}

std::size_t sample_bytes(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return 1;
    case SampleType::kUint16:
    case SampleType::kHalf:
      return 2;
    case SampleType::kFloat:
      return 4;
  }
  return 4;
}

}  // namespace weft
#endif
