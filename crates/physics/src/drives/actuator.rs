//! A force-controlled steering actuator: second-order lag with limits on command, force rate and stroke.
//! It acts along one line between two bodies; the engine gives its elongation and applies its force to both.

use crate::Scalar;

/// F'' = w^2 (Fc - F) - 2 zeta w F' while no limit is met.
///
/// ```
/// use klingel_physics::drives::{Actuator, ActuatorState};
/// let a = Actuator {
///     natural_frequency: 94.2, damping_ratio: 0.7, force_max: 20e3, rate_max: 200e3,
///     stroke: 0.02, stop_stiffness: 2e7,
/// };
/// let at_rest = ActuatorState { force: 20e3, force_rate: 0.0 };
/// assert_eq!(a.rates(&at_rest, 35e3), ActuatorState { force: 0.0, force_rate: 0.0 }); // command beyond the limit
/// assert_eq!(a.force(&at_rest, 0.021), 20e3 - 2e7 * (0.021 - 0.02));                  // on its stop
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actuator {
    /// \[rad/s\]
    pub natural_frequency: f64,
    /// \[-\]
    pub damping_ratio: f64,
    /// Of the command \[N\].
    pub force_max: f64,
    /// \[N/s\]
    pub rate_max: f64,
    /// Half stroke \[m\].
    pub stroke: f64,
    /// Of the end stops \[N/m\].
    pub stop_stiffness: f64,
}

/// State of an actuator, or its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ActuatorState<S> {
    /// F, positive apart (it pushes the second body forward) \[N\].
    pub force: S,
    /// F' \[N/s\]
    pub force_rate: S,
}

impl Actuator {
    /// The time derivatives of the state under the command Fc \[N\].
    ///
    /// The second-order lag is written as a force loop around a rate loop, F'' = 2 zeta w (R - F') with
    /// R = w (Fc - F)/(2 zeta), and R is limited: so F' never exceeds the limit and nothing winds up behind it.
    #[inline(always)]
    pub fn rates<S: Scalar>(&self, state: &ActuatorState<S>, command: S) -> ActuatorState<S> {
        let bandwidth = 2.0 * self.damping_ratio * self.natural_frequency;
        let error = command.clamp(-self.force_max, self.force_max) - state.force;
        let gain = self.natural_frequency / (2.0 * self.damping_ratio);
        let wanted_rate = (error * gain).clamp(-self.rate_max, self.rate_max);
        ActuatorState { force: state.force_rate, force_rate: (wanted_rate - state.force_rate) * bandwidth }
    }

    /// The force on the second body \[N\]: the actuator's own and that of the end stop, which acts once the
    /// elongation \[m\] passes the half stroke.
    #[inline(always)]
    pub fn force<S: Scalar>(&self, state: &ActuatorState<S>, elongation: S) -> S {
        state.force - self.beyond(elongation) * self.stop_stiffness
    }

    /// Elastic energy of the end stop \[J\]; the power of the rest of the force is the actuator's work.
    pub fn stored<S: Scalar>(&self, elongation: S) -> S {
        self.beyond(elongation).square() * (0.5 * self.stop_stiffness)
    }

    /// How far the end stop is pressed in \[m\].
    #[inline(always)]
    fn beyond<S: Scalar>(&self, elongation: S) -> S {
        elongation - elongation.clamp(-self.stroke, self.stroke)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    const ACTUATOR: Actuator = Actuator {
        natural_frequency: 94.2,
        damping_ratio: 0.7,
        force_max: 20e3,
        rate_max: 200e3,
        stroke: 0.02,
        stop_stiffness: 2e7,
    };

    /// Euler in small steps: good enough for limits and time constants.
    fn respond(command: f64, time: f64) -> (ActuatorState<f64>, f64) {
        let (mut s, mut fastest, dt) = (ActuatorState::default(), 0.0f64, 1e-5);
        for _ in 0..(time / dt) as usize {
            let r = ACTUATOR.rates(&s, command);
            s = ActuatorState { force: s.force + dt * r.force, force_rate: s.force_rate + dt * r.force_rate };
            fastest = fastest.max(s.force_rate.abs());
        }
        (s, fastest)
    }

    #[test]
    fn a_small_step_is_the_second_order_response() {
        let (w, z, t) = (94.2, 0.7f64, 0.02);
        let wd = w * (1.0 - z * z).sqrt();
        let decay = (-z * w * t).exp();
        let exact = 1.0 - decay * ((wd * t).cos() + z * w / wd * (wd * t).sin());
        let (s, _) = respond(1000.0, t);
        assert!((s.force / 1000.0 - exact).abs() < 1e-3);
    }

    #[test]
    fn force_and_rate_stay_within_their_limits() {
        let (s, fastest) = respond(90e3, 0.5);
        assert!((s.force - 20e3).abs() < 1.0);
        assert!(fastest <= 200e3 && fastest > 195e3);
        let (s, _) = respond(90e3, 0.05);
        assert!(s.force < 200e3 * 0.05);
    }

    #[test]
    fn the_end_stop_stores_what_it_takes() {
        let at_rest = ActuatorState::default();
        for u in [-0.03, 0.01, 0.025] {
            let slope = (ACTUATOR.stored(u + 1e-7) - ACTUATOR.stored(u - 1e-7)) / 2e-7;
            assert!((slope + ACTUATOR.force(&at_rest, u)).abs() < 1e-3, "{u}: {slope}");
        }
    }

    #[test]
    fn dual_agrees_with_f64_and_differences() {
        let law = |x: [f64; 3]| {
            let s = ActuatorState { force: x[0], force_rate: x[1] };
            [ACTUATOR.rates(&s, x[2]).force_rate, ACTUATOR.force(&s, x[2] * 1e-6)]
        };
        let dual = |x: [f64; 3]| {
            let x: [Dual<3>; 3] = core::array::from_fn(|i| Dual::variable(x[i], i));
            let s = ActuatorState { force: x[0], force_rate: x[1] };
            [ACTUATOR.rates(&s, x[2]).force_rate, ACTUATOR.force(&s, x[2] * 1e-6)]
        };
        for x in [[1e3, 2e3, 1.5e3], [-1e3, 5e3, 19e3], [3e3, 0.0, 25e3]] {
            let (plain, exact) = (law(x), dual(x));
            for k in 0..2 {
                assert_eq!(exact[k].value, plain[k]);
                for i in 0..3 {
                    let shifted = |h: f64| law(core::array::from_fn(|j| if i == j { x[j] + h } else { x[j] }));
                    let slope = (shifted(0.01)[k] - shifted(-0.01)[k]) / 0.02;
                    assert!((exact[k].slope[i] - slope).abs() <= 1e-5 * slope.abs().max(1.0));
                }
            }
        }
    }
}
