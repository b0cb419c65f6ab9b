//! What a creep law may be asked for beside its grid: reduced stiffness, blended flexibility, falling friction.
//! Everything is off by default, which gives the laws for dry and clean bodies as published.

use super::{CreepError, error::out_of_range};
use crate::Scalar;

/// Polach's reduction of the stiffness in the area of adhesion (kA) and of slip (kS), for large creepages and
/// contaminated rails: 0 < kS <= kA <= 1. Source: Polach, Wear 258 (2005) 992-1000.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolachReduction {
    /// kA, no unit.
    pub adhesion: f64,
    /// kS, no unit.
    pub slip: f64,
}

/// Spiryagin's reduction of the initial slope of FASTSIM: the flexibilities are divided by
/// k = k0 (alpha + (1 - alpha) / (1 + beta eps)), eps Polach's gradient of tangential stress at the stiffness k0.
///
/// Source: Spiryagin, Polach & Cole, Vehicle System Dynamics 51 (2013) 1765-1783.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeReduction {
    /// k0, the factor of the initial slope, above 0 and at most 1.
    pub initial: f64,
    /// alpha = k at infinite creepage over k0, 0 to 1.
    pub limit: f64,
    /// beta, how soon the slope falls, at least 0.
    pub decay: f64,
}

/// Options of the creep laws; those of another law than the chosen one are refused.
///
/// ```
/// use klingel_physics::contact::creep::{CreepForce, CreepLaw, CreepOptions, PolachReduction};
/// use klingel_physics::contact::Material;
/// let wet = PolachReduction { adhesion: 0.3, slip: 0.1 };
/// let options = CreepOptions { reduction: Some(wet), ..CreepOptions::default() };
/// assert!(CreepForce::with_options(CreepLaw::Polach, options, &Material::STEEL).is_ok());
/// assert!(CreepForce::with_options(CreepLaw::Linear, options, &Material::STEEL).is_err());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CreepOptions {
    /// Of the Polach law.
    pub reduction: Option<PolachReduction>,
    /// Of FASTSIM: the three flexibilities blend into one as sliding sets in.
    pub blended: bool,
    /// Of FASTSIM.
    pub slope: Option<SlopeReduction>,
}

impl CreepOptions {
    /// Refuses options of another law than the named one.
    ///
    /// # Errors
    /// Options of another law; values out of their range.
    pub fn check(&self, law: &str) -> Result<(), CreepError> {
        for (option, given, owner) in [
            ("reduction (kA, kS)", self.reduction.is_some(), "polach"),
            ("blended", self.blended, "fastsim"),
            ("slope (k0, alpha, beta)", self.slope.is_some(), "fastsim"),
        ] {
            if given && law != owner {
                let (option, owner) = (option.into(), owner.into());
                return Err(CreepError::Misplaced { option, owner, law: law.into() });
            }
        }
        if let Some(PolachReduction { adhesion, slip }) = self.reduction {
            positive("kA of the Polach law", adhesion, 1.0)?;
            positive("kS of the Polach law", slip, adhesion)?;
        }
        if let Some(SlopeReduction { initial, limit, decay }) = self.slope {
            positive("k0 of the slope reduction", initial, 1.0)?;
            between("alpha of the slope reduction", limit, 1.0)?;
            between("beta of the slope reduction", decay, f64::MAX)?;
        }
        Ok(())
    }
}

/// Friction that falls with the slip velocity: mu(w) = mu0 ((1 - A) exp(-B w) + A).
///
/// Apply it to the friction coefficient before the creep law; w is the size of the rigid slip at the contact point,
/// V sqrt(xi^2 + eta^2). Source: Polach, Wear 258 (2005) 992-1000; used so with FASTSIM by Spiryagin et al. (2013).
///
/// ```
/// use klingel_physics::contact::creep::FallingFriction;
/// let falling = FallingFriction::new(0.4, 0.6).unwrap();
/// assert!((falling.at(0.55_f64, 0.0) - 0.55).abs() < 1e-12);
/// assert!((falling.at(0.55_f64, 100.0) - 0.22).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingFriction {
    /// A = mu at infinite slip velocity over mu0.
    ratio: f64,
    /// B, s/m.
    decay: f64,
}

impl FallingFriction {
    /// A without unit (0 to 1), B in s/m (at least 0).
    ///
    /// # Errors
    /// Numbers out of these ranges.
    pub fn new(ratio: f64, decay: f64) -> Result<Self, CreepError> {
        between("A of the falling friction", ratio, 1.0)?;
        between("B of the falling friction", decay, f64::MAX)?;
        Ok(Self { ratio, decay })
    }

    /// The friction coefficient at a slip velocity (m/s, not negative), from that at rest.
    pub fn at<S: Scalar>(&self, at_rest: S, slip_velocity: S) -> S {
        at_rest * ((slip_velocity * -self.decay).exp() * (1.0 - self.ratio) + self.ratio)
    }

    /// The same at a speed (m/s) and the creepages of a contact; smooth at rest, where |slip| has a corner.
    pub fn at_creepage<S: Scalar>(&self, at_rest: S, speed: S, xi: S, eta: S) -> S {
        self.at(at_rest, ((xi.square() + eta.square()) * speed.square() + LEAST_SLIP * LEAST_SLIP).sqrt())
    }
}

/// Slip velocity below which friction no longer rises, m/s.
const LEAST_SLIP: f64 = 1e-9;

const REMEDY: &str = "docs/theory/creep.md has usual values";

fn between(what: &str, value: f64, most: f64) -> Result<(), CreepError> {
    if (0.0..=most).contains(&value) { Ok(()) } else { Err(out_of_range(what, value, [0.0, most], REMEDY)) }
}

fn positive(what: &str, value: f64, most: f64) -> Result<(), CreepError> {
    if value > 0.0 && value <= most { Ok(()) } else { Err(out_of_range(what, value, [0.0, most], REMEDY)) }
}
