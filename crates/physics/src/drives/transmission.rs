//! What stands between a motor's air gap and its wheel: rotor, gearbox, elastic shaft; the same for every kind of motor.
//! Equation numbers are those of Perez, Busturia, Mei, Vinolas (2004), Annual Reviews in Control 28, 207-217.

use crate::Scalar;

/// Constants of one rotor, gearbox and shaft. The wheel turns N times for one turn of the motor (N < 1).
///
/// ```
/// use klingel_physics::drives::{Transmission, TransmissionState};
/// let law = Transmission {
///     gear_ratio: 1.0 / 3.0, rotor_inertia: 1.0, rotor_damping: 0.02, stiffness: 1e6, damping: 300.0,
/// };
/// let (state, air_gap_torque) = law.steady_state(106.0, 176.0); // wheel speed rad/s, torque on the wheel N m
/// let rates = law.rates(&state, air_gap_torque, 106.0);
/// assert!(rates.motor_speed.abs() < 1e-9 && rates.twist.abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transmission {
    /// N = wheel speed over motor speed \[-\].
    pub gear_ratio: f64,
    /// JM \[kg m2\]
    pub rotor_inertia: f64,
    /// CM \[N m s/rad\]
    pub rotor_damping: f64,
    /// KOUT, on the wheel's side of the gearbox \[N m/rad\].
    pub stiffness: f64,
    /// COUT, on the wheel's side of the gearbox \[N m s/rad\].
    pub damping: f64,
}

/// State of one transmission, or its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TransmissionState<S> {
    /// wM against the axle bridge, positive while the wheel rolls forward \[rad/s\].
    pub motor_speed: S,
    /// thE - thOUT, positive while the shaft drives the wheel forward \[rad\].
    pub twist: S,
}

impl Transmission {
    /// TOUT of Eq. (11) \[N m\]: the torque of the shaft on the wheel, positive forward.
    /// `wheel_speed` is relative to the axle bridge, positive rolling forward \[rad/s\].
    #[inline(always)]
    pub fn shaft_torque<S: Scalar>(&self, state: &TransmissionState<S>, wheel_speed: S) -> S {
        state.twist * self.stiffness + self.twist_rate(state.motor_speed, wheel_speed) * self.damping
    }

    /// X = TM - CM wM - N TOUT, the right-hand side of Eq. (10): the net torque on the rotor \[N m\].
    #[inline(always)]
    pub fn rotor_torque<S: Scalar>(&self, state: &TransmissionState<S>, air_gap_torque: S, shaft_torque: S) -> S {
        air_gap_torque - state.motor_speed * self.rotor_damping - shaft_torque * self.gear_ratio
    }

    /// The time derivatives of the state: Eq. (10) and wE - wOUT with wE = N wM of Eq. (9).
    /// `air_gap_torque` is TM \[N m\]; `wheel_speed` as in `shaft_torque`.
    #[inline(always)]
    pub fn rates<S: Scalar>(
        &self,
        state: &TransmissionState<S>,
        air_gap_torque: S,
        wheel_speed: S,
    ) -> TransmissionState<S> {
        let shaft_torque = self.shaft_torque(state, wheel_speed);
        TransmissionState {
            motor_speed: self.rotor_torque(state, air_gap_torque, shaft_torque) / self.rotor_inertia,
            twist: self.twist_rate(state.motor_speed, wheel_speed),
        }
    }

    /// Elastic energy of the shaft \[J\]; the rotor's kinetic energy goes with its absolute speed, which the engine knows.
    #[inline(always)]
    pub fn stored<S: Scalar>(&self, twist: S) -> S {
        twist.square() * (0.5 * self.stiffness)
    }

    /// Power lost in the rotor's bearings and in the shaft \[W\].
    #[inline(always)]
    pub fn dissipated<S: Scalar>(&self, motor_speed: S, wheel_speed: S) -> [S; 2] {
        let bearings = motor_speed.square() * self.rotor_damping;
        [bearings, self.twist_rate(motor_speed, wheel_speed).square() * self.damping]
    }

    /// The state and the air-gap torque \[N m\] that hold a wheel speed \[rad/s\] and a shaft torque \[N m\].
    pub fn steady_state(&self, wheel_speed: f64, shaft_torque: f64) -> (TransmissionState<f64>, f64) {
        let motor_speed = wheel_speed / self.gear_ratio;
        let torque = self.rotor_damping * motor_speed + self.gear_ratio * shaft_torque;
        (TransmissionState { motor_speed, twist: shaft_torque / self.stiffness }, torque)
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

    const LAW: Transmission =
        Transmission { gear_ratio: 1.0 / 3.0, rotor_inertia: 1.0, rotor_damping: 0.02, stiffness: 1e6, damping: 300.0 };

    /// Motor speed, twist, air-gap torque, wheel speed in; both rates and the shaft torque out.
    fn law<S: Scalar>(x: [S; 4]) -> [S; 3] {
        let state = TransmissionState { motor_speed: x[0], twist: x[1] };
        let r = LAW.rates(&state, x[2], x[3]);
        [r.motor_speed, r.twist, LAW.shaft_torque(&state, x[3])]
    }

    #[test]
    fn dual_value_is_the_f64_value_and_its_slope_the_difference_quotient() {
        let x = [318.8, 1.8e-4, 64.0, 106.3];
        let dual = law(core::array::from_fn(|i| Dual::<4>::variable(x[i], i)));
        let plain = law(x);
        for (d, p) in dual.iter().zip(plain) {
            assert_eq!(d.value, p);
        }
        for i in 0..4 {
            let shifted = |h: f64| law(core::array::from_fn(|j| if i == j { x[j] + h } else { x[j] }));
            let (up, down) = (shifted(1e-3), shifted(-1e-3));
            for k in 0..3 {
                let slope = (up[k] - down[k]) / 2e-3;
                assert!((dual[k].slope[i] - slope).abs() <= 1e-6 * slope.abs().max(1.0), "{i} {k}");
            }
        }
    }

    /// Power at the air gap = losses + power at the wheel + growth of what is stored.
    #[test]
    fn power_balances() {
        let state = TransmissionState { motor_speed: 320.0, twist: 3e-4 };
        let (air_gap_torque, wheel_speed) = (110.0, 106.0);
        let r = LAW.rates(&state, air_gap_torque, wheel_speed);
        let growing = |h: f64| {
            let motor_speed = state.motor_speed + h * r.motor_speed;
            0.5 * LAW.rotor_inertia * motor_speed * motor_speed + LAW.stored(state.twist + h * r.twist)
        };
        let stored = (growing(1e-3) - growing(-1e-3)) / 2e-3;
        let out = LAW.shaft_torque(&state, wheel_speed) * wheel_speed
            + LAW.dissipated(state.motor_speed, wheel_speed).iter().sum::<f64>();
        let input = air_gap_torque * state.motor_speed;
        assert!((input - out - stored).abs() < 1e-9 * input);
    }
}
