//! Wheels on their rails: profiles by name or points, contact tables, creep law.
//! Wheels of the same pair share one table.

use super::{Compiler, positive, value};
use crate::error::EngineError;
use crate::model::Wheel;
use crate::spec::{CreepSpec, PairSpec, ProfileSpec, Side, Spec};
use crate::tables::{self, Prepared};
use klingel_physics::contact::creep::{CreepOptions, Exact, FallingFriction, PolachReduction, SlopeReduction};
use klingel_physics::contact::{ContactError, CreepForce, CreepLaw, Material, PairGeometry, Profile};
use std::sync::Arc;

/// A wheel may be larger or smaller than its contact table by so much \[m\]: one per cent of the curvature of a patch.
const RADIUS_OFFSET_MAX: f64 = 5e-3;

impl Compiler<'_> {
    pub(super) fn wheels(&mut self, material: &Material) -> Result<Vec<Wheel>, EngineError> {
        let tables = tables_of(self.spec, material)?;
        let mut wheels = Vec::new();
        for w in &self.spec.wheels {
            let body = self.body(&w.name, &w.body)?;
            let (pair, prepared) = tables
                .get(w.pair)
                .ok_or_else(|| value(format!("{}.pair", w.name), w.pair, "give the index of a contact pair"))?;
            let half_tape_distance = pair.tape_circle();
            if w.radius_offset.is_nan() || w.radius_offset.abs() > RADIUS_OFFSET_MAX {
                let remedy = format!("give at most {RADIUS_OFFSET_MAX} m: the contact table keeps the nominal radius");
                return Err(value(format!("{}.radius_offset", w.name), w.radius_offset, &remedy));
            }
            let sign = if w.side == Side::Right { 1.0 } else { -1.0 };
            let stick = self.spec.creep.stick.then(|| {
                let first = self.states.add(format!("{}.stick_x", w.name), "1", 0.0);
                self.states.add(format!("{}.stick_y", w.name), "1", 0.0);
                first
            });
            wheels.push(Wheel {
                name: w.name.clone(),
                body,
                rotor: self.rotor(&w.name, body, &w.rotor)?,
                sign,
                table: Arc::clone(&prepared.table),
                friction: positive(&w.name, "friction", w.friction)?,
                half_tape_distance,
                radius: pair.radius + w.radius_offset,
                radius_offset: w.radius_offset,
                centre: [0.0, sign * half_tape_distance, -pair.radius - self.bodies[body].position[2]],
                stick,
            });
        }
        Ok(wheels)
    }
}

/// Every pair of a spec with its table, compiled if it was not yet.
fn tables_of(spec: &Spec, material: &Material) -> Result<Vec<(PairGeometry, Prepared)>, EngineError> {
    let table = |(index, pair): (usize, &PairSpec)| {
        let geometry = pair_geometry(index, pair)?;
        let prepared = tables::contact_table(&geometry, material, pair.normal.into())
            .map_err(|source| EngineError::Contact { index, source })?;
        Ok((geometry, prepared))
    };
    spec.contact_pairs.iter().enumerate().map(table).collect()
}

/// The contact tables of a spec, one a pair, so that the runs of a study find them ready.
///
/// # Errors
/// Profiles and pairs that are refused.
pub fn prepare(spec: &Spec) -> Result<Vec<Prepared>, EngineError> {
    Ok(tables_of(spec, &Material::STEEL)?.into_iter().map(|(_, prepared)| prepared).collect())
}

/// The creep law with its options, and how friction falls.
pub(super) fn creep_law(
    spec: &CreepSpec,
    material: &Material,
) -> Result<(CreepForce, Option<FallingFriction>), EngineError> {
    let slow =
        if spec.law == Exact::NAME { "it takes milliseconds a contact, too slow for a simulation; " } else { "" };
    let law = CreepLaw::named(&spec.law, spec.elements)
        .ok_or_else(|| value("creep.law", &spec.law, &format!("{slow}choose {}", CreepLaw::NAMES.join(", "))))?;
    let options = CreepOptions {
        reduction: spec.reduction.map(|[adhesion, slip]| PolachReduction { adhesion, slip }),
        blended: spec.blended,
        slope: spec.slope.map(|[initial, limit, decay]| SlopeReduction { initial, limit, decay }),
    };
    let falling = spec.falling.map(|[ratio, decay]| FallingFriction::new(ratio, decay)).transpose();
    Ok((CreepForce::with_options(law, options, material)?, falling?))
}

/// The profiles of a pair in their place.
///
/// # Errors
/// An unknown name, or what the profile is refused for.
pub fn pair_geometry(index: usize, pair: &PairSpec) -> Result<PairGeometry, EngineError> {
    let refused = |source| EngineError::Contact { index, source };
    Ok(PairGeometry {
        wheel: profile(&format!("contact_pairs[{index}].wheel"), &pair.wheel)?.map_err(refused)?,
        rail: profile(&format!("contact_pairs[{index}].rail"), &pair.rail)?.map_err(refused)?,
        rail_inclination: pair.rail_inclination,
        gauge: pair.gauge,
        flange_back: pair.flange_back,
        radius: pair.radius,
    })
}

fn profile(place: &str, spec: &ProfileSpec) -> Result<Result<Profile, ContactError>, EngineError> {
    Ok(match spec {
        ProfileSpec::Named(name) => Ok(named_profile(place, name)?),
        ProfileSpec::Cone(slope) => Profile::cone(*slope),
        ProfileSpec::Points { y, z } => Profile::from_points(y, z, place),
    })
}

/// A standard profile by its name; `cone(0.05)` is a cone of that slope.
///
/// # Errors
/// `EngineError::Value` for a name that is not known.
pub fn named_profile(place: &str, name: &str) -> Result<Profile, EngineError> {
    match name {
        "s1002" => Ok(Profile::s1002()),
        "60e1" => Ok(Profile::rail_60e1()),
        "54e1" => Ok(Profile::rail_54e1()),
        "uic60" => Ok(Profile::rail_uic60()),
        other => {
            let slope = other.strip_prefix("cone(").and_then(|rest| rest.strip_suffix(')')?.parse().ok());
            let cone = slope.and_then(|slope| Profile::cone(slope).ok());
            cone.ok_or_else(|| value(place, other, "choose s1002, cone(0.05), 60e1, 54e1 or uic60, or give points"))
        }
    }
}
