//! The squirrel-cage induction motor in two axes of any frame: stator currents and rotor fluxes as states.
//! Amplitudes are those of the phases (peak values), so power is 3/2 of the products; derived in docs/theory/induction.md.

use crate::Scalar;

/// Constants of the equivalent circuit of one phase (star), rotor values seen from the stator.
///
/// ```
/// use klingel_physics::drives::InductionMotor;
/// let motor = InductionMotor {
///     stator_resistance: 0.08167, rotor_resistance: 0.08281, stator_leakage: 1.655e-3, rotor_leakage: 1.511e-3,
///     magnetizing_inductance: 38.36e-3, pole_pairs: 2.0,
/// };
/// let state = motor.steady_state(1.943, 80.0); // rotor flux V s, torque N m
/// assert!((motor.torque(&state) - 80.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InductionMotor {
    /// Rs \[Ohm\]
    pub stator_resistance: f64,
    /// Rr \[Ohm\]
    pub rotor_resistance: f64,
    /// Lls \[H\]
    pub stator_leakage: f64,
    /// Llr \[H\]
    pub rotor_leakage: f64,
    /// Lm \[H\]
    pub magnetizing_inductance: f64,
    /// p \[-\]
    pub pole_pairs: f64,
}

/// State of an induction motor in the axes d, q of a turning frame, or its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InductionState<S> {
    /// Stator current \[A\].
    pub current: [S; 2],
    /// Rotor flux linkage \[V s\].
    pub flux: [S; 2],
}

impl InductionMotor {
    /// Lr = Llr + Lm \[H\]
    pub fn rotor_inductance(&self) -> f64 {
        self.rotor_leakage + self.magnetizing_inductance
    }

    /// Ls = Lls + Lm \[H\]
    pub fn stator_inductance(&self) -> f64 {
        self.stator_leakage + self.magnetizing_inductance
    }

    /// Lm/Lr \[-\]: what the stator sees of the rotor's flux.
    pub fn coupling(&self) -> f64 {
        self.magnetizing_inductance / self.rotor_inductance()
    }

    /// sigma Ls = Ls - Lm^2/Lr \[H\]: what the stator current sees while the rotor flux stays.
    pub fn transient_inductance(&self) -> f64 {
        self.stator_inductance() - self.coupling() * self.magnetizing_inductance
    }

    /// R = Rs + (Lm/Lr)^2 Rr \[Ohm\]: its partner.
    pub fn transient_resistance(&self) -> f64 {
        self.stator_resistance + self.coupling() * self.coupling() * self.rotor_resistance
    }

    /// Lr/Rr \[s\]
    pub fn rotor_time(&self) -> f64 {
        self.rotor_inductance() / self.rotor_resistance
    }

    /// 3/2 p Lm/Lr: air-gap torque over rotor flux and the current across it \[N m/(V s A)\].
    pub fn torque_factor(&self) -> f64 {
        1.5 * self.pole_pairs * self.coupling()
    }

    /// TM = 3/2 p Lm/Lr (flux_d i_q - flux_q i_d), the air-gap torque on the rotor \[N m\].
    #[inline(always)]
    pub fn torque<S: Scalar>(&self, state: &InductionState<S>) -> S {
        let ([i_d, i_q], [flux_d, flux_q]) = (state.current, state.flux);
        (flux_d * i_q - flux_q * i_d) * self.torque_factor()
    }

    /// The time derivatives of the state under the stator voltage \[V\], in a frame that turns at `frame_speed`
    /// \[rad/s, electrical\]; `motor_speed` is that of the rotor \[rad/s, mechanical\].
    ///
    /// sigma Ls i' = v - R i - j w sigma Ls i + Lm/Lr (Rr/Lr - j p wM) flux
    /// flux' = Lm Rr/Lr i - Rr/Lr flux - j (w - p wM) flux
    #[inline(always)]
    pub fn rates<S: Scalar>(
        &self,
        state: &InductionState<S>,
        voltage: [S; 2],
        frame_speed: S,
        motor_speed: S,
    ) -> InductionState<S> {
        let ([i_d, i_q], [flux_d, flux_q]) = (state.current, state.flux);
        let (coupling, leak, r) = (self.coupling(), self.transient_inductance(), self.transient_resistance());
        let decay = 1.0 / self.rotor_time();
        let rotor_speed = motor_speed * self.pole_pairs;
        let slip_speed = frame_speed - rotor_speed;
        let behind_d = (flux_d * decay + rotor_speed * flux_q) * coupling;
        let behind_q = (flux_q * decay - rotor_speed * flux_d) * coupling;
        InductionState {
            current: [
                (voltage[0] - i_d * r + behind_d) / leak + frame_speed * i_q,
                (voltage[1] - i_q * r + behind_q) / leak - frame_speed * i_d,
            ],
            flux: [
                (i_d * self.magnetizing_inductance - flux_d) * decay + slip_speed * flux_q,
                (i_q * self.magnetizing_inductance - flux_q) * decay - slip_speed * flux_d,
            ],
        }
    }

    /// Electrical power taken at the stator \[W\].
    #[inline(always)]
    pub fn input_power<S: Scalar>(&self, state: &InductionState<S>, voltage: [S; 2]) -> S {
        (voltage[0] * state.current[0] + voltage[1] * state.current[1]) * 1.5
    }

    /// Magnetic energy \[J\]: 3/4 (sigma Ls i^2 + flux^2/Lr).
    #[inline(always)]
    pub fn stored<S: Scalar>(&self, state: &InductionState<S>) -> S {
        let [current, flux] = [state.current, state.flux].map(|[d, q]| d.square() + q.square());
        (current * self.transient_inductance() + flux / self.rotor_inductance()) * 0.75
    }

    /// Copper losses of stator and rotor \[W\]; the rotor's current is (flux - Lm i)/Lr.
    #[inline(always)]
    pub fn dissipated<S: Scalar>(&self, state: &InductionState<S>) -> [S; 2] {
        let [i_d, i_q] = state.current;
        let rotor =
            [0, 1].map(|k| (state.flux[k] - state.current[k] * self.magnetizing_inductance) / self.rotor_inductance());
        [
            (i_d.square() + i_q.square()) * (1.5 * self.stator_resistance),
            (rotor[0].square() + rotor[1].square()) * (1.5 * self.rotor_resistance),
        ]
    }

    /// The steady state with the rotor flux \[V s\] along d that gives an air-gap torque \[N m\], frame at `slip` ahead.
    pub fn steady_state(&self, flux: f64, torque: f64) -> InductionState<f64> {
        let current = [flux / self.magnetizing_inductance, torque / (self.torque_factor() * flux)];
        InductionState { current, flux: [flux, 0.0] }
    }
}

/// Numbers for the tests of this room: 160 kW, 1100 V, 68 Hz, scaled from a motor of 300 kW.
#[cfg(test)]
pub(super) const MOTOR: InductionMotor = InductionMotor {
    stator_resistance: 0.08167,
    rotor_resistance: 0.08281,
    stator_leakage: 1.655e-3,
    rotor_leakage: 1.511e-3,
    magnetizing_inductance: 38.36e-3,
    pole_pairs: 2.0,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    /// Currents, fluxes, voltages, frame speed, motor speed in; all rates and the torque out.
    fn law<S: Scalar>(x: [S; 8]) -> [S; 5] {
        let state = InductionState { current: [x[0], x[1]], flux: [x[2], x[3]] };
        let r = MOTOR.rates(&state, [x[4], x[5]], x[6], x[7]);
        [r.current[0], r.current[1], r.flux[0], r.flux[1], MOTOR.torque(&state)]
    }

    const POINT: [f64; 8] = [48.0, 90.0, 1.9, 0.07, -120.0, 850.0, 425.0, 210.0];

    #[test]
    fn dual_value_is_the_f64_value_and_its_slope_the_difference_quotient() {
        let dual = law(core::array::from_fn(|i| Dual::<8>::variable(POINT[i], i)));
        let plain = law(POINT);
        for (d, p) in dual.iter().zip(plain) {
            assert_eq!(d.value, p);
        }
        for i in 0..8 {
            let shifted = |h: f64| law(core::array::from_fn(|j| if i == j { POINT[j] + h } else { POINT[j] }));
            let (up, down) = (shifted(1e-3), shifted(-1e-3));
            for k in 0..5 {
                let slope = (up[k] - down[k]) / 2e-3;
                assert!((dual[k].slope[i] - slope).abs() <= 1e-6 * slope.abs().max(1.0), "{i} {k}");
            }
        }
    }

    /// Electrical power = copper + air-gap power + growth of the magnetic energy, in any frame.
    #[test]
    fn power_balances() {
        let state = InductionState { current: [48.0, 90.0], flux: [1.9, 0.07] };
        let voltage = [-120.0, 850.0];
        for frame_speed in [0.0, 425.0, -90.0] {
            let r = MOTOR.rates(&state, voltage, frame_speed, 210.0);
            let moved = |h: f64| {
                let along = |x: [f64; 2], d: [f64; 2]| [x[0] + h * d[0], x[1] + h * d[1]];
                MOTOR.stored(&InductionState {
                    current: along(state.current, r.current),
                    flux: along(state.flux, r.flux),
                })
            };
            let stored = (moved(1e-3) - moved(-1e-3)) / 2e-3;
            let [stator, rotor] = MOTOR.dissipated(&state);
            let input = MOTOR.input_power(&state, voltage);
            assert!((input - stator - rotor - stored - MOTOR.torque(&state) * 210.0).abs() < 1e-8 * input);
        }
    }

    /// Torque and current of the equivalent circuit at a voltage amplitude, frequency and slip: phasors by hand.
    fn circuit(voltage: f64, w: f64, slip: f64) -> (f64, f64) {
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let inv = |a: C| (a.0 / (a.0 * a.0 + a.1 * a.1), -a.1 / (a.0 * a.0 + a.1 * a.1));
        let add = |a: C, b: C| (a.0 + b.0, a.1 + b.1);
        let (rotor, middle) =
            ((MOTOR.rotor_resistance / slip, w * MOTOR.rotor_leakage), (0.0, w * MOTOR.magnetizing_inductance));
        let both = inv(add(inv(rotor), inv(middle)));
        let whole = add((MOTOR.stator_resistance, w * MOTOR.stator_leakage), both);
        let current = mul((voltage, 0.0), inv(whole));
        let in_rotor = mul(mul(current, both), inv(rotor));
        let gap = 1.5 * (in_rotor.0.powi(2) + in_rotor.1.powi(2)) * MOTOR.rotor_resistance / slip;
        (gap * MOTOR.pole_pairs / w, current.0.hypot(current.1))
    }

    /// The state at rest in the stator's own turning frame, from the two equations of the flux and of the current.
    fn settled(voltage: f64, w: f64, slip: f64) -> InductionState<f64> {
        let mut state = InductionState::default();
        for _ in 0..200_000 {
            let motor_speed = w * (1.0 - slip) / MOTOR.pole_pairs;
            let half = |s: &InductionState<f64>, r: &InductionState<f64>, h: f64| InductionState {
                current: [s.current[0] + h * r.current[0], s.current[1] + h * r.current[1]],
                flux: [s.flux[0] + h * r.flux[0], s.flux[1] + h * r.flux[1]],
            };
            let first = MOTOR.rates(&state, [voltage, 0.0], w, motor_speed);
            let middle = MOTOR.rates(&half(&state, &first, 5e-5), [voltage, 0.0], w, motor_speed);
            state = half(&state, &middle, 1e-4);
        }
        state
    }

    #[test]
    fn nameplate_and_breakdown_are_those_of_the_equivalent_circuit() {
        let (voltage, w) = (1100.0 * (2.0f64 / 3.0).sqrt(), 2.0 * core::f64::consts::PI * 68.0);
        // the nameplate of the scaled motor: 818 N m and 109 A at a slip of 1.4 %
        let (torque, current) = circuit(voltage, w, 0.014);
        assert!((torque - 818.0).abs() < 1.0 && (current / 2f64.sqrt() - 109.0).abs() < 0.5);
        for slip in [0.005, 0.014, 0.08, -0.014] {
            let (torque, current) = circuit(voltage, w, slip);
            let state = settled(voltage, w, slip);
            assert!((MOTOR.torque(&state) / torque - 1.0).abs() < 1e-9, "{slip}");
            assert!((state.current[0].hypot(state.current[1]) / current - 1.0).abs() < 1e-9, "{slip}");
        }
        let breakdown = (1..3000).map(|i| circuit(voltage, w, i as f64 * 1e-4).0).fold(0.0, f64::max);
        assert!((breakdown - 1858.0).abs() < 1.0, "{breakdown}");
    }

    #[test]
    fn efficiency_at_the_rated_point_is_that_of_its_losses() {
        let (voltage, w, slip) = (1100.0 * (2.0f64 / 3.0).sqrt(), 2.0 * core::f64::consts::PI * 68.0, 0.014);
        let state = settled(voltage, w, slip);
        let shaft = MOTOR.torque(&state) * w * (1.0 - slip) / MOTOR.pole_pairs;
        let [stator, rotor] = MOTOR.dissipated(&state);
        let input = MOTOR.input_power(&state, [voltage, 0.0]);
        assert!(((shaft + stator + rotor) / input - 1.0).abs() < 1e-9);
        assert!((shaft / input - 0.970).abs() < 1e-3);
        // the rotor loses the slip's share of the air-gap power
        assert!((rotor / (shaft + rotor) - slip).abs() < 1e-9);
    }
}
