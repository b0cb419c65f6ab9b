#![allow(non_snake_case)] // monogram notation
//! Joints and the elements between two bodies: deflections, laws, and the forces back on both.
//! The force is resolved in the frame of `a` and acts at the point of `b` on both bodies, as the virtual work demands.

use crate::model::{Joint, Model};
use crate::motion::Motion;
use crate::rates::{Loads, Workspace};
use klingel_physics::Scalar;
use klingel_physics::drives::ActuatorState;
use klingel_physics::math::Vec3;

/// Deflection of a joint and the force that its elements have summed up.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointState<S> {
    /// Point of b minus point of a, in a \[m\], and its rate \[m/s\].
    pub u: Vec3<S>,
    pub rate: Vec3<S>,
    /// Small rotation of b relative to a, in a \[rad\], and its rate \[rad/s\].
    pub angle: Vec3<S>,
    pub spin: Vec3<S>,
    /// Arm from the centre of each body to the point of b, in W \[m\].
    arm_a: Vec3<S>,
    arm_b: Vec3<S>,
    /// On b, resolved in a \[N\], \[N m\].
    pub force: Vec3<S>,
    pub torque: Vec3<S>,
}

/// Kinematics of every joint; forces start at zero.
pub fn joints<S: Scalar>(m: &Model, w: &mut Workspace<S>) {
    for (joint, state) in m.joints.iter().zip(&mut w.joints) {
        let (a, b): (&Motion<S>, &Motion<S>) = (&w.motions[joint.a], &w.motions[joint.b]);
        let arm_b = b.R_WB.apply(Vec3::constant(joint.point_b));
        let arm_a = (b.p_W - a.p_W) + arm_b;
        let velocity = (b.v_W + b.w_W.cross(arm_b)) - (a.v_W + a.w_W.cross(arm_a));
        *state = JointState {
            u: a.R_WB.back(arm_a) - Vec3::constant(joint.point_a),
            rate: a.R_WB.back(velocity),
            arm_a,
            arm_b,
            ..JointState::default()
        };
        if joint.turns {
            // half the skew part of R_AB: sin of the angle about its axis
            let (ra, rb) = (&a.R_WB.0, &b.R_WB.0);
            let r = |i: usize, j: usize| ra[0][i] * rb[0][j] + ra[1][i] * rb[1][j] + ra[2][i] * rb[2][j];
            state.angle = Vec3::new(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)) * S::constant(0.5);
            state.spin = a.R_WB.back(b.w_W - a.w_W);
        }
    }
}

/// Springs, dampers, stops and actuators; rates of their inner states.
pub fn elements<S: Scalar>(m: &Model, x: &[S], inputs: &[S], w: &mut Workspace<S>, dx: &mut [S]) {
    for (joint, law) in &m.bushings {
        let j = &mut w.joints[*joint];
        j.force += law.force(j.u, j.rate);
        if law.turns() {
            j.torque += law.torque(j.angle, j.spin);
        }
    }
    for e in &m.maxwells {
        let j = &mut w.joints[e.joint];
        j.force.0[e.axis] -= x[e.state];
        dx[e.state] = e.law.rate(x[e.state], j.rate.0[e.axis]);
    }
    for e in &m.stops {
        let j = &mut w.joints[e.joint];
        let resisting = e.law.force(j.u.0[e.axis]);
        j.force.0[e.axis] -= resisting;
    }
    for e in &m.actuators {
        let j = &mut w.joints[e.joint];
        let state = ActuatorState { force: x[e.state], force_rate: x[e.state + 1] };
        j.force.0[0] += e.law.force(&state, j.u.x());
        let rates = e.law.rates(&state, inputs[e.input]);
        (dx[e.state], dx[e.state + 1]) = (rates.force, rates.force_rate);
    }
}

/// Adds what the joints carry to the loads of their bodies, mirror partners together.
pub fn apply<S: Scalar>(m: &Model, w: &mut Workspace<S>) {
    for &(first, partner) in &m.joint_pairs {
        let Joint { a, b, .. } = m.joints[first];
        let mut carried = carry(m, w, first);
        if let Some(partner) = partner {
            let other = carry(m, w, partner);
            carried = [0, 1, 2].map(|i| carried[i] + other[i]);
        }
        let [force, on_a, on_b] = carried;
        let Loads { force_W, moment_W, .. } = &mut w.loads[b];
        *force_W += force;
        *moment_W += on_b;
        let Loads { force_W, moment_W, .. } = &mut w.loads[a];
        *force_W -= force;
        *moment_W -= on_a;
    }
}

/// Force on b, the moment that a gives and the moment that b takes about their centres of mass, in W.
fn carry<S: Scalar>(m: &Model, w: &Workspace<S>, joint: usize) -> [Vec3<S>; 3] {
    let state = &w.joints[joint];
    let R_WA = &w.motions[m.joints[joint].a].R_WB;
    let force = R_WA.apply(state.force);
    let (mut on_a, mut on_b) = (state.arm_a.cross(force), state.arm_b.cross(force));
    if m.joints[joint].turns {
        let torque = R_WA.apply(state.torque);
        on_a += torque;
        on_b += torque;
    }
    [force, on_a, on_b]
}
