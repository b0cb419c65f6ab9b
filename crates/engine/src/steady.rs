//! Steady states: every body at rest relative to the others while the vehicle rolls on, controllers settled.
//! Newton's method on the rates of the model itself with the exact Jacobian; the curve is entered step by step.

use crate::equilibrium::{design_state, scale_speeds, settle_on_rails};
use crate::error::{Curve, EngineError, Fault, Running};
use crate::model::{Course, Model};
use crate::pass::{DIRECTIONS, Pass};
use crate::wiring::Wiring;
use klingel_physics::{Dual, Scalar};
use nalgebra::{DMatrix, DVector};

const MAX_ITERATIONS: usize = 60;
/// What an integral's limits change by less than this, in the unit of its block, is rounding.
const ROUNDED: f64 = 1e-6;
/// The Jacobian is kept as long as each step with it is shorter than this part of the one before.
const LEADS_ON: f64 = 0.1;
/// A step that is this short and no longer gets shorter is rounding.
const STALLED: f64 = 1e-7;
/// Parts of the speed by which a detour goes, and in how many steps it comes back.
const DETOURS: [f64; 4] = [0.035, -0.035, 0.07, -0.07];
const DETOUR_STEPS: usize = 14;
/// First and last step of the relaxation \[s\], and how many there may be.
const RELAXATION: [f64; 2] = [5e-3, 100.0];
const MAX_RELAXATIONS: usize = 300;
/// A wheel may move so far in one step of it \[m\].
const RELAXED_WHEEL_STEP: f64 = 4e-4;
/// The least part of a Newton step.
const LEAST_SHARE: f64 = 1.0 / 64.0;
/// The Newton step, relative to 1 + |x|, at which the state is found.
const TOLERANCE: f64 = 1e-10;
/// A wheel may move so far in one iteration \[m\], which keeps it on the rail.
const WHEEL_STEP: f64 = 4e-5;
/// Parts of a curve by which it is entered: the first one, and the least before giving up.
const ENTRY: [f64; 2] = [1.0, 1.0 / 256.0];

/// A steady state.
#[derive(Clone, Debug)]
pub struct Steady {
    /// States; the arc length of the reference body is that of the start.
    pub x: Vec<f64>,
    /// Inputs with the commands of the controllers.
    pub inputs: Vec<f64>,
    /// Of the PI blocks.
    pub integrals: Vec<f64>,
    /// Newton steps, each with a Jacobian of its own, those on the way into the curve included.
    pub iterations: usize,
}

/// The unknowns: states but the free ones, then commands, then integrals.
struct Problem<'a> {
    m: &'a Model,
    wiring: Option<&'a Wiring>,
    /// Share of the curvature and cant of a uniform track.
    share: f64,
    /// Share of the held speed.
    speed_share: f64,
    free: Vec<usize>,
    /// Whether limits of integrals count.
    limited: bool,
}

/// The steady state at `m.speed` of the plant with its controllers: first as if their integrals had no limits, which on
/// the way there may stand in it, then with them if any is met.
///
/// # Errors
/// `EngineError::Equilibrium` when Newton's method does not converge; a controller outside the core.
pub fn steady(m: &Model, wiring: Option<&Wiring>, start: Option<&Steady>) -> Result<Steady, EngineError> {
    wiring.map_or(Ok(()), |w| w.diagram.is_linear())?;
    let mut problem = Problem::new(m, wiring);
    if wiring.is_none() {
        return problem.solve(start);
    }
    problem.limited = false;
    let found = problem.solve(start).ok();
    let within = found.as_ref().is_some_and(|at| problem.within_limits(at));
    problem.limited = true;
    match found {
        Some(at) if within => Ok(at),
        Some(at) => problem.newton(at).or_else(|_| Problem::new(m, wiring).solve(start)),
        None => Problem::new(m, wiring).solve(start),
    }
}

impl<'a> Problem<'a> {
    fn new(m: &'a Model, wiring: Option<&'a Wiring>) -> Self {
        let reference = &m.bodies[m.reference()];
        let (s_ref, v_ref) = (reference.state, reference.velocities().start);
        // the place along the track is free; without anything that holds the speed, that of the reference body is given
        let kept: Vec<usize> = m.bodies.iter().flat_map(|b| b.kept().flatten()).collect();
        let given =
            |i: &usize| *i == s_ref || (m.hold.is_none() && wiring.is_none() && *i == v_ref) || kept.contains(i);
        let free = (0..m.state_count()).filter(|i| !given(i)).collect();
        Self { m, wiring, share: 1.0, speed_share: 1.0, free, limited: true }
    }

    /// From a neighbour, or from the design position, in a curve by way of flatter ones.
    fn solve(&mut self, start: Option<&Steady>) -> Result<Steady, EngineError> {
        let m = self.m;
        if let Some(Ok(found)) = start.map(|near| self.newton(self.neighbour(near))) {
            return Ok(found);
        }
        let curved = matches!(m.track, Course::Uniform(t) if t.curvature != 0.0 || t.cant != 0.0);
        let mut state = self.guess();
        if !curved {
            let undamped = || self.iterated(state.clone(), false);
            return self.newton(state.clone()).or_else(|_| undamped()).or_else(|_| self.settled(state));
        }
        self.share = 0.0;
        state = self.newton(state)?;
        let mut step = ENTRY[0];
        while self.share < 1.0 {
            let before = self.share;
            self.share = (before + step).min(1.0);
            match self.newton(state.clone()) {
                Ok(found) => {
                    state = found;
                    step *= 2.0;
                }
                Err(_) if 0.5 * step < ENTRY[1] => {
                    // the branch turns back: let the motion find the next one
                    self.share = 1.0;
                    return self.settled(state.clone()).or_else(|_| self.detour(state));
                }
                Err(_) => {
                    self.share = before;
                    step *= 0.5;
                }
            }
        }
        Ok(state)
    }

    /// Whether no integral has met its limits: then they change nothing.
    fn within_limits(&self, at: &Steady) -> bool {
        let residual = |limited: bool| {
            let mut pass = Pass::<f64>::new(self.m, self.wiring).limited(limited);
            self.plain(at, &mut pass).ok()
        };
        residual(true).is_some_and(|with| residual(false).is_some_and(|without| (with - without).amax() < ROUNDED))
    }

    /// By way of the motion.
    fn settled(&self, state: Steady) -> Result<Steady, EngineError> {
        self.newton(self.relaxed(state)?)
    }

    /// By way of a neighbouring speed, from which this one is approached in steps.
    fn detour(&mut self, state: Steady) -> Result<Steady, EngineError> {
        let mut last = self.failed(0, (f64::INFINITY, 0));
        for away in DETOURS {
            let mut at = Ok(state.clone());
            for left in (0..=DETOUR_STEPS).rev() {
                self.speed_share = 1.0 + away * left as f64 / DETOUR_STEPS as f64;
                at = at.and_then(|s| self.newton(s.clone()).or_else(|_| self.settled(s)));
            }
            match at {
                Ok(found) => return Ok(found),
                Err(error) => last = error,
            }
        }
        Err(last)
    }

    /// The state of a neighbour with our voltages and the like, its velocities scaled to our speed: the same way of
    /// running over the same track.
    fn neighbour(&self, start: &Steady) -> Steady {
        let m = self.m;
        let mut state = Steady { inputs: m.inputs.clone(), iterations: 0, ..start.clone() };
        self.driven().iter().for_each(|&i| state.inputs[i] = start.inputs[i]);
        let ratio = m.speed / m.reference_speed(&start.x);
        scale_speeds(m, &mut state.x, ratio);
        state
    }

    fn guess(&self) -> Steady {
        let mut x = design_state(self.m);
        settle_on_rails(self.m, &mut x);
        let integrals = vec![0.0; self.wiring.map_or(0, |w| w.diagram.integrators())];
        Steady { x, inputs: self.m.inputs.clone(), integrals, iterations: 0 }
    }

    fn driven(&self) -> &[usize] {
        self.wiring.map_or(&[], |w| &w.driven)
    }

    /// Newton's method, damped as Deuflhard's natural test wants it: the next step of the same Jacobian must be shorter
    /// than this one (Newton Methods for Nonlinear Problems, 2004, sec. 3.3). Near the end, where it is much shorter, it
    /// is taken, and so on: a Jacobian and its factors cost as much as twenty steps with them. Further away wheels soon
    /// have other contacts, and it leads nowhere.
    fn newton(&self, at: Steady) -> Result<Steady, EngineError> {
        self.iterated(at, true)
    }

    /// Newton's method, damped or with nothing but the limit of what a wheel may move.
    fn iterated(&self, mut at: Steady, damped: bool) -> Result<Steady, EngineError> {
        let n = self.free.len() + self.driven().len() + at.integrals.len();
        let mut jacobian = DMatrix::zeros(n, n);
        let mut plain = Pass::<f64>::new(self.m, self.wiring).limited(self.limited);
        let (mut worst, mut before) = ((f64::INFINITY, 0), f64::INFINITY);
        for iteration in 0..MAX_ITERATIONS {
            let fail = |worst| self.failed(iteration, worst);
            let residual = self.linearised(&at, &mut jacobian).map_err(|_| fail(worst))?;
            worst = (0..n).map(|i| (residual[i].abs(), i)).fold((0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
            let lu = jacobian.clone().lu();
            let solve = |r: &DVector<f64>| lu.solve(&-r).filter(|d| d.iter().all(|d| d.is_finite()));
            let step = solve(&residual).ok_or_else(|| fail(worst))?;
            at.iterations += 1;
            let mut size = self.size(&at, &step);
            if size < TOLERANCE || (size < STALLED && size > 0.5 * before) {
                return Ok(self.moved(&at, &step, 1.0));
            }
            // the step after this one, its size as seen from here
            let mut ahead_of = |next: &Steady, here: &Steady| {
                let ahead = self.plain(next, &mut plain).ok().and_then(|r| solve(&r))?;
                Some((self.size(here, &ahead), ahead))
            };
            let mut share = (WHEEL_STEP / self.wheel_step(&step)).min(1.0);
            let mut next = self.moved(&at, &step, share);
            let mut ahead = None;
            while damped && share > LEAST_SHARE {
                ahead = ahead_of(&next, &at).filter(|(length, _)| *length < size * (1.0 - 0.25 * share));
                if ahead.is_some() {
                    break;
                }
                share *= 0.5;
                next = self.moved(&at, &step, share);
            }
            at = next;
            while let Some((length, step)) = ahead.filter(|(length, _)| *length < WHEEL_STEP.min(LEADS_ON * size)) {
                at = self.moved(&at, &step, 1.0);
                size = length;
                ahead = ahead_of(&at, &at);
            }
            if size < TOLERANCE {
                return Ok(at);
            }
            before = size;
        }
        Err(self.failed(MAX_ITERATIONS, worst))
    }

    /// Follows the motion with implicit Euler steps that grow, (M/dt - J) d = f: long ones damp everything, so that it
    /// ends near a steady state, be that stable or not (pseudo-transient continuation; Kelley & Keyes, SIAM J. Numer.
    /// Anal. 35, 1998). M is one for states and nil for commands and integrals.
    fn relaxed(&self, mut at: Steady) -> Result<Steady, EngineError> {
        let n = self.unknowns(&at).count();
        let mut jacobian = DMatrix::zeros(n, n);
        let mut dt = RELAXATION[0];
        let mut found = None;
        for iteration in 0..MAX_RELAXATIONS {
            let failed = |_| self.failed(iteration, (f64::INFINITY, 0));
            let Ok(residual) = self.linearised(&at, &mut jacobian) else {
                // a step too long has left the rail
                at = found.clone().ok_or_else(|| failed(()))?;
                dt *= 0.25;
                continue;
            };
            found = Some(at.clone());
            let mut matrix = -&jacobian;
            (0..self.free.len()).for_each(|i| matrix[(i, i)] += 1.0 / dt);
            let step = matrix.lu().solve(&residual).filter(|d| d.iter().all(|d| d.is_finite()));
            let step = step.ok_or_else(|| failed(()))?;
            let share = (RELAXED_WHEEL_STEP / self.wheel_step(&step)).min(1.0);
            at = self.moved(&at, &step, share);
            at.iterations += 1;
            dt *= if share < 1.0 { 0.5 } else { 1.3 };
            if dt > RELAXATION[1] {
                return Ok(at);
            }
        }
        Err(self.failed(MAX_RELAXATIONS, (f64::INFINITY, 0)))
    }

    /// The unknowns in their order: free states, commands, integrals.
    fn unknowns(&self, at: &Steady) -> impl Iterator<Item = f64> {
        let states = self.free.iter().map(|&i| at.x[i]);
        states.chain(self.driven().iter().map(|&i| at.inputs[i])).chain(at.integrals.iter().copied())
    }

    /// Of a step, each part over 1 + its unknown.
    fn size(&self, at: &Steady, step: &DVector<f64>) -> f64 {
        let parts = self.unknowns(at).zip(step.iter()).map(|(x, d)| d.abs() / (1.0 + x.abs()));
        parts.fold(0.0, f64::max)
    }

    fn moved(&self, at: &Steady, step: &DVector<f64>, share: f64) -> Steady {
        let mut to = at.clone();
        let mut parts = step.iter().map(|d| share * d);
        self.free.iter().zip(&mut parts).for_each(|(&i, d)| to.x[i] += d);
        self.driven().iter().zip(&mut parts).for_each(|(&i, d)| to.inputs[i] += d);
        to.integrals.iter_mut().zip(&mut parts).for_each(|(value, d)| *value += d);
        to
    }

    /// The largest vertical and rolling step of a body with wheels, half a gauge being about a metre.
    fn wheel_step(&self, step: &DVector<f64>) -> f64 {
        let places = self.m.wheels.iter().map(|w| self.m.bodies[w.body].state).flat_map(|i| [i + 2, i + 3]);
        places.filter_map(|i| self.free.iter().position(|&f| f == i)).map(|j| step[j].abs()).fold(0.0, f64::max)
    }

    fn failed(&self, iterations: usize, (residual, i): (f64, usize)) -> EngineError {
        let state = match (self.free.get(i), self.wiring) {
            (Some(&i), _) => self.m.state_names[i].clone(),
            (None, Some(w)) => {
                let i = i - self.free.len();
                w.diagram.command_targets.get(i).cloned().unwrap_or_else(|| "an integral of the controllers".into())
            }
            (None, None) => "none".into(),
        };
        EngineError::Equilibrium { course: self.course(), iterations, residual, state }
    }

    /// How it should run, for what a failure says.
    fn course(&self) -> Running {
        let m = self.m;
        let curve = match m.track {
            Course::Uniform(t) if t.curvature != 0.0 || t.cant != 0.0 => {
                let lateral = m.speed.powi(2) * t.curvature - m.gravity * t.cant / t.cant_base;
                Some(Curve { curvature: t.curvature, cant: t.cant, lateral })
            }
            _ => None,
        };
        Running { speed: m.speed, friction: m.wheels.iter().map(|w| w.friction).reduce(f64::min), curve }
    }

    /// Writes a state as constants.
    fn put<S: Scalar>(&self, at: &Steady, pass: &mut Pass<S>) {
        let m = self.m;
        pass.x.iter_mut().zip(&at.x).for_each(|(to, &x)| *to = S::constant(x));
        pass.inputs.iter_mut().zip(&at.inputs).for_each(|(to, &u)| *to = S::constant(u));
        pass.integrals.iter_mut().zip(&at.integrals).for_each(|(to, &w)| *to = S::constant(w));
        if m.hold.is_some() {
            let speed = &mut pass.inputs[m.places.speed];
            *speed = *speed * self.speed_share;
        }
        if let Course::Uniform(track) = m.track {
            let [curvature, cant] = [0, 1].map(|i| m.places.track + i);
            pass.inputs[curvature] = pass.inputs[curvature] + (self.share - 1.0) * track.curvature;
            pass.inputs[cant] = pass.inputs[cant] + (self.share - 1.0) * track.cant;
        }
    }

    /// What is nil in a steady state.
    fn plain(&self, at: &Steady, pass: &mut Pass<f64>) -> Result<DVector<f64>, Fault> {
        self.put(at, pass);
        pass.evaluate(self.m, self.wiring)?;
        let mut residual = DVector::zeros(self.unknowns(at).count());
        self.residual(pass, residual.as_mut_slice());
        Ok(residual)
    }

    /// What is nil in a steady state, and its Jacobian.
    fn linearised(&self, at: &Steady, jacobian: &mut DMatrix<f64>) -> Result<DVector<f64>, Fault> {
        let n = jacobian.nrows();
        let (m, commands) = (self.m, self.driven().len());
        let mut pass = Pass::<Dual<DIRECTIONS>>::new(m, self.wiring).limited(self.limited);
        let mut residual = vec![Dual::default(); n];
        for first in (0..n).step_by(DIRECTIONS) {
            let seed = |value: f64, place: usize| Dual {
                value,
                slope: core::array::from_fn(|d| f64::from(u8::from(first + d == place))),
            };
            self.put(at, &mut pass);
            for (j, &i) in self.free.iter().enumerate() {
                pass.x[i] = seed(at.x[i], j);
            }
            for (j, &i) in self.driven().iter().enumerate() {
                pass.inputs[i] = seed(at.inputs[i], self.free.len() + j);
            }
            for (j, &value) in at.integrals.iter().enumerate() {
                pass.integrals[j] = seed(value, self.free.len() + commands + j);
            }
            pass.evaluate(m, self.wiring)?;
            self.residual(&pass, &mut residual);
            for d in 0..DIRECTIONS.min(n - first) {
                for i in 0..n {
                    jacobian[(i, first + d)] = residual[i].slope[d];
                }
            }
        }
        Ok(DVector::from_iterator(n, residual.iter().map(|r| r.value)))
    }

    /// Rates, with those of the arc lengths relative to the reference body's; commands less what they should be; what
    /// the integrals lack.
    fn residual<S: Scalar>(&self, pass: &Pass<S>, into: &mut [S]) {
        let m = self.m;
        let s_ref = m.bodies[m.reference()].state;
        for (to, &i) in into.iter_mut().zip(&self.free) {
            *to = pass.dx[i];
            if m.bodies.iter().any(|b| b.state == i) {
                *to -= pass.dx[s_ref];
            }
        }
        if let (Some(wiring), Some(memory)) = (self.wiring, &pass.memory) {
            let wanted = wiring.diagram.commands(memory).zip(&wiring.driven).map(|(u, &i)| pass.inputs[i] - u);
            let rest = wanted.chain(wiring.diagram.unsettled(memory, &pass.integrals));
            into[self.free.len()..].iter_mut().zip(rest).for_each(|(to, value)| *to = value);
        }
    }
}
