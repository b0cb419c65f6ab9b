//! Field-oriented control of an induction motor and its averaged inverter: torque command in, stator voltage out.
//! It runs at several kHz on a real vehicle and is continuous here; derived in docs/theory/induction.md.

use super::{InductionMotor, InductionState};
use crate::Scalar;

/// Below this share of the rated flux the torque command is divided by that much flux.
const FLUX_LEAST: f64 = 0.1;
/// Share of the current limit that stays for the torque when the flux needs more than there is.
const CURRENT_LEAST: f64 = 0.1;

/// Share of the voltage that stays for q, however much d wants: the circle is passed by its square at most.
const VOLTAGE_LEAST: f64 = 0.01;
/// Share of the voltage that steady currents may be commanded up to; the rest pays resistances and changes.
const VOLTAGE_USED: f64 = 0.95;

/// Constants of control and inverter; the drive is one pole at `torque_bandwidth` while no limit is met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOriented {
    /// What the controller takes the motor for: with the motor's own values the flux stays on the d axis exactly.
    pub model: InductionMotor,
    /// Of the closed current loops, and so of the torque \[1/s\].
    pub torque_bandwidth: f64,
    /// Of the flux loop \[1/s\].
    pub flux_bandwidth: f64,
    /// Rotor flux below the speed of field weakening \[V s\].
    pub flux_rated: f64,
    /// Amplitude of the stator current at most \[A\].
    pub current_max: f64,
    /// Amplitude of the phase voltage that the inverter gives at most \[V\].
    pub voltage_max: f64,
    /// Share of it that the flux may take at speed; the rest drives currents.
    pub flux_share: f64,
}

/// State of the control, or its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FieldOrientedState<S> {
    /// Rotor flux that the flux model knows \[V s\].
    pub flux: S,
    /// Integrals of the current loops d, q \[V\].
    pub integral: [S; 2],
}

/// What the control puts out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Excited<S> {
    /// Stator voltage in the axes of the control \[V\].
    pub voltage: [S; 2],
    /// Of those axes \[rad/s, electrical\].
    pub frame_speed: S,
}

impl FieldOriented {
    /// Electrical speed above which the field is weakened \[rad/s\]: w Ls flux/Lm meets its share of the voltage there.
    pub fn weakening_speed(&self) -> f64 {
        let m = &self.model;
        self.flux_share * self.voltage_max * m.magnetizing_inductance / (m.stator_inductance() * self.flux_rated)
    }

    /// Flux that is wanted at a motor speed \[rad/s\]: rated, and falling with 1/speed above the weakening speed \[V s\].
    #[inline(always)]
    pub fn flux_command<S: Scalar>(&self, motor_speed: S) -> S {
        let corner = self.weakening_speed();
        let speed = (motor_speed * self.model.pole_pairs).abs().max(S::constant(corner));
        speed.recip() * (corner * self.flux_rated)
    }

    /// Largest current across the flux \[A\] beside `i_d`: within the current limit, and within the voltage at speed
    /// (v/w)^2 = (Ls i_d)^2 + (sigma Ls i_q)^2, with a twentieth of the voltage for the resistances.
    #[inline(always)]
    pub fn cross_current_max<S: Scalar>(&self, i_d: S, motor_speed: S) -> S {
        let m = &self.model;
        let least = CURRENT_LEAST * self.current_max;
        let current = (i_d.square() * -1.0 + self.current_max * self.current_max).max(S::constant(least * least));
        let speed = (motor_speed * m.pole_pairs).abs().max(S::constant(0.5 * self.weakening_speed()));
        let linked = speed.recip() * (VOLTAGE_USED * self.voltage_max);
        let voltage = (linked.square() - (i_d * m.stator_inductance()).square()) / m.transient_inductance().powi(2);
        current.min(voltage.max(S::constant(least * least))).sqrt()
    }

    /// Voltage and frame for an air-gap torque command \[N m\], and the rates of the control's states.
    ///
    /// Indirect orientation: the frame turns at p wM + Lm Rr/Lr i_q/flux with the flux of flux' = Rr/Lr (Lm i_d - flux).
    /// Current loops: v = sigma Ls a (i* - i) + integral of R a (i* - i), with both axes decoupled and the voltage
    /// induced by the rotor flux added; so i follows i* as a/(s + a).
    #[inline(always)]
    pub fn control<S: Scalar>(
        &self,
        state: &FieldOrientedState<S>,
        current: [S; 2],
        torque_command: S,
        motor_speed: S,
    ) -> (Excited<S>, FieldOrientedState<S>) {
        let m = &self.model;
        let [i_d, i_q] = current;
        let (coupling, leak, decay) = (m.coupling(), m.transient_inductance(), 1.0 / m.rotor_time());

        let lacking = self.flux_command(motor_speed) - state.flux;
        let i_d_wanted = (state.flux + lacking * (self.flux_bandwidth / decay)) / m.magnetizing_inductance;
        let i_d_wanted = i_d_wanted.clamp(-self.current_max, self.current_max);
        let flux = state.flux.max(S::constant(FLUX_LEAST * self.flux_rated));
        let i_q_max = self.cross_current_max(i_d_wanted, motor_speed);
        let i_q_wanted = (torque_command / (flux * m.torque_factor())).max(-i_q_max).min(i_q_max);

        let rotor_speed = motor_speed * m.pole_pairs;
        let frame_speed = rotor_speed + i_q / flux * (m.magnetizing_inductance * decay);
        let errors = [i_d_wanted - i_d, i_q_wanted - i_q];
        let beside = [
            frame_speed * i_q * -leak - state.flux * (coupling * decay),
            frame_speed * i_d * leak + rotor_speed * state.flux * coupling,
        ];
        let gain = leak * self.torque_bandwidth;
        let wanted: [S; 2] = core::array::from_fn(|k| errors[k] * gain + state.integral[k] + beside[k]);
        let voltage = self.limited(wanted);

        let integral_gain = m.transient_resistance() * self.torque_bandwidth;
        let rates = FieldOrientedState {
            flux: (i_d * m.magnetizing_inductance - state.flux) * decay,
            // what the inverter does not give is taken from the error, so that nothing winds up
            integral: core::array::from_fn(|k| (errors[k] + (voltage[k] - wanted[k]) / gain) * integral_gain),
        };
        (Excited { voltage, frame_speed }, rates)
    }

    /// The voltage within the circle that the inverter reaches, d first: the flux is kept, torque gives way.
    #[inline(always)]
    fn limited<S: Scalar>(&self, [d, q]: [S; 2]) -> [S; 2] {
        let d = d.clamp(-self.voltage_max, self.voltage_max);
        let least = VOLTAGE_LEAST * self.voltage_max;
        let rest = (d.square() * -1.0 + self.voltage_max * self.voltage_max).max(S::constant(least * least)).sqrt();
        [d, q.max(-rest).min(rest)]
    }

    /// The settled states of motor and control for an air-gap torque \[N m\] within the limits, the motor being as the
    /// control takes it.
    pub fn steady_state(&self, torque: f64, motor_speed: f64) -> (InductionState<f64>, FieldOrientedState<f64>) {
        let flux = self.flux_command(motor_speed);
        let motor = self.model.steady_state(flux, torque);
        let r = self.model.transient_resistance();
        (motor, FieldOrientedState { flux, integral: motor.current.map(|i| r * i) })
    }
}

#[cfg(test)]
mod tests {
    use super::super::induction::MOTOR;
    use super::*;
    use crate::Dual;

    const CONTROL: FieldOriented = FieldOriented {
        model: MOTOR,
        torque_bandwidth: 500.0,
        flux_bandwidth: 10.0,
        flux_rated: 1.943,
        current_max: 250.0,
        voltage_max: 955.0,
        flux_share: 0.85,
    };

    /// Currents, fluxes, model flux, integrals, command, motor speed in; all rates out.
    fn law<S: Scalar>(motor: &InductionMotor, x: [S; 9]) -> [S; 7] {
        let state = InductionState { current: [x[0], x[1]], flux: [x[2], x[3]] };
        let inner = FieldOrientedState { flux: x[4], integral: [x[5], x[6]] };
        let (out, c) = CONTROL.control(&inner, state.current, x[7], x[8]);
        let r = motor.rates(&state, out.voltage, out.frame_speed, x[8]);
        [r.current[0], r.current[1], r.flux[0], r.flux[1], c.flux, c.integral[0], c.integral[1]]
    }

    /// Classical Runge-Kutta steps of the drive at a held motor speed and command.
    fn run(motor: &InductionMotor, mut x: [f64; 7], command: f64, speed: f64, step: f64, steps: usize) -> [f64; 7] {
        let f = |x: [f64; 7]| law(motor, core::array::from_fn(|i| if i < 7 { x[i] } else { [command, speed][i - 7] }));
        let along = |x: [f64; 7], d: [f64; 7], h: f64| core::array::from_fn(|i| x[i] + h * d[i]);
        for _ in 0..steps {
            let a = f(x);
            let b = f(along(x, a, 0.5 * step));
            let c = f(along(x, b, 0.5 * step));
            let d = f(along(x, c, step));
            x = core::array::from_fn(|i| x[i] + step / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
        }
        x
    }

    fn start(torque: f64, speed: f64) -> [f64; 7] {
        let (m, c) = CONTROL.steady_state(torque, speed);
        [m.current[0], m.current[1], m.flux[0], m.flux[1], c.flux, c.integral[0], c.integral[1]]
    }

    fn torque(x: &[f64; 7]) -> f64 {
        MOTOR.torque(&InductionState { current: [x[0], x[1]], flux: [x[2], x[3]] })
    }

    #[test]
    fn dual_value_is_the_f64_value_and_its_slope_the_difference_quotient() {
        // inside every limit, field weakening, voltage limit, current limit
        let points = [
            [50.6, 90.0, 1.94, 0.07, 1.9, 8.0, 14.0, 500.0, 100.0],
            [22.0, 40.0, 0.85, 0.01, 0.86, 3.5, 6.0, 90.0, 480.0],
            [22.0, 40.0, 0.85, 0.01, 0.86, 300.0, 900.0, 90.0, 480.0],
            [50.6, 90.0, 1.94, 0.07, 1.9, 8.0, 14.0, 5000.0, 10.0],
        ];
        for x in points {
            let dual = law(&MOTOR, core::array::from_fn(|i| Dual::<9>::variable(x[i], i)));
            let plain = law(&MOTOR, x);
            for (d, p) in dual.iter().zip(plain) {
                assert_eq!(d.value, p);
            }
            for i in 0..9 {
                let h = 1e-5 * x[i].abs().max(0.1);
                let shifted = |h: f64| law(&MOTOR, core::array::from_fn(|j| if i == j { x[j] + h } else { x[j] }));
                let (up, down) = (shifted(h), shifted(-h));
                for k in 0..7 {
                    let slope = (up[k] - down[k]) / (2.0 * h);
                    assert!((dual[k].slope[i] - slope).abs() <= 1e-5 * slope.abs().max(10.0), "{i} {k}");
                }
            }
        }
    }

    #[test]
    fn the_steady_state_rests() {
        for (torque_wanted, speed) in [(0.0, 0.0), (300.0, 5.0), (-400.0, 150.0), (120.0, 480.0)] {
            let x = start(torque_wanted, speed);
            let rates = law(&MOTOR, core::array::from_fn(|i| if i < 7 { x[i] } else { [torque_wanted, speed][i - 7] }));
            assert!(rates.iter().all(|r| r.abs() < 1e-7), "{rates:?}");
            assert!((torque(&x) - torque_wanted).abs() < 1e-9);
        }
    }

    /// A step of the command is answered by one pole, and the flux stays on its axis: at steps of 0.5 and 1 ms.
    #[test]
    fn torque_follows_with_one_pole_and_the_flux_stays_on_its_axis() {
        for speed in [0.0, 100.0, 480.0] {
            for step in [5e-4, 1e-3] {
                let x = run(&MOTOR, start(20.0, speed), 60.0, speed, step, (4e-3 / step) as usize);
                let exact = 20.0 + 40.0 * (1.0 - (-500.0f64 * 4e-3).exp());
                assert!((torque(&x) - exact).abs() < 0.2, "{speed} {step}: {} for {exact}", torque(&x));
                let later = run(&MOTOR, x, 60.0, speed, step, 2000);
                assert!(later[3].abs() < 1e-9 && (later[2] - later[4]).abs() < 1e-9);
                assert!((torque(&later) - 60.0).abs() < 1e-6);
            }
        }
    }

    /// A warm rotor (resistance 30 % up) turns the flux off its axis; torque is a little off, nothing is unstable.
    #[test]
    fn a_detuned_control_gives_another_torque_and_stays_stable() {
        let warm = InductionMotor { rotor_resistance: 1.3 * MOTOR.rotor_resistance, ..MOTOR };
        for (speed, within) in [(20.0, 0.3), (200.0, 0.3), (480.0, 0.6)] {
            let x = run(&warm, start(150.0, speed), 150.0, speed, 1e-3, 8000);
            let further = run(&warm, x, 150.0, speed, 1e-3, 1000);
            assert!(x.iter().zip(&further).all(|(a, b)| (a - b).abs() < 1e-6), "settled at {speed}");
            assert!(x[3].abs() > 1e-3, "the flux is off its axis: {}", x[3]);
            // at 480 rad/s the stronger flux takes the voltage that the torque needs
            let off = torque(&x) / 150.0 - 1.0;
            assert!(off < -1e-3 && off > -within, "{off} at {speed}");
        }
    }

    /// Commands beyond every limit: current and voltage stay within theirs, and the way back is the ordinary one.
    #[test]
    fn limits_hold_and_nothing_winds_up() {
        for (command, speed) in [(9000.0, 50.0), (-9000.0, 50.0), (9000.0, 480.0), (-9000.0, 480.0)] {
            let x = run(&MOTOR, start(0.0, speed), command, speed, 5e-4, 4000);
            assert!(x[0].hypot(x[1]) < 1.001 * CONTROL.current_max, "{:?}", x);
            let inner = FieldOrientedState { flux: x[4], integral: [x[5], x[6]] };
            let (out, _) = CONTROL.control(&inner, [x[0], x[1]], command, speed);
            assert!(out.voltage[0].hypot(out.voltage[1]) <= CONTROL.voltage_max * (1.0 + 1e-4));
            assert!(torque(&x) * command > 0.0 && torque(&x).abs() > 100.0, "{}", torque(&x));
            let back = run(&MOTOR, x, 0.0, speed, 5e-4, 100);
            assert!(torque(&back).abs() < 2.0, "{} after 50 ms", torque(&back));
        }
    }
}
