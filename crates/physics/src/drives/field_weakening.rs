//! The field current that gives a wheel torque at a speed: Eq. (5) of Perez et al. (2004) and its limit.
//! Field weakening with the share x of the armature voltage; the rest of the voltage is left for steering.

use super::DcMotor;
use thiserror::Error;

/// A torque that no field current gives.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FieldError {
    #[error(
        "wheel torque {torque} N m at motor speed {motor_speed} rad/s is more than this motor gives \
         ({limit} N m at {voltage} V); ask for less torque, less speed or more voltage"
    )]
    TooMuchTorque { torque: f64, limit: f64, motor_speed: f64, voltage: f64 },
    #[error("motor speed {motor_speed} rad/s with {voltage} V sets no field current; give both above zero")]
    NoSpeed { motor_speed: f64, voltage: f64 },
}

/// TW of Eq. (5) \[N m\]: the torque at the wheel, N = `gear_ratio`, at motor speed wM \[rad/s\], armature voltage
/// x VaMax \[V\] and field current \[A\], losses CM wM left out as in the paper.
pub fn wheel_torque(motor: &DcMotor, gear_ratio: f64, field_current: f64, motor_speed: f64, voltage: f64) -> f64 {
    let (k, i) = (motor.emf_constant, field_current);
    k / (gear_ratio * motor.armature_resistance) * (voltage * i - k * motor_speed * i * i)
}

/// The largest wheel torque of any field current: (x VaMax)^2 / (4 N Ra wM) \[N m\].
pub fn wheel_torque_max(motor: &DcMotor, gear_ratio: f64, motor_speed: f64, voltage: f64) -> f64 {
    voltage * voltage / (4.0 * gear_ratio * motor.armature_resistance * motor_speed)
}

/// If \[A\] for a wheel torque \[N m\] at a **motor** speed \[rad/s\] and the armature voltage x VaMax \[V\]: the larger
/// root of Eq. (5), which needs the smaller armature current.
///
/// # Errors
/// The torque is above `wheel_torque_max`, or speed or voltage are not above zero.
pub fn field_current(
    motor: &DcMotor,
    gear_ratio: f64,
    torque: f64,
    motor_speed: f64,
    voltage: f64,
) -> Result<f64, FieldError> {
    if !(motor_speed > 0.0 && voltage > 0.0) {
        return Err(FieldError::NoSpeed { motor_speed, voltage });
    }
    let root = voltage * voltage - 4.0 * gear_ratio * motor.armature_resistance * torque * motor_speed;
    if root >= 0.0 {
        Ok((voltage + root.sqrt()) / (2.0 * motor.emf_constant * motor_speed))
    } else {
        let limit = wheel_torque_max(motor, gear_ratio, motor_speed, voltage);
        Err(FieldError::TooMuchTorque { torque, limit, motor_speed, voltage })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: DcMotor = DcMotor { armature_resistance: 0.15, armature_inductance: 3e-3, emf_constant: 0.4646 };
    const GEAR: f64 = 1.0 / 3.0;

    #[test]
    fn the_larger_root_gives_the_torque_back() {
        for (torque, motor_speed) in [(90.5, 195.7), (176.0, 318.8), (337.0, 480.1), (-200.0, 318.8)] {
            let i = field_current(&MOTOR, GEAR, torque, motor_speed, 900.0).unwrap();
            assert!((wheel_torque(&MOTOR, GEAR, i, motor_speed, 900.0) - torque).abs() < 1e-7 * torque.abs());
            let other = 900.0 / (0.4646 * motor_speed) - i;
            assert!(i > other);
            assert!((wheel_torque(&MOTOR, GEAR, other, motor_speed, 900.0) - torque).abs() < 1e-7 * torque.abs());
        }
    }

    #[test]
    fn both_roots_meet_at_the_largest_torque_and_none_lies_beyond() {
        let limit = wheel_torque_max(&MOTOR, GEAR, 318.8, 900.0);
        let i = field_current(&MOTOR, GEAR, limit * (1.0 - 1e-14), 318.8, 900.0).unwrap();
        assert!((i - 900.0 / (2.0 * 0.4646 * 318.8)).abs() < 1e-6);
        let error = field_current(&MOTOR, GEAR, 1.01 * limit, 318.8, 900.0).unwrap_err();
        assert!(matches!(error, FieldError::TooMuchTorque { .. }));
        assert!(matches!(field_current(&MOTOR, GEAR, 1.0, 0.0, 900.0), Err(FieldError::NoSpeed { .. })));
    }
}
