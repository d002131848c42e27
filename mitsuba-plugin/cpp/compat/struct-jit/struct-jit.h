/**
 * What mitsuba/core/struct.h needs of a header that the wheel does not ship, so that mesh.h compiles. Not for bitmap.h
 * or tensor.h, whose layouts depend on the real one.
 */
#pragma once

namespace struct_jit {
enum class Type { Float16 };
template <typename T> struct type_id;
template <typename T> inline constexpr Type type_v = type_id<T>::value;
} // namespace struct_jit
