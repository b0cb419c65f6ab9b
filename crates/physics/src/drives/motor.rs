//! The traction drive of one wheel: separately excited DC motor, gearbox, elastic transmission.
//! Equation numbers are those of Perez, Busturia, Mei, Vinolas (2004), Annual Reviews in Control 28, 207-217.

use crate::Scalar;

/// Constants of one drive. The wheel turns N times for one turn of the motor (N < 1).
///
/// ```
/// use klingel_physics::drives::{Drive, DriveState};
/// let drive = Drive {
///     armature_resistance: 0.15, armature_inductance: 3e-3, emf_constant: 0.4646, field_current: 6.0,
///     gear_ratio: 1.0 / 3.0, rotor_inertia: 1.0, rotor_damping: 0.02,
///     transmission_stiffness: 1e6, transmission_damping: 300.0,
/// };
/// let (state, voltage) = drive.steady_state(106.0, 176.0); // wheel speed rad/s, torque on the wheel N m
/// let rates = drive.rates(&state, voltage, 106.0);
/// assert!(rates.armature_current.abs() < 1e-9 && rates.motor_speed.abs() < 1e-9 && rates.twist.abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Ra \[Ohm\]
    pub armature_resistance: f64,
    /// La \[H\]
    pub armature_inductance: f64,
    /// Ke \[V s/(rad A)\]
    pub emf_constant: f64,
    /// If, constant: the field is set for the speed before a run \[A\].
    pub field_current: f64,
    /// N = wheel speed over motor speed \[-\].
    pub gear_ratio: f64,
    /// JM \[kg m2\]
    pub rotor_inertia: f64,
    /// CM \[N m s/rad\]
    pub rotor_damping: f64,
    /// KOUT, on the wheel's side of the gearbox \[N m/rad\].
    pub transmission_stiffness: f64,
    /// COUT, on the wheel's side of the gearbox \[N m s/rad\].
    pub transmission_damping: f64,
}

/// State of one drive, or its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveState<S> {
    /// Ia \[A\]
    pub armature_current: S,
    /// wM against the axle bridge, positive while the wheel rolls forward \[rad/s\].
    pub motor_speed: S,
    /// thE - thOUT, positive while the shaft drives the wheel forward \[rad\].
    pub twist: S,
}

impl Drive {
    /// KT = Ke If, Eq. (6) \[N m/A\].
    pub fn torque_constant(&self) -> f64 {
        self.emf_constant * self.field_current
    }

    /// TM of Eqs (4) and (7): the air-gap torque on the rotor \[N m\].
    #[inline(always)]
    pub fn motor_torque<S: Scalar>(&self, armature_current: S) -> S {
        armature_current * self.torque_constant()
    }

    /// TOUT of Eq. (11) \[N m\]: the torque of the shaft on the wheel, positive forward.
    /// `wheel_speed` is relative to the axle bridge, positive rolling forward \[rad/s\].
    #[inline(always)]
    pub fn shaft_torque<S: Scalar>(&self, state: &DriveState<S>, wheel_speed: S) -> S {
        state.twist * self.transmission_stiffness
            + self.twist_rate(state.motor_speed, wheel_speed) * self.transmission_damping
    }

    /// X = TM - CM wM - N TOUT, the right-hand side of Eq. (10): the net torque on the rotor \[N m\].
    #[inline(always)]
    pub fn rotor_torque<S: Scalar>(&self, state: &DriveState<S>, shaft_torque: S) -> S {
        self.motor_torque(state.armature_current)
            - state.motor_speed * self.rotor_damping
            - shaft_torque * self.gear_ratio
    }

    /// The time derivatives of the state: Eqs (2), (10) and wE - wOUT with wE = N wM of Eq. (9).
    /// `voltage` is Va \[V\]; `wheel_speed` as in `shaft_torque`.
    #[inline(always)]
    pub fn rates<S: Scalar>(&self, state: &DriveState<S>, voltage: S, wheel_speed: S) -> DriveState<S> {
        let back_emf = state.motor_speed * self.torque_constant();
        let drop = state.armature_current * self.armature_resistance;
        let shaft_torque = self.shaft_torque(state, wheel_speed);
        DriveState {
            armature_current: (voltage - drop - back_emf) / self.armature_inductance,
            motor_speed: self.rotor_torque(state, shaft_torque) / self.rotor_inertia,
            twist: self.twist_rate(state.motor_speed, wheel_speed),
        }
    }

    /// Copper loss of the armature \[W\].
    #[inline(always)]
    pub fn copper<S: Scalar>(&self, armature_current: S) -> S {
        armature_current.square() * self.armature_resistance
    }

    /// Friction of the rotor, CM wM^2 \[W\].
    #[inline(always)]
    pub fn friction<S: Scalar>(&self, motor_speed: S) -> S {
        motor_speed.square() * self.rotor_damping
    }

    /// Power that the damping of the shaft turns to heat \[W\].
    #[inline(always)]
    pub fn transmission<S: Scalar>(&self, motor_speed: S, wheel_speed: S) -> S {
        self.twist_rate(motor_speed, wheel_speed).square() * self.transmission_damping
    }

    /// Energy in the armature's field \[J\].
    pub fn magnetic<S: Scalar>(&self, armature_current: S) -> S {
        armature_current.square() * (0.5 * self.armature_inductance)
    }

    /// Energy of the twisted shaft \[J\].
    pub fn elastic<S: Scalar>(&self, twist: S) -> S {
        twist.square() * (0.5 * self.transmission_stiffness)
    }

    /// The state and the armature voltage \[V\] that hold a wheel speed \[rad/s\] and a shaft torque \[N m\].
    pub fn steady_state(&self, wheel_speed: f64, shaft_torque: f64) -> (DriveState<f64>, f64) {
        let motor_speed = wheel_speed / self.gear_ratio;
        let torque = self.rotor_damping * motor_speed + self.gear_ratio * shaft_torque;
        let armature_current = torque / self.torque_constant();
        let twist = shaft_torque / self.transmission_stiffness;
        let voltage = self.armature_resistance * armature_current + self.torque_constant() * motor_speed;
        (DriveState { armature_current, motor_speed, twist }, voltage)
    }

    #[inline(always)]
    fn twist_rate<S: Scalar>(&self, motor_speed: S, wheel_speed: S) -> S {
        motor_speed * self.gear_ratio - wheel_speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    const DRIVE: Drive = Drive {
        armature_resistance: 0.15,
        armature_inductance: 3e-3,
        emf_constant: 0.4646,
        field_current: 6.052,
        gear_ratio: 1.0 / 3.0,
        rotor_inertia: 1.0,
        rotor_damping: 0.02,
        transmission_stiffness: 1e6,
        transmission_damping: 300.0,
    };

    /// Voltage and wheel speed in, all three rates and the shaft torque out.
    fn law<S: Scalar>(x: [S; 5]) -> [S; 4] {
        let state = DriveState { armature_current: x[0], motor_speed: x[1], twist: x[2] };
        let r = DRIVE.rates(&state, x[3], x[4]);
        [r.armature_current, r.motor_speed, r.twist, DRIVE.shaft_torque(&state, x[4])]
    }

    #[test]
    fn dual_value_is_the_f64_value_and_its_slope_the_difference_quotient() {
        let x = [23.0, 318.8, 1.8e-4, 900.0, 106.3];
        let dual = law(core::array::from_fn(|i| Dual::<5>::variable(x[i], i)));
        let plain = law(x);
        for (d, p) in dual.iter().zip(plain) {
            assert_eq!(d.value, p);
        }
        for i in 0..5 {
            let shifted = |h: f64| law(core::array::from_fn(|j| if i == j { x[j] + h } else { x[j] }));
            let (up, down) = (shifted(1e-3), shifted(-1e-3));
            for k in 0..4 {
                let slope = (up[k] - down[k]) / 2e-3;
                assert!((dual[k].slope[i] - slope).abs() <= 1e-6 * slope.abs().max(1.0), "{i} {k}");
            }
        }
    }

    /// Electrical power in = heat + friction + power at the wheel + growth of the stored energies.
    #[test]
    fn power_balances() {
        let state = DriveState { armature_current: 40.0, motor_speed: 320.0, twist: 3e-4 };
        let (voltage, wheel_speed) = (905.0, 106.0);
        let r = DRIVE.rates(&state, voltage, wheel_speed);
        let shaft = DRIVE.shaft_torque(&state, wheel_speed);
        let h = 1e-6;
        let energy = |t: f64| {
            DRIVE.magnetic(state.armature_current + t * r.armature_current)
                + DRIVE.elastic(state.twist + t * r.twist)
                + 0.5 * DRIVE.rotor_inertia * (state.motor_speed + t * r.motor_speed).powi(2)
        };
        let stored = (energy(h) - energy(-h)) / (2.0 * h);
        let heat = DRIVE.copper(state.armature_current)
            + DRIVE.friction(state.motor_speed)
            + DRIVE.transmission(state.motor_speed, wheel_speed);
        let input = voltage * state.armature_current;
        assert!((input - heat - stored - shaft * wheel_speed).abs() < 1e-6 * input);
    }
}
