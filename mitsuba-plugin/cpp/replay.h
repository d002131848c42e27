/**
 * The core's closed forms in traced variants: programs that it recorded (its kernels.rs), repeated on Dr.Jit arrays.
 */
#pragma once

#include <drjit/math.h>
#include <mitsuba/core/fwd.h>
#include <mitsuba/core/vector.h>
#include <vector>

namespace prob_water {

/// The larger and the smaller of two numbers, the second where the first is none: one comparison, where
/// Dr.Jit's own take several to pass on what is not a number.
template <typename A, typename B> A larger(const A &a, const B &b) {
    A c(b);
    return drjit::select(a > c, a, c);
}
template <typename A, typename B> A smaller(const A &a, const B &b) {
    A c(b);
    return drjit::select(a < c, a, c);
}

/// What a program is given.
template <typename Float> struct Inputs {
    Float numbers[(size_t) Input::Count];

    void set(Input input, const Float &x) { numbers[(size_t) input] = x; }
    void set(Input first, const mitsuba::Vector<Float, 3> &v) {
        for (size_t k = 0; k < 3; ++k)
            numbers[(size_t) first + k] = v[k];
    }
};

template <typename Float_> struct Replay {
    using Float = Float_;
    using Mask = drjit::mask_t<Float>;
    using Int = drjit::int32_array_t<Float>;
    using UInt32 = drjit::uint32_array_t<Float>;
    using Buffer = mitsuba::DynamicBuffer<Float>;
    using HalfBuffer = mitsuba::DynamicBuffer<drjit::float16_array_t<Float>>;
    using Packet = drjit::Array<Float, 8>;

    /// Numbers are data, so that a change does not compile new kernels; decisions were made while recording.
    std::vector<Float> coefficients;
    std::vector<Buffer> tables;
    std::vector<HalfBuffer> half_tables;
    /// Of a table: numbers in a packet, its place among those of its precision, and whether that is half.
    struct Table {
        uint32_t width, place;
        bool half;
    };
    std::vector<Table> layout;
    rust::Vec<prob_water::Program> programs;

    explicit Replay(prob_water::Kernels &&kernels) : programs(std::move(kernels.programs)) {
        for (float x : kernels.coefficients)
            coefficients.push_back(drjit::opaque<Float>(x));
        for (const auto &table : kernels.tables) {
            layout.push_back({ table.width, uint32_t(table.half ? half_tables.size() : tables.size()), table.half });
            if (table.half) {
                std::vector<drjit::half> halves(table.numbers.begin(), table.numbers.end());
                half_tables.push_back(drjit::load<HalfBuffer>(halves.data(), halves.size()));
            } else {
                tables.push_back(drjit::load<Buffer>(table.numbers.data(), table.numbers.size()));
            }
        }
    }

    DRJIT_STRUCT(Replay, coefficients, tables, half_tables)

    /// The results of a kernel, for some parts (1 facets, 2 whitecaps).
    std::vector<Float> run(Kernel kernel, uint32_t parts, const Inputs<Float> &inputs) const {
        return run(programs[prob_water::program(kernel, parts)], inputs);
    }

private:
    template <size_t N, typename Source> static Packet gather(const Source &table, const UInt32 &at, const Mask &active) {
        drjit::Array<Float, N> found(drjit::gather<drjit::Array<Source, N>>(table, at, active));
        Packet packet = 0.f;
        for (size_t k = 0; k < N; ++k)
            packet[k] = found[k];
        return packet;
    }

    Packet lookup(const Table &t, const UInt32 &at, const Mask &active) const {
        if (t.half)
            return t.width == 4 ? gather<4>(half_tables[t.place], at, active) : gather<8>(half_tables[t.place], at, active);
        return t.width == 4 ? gather<4>(tables[t.place], at, active) : gather<8>(tables[t.place], at, active);
    }

    /// 2^n of an integer from -127, which gives 0, to 127.
    static Float power_of_2(const Float &n) {
        return drjit::reinterpret_array<Float>(Int(drjit::fmadd(n, 0x1p23f, 127.f * 0x1p23f)));
    }

    std::vector<Float> run(const prob_water::Program &program, const Inputs<Float> &inputs) const {
        namespace dr = drjit;
        using Op = prob_water::Operation;
        size_t count = program.instructions.size() / 4;
        std::vector<Float> x(count);
        std::vector<Mask> m(count);
        std::vector<Packet> packets(count);
        for (size_t k = 0; k < count; ++k) {
            const uint32_t *word = &program.instructions[4 * k];
            uint32_t a = word[1], b = word[2], c = word[3];
            switch ((Op) word[0]) {
                case Op::Constant: x[k] = dr::reinterpret_array<float>(a); break;
                case Op::Coefficient: x[k] = coefficients[a]; break;
                case Op::Input: x[k] = inputs.numbers[a]; break;
                case Op::Add: x[k] = x[a] + x[b]; break;
                case Op::Subtract: x[k] = x[a] - x[b]; break;
                case Op::Multiply: x[k] = x[a] * x[b]; break;
                case Op::Divide: x[k] = x[a] / x[b]; break;
                case Op::Negate: x[k] = -x[a]; break;
                case Op::Absolute: x[k] = dr::abs(x[a]); break;
                case Op::SquareRoot: x[k] = dr::sqrt(x[a]); break;
                case Op::Reciprocal: x[k] = dr::rcp(x[a]); break;
                case Op::ReciprocalRoot: x[k] = dr::rsqrt(x[a]); break;
                case Op::MultiplyAdd: x[k] = dr::fmadd(x[a], x[b], x[c]); break;
                case Op::Residual: x[k] = dr::fnmadd(x[a], x[b], x[c]); break;
                case Op::Less: m[k] = x[a] < x[b]; break;
                case Op::And: m[k] = m[a] & m[b]; break;
                case Op::Or: m[k] = m[a] | m[b]; break;
                case Op::Not: m[k] = !m[a]; break;
                case Op::Select: x[k] = dr::select(m[a], x[b], x[c]); break;
                case Op::Round: x[k] = dr::round(x[a]); break;
                case Op::Floor: x[k] = Float(Int(x[a])); break;
                case Op::ScaleByPowerOf2: x[k] = x[a] * power_of_2(x[b]); break;
                case Op::Exponent:
                    x[k] = Float((dr::reinterpret_array<Int>(dr::detach(x[a])) - 0x3f3504f3) >> 23);
                    break;
                case Op::FlipSign: x[k] = dr::mulsign(x[a], x[b]); break;
                case Op::Detach: x[k] = dr::detach(x[a]); break;
                case Op::Lookup: packets[k] = lookup(layout[a], UInt32(Int(x[b])), m[c]); break;
                case Op::Element: x[k] = packets[a][b]; break;
                default: break;
            }
        }
        std::vector<Float> results;
        for (uint32_t output : program.outputs)
            results.push_back(x[output]);
        return results;
    }
};

} // namespace prob_water
