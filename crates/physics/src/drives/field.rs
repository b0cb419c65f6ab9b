//! The field current that gives a wheel torque at a speed: Eq. (5) of Perez et al. (2004) and its limit.
//! Field weakening with the share x of the armature voltage; the rest of the voltage is left for steering.

use super::Drive;
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

/// TW of Eq. (5) \[N m\]: the wheel torque at motor speed wM \[rad/s\], armature voltage x VaMax \[V\] and the
/// drive's field current, losses CM wM left out as in the paper.
pub fn wheel_torque(drive: &Drive, motor_speed: f64, voltage: f64) -> f64 {
    let (k, i) = (drive.emf_constant, drive.field_current);
    k / (drive.gear_ratio * drive.armature_resistance) * (voltage * i - k * motor_speed * i * i)
}

/// The largest wheel torque of any field current: (x VaMax)^2 / (4 N Ra wM) \[N m\].
pub fn wheel_torque_max(drive: &Drive, motor_speed: f64, voltage: f64) -> f64 {
    voltage * voltage / (4.0 * drive.gear_ratio * drive.armature_resistance * motor_speed)
}

/// If \[A\] for a wheel torque \[N m\] at a **motor** speed \[rad/s\] and the armature voltage x VaMax \[V\]: the larger
/// root of Eq. (5), which needs the smaller armature current. The field current in `drive` is not used.
///
/// # Errors
/// The torque is above `wheel_torque_max`, or speed or voltage are not above zero.
pub fn field_current(drive: &Drive, torque: f64, motor_speed: f64, voltage: f64) -> Result<f64, FieldError> {
    if !(motor_speed > 0.0 && voltage > 0.0) {
        return Err(FieldError::NoSpeed { motor_speed, voltage });
    }
    let root = voltage * voltage - 4.0 * drive.gear_ratio * drive.armature_resistance * torque * motor_speed;
    if root >= 0.0 {
        Ok((voltage + root.sqrt()) / (2.0 * drive.emf_constant * motor_speed))
    } else {
        let limit = wheel_torque_max(drive, motor_speed, voltage);
        Err(FieldError::TooMuchTorque { torque, limit, motor_speed, voltage })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(field_current: f64) -> Drive {
        Drive {
            armature_resistance: 0.15,
            armature_inductance: 3e-3,
            emf_constant: 0.4646,
            field_current,
            gear_ratio: 1.0 / 3.0,
            rotor_inertia: 1.0,
            rotor_damping: 0.02,
            transmission_stiffness: 1e6,
            transmission_damping: 300.0,
        }
    }

    #[test]
    fn the_larger_root_gives_the_torque_back() {
        for (torque, motor_speed) in [(90.5, 195.7), (176.0, 318.8), (337.0, 480.1), (-200.0, 318.8)] {
            let i = field_current(&drive(1.0), torque, motor_speed, 900.0).unwrap();
            assert!((wheel_torque(&drive(i), motor_speed, 900.0) - torque).abs() < 1e-7 * torque.abs());
            let other = 900.0 / (0.4646 * motor_speed) - i;
            assert!(i > other);
            assert!((wheel_torque(&drive(other), motor_speed, 900.0) - torque).abs() < 1e-7 * torque.abs());
        }
    }

    #[test]
    fn both_roots_meet_at_the_largest_torque_and_none_lies_beyond() {
        let limit = wheel_torque_max(&drive(1.0), 318.8, 900.0);
        let i = field_current(&drive(1.0), limit * (1.0 - 1e-14), 318.8, 900.0).unwrap();
        assert!((i - 900.0 / (2.0 * 0.4646 * 318.8)).abs() < 1e-6);
        let error = field_current(&drive(1.0), 1.01 * limit, 318.8, 900.0).unwrap_err();
        assert!(matches!(error, FieldError::TooMuchTorque { .. }));
        assert!(matches!(field_current(&drive(1.0), 1.0, 0.0, 900.0), Err(FieldError::NoSpeed { .. })));
    }
}
