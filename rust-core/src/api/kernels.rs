//! The closed forms as programs for a renderer that compiles its own code: recorded from the same text that everything else runs.

use crate::brdf::{Dispersion, Lobe, Parts};
use crate::empirical::FineGrid;
use crate::numeric::Real;
use crate::numeric::real::Extended;
use crate::render::ensemble_lobe::MeanLobe;
use crate::render::{FacetTable, OnsetTable, WaveTerm};
use crate::sea::whitecap::Onset;
use crate::simd::recorded::{Program, Recording, Traced};

/// What a program gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kernel {
    /// f times the cosine among the inputs.
    Eval,
    /// The same where its last digits do not matter.
    Weight,
    /// The density of draws, 1/sr.
    Pdf,
    /// A drawn direction, and 1 where it comes from the whitecaps.
    Draw,
    /// The share of draws for the light from below, by its reflectance.
    WaterLeavingShare,
    /// `f cos(theta_o)` of the light from below for a reflectance of 1, and the density of draws by cosine.
    WaterLeaving,
    /// Diffuse reflectance of the whitecaps, and the share of water without any.
    Diffuse,
    /// The sums over the waves with another one.
    Wave,
    /// The wave normal and the probability of a whitecap that follow.
    Normal,
    /// m01, m22 and m23 of the facets' Mueller matrix over m00, [`crate::Reflectance::polarised`].
    Polarisation,
    /// The index and the whitecaps' BRDF over the sea's, at a wavelength.
    Lane,
    /// The facets' reflectance for an index over the sea's.
    LaneReflectance,
}

impl Kernel {
    /// Those that there are for facets alone, whitecaps alone and both.
    const OF_PARTS: [Self; 5] = [Self::Eval, Self::Weight, Self::Pdf, Self::Draw, Self::WaterLeavingShare];

    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::Eval,
        Self::Weight,
        Self::Pdf,
        Self::Draw,
        Self::WaterLeavingShare,
        Self::WaterLeaving,
        Self::Diffuse,
        Self::Wave,
        Self::Normal,
        Self::Polarisation,
        Self::Lane,
        Self::LaneReflectance,
    ];

    /// The number of its program among a sea's, for the parts that take part (of those [`Kernel::Wave`] knows nothing).
    ///
    /// # Panics
    /// Where no part does and the kernel is one of parts.
    pub fn program(self, parts: Parts) -> usize {
        let count = Self::OF_PARTS.len();
        if (self as usize) < count {
            let nth = PARTS.iter().position(|known| *known == parts).expect("a part takes part");
            nth * count + self as usize
        } else {
            PARTS.len() * count + self as usize - count
        }
    }
}

const PARTS: [Parts; 3] = [Parts::FACETS, Parts::WHITECAPS, Parts::ALL];

/// What the inputs of a program are, by their numbers.
pub mod inputs {
    /// Unit vector to the source; where the order matters, to the light.
    pub const SOURCE: u32 = 0;
    /// Unit vector to the observer.
    pub const OBSERVER: u32 = 3;
    /// Three uniform numbers of [0, 1).
    pub const RANDOM: u32 = 6;
    /// The wave normal.
    pub const NORMAL: u32 = 9;
    /// The footprint, m; of a wave and of what follows from all of them its log2.
    pub const FOOTPRINT: u32 = 12;
    /// The probability of a whitecap.
    pub const WHITECAP: u32 = 13;
    /// The cosine that f is multiplied by.
    pub const COSINE: u32 = 14;
    /// The reflectance of the water body.
    pub const REFLECTANCE: u32 = 15;
    /// A wave: turns, turns per m along x and y, amplitude in m, omega^2 in 1/s^2, log2(k/pi).
    pub const WAVE: u32 = 16;
    /// Sums over the waves, of [`WaveTerm::add_to`].
    pub const SUMS: u32 = 22;
    /// A wavelength, nm.
    pub const WAVELENGTH: u32 = 25;
    /// The index of a wavelength, where there are many.
    pub const INDEX: u32 = 26;
    /// How many.
    pub const COUNT: u32 = 27;
}

/// What differs from place to place.
#[derive(Debug, Clone, Copy, Default)]
pub struct Places<'a> {
    /// The normal is a wave's.
    pub normal: bool,
    /// Whitecaps come with it.
    pub onset: Option<Onset<f64>>,
    /// Their onset for a footprint.
    pub onsets: Option<&'a OnsetTable<f64>>,
    /// The probability of a whitecap is an input.
    pub whitecap: bool,
    /// Facets for a footprint.
    pub footprint: Option<&'a FacetTable<f64>>,
}

/// What is told of light; what is not asked for has empty programs.
#[derive(Debug, Clone, Copy, Default)]
pub struct Light<'a> {
    /// It is polarised.
    pub polarised: bool,
    /// It has many wavelengths: an index is among the inputs.
    pub dispersion: Option<&'a Dispersion<f64>>,
}

impl Light<'_> {
    fn has(&self, kernel: Kernel) -> bool {
        match kernel {
            Kernel::Polarisation => self.polarised,
            Kernel::Lane | Kernel::LaneReflectance => self.dispersion.is_some(),
            _ => true,
        }
    }
}

/// What is evaluated.
#[derive(Debug, Clone, Copy)]
pub enum Mean<'a> {
    /// The lobe itself.
    Facets,
    /// A sea from afar.
    Ensemble(&'a MeanLobe<f64>),
    /// The same by a table of the empirical model.
    Empirical(&'a FineGrid<f64>),
}

/// The programs of a sea.
#[derive(Debug, Clone, Default)]
pub struct Kernels {
    /// Coefficients and tables.
    pub recording: Recording,
    /// By [`Kernel::program`].
    pub programs: Vec<Program>,
}

impl Kernels {
    /// Of a lobe; where there is another mean than its own, it draws for this one.
    pub fn new(lobe: &Lobe<f64>, mean: Mean, places: Places, light: Light) -> Self {
        let mut recording = Recording::default();
        let mut programs = Vec::new();
        let mut record = |kernel: Kernel, parts: Parts| {
            programs.push(if light.has(kernel) {
                recording.record(inputs::COUNT, |x| {
                    Sea::new(lobe, mean, places, light, Inputs(x)).run(kernel, parts, Inputs(x))
                })
            } else {
                Program::default()
            });
        };
        for parts in PARTS {
            for kernel in Kernel::OF_PARTS {
                record(kernel, parts);
            }
        }
        for kernel in Kernel::ALL.into_iter().skip(Kernel::OF_PARTS.len()) {
            record(kernel, Parts::ALL);
        }
        Self { recording, programs }
    }
}

/// The inputs of a program.
#[derive(Clone, Copy)]
struct Inputs<'a>(&'a [Traced]);

impl Inputs<'_> {
    fn number(&self, at: u32) -> Traced {
        self.0[at as usize]
    }

    fn vector(&self, first: u32) -> [Traced; 3] {
        [self.number(first), self.number(first + 1), self.number(first + 2)]
    }
}

/// [`Mean`] as it is recorded.
enum TracedMean {
    Facets,
    Ensemble(MeanLobe<Traced>),
    Empirical(FineGrid<Traced>),
}

/// A sea at a place, as it is recorded.
struct Sea {
    lobe: Lobe<Traced>,
    mean: TracedMean,
    normal: Option<[Traced; 3]>,
    onset: Option<Onset<Traced>>,
    onsets: Option<OnsetTable<Traced>>,
    log2_footprint: Option<Traced>,
    dispersion: Option<Dispersion<Traced>>,
}

impl Sea {
    fn new(lobe: &Lobe<f64>, mean: Mean, places: Places, light: Light, x: Inputs) -> Self {
        let mut lobe: Lobe<Traced> = lobe.cast();
        // Means need no digits that turning takes: where the wind comes from is data.
        let mean = match mean {
            Mean::Facets => TracedMean::Facets,
            Mean::Ensemble(mean) => {
                let mut mean: MeanLobe<Traced> = mean.cast();
                mean.lobe.facets.wind.quadrant = None;
                lobe.facets.wind.quadrant = None;
                TracedMean::Ensemble(mean)
            }
            Mean::Empirical(grid) => {
                let mut grid: FineGrid<Traced> = grid.cast();
                grid.lobe.facets.wind.quadrant = None;
                lobe.facets.wind.quadrant = None;
                TracedMean::Empirical(grid)
            }
        };
        if let Some(table) = places.footprint {
            table.cast().set(&mut lobe.facets, x.number(inputs::FOOTPRINT));
        }
        if places.whitecap {
            lobe.whitecap_fraction = x.number(inputs::WHITECAP);
            lobe.smooth_fraction = Traced::of(1.0) - x.number(inputs::WHITECAP);
        }
        Self {
            lobe,
            mean,
            normal: places.normal.then(|| x.vector(inputs::NORMAL)),
            onset: places.onset.map(|onset| onset.cast()),
            onsets: places.onsets.map(OnsetTable::cast),
            log2_footprint: places.footprint.map(|_| x.number(inputs::FOOTPRINT)),
            dispersion: light.dispersion.map(Dispersion::cast),
        }
    }

    /// The lobe for the index among the inputs, if there is one.
    fn lobe_of_lane(&self, x: Inputs) -> Lobe<Traced> {
        let mut lobe = self.lobe;
        if let Some(dispersion) = &self.dispersion {
            lobe.facets.reflectance = dispersion.reflectance(x.number(inputs::INDEX));
        }
        lobe
    }

    fn run(&self, kernel: Kernel, parts: Parts, x: Inputs) -> Vec<Traced> {
        let (i, o) = (x.vector(inputs::SOURCE), x.vector(inputs::OBSERVER));
        match kernel {
            Kernel::Eval => vec![self.eval(i, o, x.number(inputs::COSINE), parts, true)],
            Kernel::Weight => vec![self.eval(i, o, x.number(inputs::COSINE), parts, false)],
            Kernel::Pdf => vec![self.pdf(i, o, parts)],
            Kernel::Draw => {
                let (direction, whitecap) = self.lobe.draw(i, self.normal, x.vector(inputs::RANDOM), parts);
                let whitecap = Traced::select(whitecap, Traced::of(1.0), Traced::of(0.0));
                vec![direction[0], direction[1], direction[2], whitecap]
            }
            Kernel::WaterLeavingShare => {
                vec![self.lobe.water_leaving_share(i, x.number(inputs::REFLECTANCE), parts)]
            }
            Kernel::WaterLeaving => self.lobe_of_lane(x).water_leaving(i, o).to_vec(),
            Kernel::Diffuse => vec![self.lobe.whitecap_albedo(), self.lobe.smooth_fraction],
            Kernel::Wave => {
                let wave = |k| x.number(inputs::WAVE + k);
                let wave = WaveTerm {
                    turns: wave(0),
                    wave_number: [wave(1), wave(2)],
                    amplitude: wave(3),
                    frequency_squared: wave(4),
                    log2_fading: wave(5),
                };
                wave.add_to(x.vector(inputs::SUMS), self.log2_footprint).to_vec()
            }
            Kernel::Normal => {
                let [down_x, down_y, fall] = x.vector(inputs::SUMS);
                let z = down_x.mul_add(down_x, down_y.mul_add(down_y, Traced::of(1.0))).rsqrt();
                let onset = match (&self.onsets, self.log2_footprint) {
                    (Some(onsets), Some(log2_footprint)) => Some(onsets.at(log2_footprint)),
                    _ => self.onset,
                };
                let whitecap = onset.map_or(Traced::of(0.0), |onset| onset.probability(-fall));
                vec![down_x * z, down_y * z, z, whitecap]
            }
            Kernel::Polarisation => self.lobe_of_lane(x).facets.reflectance.polarised_between(i, o).to_vec(),
            Kernel::Lane => match &self.dispersion {
                Some(dispersion) => dispersion.at(x.number(inputs::WAVELENGTH)).to_vec(),
                None => vec![],
            },
            Kernel::LaneReflectance => match &self.dispersion {
                Some(dispersion) => dispersion.ratios([x.number(inputs::INDEX)], i, o).to_vec(),
                None => vec![],
            },
        }
    }

    fn eval(
        &self,
        i: [Traced; 3],
        o: [Traced; 3],
        cosine: Traced,
        parts: Parts,
        last_digits: bool,
    ) -> Traced {
        match &self.mean {
            TracedMean::Ensemble(mean) => mean.eval(i, o, parts) * cosine,
            TracedMean::Empirical(grid) => grid.eval(i, o, parts) * cosine,
            TracedMean::Facets if last_digits && self.lobe.facets.needs_extended(self.normal.is_none()) => {
                self.eval_in::<<Traced as Real>::Extended>(i, o, parts, cosine)
            }
            TracedMean::Facets => self.eval_in::<<Traced as Real>::Plain>(i, o, parts, cosine),
        }
    }

    fn eval_in<E: Extended<Traced>>(
        &self,
        i: [Traced; 3],
        o: [Traced; 3],
        parts: Parts,
        cosine: Traced,
    ) -> Traced {
        let f = self.lobe.eval_in::<E>(i, o, self.normal, parts);
        match self.normal {
            Some(n) => self.lobe.projected_from_wave::<E>(f, i, o, n),
            None => f * cosine,
        }
    }

    fn pdf(&self, i: [Traced; 3], o: [Traced; 3], parts: Parts) -> Traced {
        let zero = Traced::of(0.0);
        if !matches!(self.mean, TracedMean::Facets) {
            return self.lobe.pdf_in::<<Traced as Real>::Plain>(i, o, None, parts);
        }
        let pdf = self.lobe.pdf_parts(i, o, self.normal, parts);
        if self.normal.is_none() {
            return pdf;
        }
        Traced::select(Traced::lt(zero, i[2]) & Traced::lt(zero, o[2]), pdf, zero)
    }
}
