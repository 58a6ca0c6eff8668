//! What a method does with the stencil, as a programmer of its day set it up: a start value, then passes over volumes.
//!
//! A method's module makes a [`Procedure`] and the `stage` carries it out: depth of the scene, the passes in order, and
//! the verdict: lit where the stencil has come back to 0.

use crate::volumes::Volumes;
use wgpu::{CompareFunction, Face, StencilFaceState, StencilOperation};
use zfail_plan::view::View;

/// What the stage is to do.
#[derive(Clone, Debug)]
pub struct Procedure {
    /// The camera, with the method's own far plane.
    pub view: View,
    /// What the stencil holds before the first pass, modulo 256.
    pub start: u32,
    /// What is drawn.
    pub lists: Vec<Volumes>,
    /// In which passes.
    pub passes: Vec<Pass>,
    /// Whether some depth in front of the near plane is kept free for passes that are [`Pass::on_ledge`].
    pub ledge: bool,
    /// Whether what is not 0 is lit instead.
    pub inverted: bool,
}

/// All of one list of volumes, drawn once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Pass {
    /// Index into [`Procedure::lists`].
    pub list: usize,
    /// Which faces are left out.
    pub cull: Option<Face>,
    /// The depth test; depth is reversed, so that `Greater` passes what lies in front of the visible surface.
    pub depth: CompareFunction,
    /// What front faces do to the stencil.
    pub front: StencilFaceState,
    /// What back faces do to it.
    pub back: StencilFaceState,
    /// Whether it is drawn in front of everything, in the depth kept free by [`Procedure::ledge`].
    pub on_ledge: bool,
}

impl Pass {
    /// Both faces in one pass over list 0 ("two-sided stencil testing", E&K 4.3).
    pub const fn two_sided(front: StencilFaceState, back: StencilFaceState) -> Self {
        Self { list: 0, cull: None, depth: CompareFunction::Greater, front, back, on_ledge: false }
    }

    /// z-pass: the faces in front of the visible surface, entered minus left (E&K 2.2.1), with counts that wrap.
    pub const Z_PASS: Self =
        Self::two_sided(in_front(StencilOperation::IncrementWrap), in_front(StencilOperation::DecrementWrap));

    /// z-fail: the faces at or behind the visible surface, left minus entered (E&K 2.2.3), with counts that wrap.
    pub const Z_FAIL: Self =
        Self::two_sided(behind(StencilOperation::DecrementWrap), behind(StencilOperation::IncrementWrap));
}

/// `glStencilOp(KEEP, KEEP, operation)`: for what passes the depth test.
pub const fn in_front(operation: StencilOperation) -> StencilFaceState {
    StencilFaceState { pass_op: operation, ..KEEP }
}

/// `glStencilOp(KEEP, operation, KEEP)`: for what fails it.
pub const fn behind(operation: StencilOperation) -> StencilFaceState {
    StencilFaceState { depth_fail_op: operation, ..KEEP }
}

const KEEP: StencilFaceState = StencilFaceState::IGNORE;
