//! Writing strokes. Numbers are the shortest decimals that give the same bits again.

use crate::region::RegionChange;
use crate::stroke::{Action, Beginning, Constraint, MaskChange, PathPoint, Stroke, Sweep};
use core::fmt::{Formatter, Result};
use glam::DVec3;

pub fn beginning(f: &mut Formatter<'_>, beginning: &Beginning) -> Result {
    match beginning {
        Beginning::File(name) => write!(f, "start file {name}"),
        Beginning::Shape(start) => {
            write!(f, "start {} {}", start.shape.name(), start.divisions)?;
            if start.semi_axes == DVec3::ONE {
                return Ok(());
            }
            f.write_str(" ")?;
            vector(f, start.semi_axes)
        }
    }
}

pub fn stroke(f: &mut Formatter<'_>, stroke: &Stroke) -> Result {
    match stroke {
        Stroke::Stage(name) => write!(f, "stage {name}"),
        Stroke::Symmetry(planes) => symmetry(f, *planes),
        Stroke::Sweep(sweep) => write_sweep(f, sweep),
        Stroke::Region(change) => match change {
            RegionChange::All => f.write_str("region all"),
            RegionChange::None => f.write_str("region none"),
            RegionChange::Invert => f.write_str("region invert"),
            RegionChange::Grow(n) => write!(f, "region grow {n}"),
            RegionChange::Shrink(n) => write!(f, "region shrink {n}"),
        },
        Stroke::Masks(MaskChange::Clear) => f.write_str("mask clear"),
        Stroke::Masks(MaskChange::Invert) => f.write_str("mask invert"),
        Stroke::Refine(how) => write!(f, "refine {}", how.name()),
        Stroke::Loop(levels) => write!(f, "loop {levels}"),
        Stroke::Average(levels, share) => write!(f, "average {levels} {share}"),
        Stroke::Fill => f.write_str("fill"),
        Stroke::Delete(to) => write!(f, "delete {}", to.name()),
        Stroke::Simplify(share) => write!(f, "simplify {share}"),
    }
}

fn symmetry(f: &mut Formatter<'_>, planes: [bool; 3]) -> Result {
    if planes == [false; 3] {
        return f.write_str("symmetry off");
    }
    f.write_str("symmetry")?;
    let named = ["x", "y", "z"].into_iter().zip(planes);
    named
        .filter(|(_, on)| *on)
        .try_for_each(|(name, _)| write!(f, " {name}"))
}

fn write_sweep(f: &mut Formatter<'_>, sweep: &Sweep) -> Result {
    match sweep.action {
        Action::Push => f.write_str("push")?,
        Action::Pull => f.write_str("pull")?,
        Action::Smooth => f.write_str("smooth")?,
        Action::Mask(value) => write!(f, "mask {value}")?,
        Action::Paint([red, green, blue]) => write!(f, "paint {red} {green} {blue}")?,
        Action::Region(choice) => {
            f.write_str("region")?;
            if !choice.name().is_empty() {
                write!(f, " {}", choice.name())?;
            }
        }
    }
    let tool = &sweep.tool;
    write!(f, " {} ", tool.form.name())?;
    vector(f, tool.semi_axes)?;
    if tool.exponents != tool.form.exponents() {
        write!(f, " {} {}", tool.exponents[0], tool.exponents[1])?;
    }
    if tool.turn != DVec3::ZERO {
        f.write_str(" turn ")?;
        vector(f, tool.turn)?;
    }
    if sweep.range > 0.0 {
        write!(f, " {} {}", sweep.decay.name(), sweep.range)?;
    }
    match sweep.constraint {
        None => {}
        Some(Constraint::Normal) => f.write_str(" normal")?,
        Some(Constraint::Tangent) => f.write_str(" tangent")?,
    }
    if sweep.only_region {
        f.write_str(" only")?;
    }
    let mut separator = " :";
    for PathPoint { position, pressure } in &sweep.path {
        write!(f, "{separator} ")?;
        vector(f, *position)?;
        if *pressure != 1.0 {
            write!(f, " {pressure}")?;
        }
        separator = ",";
    }
    Ok(())
}

fn vector(f: &mut Formatter<'_>, v: DVec3) -> Result {
    write!(f, "{} {} {}", v.x, v.y, v.z)
}
