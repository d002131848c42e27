/**
 * Refuses a plugin whose memory layout is not that of the Mitsuba wheel.
 *
 * The wheel is compiled for AVX2 and FMA. The layout of dr::Array<float, 3> depends on the
 * instruction set: a plugin compiled for another one loads, runs, and returns wrong results.
 * So the layout is checked when this is compiled and, by a round trip through the library, when
 * the plugin is loaded.
 */
#pragma once

#include <mitsuba/core/spectrum.h>
#include <stdexcept>
#include <vector>

#if !defined(PROB_WATER_ONLY_LOAD_CHECK)
#  if !defined(__AVX2__) || !defined(__FMA__)
#    error "prob_water must be compiled for AVX2 and FMA like the Mitsuba wheel: pass -march=x86-64-v3"
#  endif
#  if defined(__AVX512F__)
#    error "prob_water must not be compiled for AVX-512, the Mitsuba wheel is not: pass -march=x86-64-v3"
#  endif
static_assert(sizeof(drjit::Array<float, 3>) == 16 && alignof(drjit::Array<float, 3>) == 16,
              "dr::Array<float, 3> is not laid out as in the Mitsuba wheel: pass -march=x86-64-v3");
#endif

namespace prob_water {

/// Throws where the loaded Mitsuba does not agree with what this file was compiled against.
inline void check_compatible() {
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
        throw std::runtime_error("prob_water: this processor lacks AVX2 or FMA, which the Mitsuba wheel needs");

    /* A flat spectrum has a known sRGB colour; a wrong layout of Color<float, 3> garbles it. */
    std::vector<float> wavelengths = { 360.f, 830.f }, values = { 1.f, 1.f };
    auto white = mitsuba::spectrum_list_to_srgb<float>(wavelengths, values, false, true);
    const float *rgb = white.data();
    bool ok = true;
    for (int k = 0; k < 3; ++k)
        ok &= rgb[k] > 0.9f && rgb[k] < 1.1f;
    if (!ok)
        throw std::runtime_error(
            "prob_water: this plugin was compiled for another instruction set than the loaded Mitsuba "
            "(its vectors are laid out differently): rebuild it with 'cargo xtask build'");
}

} // namespace prob_water
