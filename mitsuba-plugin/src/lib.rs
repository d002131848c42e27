//! What the Mitsuba shim calls: configuration and errors over a cxx bridge, the hot path of scalar variants as plain C functions.

mod evaluate;
mod options;
mod surface;
mod water;

use options::{Options, options, vocabulary};
use prob_water::brdf::Parts;
use prob_water::kernels::{Kernel, inputs};
use prob_water::simd::recorded::Operation;
use water::Water;

/// Those in `bits`: 1 facets, 2 whitecaps.
fn parts(bits: u32) -> Parts {
    Parts { facets: bits & 1 != 0, whitecaps: bits & 2 != 0 }
}

#[cxx::bridge(namespace = "prob_water")]
mod ffi {
    /// A numeric parameter.
    struct Number {
        name: String,
        value: f64,
    }

    /// What a variant of Mitsuba has of light and code.
    #[derive(Clone, Copy)]
    struct Variant {
        /// Code is traced.
        traced: bool,
        /// Light is polarised.
        polarised: bool,
        /// Every lane has a wavelength of its own.
        spectral: bool,
    }

    /// What a BSDF declares of itself.
    struct Traits {
        /// One drawn sea: every place has its own normal and whitecaps.
        drawn: bool,
        /// The order of source and observer matters.
        ordered: bool,
        /// Whether whitecaps take part.
        whitecaps: bool,
        /// The footprint comes with every place.
        varying_footprint: bool,
        /// So does the probability of a whitecap.
        whitecap_texture: bool,
        /// Index and whitecaps follow the lane.
        lanes: bool,
        /// The footprint is a pixel's.
        pixel: bool,
        /// Angle of a pixel, radians; 0 where ray differentials tell its size.
        pixel_angle: f32,
        /// D for a width of 1 of a pixel or of a texture.
        diameter: f32,
        /// m.
        footprint: f32,
    }

    /// `prob_water::kernels::Kernel`.
    #[repr(u32)]
    enum Kernel {
        Eval,
        Weight,
        Pdf,
        Draw,
        WaterLeavingShare,
        WaterLeaving,
        Diffuse,
        Wave,
        Normal,
        Polarisation,
        Lane,
        LaneReflectance,
    }

    /// `prob_water::kernels::inputs`.
    #[repr(u32)]
    enum Input {
        Source = 0,
        Observer = 3,
        Random = 6,
        Normal = 9,
        Footprint = 12,
        Whitecap = 13,
        Cosine = 14,
        Reflectance = 15,
        Wave = 16,
        Sums = 22,
        Wavelength = 25,
        Index = 26,
        Count = 27,
    }

    /// `prob_water::simd::recorded::Operation`.
    #[repr(u32)]
    enum Operation {
        Constant,
        Coefficient,
        Input,
        Add,
        Subtract,
        Multiply,
        Divide,
        Negate,
        Absolute,
        SquareRoot,
        Reciprocal,
        ReciprocalRoot,
        MultiplyAdd,
        Residual,
        Less,
        And,
        Or,
        Not,
        Select,
        Round,
        ScaleByPowerOf2,
        Exponent,
        FlipSign,
        Detach,
        Floor,
        Lookup,
        Element,
    }

    /// `prob_water::simd::recorded::Program`: operation and three operands of every instruction, and its outputs.
    struct Program {
        instructions: Vec<u32>,
        outputs: Vec<u32>,
    }

    /// `prob_water::numeric::packets::Packets`.
    struct Packets {
        width: u32,
        half: bool,
        numbers: Vec<f32>,
    }

    /// `prob_water::Kernels`.
    struct Kernels {
        coefficients: Vec<f32>,
        tables: Vec<Packets>,
        programs: Vec<Program>,
    }

    extern "Rust" {
        /// Parameters being collected.
        type Options;
        fn options() -> Box<Options>;
        /// Every name that the below know.
        fn vocabulary() -> Vec<String>;
        fn set_number(self: &mut Options, name: &str, value: f64) -> Result<()>;
        fn set_flag(self: &mut Options, name: &str, value: bool) -> Result<()>;
        fn set_text(self: &mut Options, name: &str, value: &str) -> Result<()>;
        /// The parameter is an object of the scene.
        fn set_object(self: &mut Options, name: &str) -> Result<()>;
        /// Reflectances of the water body from 360 to 830 nm, evenly; none where its chlorophyll is not given.
        fn water_body(self: &Options) -> Result<Vec<f64>>;
        /// What is set from now on is the shape's that the BSDF lies on.
        fn lend(self: &mut Options) -> Result<()>;
        /// The sea, for a variant.
        fn configure(self: &Options, variant: Variant) -> Result<Box<Water>>;
        /// The same with other numbers, which stay where they are not refused.
        fn change(self: &mut Options, numbers: &[Number], variant: Variant) -> Result<Box<Water>>;

        /// A configured sea.
        type Water;
        fn traits(self: &Water) -> Traits;
        /// Numbers that can be changed: those that are set and matter.
        fn exposed(self: &Water) -> Vec<Number>;
        fn kernels(self: &Water) -> Kernels;
        /// The waves of one drawn sea, eight numbers each: those of `Input::Wave` and two that fill a packet.
        fn drawn_waves(self: &Water) -> Vec<f64>;
        /// `name = value` lines of the parameters and of what follows from them.
        fn describe(self: &Water) -> String;
        /// Values that are allowed but hardly meant, a line each.
        fn warnings(self: &Water) -> Vec<String>;
        /// Changes what `describe` tells of the time.
        fn set_time(self: &mut Water, time: f64);

        /// The number of a kernel's program, for the parts in `bits` (1 facets, 2 whitecaps).
        fn program(kernel: Kernel, bits: u32) -> usize;
    }
}

/// Enumerations of the core by their numbers on the bridge: a word that the bridge lacks, or has under another name, does not
/// compile.
macro_rules! numbered {
    ($name:ident, $enumeration:ident: $($word:ident)*) => {
        fn $name(value: $enumeration) -> u32 {
            match value {
                $($enumeration::$word => ffi::$enumeration::$word.repr,)*
            }
        }
    };
}
numbered! {
    operation_number, Operation:
    Constant Coefficient Input Add Subtract Multiply Divide Negate Absolute
    SquareRoot Reciprocal ReciprocalRoot MultiplyAdd Residual Less And Or Not Select Round
    ScaleByPowerOf2 Exponent FlipSign Detach Floor Lookup Element
}
numbered! {
    kernel_number, Kernel: Eval Weight Pdf Draw WaterLeavingShare WaterLeaving Diffuse Wave Normal Polarisation Lane LaneReflectance
}

const _: () = {
    use ffi::Input;
    let same = [
        Input::Source.repr == inputs::SOURCE,
        Input::Observer.repr == inputs::OBSERVER,
        Input::Random.repr == inputs::RANDOM,
        Input::Normal.repr == inputs::NORMAL,
        Input::Footprint.repr == inputs::FOOTPRINT,
        Input::Whitecap.repr == inputs::WHITECAP,
        Input::Cosine.repr == inputs::COSINE,
        Input::Reflectance.repr == inputs::REFLECTANCE,
        Input::Wave.repr == inputs::WAVE,
        Input::Sums.repr == inputs::SUMS,
        Input::Wavelength.repr == inputs::WAVELENGTH,
        Input::Index.repr == inputs::INDEX,
        Input::Count.repr == inputs::COUNT,
    ];
    let mut k = 0;
    while k < same.len() {
        assert!(same[k], "the bridge has the core's numbers");
        k += 1;
    }
};

fn program(kernel: ffi::Kernel, bits: u32) -> usize {
    let known = Kernel::ALL.into_iter().find(|known| kernel_number(*known) == kernel.repr);
    known.expect("the bridge has the core's kernels").program(parts(bits))
}
