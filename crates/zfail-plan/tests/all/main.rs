//! Planning without a device.

mod batches;
mod closure;
mod deep;
mod extraction;
mod figures;
mod layers;
mod shapes;
mod stacks;
mod topology;
mod walks;
