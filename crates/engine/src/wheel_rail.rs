#![allow(non_snake_case)] // monogram notation
//! Every wheel on its rail: placement in the contact table, creepages in the contact plane, forces on the wheel.
//! Rails are rigid and lie still in the track frame, so absolute wheel velocities are slip velocities.
//!
//! A wheel may be larger than its contact table by `radius_offset` dr, its profile moved outwards as a whole. Table
//! coordinates are those of the tape circle's lowest point, which lies r0 + dr below the axle: an axle that stays at its
//! height presses the wheel deeper by dr, and roll shifts it by sin(roll) (r0 + dr). Every contact point lies at the
//! table's radius + dr, which is what creepages, moment arms and the torque on the rotor see. Not followed, of the order
//! dr/r0 (0.1 % for half a millimetre): the curvature of the tread along the rail in patch sizes and stiffnesses, and the
//! second-order gap of a yawed wheel.

use crate::error::Fault;
use crate::inputs::RAIL;
use crate::model::{Model, Wheel};
use crate::motion::Motion;
use crate::rates::Workspace;
use klingel_physics::Scalar;
use klingel_physics::contact::creep::{CreepTable, StickingContact, relaxation_length};
use klingel_physics::contact::{Patch, RollingContact};
use klingel_physics::math::Vec3;

/// A patch counts towards the reported contact angle above this load \[N\].
const REPORTED_LOAD: f64 = 1000.0;
/// Transient creepages stay below this part of mu N/(G a b C11), at a little more than 3 of which patches slide.
const SLIDING: f64 = 4.0;
/// A patch steeper than this is reported as steep \[rad\]: 15 degrees.
const STEEP: f64 = 0.261_799_387_799_149_4;

/// What a wheel and its rail do to each other.
#[derive(Clone, Copy, Debug, Default)]
pub struct WheelState<S> {
    /// On the wheel, resolved in T \[N\].
    pub force_T: Vec3<S>,
    /// Torque on the rotor about its axis, positive when it speeds up forward rolling \[N m\].
    pub spin_torque: S,
    /// Normal force of the tread, root and flange patch \[N\].
    pub normal: [S; 3],
    /// Sum of |Fx xi| + |Fy eta| \[N\].
    pub t_gamma: S,
    /// Sum of |Mz phi| \[N\].
    pub spin_work: S,
    /// Steepest patch above 1 kN \[rad\], and load of the most loaded patch over 15 degrees \[N\].
    pub contact_angle: S,
    pub steep_force: S,
    /// Coefficient of friction before the slip velocity lowers it \[-\].
    pub friction: S,
    /// Creepages along and across, means over the patches weighted with their loads \[-\].
    pub creep_x: S,
    pub creep_y: S,
    /// Powers on the wheel's contact \[W\]: lost to friction and to the damping of the approach, taken by the elastic
    /// normal force as it is pressed in, and given by a rail that moves or climbs a cant ramp: in the model forces stay in
    /// the cross-section, so that the ramp itself lifts the wheel.
    pub friction_power: S,
    pub damping_power: S,
    pub elastic_power: S,
    pub rail_power: S,
    /// Load of the patches so slender that the creep table does not hold their a/b \[N\].
    pub slender_force: S,
}

pub fn wheels<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) -> Result<(), Fault> {
    let rails = inputs[m.places.rails..].chunks_exact(RAIL.len());
    for ((wheel, state), rail) in m.wheels.iter().zip(&mut w.wheels).zip(rails) {
        let motion = &w.motions[wheel.body];
        let (forces, moment) = wheel_on_rail(m, wheel, motion, x, rail, dx, w.secants)?;
        let loads = &mut w.loads[wheel.body];
        loads.force_T += forces.force_T;
        loads.moment_T += moment;
        w.rotor_torque[wheel.rotor] += forces.spin_torque;
        *state = forces;
    }
    Ok(())
}

/// Forces of one wheel, and their moment about the body's centre of mass in T. `rail`: how it lies off its place, y and z,
/// how fast that changes at the wheel, and its roll about that place (the tape circle's, at the top of rail). Forces stay
/// in the cross-section: the slope of an irregularity along the rail turns neither the normal force nor the slip, effects
/// of second order for creepages and of N dz/ds along the track.
fn wheel_on_rail<S: Scalar>(
    m: &Model,
    wheel: &Wheel,
    body: &Motion<S>,
    x: &[S],
    rail: &[S],
    dx: &mut [S],
    secants: bool,
) -> Result<(WheelState<S>, Vec3<S>), Fault> {
    let (sign, spin) = (wheel.sign, x[m.rotors[wheel.rotor].state]);
    let standing_friction = m.friction(wheel, x);
    // point on the axle line in the tape-circle plane: position and velocity in T
    let centre_B = Vec3::constant(wheel.centre);
    let arm_T = body.R_TB.apply(centre_B);
    let p_T = body.p_T + arm_T;
    let v_T = body.v_T + body.R_TB.apply(body.w_B.cross(centre_B));

    // coordinates of the contact table, which is made for a right wheel
    let (sin_rail, cos_rail) = rail[4].sin_cos();
    let (y, z) = (p_T.y() - rail[0], p_T.z() - rail[1]);
    let sin_roll = body.sin_roll * cos_rail - body.cos_roll * sin_rail;
    let cos_roll = body.cos_roll * cos_rail + body.sin_roll * sin_rail;
    let shift =
        (y * cos_rail + z * sin_rail) * sign - sin_roll * (sign * wheel.radius) - cos_rail * wheel.half_tape_distance;
    let depth = z * cos_rail - (y - sign * wheel.half_tape_distance) * sin_rail + cos_roll * wheel.radius;
    // a cant ramp lifts the rail under the travelling wheel
    let climb = body.w_track_T.x() * (wheel.half_tape_distance * sign);
    let rail_rate_T = Vec3::new(S::zero(), rail[2], rail[3] + climb);
    let roll = sin_roll * sign;
    let yaw = body.yaw * sign;
    let patches =
        wheel.table.patches(shift, depth, roll, yaw).map_err(|outside| Fault::outside_table(&wheel.name, outside))?;

    let w_F = Vec3::new(body.w_F.x(), -spin, body.w_F.z());

    let touch = |patch: &Patch<S>| {
        let (sin, cos) = patch.angle.sin_cos();
        let radius = patch.radius + wheel.radius_offset;
        // the contact of a yawed wheel runs ahead: x = r tan(delta) psi
        let ahead = radius * yaw * sin / cos;
        let drop = ahead.square() / radius * 0.5;
        let point_F = Vec3::new(ahead, patch.y_wheel * sign, radius - drop);
        let point_T = body.R_TF.apply(point_F);
        let slip_T = v_T + body.R_TF.apply(w_F.cross(point_F));
        let (sin_T, cos_T) = (sin * cos_rail - cos * sin_rail * sign, cos * cos_rail + sin * sin_rail * sign);
        let across = Vec3::new(S::zero(), cos_T, sin_T * -sign);
        let into_rail = Vec3::new(S::zero(), sin_T * sign, cos_T);
        let w_T = body.R_TF.apply(w_F);

        let approach = (slip_T - rail_rate_T).dot(into_rail);
        let damping = (approach * m.contact_dissipation + 1.0).positive();
        let normal = patch.normal_force * damping;
        let mean_speed = (v_T.x() + spin * radius) * 0.5;
        let v_ref = (mean_speed.square() + m.creep_floor * m.creep_floor).sqrt();
        let creepages = [slip_T.x() / v_ref, slip_T.dot(across) / v_ref, w_T.dot(into_rail) / v_ref];
        Touch { point_F, point_T, across, into_rail, approach, normal, mean_speed, v_ref, creepages }
    };
    let lag = wheel.stick.map(|first| lag(m, wheel, patches.iter().map(|p| (p, touch(p))), first, x, dx, secants));

    let mut state = WheelState { friction: standing_friction, ..WheelState::default() };
    let mut moment_T = Vec3::zero();
    for (zone, patch) in patches.iter().enumerate() {
        if patch.active {
            let Touch { point_F, point_T, across, into_rail, approach, normal, mean_speed, v_ref, creepages } =
                touch(patch);
            let [xi, eta, phi] = creepages;
            let friction = match &m.falling_friction {
                Some(falling) => falling.at_creepage(standing_friction, v_ref, xi, eta),
                None => standing_friction,
            };
            let [lag_x, lag_y] = lag.unwrap_or_default();
            let sense = sense(mean_speed / m.creep_floor);
            let rolling = RollingContact {
                a: patch.a,
                b: patch.b,
                normal_force: normal,
                friction,
                xi: xi + lag_x,
                eta: eta + lag_y,
                phi: phi * sense,
            };
            let [fx, fy, mz] = if secants { m.creep.force_with_secants(&rolling) } else { m.creep.force(&rolling) };
            let mz = mz * sense;

            let force_T = Vec3::new(fx, S::zero(), S::zero()) + across * fy - into_rail * normal;
            let spin_moment_T = into_rail * mz;
            state.force_T += force_T;
            moment_T += (arm_T + point_T).cross(force_T) + spin_moment_T;
            let turning_F = point_F.cross(body.R_TF.back(force_T)) + body.R_TF.back(spin_moment_T);
            state.spin_torque -= turning_F.y();
            state.normal[zone] = normal;
            state.t_gamma += (fx * xi).abs() + (fy * eta).abs();
            state.spin_work += (mz * phi).abs();
            state.friction_power -= (fx * xi + fy * eta + mz * phi) * v_ref;
            state.damping_power += (normal - patch.normal_force) * approach;
            state.elastic_power += patch.normal_force * approach;
            state.rail_power -= normal * rail_rate_T.dot(into_rail);
            state.creep_x += normal * xi;
            state.creep_y += normal * eta;
            report_angle(&mut state, patch.angle, normal);
            if !CreepTable::holds(patch.a.value() / patch.b.value()) {
                state.slender_force += normal;
            }
        }
    }
    let load = state.normal[0] + state.normal[1] + state.normal[2];
    if load.value() > 0.0 {
        state.creep_x = state.creep_x / load;
        state.creep_y = state.creep_y / load;
    }
    Ok((state, moment_T))
}

/// One patch as it touches its rail: place in F and T, directions, speed of approach \[m/s\], load \[N\], speeds \[m/s\]
/// and quasi-steady creepages.
struct Touch<S> {
    point_F: Vec3<S>,
    point_T: Vec3<S>,
    across: Vec3<S>,
    into_rail: Vec3<S>,
    approach: S,
    normal: S,
    mean_speed: S,
    v_ref: S,
    creepages: [S; 3],
}

/// +1 rolling forward, -1 rolling back, smooth between at less than the least speed: rolling back, a creep law sees its
/// own mirror image along the track, in which spin and its moment change sides.
fn sense<S: Scalar>(parts: S) -> S {
    let s = parts.clamp(-1.0, 1.0);
    s * (s.square() * -0.5 + 1.5)
}

/// What the transient creepages of a sticking wheel are ahead of the quasi-steady ones, on average by load; their rates
/// into `dx`. Where the patches of a wheel slip differently, that difference stays quasi-steady.
fn lag<'a, S: Scalar>(
    m: &Model,
    wheel: &Wheel,
    touches: impl Iterator<Item = (&'a Patch<S>, Touch<S>)>,
    first: usize,
    x: &[S],
    dx: &mut [S],
    secants: bool,
) -> [S; 2] {
    // a wheel in the air has a patch of 5 mm with 1 N, and with G a b C11 over the load as under a wheel of some kN
    let (mut load, mut stiffness) = (S::one(), S::constant(300.0));
    let (mut length, mut speed) = (S::constant(5e-3), S::zero());
    let (mut slip, mut quasi_steady) = ([S::zero(); 2], [S::zero(); 2]);
    for (patch, touch) in touches.filter(|(patch, _)| patch.active) {
        load += touch.normal;
        length += patch.a * touch.normal;
        stiffness += m.creep.stiffness(patch.a, patch.b);
        speed += touch.mean_speed * touch.normal;
        for i in 0..2 {
            slip[i] += touch.creepages[i] * touch.v_ref * touch.normal;
            quasi_steady[i] += touch.creepages[i] * touch.normal;
        }
    }
    let creepage = [x[first], x[first + 1]];
    let contact = StickingContact {
        creepage,
        slip: slip.map(|w| w / load),
        speed: speed / load,
        length: relaxation_length(length / load),
        largest: load * m.friction(wheel, x) * SLIDING / stiffness,
    };
    let rates = if secants { contact.rates_with_secants(m.creep_floor) } else { contact.rates(m.creep_floor) };
    dx[first..first + 2].copy_from_slice(&rates);
    [0, 1].map(|i| creepage[i] - quasi_steady[i] / load)
}

fn report_angle<S: Scalar>(state: &mut WheelState<S>, angle: S, load: S) {
    if load.value() > REPORTED_LOAD {
        state.contact_angle = state.contact_angle.max(angle.abs());
    }
    if angle.value().abs() > STEEP {
        state.steep_force = state.steep_force.max(load);
    }
}
