//! The closed form as a kernel: a number that writes down what is done with it.
//!
//! [`Traced`] is a [`crate::Real`]. Code of the model run with it leaves a [`Program`]: its operations in order, once each, for
//! an interpreter that repeats them on numbers of its own (arrays of a just-in-time compiler, say). What differs from sea to
//! sea are the recording's coefficients; constants of the formulas and decisions become part of the program.

use super::real::Lanes;
use super::vector::Arithmetic;
use crate::numeric::Real;
use crate::numeric::packets::{Packets, Tabulated};
use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::{BitAnd, BitOr, Not};

/// What an operation does with its operands a, b and c.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Operation {
    /// The number with the bits a.
    Constant,
    /// Coefficient a.
    Coefficient,
    /// Input a.
    Input,
    /// a + b.
    Add,
    /// a - b.
    Subtract,
    /// a b.
    Multiply,
    /// a/b.
    Divide,
    /// -a.
    Negate,
    /// |a|.
    Absolute,
    /// The square root of a.
    SquareRoot,
    /// 1/a.
    Reciprocal,
    /// 1/sqrt(a).
    ReciprocalRoot,
    /// a b + c, rounded once.
    MultiplyAdd,
    /// c - a b, rounded once.
    Residual,
    /// Whether a < b.
    Less,
    /// a and b.
    And,
    /// a or b.
    Or,
    /// Not a.
    Not,
    /// b where a holds, else c.
    Select,
    /// The integer nearest to a.
    Round,
    /// a 2^b.
    ScaleByPowerOf2,
    /// The exponent of a.
    Exponent,
    /// a with its sign flipped where b is negative.
    FlipSign,
    /// a without a derivative.
    Detach,
    /// The integer part of a, which is not negative.
    Floor,
    /// Packet b of table a, where the mask c holds.
    Lookup,
    /// Number b of the packet a.
    Element,
}

/// An operation: its operands are numbers of earlier ones, or what [`Operation`] says.
pub type Instruction = (Operation, [u32; 3]);

/// What was recorded.
#[derive(Debug, Clone, Default)]
pub struct Program {
    /// In order, each after its operands.
    pub instructions: Vec<Instruction>,
    /// Which of them are the results.
    pub outputs: Vec<u32>,
}

/// Several programs over the same coefficients and tables.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    /// Coefficients, in float32.
    pub coefficients: Vec<f32>,
    /// Tables.
    pub tables: Vec<Packets>,
}

/// A number being recorded.
pub(crate) type Traced = Lanes<Recorded>;

/// A constant, or what an instruction gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Recorded {
    /// Known while recording.
    Constant(f32),
    /// The result of an instruction.
    Node(u32),
}

/// The outcome of a comparison.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum RecordedMask {
    /// Known while recording.
    Constant(bool),
    /// The result of an instruction.
    Node(u32),
}

/// The program being recorded on this thread.
#[derive(Default)]
struct Tape {
    recording: Recording,
    /// How many coefficients this program has asked for: every program asks for the same ones first.
    asked: usize,
    instructions: Vec<Instruction>,
    known: HashMap<Instruction, u32>,
}

thread_local! {
    static TAPE: RefCell<Tape> = RefCell::default();
}

fn push(operation: Operation, operands: [u32; 3]) -> u32 {
    TAPE.with_borrow_mut(|tape| {
        let instructions = &mut tape.instructions;
        *tape.known.entry((operation, operands)).or_insert_with(|| {
            instructions.push((operation, operands));
            instructions.len() as u32 - 1
        })
    })
}

impl Recording {
    /// Records a program of numbers: `inputs` are how many inputs it has, the result its outputs. Coefficients and tables that
    /// it uses are added to the recording; all programs of a recording take the same coefficients in the same order.
    pub(crate) fn record(&mut self, inputs: u32, program: impl FnOnce(&[Traced]) -> Vec<Traced>) -> Program {
        TAPE.set(Tape { recording: std::mem::take(self), ..Tape::default() });
        let inputs: Vec<_> =
            (0..inputs).map(|k| Lanes(Recorded::Node(push(Operation::Input, [k, 0, 0])))).collect();
        let outputs = program(&inputs).iter().map(|x| x.0.node()).collect();
        let tape = TAPE.take();
        *self = tape.recording;
        Program { instructions: tape.instructions, outputs }.without_unused()
    }
}

impl Program {
    /// Without what no output needs.
    fn without_unused(self) -> Self {
        let mut used = vec![false; self.instructions.len()];
        for output in &self.outputs {
            used[*output as usize] = true;
        }
        for (k, (operation, operands)) in self.instructions.iter().enumerate().rev() {
            if used[k] {
                operation.operands().for_each(|operand| used[operands[operand] as usize] = true);
            }
        }
        let mut place = vec![0; self.instructions.len()];
        let mut instructions = Vec::new();
        for (k, (operation, mut operands)) in self.instructions.into_iter().enumerate() {
            if used[k] {
                for operand in operation.operands() {
                    operands[operand] = place[operands[operand] as usize];
                }
                place[k] = instructions.len() as u32;
                instructions.push((operation, operands));
            }
        }
        Self { instructions, outputs: self.outputs.iter().map(|output| place[*output as usize]).collect() }
    }
}

impl Operation {
    /// Which of an instruction's operands are numbers of earlier ones.
    fn operands(self) -> std::ops::Range<usize> {
        use Operation::*;
        match self {
            Constant | Coefficient | Input => 0..0,
            Negate | Absolute | SquareRoot | Reciprocal | ReciprocalRoot | Not | Round | Exponent
            | Detach | Floor | Element => 0..1,
            Add | Subtract | Multiply | Divide | Less | And | Or | ScaleByPowerOf2 | FlipSign => 0..2,
            MultiplyAdd | Residual | Select => 0..3,
            Lookup => 1..3,
        }
    }
}

use Recorded::{Constant, Node};

impl Recorded {
    fn node(self) -> u32 {
        match self {
            Constant(x) => push(Operation::Constant, [x.to_bits(), 0, 0]),
            Node(node) => node,
        }
    }

    fn unary(self, operation: Operation, fold: impl Fn(f32) -> f32) -> Self {
        match self {
            Constant(x) => Constant(fold(x)),
            Node(node) => Node(push(operation, [node, 0, 0])),
        }
    }

    fn binary(self, b: Self, operation: Operation, fold: impl Fn(f32, f32) -> f32) -> Self {
        match (self, b) {
            (Constant(x), Constant(y)) => Constant(fold(x, y)),
            _ => Node(push(operation, [self.node(), b.node(), 0])),
        }
    }

    fn ternary(self, b: Self, c: Self, operation: Operation) -> Self {
        Node(push(operation, [self.node(), b.node(), c.node()]))
    }
}

impl RecordedMask {
    fn node(self) -> u32 {
        match self {
            // No comparison of the model is known beforehand but those of constants.
            Self::Constant(holds) => {
                let [low, high] = [Constant(0.0).node(), Constant(1.0).node()];
                push(Operation::Less, if holds { [low, high, 0] } else { [high, low, 0] })
            }
            Self::Node(node) => node,
        }
    }
}

impl BitAnd for RecordedMask {
    type Output = Self;
    fn bitand(self, b: Self) -> Self {
        match (self, b) {
            (Self::Constant(true), other) | (other, Self::Constant(true)) => other,
            (Self::Constant(false), _) | (_, Self::Constant(false)) => Self::Constant(false),
            _ => Self::Node(push(Operation::And, [self.node(), b.node(), 0])),
        }
    }
}

impl BitOr for RecordedMask {
    type Output = Self;
    fn bitor(self, b: Self) -> Self {
        match (self, b) {
            (Self::Constant(false), other) | (other, Self::Constant(false)) => other,
            (Self::Constant(true), _) | (_, Self::Constant(true)) => Self::Constant(true),
            _ => Self::Node(push(Operation::Or, [self.node(), b.node(), 0])),
        }
    }
}

impl Not for RecordedMask {
    type Output = Self;
    fn not(self) -> Self {
        match self {
            Self::Constant(holds) => Self::Constant(!holds),
            Self::Node(node) => Self::Node(push(Operation::Not, [node, 0, 0])),
        }
    }
}

/// Zeros and ones are left out: 0 x is 0 whatever x is, which is not so of numbers that are none. Kernels do not carry those.
impl Arithmetic for Recorded {
    type Mask = RecordedMask;
    const MAX: Self = Constant(f32::MAX);
    const TINY: Self = Constant(f32::MIN_POSITIVE);
    const SMALL: Self = Constant(1e-9);

    fn splat(x: f32) -> Self {
        Constant(x)
    }
    fn coefficient(x: f32) -> Self {
        let number = TAPE.with_borrow_mut(|tape| {
            let number = tape.asked;
            tape.asked += 1;
            match tape.recording.coefficients.get(number) {
                Some(known) => assert!(known.to_bits() == x.to_bits(), "programs share their coefficients"),
                None => tape.recording.coefficients.push(x),
            }
            number as u32
        });
        Node(push(Operation::Coefficient, [number, 0, 0]))
    }
    fn add(self, b: Self) -> Self {
        match (self, b) {
            (Constant(0.0), other) | (other, Constant(0.0)) => other,
            _ => self.binary(b, Operation::Add, |a, b| a + b),
        }
    }
    fn sub(self, b: Self) -> Self {
        match (self, b) {
            (other, Constant(0.0)) => other,
            (Constant(0.0), other) => other.neg(),
            _ => self.binary(b, Operation::Subtract, |a, b| a - b),
        }
    }
    fn mul(self, b: Self) -> Self {
        match (self, b) {
            (Constant(0.0), _) | (_, Constant(0.0)) => Constant(0.0),
            (Constant(1.0), other) | (other, Constant(1.0)) => other,
            _ => self.binary(b, Operation::Multiply, |a, b| a * b),
        }
    }
    fn div(self, b: Self) -> Self {
        if self == Constant(1.0) { b.recip() } else { self.binary(b, Operation::Divide, |a, b| a / b) }
    }
    fn neg(self) -> Self {
        self.unary(Operation::Negate, |a| -a)
    }
    fn abs(self) -> Self {
        self.unary(Operation::Absolute, f32::abs)
    }
    fn sqrt(self) -> Self {
        self.unary(Operation::SquareRoot, f32::sqrt)
    }
    fn recip(self) -> Self {
        self.unary(Operation::Reciprocal, f32::recip)
    }
    fn rsqrt(self) -> Self {
        self.unary(Operation::ReciprocalRoot, |a| a.sqrt().recip())
    }
    fn min(self, b: Self) -> Self {
        Self::select(self.lt(b), self, b)
    }
    fn max(self, b: Self) -> Self {
        Self::select(b.lt(self), self, b)
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        match (self, a, b) {
            (Constant(0.0), ..) | (_, Constant(0.0), _) => b,
            (Constant(1.0), other, _) | (other, Constant(1.0), _) => other.add(b),
            (_, _, Constant(0.0)) => self.mul(a),
            (Constant(x), Constant(y), _) => Constant(x * y).add(b),
            _ => self.ternary(a, b, Operation::MultiplyAdd),
        }
    }
    fn residual(self, a: Self, c: Self) -> Self {
        self.ternary(a, c, Operation::Residual)
    }
    fn lt(self, b: Self) -> RecordedMask {
        match (self, b) {
            (Constant(x), Constant(y)) => RecordedMask::Constant(x < y),
            _ => RecordedMask::Node(push(Operation::Less, [self.node(), b.node(), 0])),
        }
    }
    fn select(mask: RecordedMask, a: Self, b: Self) -> Self {
        match mask {
            RecordedMask::Constant(holds) => {
                if holds {
                    a
                } else {
                    b
                }
            }
            RecordedMask::Node(mask) => Node(push(Operation::Select, [mask, a.node(), b.node()])),
        }
    }
    fn round(self) -> Self {
        self.unary(Operation::Round, f32::round_ties_even)
    }
    fn ldexp(self, n: Self) -> Self {
        Node(push(Operation::ScaleByPowerOf2, [self.node(), n.node(), 0]))
    }
    fn exponent(self) -> Self {
        Node(push(Operation::Exponent, [self.node(), 0, 0]))
    }
    fn flip_sign_by(self, sign: Self) -> Self {
        Node(push(Operation::FlipSign, [self.node(), sign.node(), 0]))
    }
    fn detach(self) -> Self {
        match self {
            Constant(_) => self,
            Node(node) => Node(push(Operation::Detach, [node, 0, 0])),
        }
    }
}

impl Tabulated for Traced {
    fn step(self, steps: u32) -> (Self, Self) {
        let Node(node) = self.0.detach() else { unreachable!("places come from inputs") };
        let last = Self::splat((steps - 1) as f32);
        // What is not a number has no integer part: lookups must stay within their table.
        let floor = Lanes(Node(push(Operation::Floor, [node, 0, 0])));
        let step = Self::min(Self::max(floor, Self::splat(0.0)), last);
        (step, self - step)
    }

    fn lookup<const N: usize>(table: &Packets, index: Self, active: RecordedMask) -> [Self; N] {
        let number = TAPE.with_borrow_mut(|tape| {
            let tables = &mut tape.recording.tables;
            let known =
                tables.iter().position(|known| std::sync::Arc::ptr_eq(&known.numbers, &table.numbers));
            known.unwrap_or_else(|| {
                tables.push(table.clone());
                tables.len() - 1
            }) as u32
        });
        let packet = push(Operation::Lookup, [number, index.0.node(), active.node()]);
        std::array::from_fn(|k| Lanes(Node(push(Operation::Element, [packet, k as u32, 0]))))
    }
}
