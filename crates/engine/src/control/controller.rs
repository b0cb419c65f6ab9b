//! A controller in a run: a block diagram with its memory.
//! The engine calls `reset` once and `step` at every sample, and holds the commands in between.

use super::diagram::{Diagram, Memory};
use super::error::ControlError;
use super::external::{Attached, Externals};
use super::spec::ControlSpec;

/// A block diagram ready to run.
#[derive(Debug)]
pub struct Controller {
    diagram: Diagram,
    externals: Vec<Attached>,
    memory: Memory<f64>,
    integrals: Vec<f64>,
    commands: Vec<f64>,
    probes: Vec<f64>,
}

impl Controller {
    /// Checks and compiles a diagram.
    ///
    /// # Errors
    /// Names that are unknown or taken twice, numbers out of their range, filters with a pole at z = 1, controllers
    /// outside the core.
    pub fn compile(spec: &ControlSpec) -> Result<Self, ControlError> {
        Self::with(spec, Externals::new())
    }

    /// As `compile`, with the controllers outside the core by the names of their blocks.
    ///
    /// # Errors
    /// As `compile`; a block without its controller, a controller without its block.
    pub fn with(spec: &ControlSpec, externals: Externals) -> Result<Self, ControlError> {
        let diagram = Diagram::compile(spec)?;
        Ok(Self {
            externals: Attached::all(&spec.blocks, externals)?,
            memory: diagram.memory(),
            integrals: vec![0.0; diagram.integrators()],
            commands: vec![0.0; diagram.command_targets.len()],
            probes: vec![0.0; diagram.probe_channels.len()],
            diagram,
        })
    }

    /// What it was compiled to.
    pub fn diagram(&self) -> &Diagram {
        &self.diagram
    }

    /// Time between two calls of `step`, s.
    pub fn sample_time(&self) -> f64 {
        self.diagram.sample_time
    }

    /// The channels `reset` and `step` want, in order.
    pub fn measurement_names(&self) -> &[String] {
        &self.diagram.measurement_names
    }

    /// The inputs of the plant that `commands` drives, in order.
    pub fn command_targets(&self) -> &[String] {
        &self.diagram.command_targets
    }

    /// Channel and unit of every probe, in order.
    pub fn probe_channels(&self) -> &[(String, String)] {
        &self.diagram.probe_channels
    }

    /// Goes to the state that constant measurements would lead to: a run starts without a jolt.
    ///
    /// # Errors
    /// As `step`.
    pub fn reset(&mut self, measurements: &[f64]) -> Result<(), ControlError> {
        let Self { diagram, externals, memory, integrals, .. } = self;
        diagram.settle_with(memory, measurements, integrals, calling(externals))?;
        self.put_out();
        Ok(())
    }

    /// Integrals that `reset` begins with, one a PI block; zero if never given.
    pub fn start_with(&mut self, integrals: &[f64]) {
        self.integrals.copy_from_slice(integrals);
    }

    /// Settled before the run: its first sample is a `step`.
    pub fn before_start(&mut self) {
        Diagram::before_start(&mut self.memory);
    }

    /// One sample: measurements in (SI, in the order of `measurement_names`), commands and probes out.
    ///
    /// # Errors
    /// A wrong number of measurements, a value that is not finite, an input outside its table; a controller outside the
    /// core that fails.
    pub fn step(&mut self, measurements: &[f64]) -> Result<(), ControlError> {
        self.diagram.step_with(&mut self.memory, measurements, calling(&mut self.externals))?;
        self.put_out();
        Ok(())
    }

    fn put_out(&mut self) {
        self.commands.iter_mut().zip(self.diagram.commands(&self.memory)).for_each(|(to, value)| *to = value);
        self.probes.iter_mut().zip(self.diagram.probes(&self.memory)).for_each(|(to, value)| *to = value);
    }

    /// What the last `reset` or `step` commands, in the order of `command_targets`.
    pub fn commands(&self) -> &[f64] {
        &self.commands
    }

    /// The probed signals of the last `reset` or `step`, in the order of `probe_channels`.
    pub fn probes(&self) -> &[f64] {
        &self.probes
    }
}

/// Calls the external controller of a name.
fn calling(externals: &mut [Attached]) -> impl FnMut(&str, f64, &[f64], &mut [f64]) -> Result<(), ControlError> {
    |name, time, inputs, outputs| match externals.iter_mut().find(|e| e.name == name) {
        Some(external) => external.step(time, inputs, outputs),
        None => Err(ControlError::ExternalMissing { name: name.into() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn controller(blocks: &str) -> Result<Controller, ControlError> {
        let json = format!(
            r#"{{"sample_time": 0.001, "measurements": ["v", "w"], "blocks": [{blocks}],
                "commands": [{{"target": "motor", "signal": "out"}}],
                "probes": [{{"channel": "u", "unit": "V", "signal": "out"}}]}}"#
        );
        Controller::compile(&serde_json::from_str(&json).unwrap())
    }

    #[test]
    fn the_clock_tells_the_time_of_the_run() {
        let mut c = controller(r#"{"kind": "clock", "name": "out"}"#).unwrap();
        c.reset(&[0.0, 0.0]).unwrap();
        assert_eq!(c.commands(), [0.0]);
        for _ in 0..250 {
            c.step(&[0.0, 0.0]).unwrap();
        }
        assert_eq!(c.commands(), [0.25]);
        c.before_start();
        c.step(&[0.0, 0.0]).unwrap();
        assert_eq!(c.commands(), [0.0]);
    }

    const LOOKUP: &str = r#"{"kind": "lookup", "name": "out", "input": "v", "x": [0, 10], "y": [1, 3]}"#;

    #[test]
    fn signals_flow_from_measurements_through_blocks_to_commands_and_probes() {
        let mut c = controller(
            r#"{"kind": "lookup", "name": "k", "input": "v", "x": [0, 10], "y": [1, 3]},
               {"kind": "sum", "name": "out", "terms": [{"signal": "w", "gain": "k"}, {"signal": "v"}]}"#,
        )
        .unwrap();
        c.reset(&[5.0, 10.0]).unwrap();
        assert_eq!((c.commands(), c.probes()), (&[25.0][..], &[25.0][..]));
        c.step(&[0.0, 10.0]).unwrap();
        assert_eq!(c.commands(), [10.0]);
        assert_eq!(c.measurement_names(), ["v", "w"]);
        assert_eq!(c.command_targets(), ["motor"]);
        assert_eq!(c.probe_channels(), [("u".to_owned(), "V".to_owned())]);
    }

    #[test]
    fn what_cannot_be_known_or_run_is_refused_by_name() {
        for (blocks, word) in [
            (r#"{"kind": "sum", "name": "out", "terms": [{"signal": "x"}]}"#, "`x`"),
            (r#"{"kind": "sum", "name": "out", "terms": []}, {"kind": "sum", "name": "out", "terms": []}"#, "twice"),
            (r#"{"kind": "delay", "name": "out", "input": "v", "samples": 0}"#, "samples"),
            (r#"{"kind": "delay", "name": "out", "input": "v", "samples": 1000000000000}"#, "at most 1000000"),
            (r#"{"kind": "saturation", "name": "out", "input": "v", "lower": 1, "upper": -1}"#, "above upper = -1"),
            (
                r#"{"kind": "pi", "name": "out", "input": "v", "proportional": 1, "integral": 1, "lower": 2, "upper": 1}"#,
                "above upper = 1",
            ),
            (r#"{"kind": "lookup", "name": "out", "input": "v", "x": [1, 1], "y": [0, 0]}"#, "increasing"),
            (r#"{"kind": "quantise", "name": "out", "input": "v", "step": 0}"#, "step"),
            (r#"{"kind": "noise", "name": "out", "std": -1, "seed": 0}"#, "std"),
            (r#"{"kind": "hold", "name": "out", "input": "v", "samples": 0}"#, "samples"),
            (r#"{"kind": "rate_limit", "name": "out", "input": "v", "rising": 0, "falling": 1}"#, "rising"),
            (r#"{"kind": "filter", "name": "out", "input": "v", "sections": [{"b": [1, 0, 0], "a": [-1, 0]}]}"#, "pi"),
            (
                r#"{"kind": "state_space", "name": "f", "inputs": ["v"], "outputs": ["out"], "a": [[1]], "b": [[1]], "c": [[1]], "d": [[0]]}"#,
                "pole",
            ),
            (
                r#"{"kind": "state_space", "name": "f", "inputs": ["v"], "outputs": ["out"], "a": [[1, 2]], "b": [[1]], "c": [[1]], "d": [[0]]}"#,
                "shape",
            ),
        ] {
            let error = controller(blocks).unwrap_err().to_string();
            assert!(error.contains(word), "{error}");
        }
    }

    #[test]
    fn a_probe_is_recorded_once() {
        let json = r#"{"sample_time": 0.001, "measurements": ["v"], "blocks": [], "commands": [], "probes": [
            {"channel": "u", "unit": "V", "signal": "v"}, {"channel": "u", "unit": "V", "signal": "v"}]}"#;
        let error = Controller::compile(&serde_json::from_str(json).unwrap()).unwrap_err().to_string();
        assert_eq!(error, "control probe `u` is recorded twice; give it another name");
    }

    #[test]
    fn a_block_of_several_outputs_is_read_by_their_names() {
        let mut c = controller(
            r#"{"kind": "state_space", "name": "both", "inputs": ["v", "w"], "outputs": ["sum", "lag"],
                "a": [[0.5]], "b": [[1, 0]], "c": [[0], [1]], "d": [[1, 1], [0, 0]]},
               {"kind": "sum", "name": "out", "terms": [{"signal": "sum"}, {"signal": "lag", "gain": 10}]}"#,
        )
        .unwrap();
        c.reset(&[1.0, 3.0]).unwrap();
        assert_eq!(c.commands(), [24.0]);
        c.step(&[0.0, 0.0]).unwrap();
        assert_eq!(c.commands(), [20.0]);
        assert_eq!(c.diagram().state_names(), ["both.0"]);
    }

    #[test]
    fn runs_round_and_hold_and_steady_states_do_not() {
        let blocks = r#"{"kind": "quantise", "name": "q", "input": "v", "step": 1.0},
            {"kind": "noise", "name": "n", "std": 1.0, "seed": 5},
            {"kind": "hold", "name": "h", "input": "q", "samples": 2},
            {"kind": "sum", "name": "out", "terms": [{"signal": "h"}, {"signal": "n"}]}"#;
        let mut c = controller(blocks).unwrap();
        c.reset(&[0.3, 0.0]).unwrap();
        assert_eq!(c.commands(), [0.3]);
        c.before_start();
        c.step(&[0.3, 0.0]).unwrap();
        let first = c.commands()[0];
        assert!(first != 0.0 && first != 0.3, "{first}");
        let mut again = controller(blocks).unwrap();
        again.before_start();
        again.step(&[0.3, 0.0]).unwrap();
        assert_eq!(again.commands(), [first]);
        let diagram = c.diagram();
        let mut memory = diagram.memory::<f64>();
        memory.linear = true;
        diagram.settle(&mut memory, &[0.3, 0.0], &[]).unwrap();
        diagram.step(&mut memory, &[0.5, 0.0]).unwrap();
        assert_eq!(diagram.commands(&memory).collect::<Vec<_>>(), [0.4]);
    }

    #[test]
    fn a_run_reports_the_block_and_the_value_that_failed() {
        let mut c = controller(LOOKUP).unwrap();
        let outside = ControlError::OutsideTable { block: "out".into(), value: 11.0, low: 0.0, high: 10.0 };
        assert_eq!(c.step(&[11.0, 0.0]).unwrap_err(), outside);
        assert!(c.step(&[f64::NAN, 0.0]).unwrap_err().to_string().contains("`v`"));
        assert!(c.step(&[1.0]).unwrap_err().to_string().contains("expects 2"));
        let mut c = controller(r#"{"kind": "product", "name": "out", "factors": ["v", "w"]}"#).unwrap();
        assert!(c.step(&[1e200, 1e200]).unwrap_err().to_string().contains("`out` gives inf"));
    }
}
