//! The separately excited DC motor: armature and field circuit, and the torque that both make.
//! Equation numbers are those of Perez, Busturia, Mei, Vinolas (2004), Annual Reviews in Control 28, 207-217.

use crate::Scalar;

/// Constants of the armature. The field current is a state (`DcField`) or held for a run.
///
/// ```
/// use klingel_physics::drives::DcMotor;
/// let motor = DcMotor { armature_resistance: 0.15, armature_inductance: 3e-3, emf_constant: 0.4646 };
/// let (current, voltage) = motor.steady_state(64.0, 318.0, 6.0); // torque N m, motor speed rad/s, field current A
/// let kt = motor.torque_constant(6.0);
/// assert!(motor.current_rate(current, kt, voltage, 318.0).abs() < 1e-9);
/// assert!((motor.torque(current, kt) - 64.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DcMotor {
    /// Ra \[Ohm\]
    pub armature_resistance: f64,
    /// La \[H\]
    pub armature_inductance: f64,
    /// Ke \[V s/(rad A)\]
    pub emf_constant: f64,
}

/// The field circuit, Eq. (3). Its inductance is constant: the iron does not saturate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DcField {
    /// Rf \[Ohm\]
    pub resistance: f64,
    /// Lf \[H\]
    pub inductance: f64,
}

impl DcMotor {
    /// KT = Ke If, Eq. (6) \[N m/A\], at a field current \[A\].
    #[inline(always)]
    pub fn torque_constant<S: Scalar>(&self, field_current: S) -> S {
        field_current * self.emf_constant
    }

    /// TM of Eqs (4) and (7): the air-gap torque on the rotor \[N m\].
    #[inline(always)]
    pub fn torque<S: Scalar>(&self, armature_current: S, torque_constant: S) -> S {
        armature_current * torque_constant
    }

    /// dIa/dt of Eq. (2) \[A/s\] under the armature voltage Va \[V\] at the motor speed wM \[rad/s\].
    #[inline(always)]
    pub fn current_rate<S: Scalar>(&self, armature_current: S, torque_constant: S, voltage: S, motor_speed: S) -> S {
        let back_emf = motor_speed * torque_constant;
        let drop = armature_current * self.armature_resistance;
        (voltage - drop - back_emf) / self.armature_inductance
    }

    /// Energy in the armature's inductance \[J\].
    #[inline(always)]
    pub fn stored<S: Scalar>(&self, armature_current: S) -> S {
        armature_current.square() * (0.5 * self.armature_inductance)
    }

    /// Copper loss of the armature \[W\].
    #[inline(always)]
    pub fn dissipated<S: Scalar>(&self, armature_current: S) -> S {
        armature_current.square() * self.armature_resistance
    }

    /// The armature current \[A\] and voltage \[V\] that hold an air-gap torque \[N m\] at a motor speed \[rad/s\] and
    /// a field current \[A\].
    pub fn steady_state(&self, torque: f64, motor_speed: f64, field_current: f64) -> (f64, f64) {
        let kt = self.torque_constant(field_current);
        let current = torque / kt;
        (current, self.armature_resistance * current + kt * motor_speed)
    }
}

impl DcField {
    /// dIf/dt of Eq. (3) \[A/s\] under the field voltage Vf \[V\].
    #[inline(always)]
    pub fn current_rate<S: Scalar>(&self, field_current: S, voltage: S) -> S {
        (voltage - field_current * self.resistance) / self.inductance
    }

    /// Energy in the field \[J\].
    #[inline(always)]
    pub fn stored<S: Scalar>(&self, field_current: S) -> S {
        field_current.square() * (0.5 * self.inductance)
    }

    /// Copper loss of the field winding \[W\].
    #[inline(always)]
    pub fn dissipated<S: Scalar>(&self, field_current: S) -> S {
        field_current.square() * self.resistance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    const MOTOR: DcMotor = DcMotor { armature_resistance: 0.15, armature_inductance: 3e-3, emf_constant: 0.4646 };
    const FIELD: DcField = DcField { resistance: 20.0, inductance: 12.0 };

    /// Armature and field current, both voltages, motor speed in; both rates and the torque out.
    fn law<S: Scalar>([ia, i_f, va, vf, speed]: [S; 5]) -> [S; 3] {
        let kt = MOTOR.torque_constant(i_f);
        [MOTOR.current_rate(ia, kt, va, speed), FIELD.current_rate(i_f, vf), MOTOR.torque(ia, kt)]
    }

    #[test]
    fn dual_value_is_the_f64_value_and_its_slope_the_difference_quotient() {
        let x = [23.0, 6.052, 900.0, 121.0, 318.8];
        let dual = law(core::array::from_fn(|i| Dual::<5>::variable(x[i], i)));
        let plain = law(x);
        for (d, p) in dual.iter().zip(plain) {
            assert_eq!(d.value, p);
        }
        for i in 0..5 {
            let shifted = |h: f64| law(core::array::from_fn(|j| if i == j { x[j] + h } else { x[j] }));
            let (up, down) = (shifted(1e-3), shifted(-1e-3));
            for k in 0..3 {
                let slope = (up[k] - down[k]) / 2e-3;
                assert!((dual[k].slope[i] - slope).abs() <= 1e-6 * slope.abs().max(1.0), "{i} {k}");
            }
        }
    }

    /// Electrical power in = copper + air-gap power + growth of both fields' energies.
    #[test]
    fn power_balances() {
        let (ia, i_f, va, vf, speed) = (40.0, 6.0, 905.0, 180.0, 320.0);
        let [a, f, torque] = law([ia, i_f, va, vf, speed]);
        let stored = MOTOR.armature_inductance * ia * a + FIELD.inductance * i_f * f;
        let input = va * ia + vf * i_f;
        let out = MOTOR.dissipated(ia) + FIELD.dissipated(i_f) + torque * speed;
        assert!((input - out - stored).abs() < 1e-12 * input);
        assert!((MOTOR.stored(ia + 1e-3) - MOTOR.stored(ia - 1e-3) - 2e-3 * 3e-3 * ia).abs() < 1e-12);
        assert!((FIELD.stored(i_f + 1e-3) - FIELD.stored(i_f - 1e-3) - 2e-3 * 12.0 * i_f).abs() < 1e-9);
    }

    /// The field's time constant Lf/Rf: after one of it 1 - 1/e of a step.
    #[test]
    fn the_field_follows_its_voltage_with_its_time_constant() {
        let (mut current, dt) = (0.0f64, 1e-5);
        for _ in 0..60_000 {
            current += dt * FIELD.current_rate(current, 200.0);
        }
        assert!((current - 10.0 * (1.0 - (-1.0f64).exp())).abs() < 1e-4);
    }
}
